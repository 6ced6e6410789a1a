// SPDX-License-Identifier: Apache-2.0
// The pass over an OBJ file that comes before tinyobjloader. It gives the loader nothing but statements that it reads rightly. Left to itself,
// tinyobjloader 2.0 rc10 reads "nan", "0x10" and "" as 0, lets indices point anywhere, gives up on the whole file at an index of 0, counts a face's
// corners in a byte, cuts names of materials at their first blank, and does not know continued lines.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "import/obj_text.h"

namespace sunstone {

// What has to be known before the statements are looked at: how many of each there are, and which libraries are named.
struct ObjSurvey {
  struct Library {
    std::string rest;  // of the line, one name or several
    std::size_t line = 0;
  };
  std::size_t positions = 0, texture_coordinates = 0, normals = 0, faces = 0, lines_and_points = 0, free_form = 0;
  std::vector<Library> libraries;
};

struct GuardedObj {
  std::string text;                    // for tinyobjloader; materials are called by their numbers
  std::vector<std::uint32_t> corners;  // of each face, in the order of the file
  bool has_colors = false;
};

ObjSurvey survey_obj(std::string_view text);

// Drops what is broken and says so, by line. `materials` gives the number of a material by its name. Faces keep the texture coordinates and normals
// that are there; indices become positive.
GuardedObj guard_obj(std::string_view text, const ObjSurvey &survey, const std::map<std::string, int> &materials, LineFaults &faults);

}  // namespace sunstone
