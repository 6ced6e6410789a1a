// SPDX-License-Identifier: Apache-2.0
// Files read whole and written whole: beside, then renamed, so that nothing is ever half-written.
#pragma once
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace sunstone {

// The bytes of a file; an Error names it where it is missing, a folder, unreadable or longer than `limit`.
std::vector<std::byte> read_file(const std::filesystem::path &path, std::size_t limit = std::size_t(1) << 34);

// Writes `data` to a new file beside `path`, flushes it, and renames it to `path`; leaves nothing behind on an Error.
void write_file(const std::filesystem::path &path, std::span<const std::byte> data);

// A name beside `path` for writers that want a file name, with the same extension; commit() renames it to `path`, the destructor removes what was not committed.
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path path);
  ~AtomicFile();
  AtomicFile(const AtomicFile &) = delete;
  AtomicFile &operator=(const AtomicFile &) = delete;
  const std::filesystem::path &temporary() const { return temporary_; }
  void commit();

 private:
  std::filesystem::path path_, temporary_;
  bool committed_ = false;
};

// Fails now, not after an hour's render, where `path` could not be written: no folder, no permission, or it is a folder.
void check_writable(const std::filesystem::path &path);

}  // namespace sunstone
