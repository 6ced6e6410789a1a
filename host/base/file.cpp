// SPDX-License-Identifier: Apache-2.0
#include "base/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "base/error.h"

namespace sunstone {

namespace {

class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor &) = delete;
  Descriptor &operator=(const Descriptor &) = delete;
  int get() const { return fd_; }
  int release_and_close() {
    const int fd = fd_;
    fd_ = -1;
    return ::close(fd);
  }

 private:
  int fd_;
};

std::string shown(const std::filesystem::path &path) { return printable(path.string(), 400); }
std::string reason() { return std::strerror(errno); }

}  // namespace

std::vector<std::byte> read_file(const std::filesystem::path &path, std::size_t limit) {
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.get() < 0) throw Error(shown(path), errno == ENOENT ? "no such file" : reason());
  struct stat status {};
  if (::fstat(file.get(), &status) != 0) throw Error(shown(path), reason());
  if (S_ISDIR(status.st_mode)) throw Error(shown(path), "is a folder, not a file");
  if (!S_ISREG(status.st_mode)) throw Error(shown(path), "is not a regular file");
  if (static_cast<std::size_t>(status.st_size) > limit)
    throw Error(shown(path), "has " + std::to_string(status.st_size) + " bytes, more than the " + std::to_string(limit) + " that are read");
  std::vector<std::byte> data(static_cast<std::size_t>(status.st_size));
  std::size_t done = 0;
  while (done < data.size()) {
    const ssize_t n = ::read(file.get(), data.data() + done, data.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) throw Error(shown(path), reason());
    if (n == 0) break;
    done += static_cast<std::size_t>(n);
  }
  data.resize(done);
  return data;
}

AtomicFile::AtomicFile(std::filesystem::path path) : path_(std::move(path)) {
  const std::string name = "." + path_.stem().string() + "." + std::to_string(::getpid()) + ".part" + path_.extension().string();
  temporary_ = path_.parent_path() / name;
}

AtomicFile::~AtomicFile() {
  if (!committed_) ::unlink(temporary_.c_str());
}

void AtomicFile::commit() {
  {
    const Descriptor file(::open(temporary_.c_str(), O_RDONLY | O_CLOEXEC));
    if (file.get() < 0 || ::fsync(file.get()) != 0) throw Error(shown(path_), "could not be written: " + reason());
  }
  if (::rename(temporary_.c_str(), path_.c_str()) != 0) throw Error(shown(path_), "could not be written: " + reason());
  committed_ = true;
}

void write_file(const std::filesystem::path &path, std::span<const std::byte> data) {
  AtomicFile atomic(path);
  Descriptor file(::open(atomic.temporary().c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
  if (file.get() < 0) throw Error(shown(path), "could not be written: " + reason());
  std::size_t done = 0;
  while (done < data.size()) {
    const ssize_t n = ::write(file.get(), data.data() + done, data.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) throw Error(shown(path), "could not be written: " + reason());
    done += static_cast<std::size_t>(n);
  }
  if (file.release_and_close() != 0) throw Error(shown(path), "could not be written: " + reason());
  atomic.commit();
}

void check_writable(const std::filesystem::path &path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) throw Error(shown(path), "is a folder; give a file name");
  const std::filesystem::path folder = path.parent_path().empty() ? "." : path.parent_path();
  if (!std::filesystem::is_directory(folder, error)) throw Error(shown(path), "the folder " + shown(folder) + " does not exist");
  const AtomicFile probe(path);
  const Descriptor file(::open(probe.temporary().c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666));
  if (file.get() < 0) throw Error(shown(path), "cannot be written: " + reason());
}

}  // namespace sunstone
