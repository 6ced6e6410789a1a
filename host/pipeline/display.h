// SPDX-License-Identifier: Apache-2.0
// Frames for a display, as fast as a device makes them, by an integrator that is one fused walk.
#pragma once
#include <array>

#include "device/kernel.h"
#include "pipeline/upload.h"
#include "shared/frame.h"

namespace sunstone {

// A ray through the middle of each pixel, radiance times a scale, the curve of sRGB; no film. Two frames are under way at once, each in a queue of its own: a device
// that ends one goes on with the next, while the host places the camera of the one behind that.
class Display {
 public:
  // `frame`: of a picture that is one tile. `scene` has to outlive the display.
  Display(const Device &device, const Program &program, unsigned lanes, const kernel::Frame &frame, const DeviceScene &scene);
  ~Display();
  Display(const Display &) = delete;
  Display &operator=(const Display &) = delete;
  // Begins a frame; first waits for the one before the last.
  void show(const kernel::Camera &camera, float scale);
  void finish() const;                      // waits for what has begun
  std::vector<kernel::uint> shown() const;  // the last one: a word a pixel, red in its lowest byte

 private:
  struct Slot {
    Device queue;
    Kernel view;
    Buffer<kernel::Frame> device_frame;
    Buffer<kernel::uint> pixels;
    kernel::Frame frame;  // being read until the slot's queue is empty
  };
  std::array<Slot, 2> slots_;
  std::size_t last_ = 0;
  unsigned lanes_;
  const DeviceScene &scene_;
};

}  // namespace sunstone
