// SPDX-License-Identifier: Apache-2.0
#include "import/gltf_strict.h"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <vector>

#include "base/error.h"

namespace sunstone::gltf {

namespace {

// A read position that everybody can see: nlohmann's SAX events do not say where in the text they are.
class CountedByte {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char *;
  using reference = const char &;

  CountedByte(const char *at, std::size_t *count) : at_(at), count_(count) {}
  reference operator*() const { return *at_; }
  CountedByte &operator++() {
    ++at_;
    ++*count_;
    return *this;
  }
  CountedByte operator++(int) {
    const CountedByte before = *this;
    ++*this;
    return before;
  }
  bool operator==(const CountedByte &other) const { return at_ == other.at_; }

 private:
  const char *at_;
  std::size_t *count_;
};

// nlohmann's SAX interface: builds the document, and throws at the first thing that is not to be trusted.
class Builder {
 public:
  Builder(std::string file, const std::size_t *position) : file_(std::move(file)), position_(position) {}
  Json take() { return std::move(root_); }

  bool null() { return add(nullptr); }
  bool boolean(bool value) { return add(value); }
  bool number_integer(Json::number_integer_t value) { return add(value); }
  bool number_unsigned(Json::number_unsigned_t value) { return add(value); }
  bool number_float(Json::number_float_t value, const std::string &) { return add(value); }  // the parser has refused what is not finite
  bool string(std::string &value) { return add(std::move(value)); }
  bool binary(Json::binary_t &) { return false; }  // JSON text has none

  bool start_object(std::size_t) { return open(Json::object()); }
  bool start_array(std::size_t) { return open(Json::array()); }
  bool end_object() { return close(); }
  bool end_array() { return close(); }

  bool key(std::string &name) {
    Level &level = levels_.back();
    level.key = std::move(name);
    if (level.container->contains(level.key)) fail("the key stands twice in this object");
    return true;
  }

  bool parse_error(std::size_t position, const std::string &, const Json::exception &exception) {
    std::string reason = exception.what();  // "[json.exception.parse_error.101] parse error at line 1, column 2: syntax error ..."
    if (const std::size_t at = reason.find("] "); at != std::string::npos) reason.erase(0, at + 2);
    if (reason.starts_with("parse error at"))
      if (const std::size_t at = reason.find(": "); at != std::string::npos) reason.erase(0, at + 2);
    throw Error(place(), "broken JSON at byte " + std::to_string(position) + ": " + printable(reason, 200));
  }

 private:
  struct Level {
    Json *container;
    std::string key;  // of the value that is being read; empty between values and in arrays
  };

  // "lamp.gltf: cameras[0].perspective.yfov": the value that is being read.
  std::string place() const {
    std::string path;
    for (std::size_t i = 0; i < levels_.size() && path.size() < 120; i++) {
      const Level &level = levels_[i];
      if (level.container->is_array()) {
        // A container that has been opened is its parent's last element already.
        path += "[" + std::to_string(level.container->size() - (i + 1 < levels_.size() ? 1 : 0)) + "]";
      } else if (!level.key.empty()) {
        path += (path.empty() ? "" : ".") + printable(level.key, 60);
      }
    }
    return path.empty() ? file_ : file_ + ": " + path;
  }

  [[noreturn]] void fail(const std::string &reason) const { throw Error(place(), reason + " (byte " + std::to_string(*position_) + ")"); }

  Json *insert(Json value) {
    if (++values_ > max_json_values) fail("more than " + std::to_string(max_json_values) + " JSON values");
    if (levels_.empty()) {
      root_ = std::move(value);
      return &root_;
    }
    Level &level = levels_.back();
    if (level.container->is_array()) {
      level.container->push_back(std::move(value));
      return &level.container->back();
    }
    Json &place = (*level.container)[level.key];
    place = std::move(value);
    return &place;
  }

  bool add(Json value) {
    insert(std::move(value));
    if (!levels_.empty()) levels_.back().key.clear();
    return true;
  }

  bool open(Json empty) {
    if (levels_.size() >= max_json_depth) fail("nested deeper than " + std::to_string(max_json_depth) + " levels");
    levels_.push_back({insert(std::move(empty)), {}});
    return true;
  }

