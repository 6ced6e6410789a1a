// SPDX-License-Identifier: Apache-2.0
#include "import/gltf_buffers.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include "base/error.h"
#include "base/file.h"

namespace sunstone::gltf {

namespace {

constexpr std::array<std::int8_t, 256> base64_digits = [] {
  std::array<std::int8_t, 256> table{};
  table.fill(-1);
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (std::size_t i = 0; i < digits.size(); i++) table[static_cast<unsigned char>(digits[i])] = static_cast<std::int8_t>(i);
  return table;
}();

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }
bool is_letter(char c) { return lower(c) >= 'a' && lower(c) <= 'z'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

int hex_digit(char c) {
  if (is_digit(c)) return c - '0';
  return lower(c) >= 'a' && lower(c) <= 'f' ? lower(c) - 'a' + 10 : -1;
}

// The scheme of a URI [RFC 3986 §3.1], or nothing: "http", "file", and "C" of a Windows path.
std::string_view scheme(std::string_view uri) {
  const std::size_t colon = uri.find(':');
  if (colon == std::string_view::npos || colon == 0 || !is_letter(uri[0])) return {};
  const std::string_view name = uri.substr(0, colon);
  return std::all_of(name.begin(), name.end(), [](char c) { return is_letter(c) || is_digit(c) || c == '+' || c == '-' || c == '.'; })
             ? name
             : std::string_view{};
}

bool is_data(std::string_view name) {
  return name.size() == 4 && lower(name[0]) == 'd' && lower(name[1]) == 'a' && lower(name[2]) == 't' && lower(name[3]) == 'a';
}

}  // namespace

std::optional<std::vector<std::byte>> decode_base64(std::string_view text) {
  if (text.size() % 4 != 0) return {};
  std::size_t padding = 0;
  while (padding < 2 && padding < text.size() && text[text.size() - 1 - padding] == '=') padding++;
  std::vector<std::byte> bytes;
  bytes.reserve(text.size() / 4 * 3);
  for (std::size_t i = 0; i < text.size(); i += 4) {
    const std::size_t missing = i + 4 == text.size() ? padding : 0;
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 4; k++) {
      const int digit = k < 4 - missing ? base64_digits[static_cast<unsigned char>(text[i + k])] : 0;
      if (digit < 0) return {};
      group = group << 6 | static_cast<std::uint32_t>(digit);
    }
    if (missing > 0 && (group & ((1u << 8 * missing) - 1)) != 0) return {};  // bits that belong to no byte
    for (std::size_t k = 0; k < 3 - missing; k++) bytes.push_back(static_cast<std::byte>(group >> (16 - 8 * k)));
  }
  return bytes;
}

std::string decode_percent(std::string_view uri) {
  std::string out;
  out.reserve(uri.size());
  for (std::size_t i = 0; i < uri.size(); i++) {
    if (uri[i] == '%' && i + 2 < uri.size() && hex_digit(uri[i + 1]) >= 0 && hex_digit(uri[i + 2]) >= 0) {
      out += static_cast<char>(hex_digit(uri[i + 1]) << 4 | hex_digit(uri[i + 2]));
      i += 2;
    } else {
      out += uri[i];
    }
  }
  return out;
}

std::vector<std::byte> read_uri(const Value &uri) {
  const std::string text = uri.text();
  if (const std::string_view name = scheme(text); is_data(name)) {
    const std::size_t comma = text.find(',');
    if (comma == std::string::npos || !std::string_view(text).substr(0, comma).ends_with(";base64")) uri.fail("broken data URI: it is not base64");
    std::optional<std::vector<std::byte>> bytes = decode_base64(std::string_view(text).substr(comma + 1));
    if (!bytes) uri.fail("broken data URI: its base64 has wrong characters or is cut off");
    return std::move(*bytes);
  } else if (!name.empty()) {
    uri.fail("resources by \"" + printable(name, 20) + ":\" are not read", "only files and data URIs are");
  }
  const std::string name = decode_percent(text);
  if (name.empty()) uri.fail("is empty");
  if (name.find('\0') != std::string::npos) uri.fail("has a zero byte in it");
  const std::filesystem::path path = resolve_resource(uri.context().folder, name, uri.context().options, uri.full_place());
  try {
    return read_file(path);
  } catch (const Error &error) {
    uri.fail(printable(name) + ": " + error.reason, error.hint);
  }
}

Buffers::Buffers(const Value &root, std::optional<std::span<const std::byte>> binary)
    : buffers_(root["buffers"]), views_(root["bufferViews"]), binary_(binary), loaded_(buffers_.size()) {}

std::span<const std::byte> Buffers::buffer(std::size_t index, const Value &user) {
  Loaded &loaded = loaded_[index];
  if (loaded.done) return loaded.bytes;
  const Value value = buffers_[index];
  value.expect_object();
  const Value length = value["byteLength"], uri = value["uri"];
  if (!length) length.fail("is missing");
  const std::uint64_t declared = length.whole(0);
  if (!uri) {
    if (value.extension("EXT_meshopt_compression")) user.fail("its data is there by EXT_meshopt_compression alone, which is not supported");
    if (index != 0 || !binary_) value.fail("has neither a uri nor a binary chunk, so there is no data");
    loaded.bytes = *binary_;
  } else {
    loaded.own = read_uri(uri);
    loaded.bytes = loaded.own;
  }
  if (declared > loaded.bytes.size())
    value.fail("byteLength is " + std::to_string(declared) + ", but the data has " + std::to_string(loaded.bytes.size()) + " bytes");
  loaded.bytes = loaded.bytes.first(static_cast<std::size_t>(declared));
  loaded.done = true;
  bytes_loaded_ += loaded.bytes.size();
  return loaded.bytes;
}

View Buffers::view(const Value &reference) {
  const Value value = views_[reference.index(views_.size(), "bufferViews")];
  value.expect_object();
  const std::size_t index = value["buffer"].index(loaded_.size(), "buffers");
  const Value length_value = value["byteLength"];
  if (!length_value) length_value.fail("is missing");
  const std::uint64_t offset = value["byteOffset"].whole(0), length = length_value.whole(0), stride = value["byteStride"].whole(0);
  const std::span<const std::byte> bytes = buffer(index, value);
  if (offset > bytes.size() || length > bytes.size() - offset)
    value.fail("bytes " + std::to_string(offset) + " + " + std::to_string(length) + " lie beyond the " + std::to_string(bytes.size()) +
               " of buffers[" + std::to_string(index) + "]");
  if (value["byteStride"] && (stride < 1 || stride > 252)) value["byteStride"].fail(std::to_string(stride) + " is outside 4..252");
  if (value.extension("EXT_meshopt_compression"))
    value.context().report.once(value.context().file, "EXT_meshopt_compression is not supported: the uncompressed data is read instead");
  value.check_extensions({"EXT_meshopt_compression"});
  return {bytes.subspan(static_cast<std::size_t>(offset), static_cast<std::size_t>(length)), static_cast<std::size_t>(stride), value};
}

}  // namespace sunstone::gltf
