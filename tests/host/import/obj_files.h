// SPDX-License-Identifier: Apache-2.0
// A folder of small files made by a test, imported from and removed.
#pragma once
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "base/error.h"
#include "import/import.h"

namespace sunstone::test {

class Folder {
 public:
  Folder() : path_(std::filesystem::temp_directory_path() / ("sunstone_obj_" + std::to_string(::getpid()) + "_" + std::to_string(count()++))) {
    std::filesystem::create_directories(path_);
  }
  ~Folder() {
    std::error_code error;
    std::filesystem::remove_all(path_, error);
  }
  Folder(const Folder &) = delete;
  Folder &operator=(const Folder &) = delete;
  std::filesystem::path write(const std::string &name, std::string_view text) const {
    std::filesystem::remove(path_ / name);  // (ext4 waits for the disk where a file is written anew in place)
    std::ofstream(path_ / name, std::ios::binary) << text;
    return path_ / name;
  }
  const std::filesystem::path &path() const { return path_; }

 private:
  static int &count() {
    static int number = 0;
    return number;
  }
  std::filesystem::path path_;
};

struct Imported {
  Scene scene;
  std::vector<Notice> notices;
  std::string error;
  std::size_t triangles() const {
    std::size_t count = 0;
    for (const Mesh &mesh : scene.meshes)
      for (const Primitive &p : mesh.primitives) count += p.indices.size() / 3;
    return count;
  }
  const Primitive &only() const { return scene.meshes.at(0).primitives.at(0); }
  // How many warnings hold `text`.
  int warnings(const std::string &text = {}) const {
    int count = 0;
    for (const Notice &n : notices) count += n.kind == Notice::Kind::warning && (n.place + ": " + n.text).find(text) != std::string::npos;
    return count;
  }
};

inline Imported import_file(const std::filesystem::path &path) {
  Imported out;
  Notices notices;
  try {
    out.scene = import_scene(path, {}, notices);
  } catch (const Error &error) {
    out.error = error.what();
  }
  out.notices = notices.all();
  return out;
}

inline Imported import_text(std::string_view obj, std::string_view mtl = {}) {
  const Folder folder;
  if (!mtl.empty()) folder.write("m.mtl", mtl);
  return import_file(folder.write("s.obj", obj));
}

// The shared scenes, which a checkout may lack.
inline std::filesystem::path scenes() {
  const char *const given = std::getenv("SUNSTONE_SCENES");
  return given ? std::filesystem::path(given) : std::filesystem::path(SUNSTONE_SOURCE_DIR) / "../shared/scenes";
}

}  // namespace sunstone::test
