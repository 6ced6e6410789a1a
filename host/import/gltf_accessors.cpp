// SPDX-License-Identifier: Apache-2.0
#include "import/gltf_accessors.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <type_traits>

namespace sunstone::gltf {

namespace {

constexpr std::size_t budget_floor = std::size_t(1) << 29, budget_factor = 16;

std::size_t component_bytes(int type) { return type == 5120 || type == 5121 ? 1 : type == 5122 || type == 5123 ? 2 : 4; }

template <class T>
T load(const std::byte *at) {
  T value;
  std::memcpy(&value, at, sizeof value);  // views may be unaligned
  return value;
}

// glTF 2.0, section 3.6.2.2: c / 127 and so on, signed ones not below -1. Divided, not multiplied by a reciprocal, so that 127 is exactly 1.
template <class T>
float to_float(T value, bool normalized) {
  if constexpr (!std::is_floating_point_v<T>) {
    if (normalized) return std::max(static_cast<float>(value) / static_cast<float>(std::numeric_limits<T>::max()), -1.0f);
  }
  return static_cast<float>(value);
}

template <class T>
void decode_as(const Accessor &a, std::span<const std::byte> bytes, std::size_t stride, std::size_t count, const std::uint32_t *where, float *out) {
  const std::size_t n = static_cast<std::size_t>(a.components);
  for (std::size_t i = 0; i < count; i++) {
    float *element = out + (where ? where[i] : i) * n;
    for (std::size_t c = 0; c < n; c++) element[c] = to_float(load<T>(bytes.data() + i * stride + c * sizeof(T)), a.normalized);
  }
}

void decode_elements(const Accessor &a, std::span<const std::byte> bytes, std::size_t stride, std::size_t count, const std::uint32_t *where,
                     float *out) {
  switch (a.component_type) {
    case 5120:
      return decode_as<std::int8_t>(a, bytes, stride, count, where, out);
    case 5121:
      return decode_as<std::uint8_t>(a, bytes, stride, count, where, out);
    case 5122:
      return decode_as<std::int16_t>(a, bytes, stride, count, where, out);
    case 5123:
      return decode_as<std::uint16_t>(a, bytes, stride, count, where, out);
    case 5125:
      return decode_as<std::uint32_t>(a, bytes, stride, count, where, out);
    default:
      return decode_as<float>(a, bytes, stride, count, where, out);
  }
}

std::uint32_t load_index(const std::byte *at, int type) {
  return type == 5121 ? load<std::uint8_t>(at) : type == 5123 ? load<std::uint16_t>(at) : load<std::uint32_t>(at);
}

int components_of(const Value &type) {
  const std::string name = type.text();
  if (name == "SCALAR") return 1;
  if (name == "VEC2") return 2;
  if (name == "VEC3") return 3;
  if (name == "VEC4") return 4;
  if (name == "MAT4") return 16;
  if (name == "MAT2" || name == "MAT3") type.fail("a matrix has no use here");
  type.fail(type ? "is none of SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3, MAT4" : "is missing");
}

int component_type_of(const Value &value, std::initializer_list<int> allowed) {
  if (!value) value.fail("is missing");
  const std::uint64_t type = value.whole(0);
  if (std::none_of(allowed.begin(), allowed.end(), [&](int other) { return static_cast<std::uint64_t>(other) == type; }))
    value.fail(std::to_string(type) + " is no component type that can stand here");
  return static_cast<int>(type);
}

// The bytes of `view` from `offset` on, which hold `count` elements; nothing is multiplied that could overflow.
std::span<const std::byte> elements(const View &view, const Value &offset_value, std::uint64_t count, std::size_t element, std::size_t stride,
                                    const Value &who) {
  const std::uint64_t offset = offset_value.whole(0);
  const std::size_t size = view.bytes.size();
  if (count == 0) return {};
  if (offset > size || element > size - offset || (size - offset - element) / stride < count - 1)
    who.fail("its " + std::to_string(count) + " elements from byte " + std::to_string(offset) + " on lie beyond the " + std::to_string(size) +
             " bytes of " + view.value.place());
  return view.bytes.subspan(static_cast<std::size_t>(offset));
}

}  // namespace

void Budget::take(std::size_t count, std::size_t bytes_each, const Value &who) {
  const std::size_t limit = budget_floor + budget_factor * buffers_.bytes_loaded();
  if (count > (limit - std::min(used_, limit)) / bytes_each)
    who.fail("with this the file asks for more than " + std::to_string(limit >> 20) + " MiB of geometry, far more than its buffers hold");
  used_ += count * bytes_each;
}

Accessor Accessors::open(const Value &reference, int components) {
  const Value value = accessors_[reference.index(accessors_.size(), "accessors")];
  value.expect_object();
  value.check_extensions({});
  Accessor a{.value = value, .bytes = {}, .sparse = {}};
  a.component_type = component_type_of(value["componentType"], {5120, 5121, 5122, 5123, 5125, 5126});
  a.components = components_of(value["type"]);
  a.normalized = value["normalized"].boolean(false);
  if (components != 0 && a.components != components)
    value["type"].fail(value["type"].text() + " has " + std::to_string(a.components) + " components, but " + reference.place() + " needs " +
                       std::to_string(components));
  const Value count = value["count"];
  if (!count) count.fail("is missing");
  const std::uint64_t n = count.whole(0);
  if (n > std::numeric_limits<std::uint32_t>::max() - 1) count.fail(std::to_string(n) + " is more than can be numbered");
  a.count = static_cast<std::size_t>(n);
  const std::size_t element = component_bytes(a.component_type) * static_cast<std::size_t>(a.components);

  if (const Value view_reference = value["bufferView"]) {
    const View view = buffers_.view(view_reference);
    if (view.stride != 0 && view.stride < element)
      view.value["byteStride"].fail(std::to_string(view.stride) + " is less than the " + std::to_string(element) + " bytes of an element of " +
                                    value.place());
    a.stride = view.stride != 0 ? view.stride : element;
    a.bytes = elements(view, value["byteOffset"], n, element, a.stride, value);
    a.backed = true;
  }
  if (const Value sparse = value["sparse"]) {
    sparse.expect_object();
    if (!sparse["count"]) sparse["count"].fail("is missing");
    const std::uint64_t changed = sparse["count"].whole(0);
    if (changed > n) sparse["count"].fail(std::to_string(changed) + " of " + std::to_string(n) + " elements");
    const Value indices = sparse["indices"], values = sparse["values"];
    indices.expect_object();
    values.expect_object();
    const int type = component_type_of(indices["componentType"], {5121, 5123, 5125});
    const View index_view = buffers_.view(indices["bufferView"]), value_view = buffers_.view(values["bufferView"]);
    const std::size_t index_bytes = component_bytes(type);
    a.sparse = Accessor::Sparse{static_cast<std::size_t>(changed), type,
                                elements(index_view, indices["byteOffset"], changed, index_bytes, index_bytes, sparse),
                                elements(value_view, values["byteOffset"], changed, element, element, sparse)};
  }
  return a;
}

std::vector<std::uint32_t> Accessors::sparse_indices(const Accessor &a) {
  std::vector<std::uint32_t> where(a.sparse->count);
  for (std::size_t i = 0; i < where.size(); i++) {
    where[i] = load_index(a.sparse->indices.data() + i * component_bytes(a.sparse->index_type), a.sparse->index_type);
    if (where[i] >= a.count)
      a.value["sparse"]["indices"].fail("index " + std::to_string(where[i]) + ", but there are " + counted(a.count, "elements"));
    if (i > 0 && where[i] <= where[i - 1]) a.value["sparse"]["indices"].fail("they do not ascend");
  }
  return where;
}

void Accessors::decode(const Accessor &a, float *out) {
  if (a.backed) decode_elements(a, a.bytes, a.stride, a.count, nullptr, out);
  if (!a.sparse) return;
  const std::vector<std::uint32_t> where = sparse_indices(a);
  const std::size_t element = component_bytes(a.component_type) * static_cast<std::size_t>(a.components);
  decode_elements(a, a.sparse->values, element, a.sparse->count, where.data(), out);
}

std::vector<double> Accessors::numbers(const Accessor &a) {
  const std::size_t n = static_cast<std::size_t>(a.components);
  budget_.take(a.count, n * (sizeof(float) + sizeof(double)), a.value);
  std::vector<float> values(a.count * n);
  if (!values.empty()) decode(a, values.data());
  return {values.begin(), values.end()};
}

std::vector<std::uint32_t> Accessors::indices(const Accessor &a) {
  if (a.component_type != 5121 && a.component_type != 5123 && a.component_type != 5125)
    a.value["componentType"].fail(std::to_string(a.component_type) + " cannot be an index: that takes 5121, 5123 or 5125");
  budget_.take(a.count, sizeof(std::uint32_t), a.value);
  std::vector<std::uint32_t> out(a.count);
  if (a.backed)
    for (std::size_t i = 0; i < out.size(); i++) out[i] = load_index(a.bytes.data() + i * a.stride, a.component_type);
  if (a.sparse) {
    const std::vector<std::uint32_t> where = sparse_indices(a);
    for (std::size_t i = 0; i < where.size(); i++)
      out[where[i]] = load_index(a.sparse->values.data() + i * component_bytes(a.component_type), a.component_type);
  }
  return out;
}

}  // namespace sunstone::gltf
