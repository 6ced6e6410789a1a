// SPDX-License-Identifier: Apache-2.0
// Memory of a device. Allocation is checked against the device's limits first; an Error says how much was asked and how much there is.
#pragma once
#include <cstddef>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "device/device.h"

namespace sunstone {

class RawBuffer {
 public:
  RawBuffer() = default;
  RawBuffer(const Device &device, std::size_t bytes, std::string what);
  void write(const void *data, std::size_t bytes, std::size_t offset = 0) const;  // blocking
  void write_later(const void *data, std::size_t bytes) const;                    // enqueued: `data` has to stay as it is until the queue has done it
  void read(void *data, std::size_t bytes, std::size_t offset = 0) const;         // blocking
  void fill_zero() const;                                                         // enqueued
  std::size_t bytes() const { return bytes_; }
  explicit operator bool() const { return state_ != nullptr; }
  struct State;
  State &state() const { return *state_; }

 private:
  std::shared_ptr<State> state_;
  std::size_t bytes_ = 0;
};

// `count` values of T. An empty buffer holds one element, since OpenCL has none of size 0.
template <class T> class Buffer : public RawBuffer {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  Buffer() = default;
  Buffer(const Device &device, std::size_t count, std::string what) : RawBuffer(device, (count ? count : 1) * sizeof(T), std::move(what)), count_(count) {}
  Buffer(const Device &device, std::span<const T> values, std::string what) : Buffer(device, values.size(), std::move(what)) { upload(values); }
  std::size_t size() const { return count_; }
  void upload(std::span<const T> values, std::size_t at = 0) const {
    if (!values.empty()) write(values.data(), values.size_bytes(), at * sizeof(T));
  }
  std::vector<T> download() const { return download(0, count_); }
  std::vector<T> download(std::size_t first, std::size_t count) const {
    std::vector<T> values(count);
    if (count) read(values.data(), count * sizeof(T), first * sizeof(T));
    return values;
  }

 private:
  std::size_t count_ = 0;
};

}  // namespace sunstone
