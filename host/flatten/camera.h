// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "scene/scene.h"
#include "shared/frame.h"

namespace sunstone {

// A camera for a picture of this size, by the arithmetic of kernels/math. Where the file's aspect differs from the picture's, the vertical angle is kept.
kernel::Camera flatten_camera(const Camera &camera, int width, int height);

}  // namespace sunstone
