// SPDX-License-Identifier: Apache-2.0
// A typed launch: Kernel shade{program, "shade"}; shade.bind(scene, paths, n); shade.launch(n);
#pragma once
#include <memory>
#include <string>
#include <type_traits>

#include "device/buffer.h"
#include "device/program.h"

namespace sunstone {

class Kernel {
 public:
  Kernel() = default;
  Kernel(const Program &program, const std::string &name);
  // In a queue of its device that is not the program's own (Device::beside).
  Kernel(const Program &program, const std::string &name, const Device &queue);
  const std::string &name() const;

  // Arguments in order: buffers, or plain values of exactly the kernel's type.
  template <class... T> void bind(const T &...arguments) {
    unsigned at = 0;
    (set(at++, arguments), ...);
    check_bound(at);
  }
  // Enqueues at least `items` work-items, rounded up to whole groups: the kernel itself returns beyond its count. Not blocking.
  void launch(std::size_t items) const;
  template <class... T> void run(std::size_t items, const T &...arguments) {
    bind(arguments...);
    launch(items);
  }

  struct State;

 private:
  void set_buffer(unsigned at, const RawBuffer &buffer);
  void set_bytes(unsigned at, const void *data, std::size_t size);
  void check_bound(unsigned count) const;
  template <class T> void set(unsigned at, const T &value) {
    if constexpr (std::is_base_of_v<RawBuffer, T>) set_buffer(at, value);
    else {
      static_assert(std::is_trivially_copyable_v<T>);
      set_bytes(at, &value, sizeof value);
    }
  }
  std::shared_ptr<State> state_;
};

}  // namespace sunstone
