// SPDX-License-Identifier: Apache-2.0
// Small glTF files made in a test: accessors are appended to one buffer, the rest is JSON that the test edits.
#pragma once
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "import/importers.h"
#include "support/temporary_folder.h"

namespace sunstone::test {

template <class T>
constexpr int component_type() {
  if constexpr (std::is_same_v<T, std::int8_t>)
    return 5120;
  else if constexpr (std::is_same_v<T, std::uint8_t>)
    return 5121;
  else if constexpr (std::is_same_v<T, std::int16_t>)
    return 5122;
  else if constexpr (std::is_same_v<T, std::uint16_t>)
    return 5123;
  else if constexpr (std::is_same_v<T, std::uint32_t>)
    return 5125;
  else {
    static_assert(std::is_same_v<T, float>);
    return 5126;
  }
}

inline int components(const std::string &type) { return type == "SCALAR" ? 1 : type == "MAT4" ? 16 : type.back() - '0'; }

class GltfBuilder {
 public:
  nlohmann::json root;
  ImportOptions options;

  // A scene of one node with one mesh of one triangle: (0,0,0) (1,0,0) (0,1,0).
  GltfBuilder() {
    root = {{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", {0}}}}}, {"nodes", {{{"mesh", 0}}}}};
    const int position = accessor<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0});
    root["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", position}}}}}}}};
  }
  nlohmann::json &primitive() { return root["meshes"][0]["primitives"][0]; }

  template <class T>
  int view(const std::vector<T> &values) {
    while (data_.size() % 4) data_.push_back(0);
    root["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", data_.size()}, {"byteLength", values.size() * sizeof(T)}});
    const char *bytes = reinterpret_cast<const char *>(values.data());
    data_.insert(data_.end(), bytes, bytes + values.size() * sizeof(T));
    return static_cast<int>(root["bufferViews"].size()) - 1;
  }
  template <class T>
  int accessor(const std::string &type, const std::vector<T> &values, bool normalized = false) {
    nlohmann::json accessor = {{"bufferView", view(values)},
                               {"componentType", component_type<T>()},
                               {"type", type},
                               {"count", values.size() / static_cast<std::size_t>(components(type))}};
    if (normalized) accessor["normalized"] = true;
    root["accessors"].push_back(accessor);
    return static_cast<int>(root["accessors"].size()) - 1;
  }

  std::vector<char> glb() const {
    nlohmann::json whole = root;
    whole["buffers"] = {{{"byteLength", data_.size()}}};
    std::string json = whole.dump();
    while (json.size() % 4) json += ' ';
    std::vector<char> out;
    const auto word = [&](std::uint32_t value) { out.insert(out.end(), reinterpret_cast<char *>(&value), reinterpret_cast<char *>(&value) + 4); };
    const std::size_t padded = (data_.size() + 3) / 4 * 4;
    word(0x46546c67), word(2), word(static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + padded));
    word(static_cast<std::uint32_t>(json.size())), word(0x4e4f534a);
    out.insert(out.end(), json.begin(), json.end());
    word(static_cast<std::uint32_t>(padded)), word(0x004e4942);
    out.insert(out.end(), data_.begin(), data_.end());
    out.resize(out.size() + padded - data_.size());
    return out;
  }
  Scene import(Notices &notices) const {
    const TemporaryFolder folder;
    return import_gltf(folder.write("test.glb", glb()), options, notices);
  }
  // Expects that nothing was to be warned about.
  Scene import() const {
    Notices notices;
    Scene scene = import(notices);
    for (const Notice &notice : notices.all())
      if (notice.kind == Notice::Kind::warning) throw std::runtime_error("unexpected warning: " + notice.place + ": " + notice.text);
    return scene;
  }
  // The text of the Error that importing ends in; empty where it does not.
  std::string refusal() const {
    Notices notices;
    try {
      import(notices);
    } catch (const Error &error) {
      return error.what();
    }
    return {};
  }
  // The texts of the warnings.
  std::vector<std::string> warnings() const {
    Notices notices;
    import(notices);
    std::vector<std::string> texts;
    for (const Notice &notice : notices.all())
      if (notice.kind == Notice::Kind::warning) texts.push_back(notice.place + ": " + notice.text);
    return texts;
  }

 private:
  std::vector<char> data_;
};

}  // namespace sunstone::test
