// SPDX-License-Identifier: Apache-2.0
#include "device/probe.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "base/cache.h"
#include "base/error.h"
#include "base/file.h"
#include "device/state.h"

namespace sunstone {

namespace {

namespace fs = std::filesystem;

constexpr unsigned patience = 60;  // seconds

// The .icd files that the loader will read (ocl-icd's rule for OCL_ICD_VENDORS).
std::vector<fs::path> driver_files() {
  const char *variable = std::getenv("OCL_ICD_VENDORS");
  const fs::path place = variable && *variable ? variable : "/etc/OpenCL/vendors";
  std::error_code error;
  if (!fs::is_directory(place, error)) return {place};
  std::vector<fs::path> files;
  for (const auto &entry : fs::directory_iterator(place, error))
    if (entry.path().extension() == ".icd") files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

// Changes with every driver that is installed, updated or removed, and with what makes one behave otherwise.
Hash drivers_key(const std::vector<fs::path> &files) {
  Hasher hasher;
  hasher.add(SUNSTONE_VERSION);
  for (const char *name : {"OCL_ICD_VENDORS", "OCL_ICD_FILENAMES", "RUSTICL_ENABLE", "LD_LIBRARY_PATH", "LD_PRELOAD"}) {
    const char *value = std::getenv(name);
    hasher.add(value ? value : "");
  }
  const auto add_time = [&](const fs::path &file) {
    std::error_code error;
    const auto time = fs::last_write_time(file, error);
    hasher.value(static_cast<std::int64_t>(error ? 0 : time.time_since_epoch().count()));
  };
  for (const fs::path &file : files) {
    hasher.add(file.string());
    add_time(file);
    try {
      const std::vector<std::byte> text = read_file(file, 4096);
      std::string library(reinterpret_cast<const char *>(text.data()), text.size());
      while (!library.empty() && (library.back() == '\n' || library.back() == ' ')) library.pop_back();
      hasher.add(library);
      if (library.starts_with('/')) add_time(library);
    } catch (const Error &) {
      hasher.add("unreadable");  // the loader will think the same
    }
  }
  return hasher.digest();
}

// Whether a process that lists all devices lives to its end; `vendors` is OCL_ICD_VENDORS for it, empty: as it is.
bool survives(const std::string &vendors) {
  const pid_t child = fork();
  if (child < 0) return true;  // no process to be had: try it here
  if (child == 0) {
    const int nowhere = open("/dev/null", O_RDWR);
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
    for (const int deadly : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGALRM}) signal(deadly, SIG_DFL);
    alarm(patience);
    if (!vendors.empty()) setenv("OCL_ICD_VENDORS", vendors.c_str(), 1);
    Notices unheard;
    list_devices_here(unheard);
    _exit(0);
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status);
}

}  // namespace

void leave_out_broken_drivers(Notices &notices) {
  const std::vector<fs::path> files = driver_files();
  const Hash key = drivers_key(files);
  if (cache_read("drivers", key) || survives("")) {
    if (!cache_read("drivers", key)) cache_write("drivers", key, std::as_bytes(std::span("fine")));
    return;
  }
  // One of them it was.
  const fs::path good = cache_folder() / ("drivers-" + key.hex());
  std::error_code error;
  fs::create_directories(good, error);
  if (error) throw Error(printable(good.string(), 400), "an OpenCL driver crashes, and there is no room to set it aside: " + error.message());
  for (const fs::path &file : files) {
    fs::remove(good / file.filename(), error);
    if (survives(file.string())) fs::copy_file(file, good / file.filename(), error);
    else notices.warning(printable(file.string(), 400), "this OpenCL driver crashes or hangs when it is asked for its devices; it is left out (update or remove its package)");
  }
  setenv("OCL_ICD_VENDORS", (good.string() + "/").c_str(), 1);
}

}  // namespace sunstone
