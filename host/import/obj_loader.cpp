// SPDX-License-Identifier: Apache-2.0
// The loader is compiled here, so that the sanitizers see into it.
#define TINYOBJLOADER_IMPLEMENTATION
#include "import/obj_loader.h"

#include <exception>
#include <istream>
#include <streambuf>

#include "base/error.h"

namespace sunstone {

namespace {

// A stream over text that stays where it is.
class TextBuffer : public std::streambuf {
 public:
  explicit TextBuffer(const std::string &text) {
    char *const begin = const_cast<char *>(text.data());  // streambuf asks for it and, for input, only reads
    setg(begin, begin, begin + text.size());
  }
};

class MemoryLibrary : public tinyobj::MaterialReader {
 public:
  explicit MemoryLibrary(const std::string &text) : text_(text) {}
  bool operator()(const std::string &, std::vector<tinyobj::material_t> *materials, std::map<std::string, int> *numbers, std::string *warnings,
                  std::string *errors) override {
    TextBuffer buffer(text_);
    std::istream stream(&buffer);
    tinyobj::LoadMtl(numbers, materials, &stream, warnings, errors);
    return true;
  }

 private:
  const std::string &text_;
};

}  // namespace

LoadedObj load_obj(const GuardedObj &obj, const GuardedMtl &libraries, const std::string &place) {
  LoadedObj out;
  std::vector<tinyobj::shape_t> shapes;
  std::string warnings, errors;
  bool read = false;
  try {
    if (!libraries.names.empty()) {  // the loader makes one of an empty library, too
      std::map<std::string, int> numbers;
      MemoryLibrary library(libraries.text);
      library("", &out.materials, &numbers, &warnings, &errors);
    }
    // usemtl names a material by its number, which the loader looks up in its own list: it gets a library of names alone.
    std::string names, text = "mtllib names\n";
    for (std::size_t i = 0; i < libraries.names.size(); i++) names += "newmtl " + std::to_string(i) + "\n";
    text += obj.text;
    TextBuffer buffer(text);
    std::istream stream(&buffer);
    MemoryLibrary library(names);
    std::vector<tinyobj::material_t> unused;
    read = tinyobj::LoadObj(&out.attributes, &shapes, &unused, &warnings, &errors, &stream, &library, false, obj.has_colors);
  } catch (const std::bad_alloc &) {
    throw Error(place, "there is not enough memory for it");
  } catch (const std::exception &error) {
    throw Error(place, "could not be read: " + printable(error.what()));
  }
  if (!read || !errors.empty()) throw Error(place, "could not be read: " + printable(errors));
  if (out.materials.size() != libraries.names.size()) throw Error(place, "could not be read: its materials were not understood");

  const tinyobj::attrib_t &a = out.attributes;
  out.faces.positions = a.vertices;
  out.faces.texture_coordinates = a.texcoords;
  out.faces.normals = a.normals;
  if (obj.has_colors) out.faces.colors = a.colors;
  out.faces.counts = obj.corners;
  const auto within = [](int index, std::size_t values, int each) { return index >= -1 && index < static_cast<long long>(values) / each; };
  for (const tinyobj::shape_t &shape : shapes) {
    for (const tinyobj::index_t &i : shape.mesh.indices) {
      if (i.vertex_index < 0 || !within(i.vertex_index, a.vertices.size(), 3) || !within(i.texcoord_index, a.texcoords.size(), 2) ||
          !within(i.normal_index, a.normals.size(), 3))
        throw Error(place, "could not be read: an index is out of range");
      out.faces.corners.push_back({i.vertex_index, i.texcoord_index, i.normal_index});
    }
    for (const int material : shape.mesh.material_ids)
      out.faces.materials.push_back(material < static_cast<int>(libraries.names.size()) && !libraries.names.empty() ? material : -1);
    for (const unsigned group : shape.mesh.smoothing_group_ids) out.faces.smoothing.push_back(group);
  }
  // (The loader's own counts of corners are bytes, so ours are used.)
  std::size_t corners = 0;
  for (const std::uint32_t count : obj.corners) corners += count;
  if (corners != out.faces.corners.size() || obj.corners.size() != out.faces.materials.size() || obj.corners.size() != out.faces.smoothing.size() ||
      (obj.has_colors && a.colors.size() != a.vertices.size()))
    throw Error(place, "could not be read: its faces were not understood");
  return out;
}

}  // namespace sunstone
