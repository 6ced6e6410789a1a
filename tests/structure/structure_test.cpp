// SPDX-License-Identifier: Apache-2.0
// The architecture, held: reads every #include of host/, kernels/ and bench/ and compares it with the table of who may know whom.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;
const fs::path root = SUNSTONE_SOURCE_DIR;

using Names = std::set<std::string>;

// What a folder may include besides itself; every folder of host/ and bench may include host/base. Folders are named from the root of the repository.
const std::map<std::string, Names> table = {
    {"host/base", {}},
    {"host/image", {"kernels/math", "kernels/shared"}},
    {"host/scene", {"host/image", "kernels/math", "kernels/shared"}},
    {"host/film", {"kernels/math", "kernels/shared"}},
    {"host/import", {"host/image", "host/scene", "kernels/math", "kernels/shared"}},
    // kernels/bsdf: make_tables.cpp integrates the lobes themselves.
    {"host/flatten", {"host/image", "host/scene", "kernels/bsdf", "kernels/math", "kernels/shared"}},
    {"host/output", {"host/film", "host/image", "kernels/math", "kernels/shared"}},
    {"host/device", {"kernels/math", "kernels/shared"}},
    {"host/pipeline", {"host/device", "host/film", "host/flatten", "kernels/math", "kernels/shared"}},
    {"bench", {"host/device", "host/film", "host/flatten", "host/pipeline", "kernels/math", "kernels/shared"}},
    // bench: Embree's side of `sunstone bench` is behind the content object's door, as Embree is.
    {"host/content", {"bench", "host/film", "host/flatten", "host/image", "host/import", "host/output", "host/scene"}},
    // learn: renders and shows as the command does, but the command opens scenes for it, so flags stay in host/cli.
    {"host/learn", {"host/content", "host/film", "host/image", "host/pipeline", "kernels/shared"}},
    {"host/cli",
     {"bench", "host/content", "host/device", "host/film", "host/flatten", "host/image", "host/import", "host/learn", "host/output", "host/pipeline", "host/scene", "kernels/math",
      "kernels/shared"}},
    {"kernels/shared", {}},
    {"kernels/math", {"kernels/shared"}},
    {"kernels/bsdf", {"kernels/math", "kernels/shared"}},
    {"kernels/path", {"kernels/math", "kernels/shared"}},
    // kernels/bsdf: scene/surface.h answers "what is here" with the parameters of a BSDF. Not the other way round.
    {"kernels/scene", {"kernels/bsdf", "kernels/math", "kernels/shared"}},
    {"kernels/transport", {"kernels/bsdf", "kernels/math", "kernels/path", "kernels/scene", "kernels/shared"}},
    {"kernels/stages", {"kernels/bsdf", "kernels/math", "kernels/path", "kernels/scene", "kernels/shared", "kernels/transport"}},
};

// Libraries with one door each: the beginning of a header's name, and the folders that may include it.
const std::map<std::string, Names> doors = {
    {"CL/", {"host/device"}},
    {"OpenImageIO/", {"host/image", "host/output"}},
    {"embree3/", {"host/flatten", "bench"}},
    {"tbb/", {"host/flatten"}},
    {"tiny_obj_loader", {"host/import"}},
    {"CLI/", {"host/cli"}},
    {"gtest/", {}},
};

// Made by the build, beside its source.
const Names generated = {"energy_tables.inc"};

struct Include {
  std::string file, folder, name;
  int line;
  bool quoted;
};

