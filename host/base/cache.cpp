// SPDX-License-Identifier: Apache-2.0
#include "base/cache.h"

#include <cstdlib>
#include <cstring>
#include <string>
#include <system_error>

#include "base/error.h"
#include "base/file.h"

namespace sunstone {

namespace {

// Ahead of the data: a mark, the key and the data's own hash.
struct Header {
  char mark[8];
  Hash key, data;
};
constexpr char mark[9] = "SUNCACH1";
constexpr const char *suffix = ".cache";

Hash hash_of(std::span<const std::byte> data) {
  Hasher hasher;
  hasher.span(data);
  return hasher.digest();
}

std::filesystem::path entry(const std::string &kind, const Hash &key) { return cache_folder() / (kind + "-" + key.hex() + suffix); }

}  // namespace

std::filesystem::path cache_folder() {
  const auto variable = [](const char *name) {
    const char *value = std::getenv(name);
    return std::filesystem::path(value ? value : "");
  };
  if (const auto own = variable("SUNSTONE_CACHE"); !own.empty()) return own;
  if (const auto xdg = variable("XDG_CACHE_HOME"); !xdg.empty()) return xdg / "sunstone";
  if (const auto home = variable("HOME"); !home.empty()) return home / ".cache" / "sunstone";
  return {};
}

std::optional<std::vector<std::byte>> cache_read(const std::string &kind, const Hash &key) {
  if (cache_folder().empty()) return std::nullopt;
  try {
    std::vector<std::byte> file = read_file(entry(kind, key));
    Header header;
    if (file.size() < sizeof header) return std::nullopt;
    std::memcpy(&header, file.data(), sizeof header);
    file.erase(file.begin(), file.begin() + sizeof header);
    if (std::memcmp(header.mark, mark, 8) != 0 || header.key != key || header.data != hash_of(file)) return std::nullopt;
    return file;
  } catch (const Error &) {
    return std::nullopt;
  }
}

void cache_write(const std::string &kind, const Hash &key, std::span<const std::byte> data) {
  if (cache_folder().empty()) return;
  Header header{{}, key, hash_of(data)};
  std::memcpy(header.mark, mark, 8);
  std::vector<std::byte> file(sizeof header + data.size());
  std::memcpy(file.data(), &header, sizeof header);
  if (!data.empty()) std::memcpy(file.data() + sizeof header, data.data(), data.size());
  std::error_code error;
  std::filesystem::create_directories(cache_folder(), error);
  if (error) return;
  try {
    write_file(entry(kind, key), file);
  } catch (const Error &) {
    return;  // a read-only home or a full disk: the next run compiles again
  }
}

std::size_t cache_clear() {
  std::size_t bytes = 0;
  std::error_code error;
  for (const auto &file : std::filesystem::directory_iterator(cache_folder(), error)) {
    if (file.path().extension() != suffix) continue;
    const auto size = file.file_size(error);
    if (!error && std::filesystem::remove(file.path(), error)) bytes += size;
  }
  return bytes;
}

}  // namespace sunstone
