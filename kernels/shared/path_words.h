// SPDX-License-Identifier: Apache-2.0
// How many words the list of path fields makes.
#ifndef SUN_SHARED_PATH_WORDS_H
#define SUN_SHARED_PATH_WORDS_H
#include "shared/types.h"

SUN_NAMESPACE_BEGIN

#define PATH_FIELD(type, name) SUN_PATH_##name,
enum PathField {
#include "shared/path_fields.h"
  SUN_PATH_WORDS
};
#undef PATH_FIELD
SUN_STATIC_ASSERT(SUN_PATH_WORDS == 16, a_path_is_a_cache_line);

SUN_NAMESPACE_END
#endif
