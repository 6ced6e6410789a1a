// SPDX-License-Identifier: Apache-2.0
// Accessors: typed arrays in buffers, of every component type, strided, normalised, sparse or without data (zeros).
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "import/gltf_buffers.h"

namespace sunstone::gltf {

// An accessor whose every byte is known to lie within its views; sparse indices are checked as they are read.
struct Accessor {
  struct Sparse {
    std::size_t count;
    int index_type;
    std::span<const std::byte> indices, values;
  };
  Value value;             // for messages
  std::size_t count = 0;   // elements
  int component_type = 0;  // 5120 byte ... 5126 float
  int components = 0;      // of an element
  bool normalized = false;
  bool backed = false;               // by a bufferView; otherwise zeros
  std::span<const std::byte> bytes;  // from the first element on
  std::size_t stride = 0;
  std::optional<Sparse> sparse;
};

// How much may come out of the buffers: a small file could otherwise name one large accessor ten thousand times.
class Budget {
 public:
  explicit Budget(const Buffers &buffers) : buffers_(buffers) {}
  void take(std::size_t count, std::size_t bytes_each, const Value &who);

 private:
  const Buffers &buffers_;
  std::size_t used_ = 0;
};

class Accessors {
 public:
  Accessors(const Value &root, Buffers &buffers) : accessors_(root["accessors"]), buffers_(buffers), budget_(buffers) {}

  // The accessor whose index `reference` holds, of `components` numbers an element (0: any).
  Accessor open(const Value &reference, int components);

  // Its elements; N has to be its number of components. Integers become floats, by the rule for normalised ones where it is.
  template <int N>
  std::vector<glm::vec<N, float>> floats(const Accessor &accessor) {
    budget_.take(accessor.count, sizeof(glm::vec<N, float>), accessor.value);
    std::vector<glm::vec<N, float>> out(accessor.count);
    if (!out.empty()) decode(accessor, &out[0][0]);
    return out;
  }
  std::vector<double> numbers(const Accessor &accessor);  // of all its elements, one after the other
  std::vector<std::uint32_t> indices(const Accessor &accessor);
  Budget &budget() { return budget_; }

 private:
  static void decode(const Accessor &accessor, float *out);
  static std::vector<std::uint32_t> sparse_indices(const Accessor &accessor);

  Value accessors_;
  Buffers &buffers_;
  Budget budget_;
};

}  // namespace sunstone::gltf
