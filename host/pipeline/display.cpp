// SPDX-License-Identifier: Apache-2.0
#include "pipeline/display.h"

#include <exception>

namespace sunstone {

Display::Display(const Device &device, const Program &program, unsigned lanes, const kernel::Frame &frame, const DeviceScene &scene) : lanes_(lanes), scene_(scene) {
  for (Slot &slot : slots_) {
    slot.queue = device.beside();
    slot.view = Kernel(program, "whitted_view", slot.queue);
    slot.device_frame = Buffer<kernel::Frame>(slot.queue, 1, "frame");
    slot.pixels = Buffer<kernel::uint>(slot.queue, std::size_t(frame.tile_width) * frame.tile_height, "frame for a display");
    slot.frame = frame;
    slot.frame.flags &= ~SUN_FRAME_CAMERA_MOVES;
    slot.frame.sample_first = 0;
  }
}

Display::~Display() {
  for (const Slot &slot : slots_) {
    try {
      slot.queue.finish();  // what is under way reads the frame
    } catch (const std::exception &) {
      // A device that is lost: whoever uses it next is told.
    }
  }
}

void Display::show(const kernel::Camera &camera, float scale) {
  last_ = (last_ + 1) % slots_.size();
  Slot &slot = slots_[last_];
  slot.queue.finish();
  slot.frame.camera = camera;
  slot.device_frame.write_later(&slot.frame, sizeof slot.frame);
  slot.view.run((slot.frame.paths_per_sample + lanes_ - 1) / lanes_, slot.device_frame, scene_.nodes, scene_.leaves, scene_.instance_list, scene_.roots, scene_.top_root, scene_.fragments,
                scene_.vertices, scene_.extras, scene_.triangles, scene_.instances, scene_.records, scene_.pages[0], scene_.pages[1], scene_.pages[2], scene_.pages[3], scale, slot.pixels);
  slot.queue.flush();
}

void Display::finish() const {
  for (const Slot &slot : slots_) slot.queue.finish();
}

std::vector<kernel::uint> Display::shown() const { return slots_[last_].pixels.download(); }

}  // namespace sunstone