std::string read(const fs::path &file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// Sources of host/, kernels/ and bench, and the folder of the table that each belongs to.
std::vector<std::pair<fs::path, std::string>> sources() {
  std::vector<std::pair<fs::path, std::string>> found;
  for (const std::string top : {"host", "kernels", "bench"}) {
    for (const fs::directory_entry &entry : fs::recursive_directory_iterator(root / top)) {
      const std::string suffix = entry.path().extension().string();
      if (!entry.is_regular_file() || (suffix != ".h" && suffix != ".cpp" && suffix != ".cl")) continue;
      const fs::path parent = fs::relative(entry.path(), root).parent_path();
      found.emplace_back(entry.path(), parent.generic_string());
    }
  }
  std::ranges::sort(found);
  return found;
}

std::vector<Include> includes() {
  std::vector<Include> found;
  for (const auto &[path, folder] : sources()) {
    std::ifstream in(path);
    int number = 0;
    for (std::string line; std::getline(in, line);) {
      number++;
      const std::size_t hash = line.find_first_not_of(" \t");
      if (hash == std::string::npos || line[hash] != '#') continue;
      const std::size_t word = line.find_first_not_of(" \t", hash + 1);
      if (word == std::string::npos || line.compare(word, 7, "include") != 0) continue;
      const std::size_t open = line.find_first_of("\"<", word);
      if (open == std::string::npos) continue;
      const std::size_t close = line.find(line[open] == '<' ? '>' : '"', open + 1);
      found.push_back({fs::relative(path, root).generic_string(), folder, line.substr(open + 1, close - open - 1), number, line[open] == '"'});
    }
  }
  return found;
}

// The folder that a quoted name leads to from a file: as the compiler looks, for kernels in kernels/ alone. Empty where there is no such file.
std::string target(const Include &include) {
  std::vector<fs::path> places = {root / "kernels"};
  if (!include.folder.starts_with("kernels")) places = {root / "host", root / "kernels", root};
  for (const fs::path &place : places)
    if (fs::exists(place / include.name)) return fs::relative((place / include.name).parent_path(), root).generic_string();
  return "";
}

std::string where(const Include &include) { return include.file + ":" + std::to_string(include.line) + " includes " + include.name; }

TEST(structure, every_folder_stands_in_the_table) {
  std::size_t files = 0;
  for (const auto &[path, folder] : sources()) {
    EXPECT_TRUE(table.contains(folder)) << path << ": its folder has no row in this test's table";
    files++;
  }
  EXPECT_GT(files, 100u) << "the sources were not found below " << root;
  for (const auto &[folder, allowed] : table) EXPECT_TRUE(fs::is_directory(root / folder)) << folder << " stands in the table and is not there";
}

TEST(structure, folders_include_what_they_may) {
  std::size_t checked = 0;
  for (const Include &include : includes()) {
    if (!include.quoted || generated.contains(include.name)) continue;
    const std::string to = target(include);
    ASSERT_FALSE(to.empty()) << where(include) << ", which is not there";
    checked++;
    const auto row = table.find(include.folder);
    if (row == table.end() || to == include.folder) continue;
    const bool base = to == "host/base" && !include.folder.starts_with("kernels");
    EXPECT_TRUE(base || row->second.contains(to)) << where(include) << ": " << include.folder << " may not know " << to;
  }
  EXPECT_GT(checked, 300u);
}

TEST(structure, the_table_has_no_cycle) {
  std::set<std::string> done, open;
  const std::function<void(const std::string &)> visit = [&](const std::string &folder) {
    ASSERT_TRUE(table.contains(folder)) << folder;
    ASSERT_FALSE(open.contains(folder)) << "a cycle through " << folder;
    if (!done.insert(folder).second) return;
    open.insert(folder);
    for (const std::string &next : table.at(folder)) visit(next);
    open.erase(folder);
  };
  for (const auto &[folder, allowed] : table) visit(folder);
}

TEST(structure, libraries_come_in_by_their_door) {
  for (const Include &include : includes()) {
    if (include.quoted) continue;
    for (const auto &[prefix, folders] : doors) {
      EXPECT_TRUE(!include.name.starts_with(prefix) || folders.contains(include.folder)) << where(include);
    }
    // A kernel compiled as C++ may take from the standard library, and that is all.
    const bool foreign = include.folder.starts_with("kernels") && include.name.find_first_of("/.") != std::string::npos;
    EXPECT_FALSE(foreign) << where(include);
  }
  for (const auto &[path, folder] : sources()) {
    const bool spoken = read(path).find("cl::") != std::string::npos;
    EXPECT_TRUE(!spoken || folder == "host/device") << path << ": OpenCL is for host/device alone";
  }
}

TEST(structure, nothing_includes_the_command) {
  for (const Include &include : includes()) {
    EXPECT_TRUE(!include.quoted || include.folder == "host/cli" || target(include) != "host/cli") << where(include);
  }
}

TEST(structure, a_licence_line_heads_each_file) {
  for (const auto &[path, folder] : sources()) EXPECT_TRUE(read(path).starts_with("// SPDX-License-Identifier: Apache-2.0\n")) << path;
}

}  // namespace
