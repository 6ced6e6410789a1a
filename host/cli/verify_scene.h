// SPDX-License-Identifier: Apache-2.0
// The little scene of `sunstone verify`: textures, glass, alpha, metals, every kind of emitter, and instances, made in code.
#pragma once
#include "scene/scene.h"

namespace sunstone {

// With punctual lights for integrators that can meet them.
Scene make_verify_scene(bool punctual);

// A few analytic shapes, which kernels with lanes ask one after the other: a matt floor with a texture, clear glass, a glossy ball, all kinds of shapes, and lights.
Scene make_verify_shapes();

}  // namespace sunstone
