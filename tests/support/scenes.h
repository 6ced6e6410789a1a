// SPDX-License-Identifier: Apache-2.0
// Small scenes in code: shapes, materials, lights, cameras, pictures. Units and axes as in docs/conventions.md.
#pragma once
#include <filesystem>
#include <string>

#include "scene/scene.h"

namespace sunstone::test {

// Materials.
Material matt(glm::vec3 albedo);                // purely Lambertian, double-sided
Material lamp(glm::vec3 radiance);              // emits from its front; black and single-sided
Material metal(glm::vec3 color, float roughness);
Material glass(glm::vec3 absorption, float roughness = 0);  // solid, index 1.5
Material thin_glass(glm::vec3 color, float roughness = 0);

// Shapes, all with normals and texture coordinates.
Primitive quad(glm::vec3 center, glm::vec3 half_right, glm::vec3 half_up);  // front towards cross(right, up)
Primitive box(glm::vec3 lower, glm::vec3 upper, bool inward = false);       // 12 triangles, flat, fronts outward
Primitive sphere(glm::vec3 center, float radius, int rings = 16);           // smooth normals, fronts outward

// Adds a mesh of one primitive, placed once; returns its number.
int add(Scene &scene, Primitive primitive, const Material &material, const glm::mat4x3 &transform = glm::mat4x3(1));
// Places a mesh once more.
void place(Scene &scene, int mesh, const glm::mat4x3 &transform);
void add_shape(Scene &scene, Shape::Kind kind, const Material &material, const glm::mat4x3 &transform);
void add_point_light(Scene &scene, glm::vec3 position, glm::vec3 intensity);
Light spot_light(glm::vec3 position = {1.5f, 2.2f, 1.5f});  // down to the left and away from the camera
Light sun_light();
void add_camera(Scene &scene, glm::vec3 from, glm::vec3 at, float yfov_degrees);
// Looks along -z from above a plane: x to the right, y up.
void add_flat_camera(Scene &scene, glm::vec3 from, float half_height);
void set_sky(Scene &scene, glm::vec3 radiance);
void set_sky_map(Scene &scene, Image map);

glm::mat4x3 scaled(glm::vec3 scale, glm::vec3 offset = {0, 0, 0});

// Pictures that are made of a formula: bytes, and a sky of floats with a bright sun in it.
Image pattern(int width, int height, int channels, std::uint32_t seed);
Image bumps(int width, int height);  // a normal map
Image sky_map(int width, int height, glm::vec3 sun);
TextureUse use_picture(Scene &scene, Image image, bool linear = true);

// Matt walls, so that every strategy of bidirectional methods finds every path, and a lamp that is large enough to be met by chance.
Scene matt_room();

// A room whose walls have one side, so that one looks into it from behind, and light falls out on the ground before it.
Scene room_of_one_side();

// Everything at once, small: textures, normal map, alpha of both kinds, solid, rough and thin glass, metal, instances (one mirrored), punctual lights, an
// emissive triangle mesh with a texture, a sky map.
Scene everything();

// scenes/<name> of this source tree.
std::filesystem::path scene_file(const std::string &name);

}  // namespace sunstone::test