  bool close() {
    levels_.pop_back();
    if (!levels_.empty()) levels_.back().key.clear();
    return true;
  }

  std::string file_;
  const std::size_t *position_;
  Json root_;
  std::vector<Level> levels_;
  std::size_t values_ = 0;
};

Json parse_json(std::span<const std::byte> text, const std::string &file) {
  if (text.size() > max_json_bytes)
    throw Error(file, "the JSON has " + std::to_string(text.size()) + " bytes, more than the " + std::to_string(max_json_bytes) + " that are read");
  // nlohmann takes a zero byte as the end, whatever follows. As padding of a GLB's chunk it is common, elsewhere it is no JSON.
  std::size_t padding = 0;
  while (padding < text.size() && text[text.size() - 1 - padding] == std::byte{0}) padding++;
  text = text.first(text.size() - padding);
  if (const auto zero = std::find(text.begin(), text.end(), std::byte{0}); zero != text.end())
    throw Error(file, "broken JSON at byte " + std::to_string(zero - text.begin() + 1) + ": a zero byte");
  const char *begin = reinterpret_cast<const char *>(text.data());
  std::size_t position = 0;
  Builder builder(file, &position);
  if (!Json::sax_parse(CountedByte(begin, &position), CountedByte(begin + text.size(), &position), &builder))
    throw Error(file, "broken JSON at byte " + std::to_string(position));
  Json root = builder.take();
  if (!root.is_object()) throw Error(file, "the JSON is no object, so this is no glTF");
  return root;
}

std::uint32_t read_u32(std::span<const std::byte> data, std::size_t at) {
  std::uint32_t value;
  std::memcpy(&value, data.data() + at, 4);
  return value;
}

constexpr std::uint32_t magic_gltf = 0x46546c67, chunk_json = 0x4e4f534a, chunk_bin = 0x004e4942;

// The container: a header of 12 bytes, a JSON chunk, perhaps a BIN chunk, and chunks of other types, which are to be ignored.
Document parse_glb(std::span<const std::byte> data, const std::string &file, Notices &notices) {
  if (data.size() < 12) throw Error(file, "cut off: it ends within the header of 12 bytes");
  if (const std::uint32_t version = read_u32(data, 4); version != 2)
    throw Error(file, "GLB version " + std::to_string(version) + " is not supported, only version 2");
  const std::size_t length = read_u32(data, 8);
  if (length > data.size())
    throw Error(file, "cut off: the header promises " + std::to_string(length) + " bytes, but there are " + std::to_string(data.size()));
  if (length < data.size()) notices.warning(file, std::to_string(data.size() - length) + " bytes after the end of the GLB were ignored");
  data = data.first(std::max<std::size_t>(length, 12));

  std::optional<std::span<const std::byte>> json, binary;
  for (std::size_t at = 12; at < data.size();) {
    if (data.size() - at < 8) throw Error(file, "cut off: it ends within the header of a chunk at byte " + std::to_string(at));
    const std::size_t size = read_u32(data, at);
    const std::uint32_t type = read_u32(data, at + 4);
    if (!json && type != chunk_json) throw Error(file, "the first chunk has to be JSON");
    at += 8;
    if (size > data.size() - at)
      throw Error(file, "cut off: the chunk at byte " + std::to_string(at - 8) + " promises " + std::to_string(size) + " bytes, but there are " +
                            std::to_string(data.size() - at));
    if (!json)
      json = data.subspan(at, size);
    else if (type == chunk_bin && !binary)
      binary = data.subspan(at, size);
    at += size;
  }
  if (!json) throw Error(file, "cut off: it has no JSON chunk");
  return {parse_json(*json, file), binary};
}

}  // namespace

Document parse_document(std::span<const std::byte> data, const std::string &file, bool said_to_be_glb, Notices &notices) {
  if (data.empty()) throw Error(file, "the file is empty");
  if (data.size() >= 4 && read_u32(data, 0) == magic_gltf) return parse_glb(data, file, notices);
  if (said_to_be_glb) throw Error(file, "not a GLB file: it does not begin with \"glTF\"");
  return {parse_json(data, file), {}};
}

}  // namespace sunstone::gltf
