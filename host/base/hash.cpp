// SPDX-License-Identifier: Apache-2.0
#include "base/hash.h"

#include <xxhash.h>

#include <cstdio>
#include <new>

namespace sunstone {

std::string Hash::hex() const {
  char text[33];
  std::snprintf(text, sizeof text, "%016llx%016llx", static_cast<unsigned long long>(high), static_cast<unsigned long long>(low));
  return text;
}

static XXH3_state_t *state_of(void *state) { return static_cast<XXH3_state_t *>(state); }

Hasher::Hasher() : state_(XXH3_createState()) {
  if (!state_) throw std::bad_alloc();
  XXH3_128bits_reset(state_of(state_));
}
Hasher::~Hasher() { XXH3_freeState(state_of(state_)); }
void Hasher::bytes(const void *data, std::size_t size) {
  if (size) XXH3_128bits_update(state_of(state_), data, size);
}
Hash Hasher::digest() const {
  const XXH128_hash_t hash = XXH3_128bits_digest(state_of(state_));
  return {hash.high64, hash.low64};
}

}  // namespace sunstone
