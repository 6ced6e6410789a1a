// SPDX-License-Identifier: Apache-2.0
// A camera and a sky for scenes that have none, and cameras made from the command's flags.
#pragma once
#include <optional>

#include "base/notice.h"
#include "scene/scene.h"

namespace sunstone {

// A three-quarter view, 40 degrees vertical, that frames the bounds at `aspect` (width / height), from the side that sees most of the scene, so that a
// Cornell box is looked into. An empty scene is looked at from (0, 0, 3).
Camera default_camera(const Scene &scene, float aspect);

// --look-from, --look-at, --up, --fov. Throws UsageError where the two points are one or up is parallel.
Camera look_camera(glm::vec3 from, glm::vec3 at, glm::vec3 up, float yfov);

// Adds a soft sky (CIE overcast, radiance 1 at the zenith) and its note where nothing emits; a note for the camera where there is none.
void add_defaults(Scene &scene, float aspect, const std::string &file, bool camera_wanted, Notices &notices);

}  // namespace sunstone
