// SPDX-License-Identifier: Apache-2.0
// The little scene of `sunstone verify`: textures, glass, alpha, metals, every kind of emitter, and instances, made in code.
#pragma once
#include "scene/scene.h"

namespace sunstone {

// With punctual lights for integrators that can meet them.
Scene make_verify_scene(bool punctual);

}  // namespace sunstone
