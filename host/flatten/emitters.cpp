// SPDX-License-Identifier: Apache-2.0
#include "flatten/emitters.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "flatten/alias_table.h"
#include "flatten/environment.h"
#include "flatten/placement.h"
#include "flatten/textures.h"
#include "flatten/weld.h"
#include "math/elementary.h"
#include "math/vector.h"

namespace sunstone {
namespace {

using kernel::uint;

constexpr double pi = 3.141592653589793;
constexpr double texture_floor = 0.05;  // of the texture's mean: what the points of a triangle may have missed
constexpr double lights_floor = 1.0 / 16;  // of all power: what the punctual lights count as at least, each the same

double luminance_of(const float *rgb) { return kernel::luminance(kernel::make_vec3(rgb[0], rgb[1], rgb[2])); }

// The emission of a material: its colour, and where its texture comes from.
struct Emission {
  double luminance = 0;  // of the factor alone
  double floor = 0;      // least mean of a triangle, with a texture
  uint ref = SUN_NONE;
};

std::vector<Emission> emissions_of(const FlatScene &flat) {
  std::vector<Emission> emissions(flat.materials.size());
  for (std::size_t i = 0; i < emissions.size(); i++) {
    const kernel::Material &material = flat.materials[i];
    if (!(material.flags & SUN_MATERIAL_EMISSIVE)) continue;
    Emission &emission = emissions[i];
    emission.luminance = luminance_of(material.emission);
    emission.ref = material.slot[SUN_SLOT_EMISSION];
    if (emission.ref == SUN_NONE) continue;
    const TextureRange range = texture_range(flat, flat.textures[flat.texture_refs[emission.ref].texture]);
    float mean[3];
    for (int c = 0; c < 3; c++) mean[c] = material.emission[c] * static_cast<float>(range.mean[static_cast<std::size_t>(c)]);
    emission.floor = texture_floor * luminance_of(mean);
  }
  return emissions;
}

// Mean luminance over a triangle: at the centroids of the 16 triangles that two halvings of its edges give.
double mean_emission(const FlatScene &flat, const kernel::Triangle &triangle, const Emission &emission) {
  if (emission.ref == SUN_NONE) return emission.luminance;
  const kernel::TextureRef &ref = flat.texture_refs[emission.ref];
  const kernel::Texture &texture = flat.textures[ref.texture];
  const kernel::Material &material = flat.materials[triangle.material];
  float uv[3][2] = {};
  for (std::size_t k = 0; k < 3; k++) {
    const uint vertex = triangle.vertex[k];
    if (ref.uv_set == 0) {
      uv[k][0] = flat.vertices[vertex].u;
      uv[k][1] = flat.vertices[vertex].v;
    } else if (flat.vertex_extras.size() > 1) {
      uv[k][0] = flat.vertex_extras[vertex].uv1[0];
      uv[k][1] = flat.vertex_extras[vertex].uv1[1];
    }
  }
  double sum = 0;
  for (int row = 0; row < 4; row++)
    for (int column = 0; column < 4 - row; column++)
      for (int down = 0; down < (column < 3 - row ? 2 : 1); down++) {
        const float third = down ? 2.0f / 3.0f : 1.0f / 3.0f;  // of an edge of the small triangle
        const float b = (static_cast<float>(column) + third) / 4.0f, c = (static_cast<float>(row) + third) / 4.0f;
        const float a = 1.0f - b - c;
        const float u = (a * uv[0][0] + b * uv[1][0]) + c * uv[2][0], v = (a * uv[0][1] + b * uv[1][1]) + c * uv[2][1];
        const auto texel = nearest_texel(flat, texture, (ref.m[0] * u + ref.m[1] * v) + ref.m[2], (ref.m[3] * u + ref.m[4] * v) + ref.m[5]);
        const float rgb[3] = {material.emission[0] * texel[0], material.emission[1] * texel[1], material.emission[2] * texel[2]};
        sum += luminance_of(rgb);
      }
  return std::max(sum / 16, emission.floor);
}

// Of a shape: as along the axes of its space on the mean, which is exact where these are scaled alike.
double shape_area(const kernel::Instance &instance) {
  const auto column = [&](int c) { return glm::dvec3(instance.to_world[c], instance.to_world[4 + c], instance.to_world[8 + c]); };
  const auto across = [&](int a, int b) {
    const glm::dvec3 n = glm::cross(column(a), column(b));
    return std::sqrt((n.x * n.x + n.y * n.y) + n.z * n.z);
  };
  if (instance.flags & SUN_INSTANCE_SPHERE) return 4 * pi * ((across(1, 2) + across(2, 0)) + across(0, 1)) / 3;
  return across(2, 0) * (instance.flags & SUN_INSTANCE_DISK ? pi : 4);
}

// Area in world space; nothing where it is not finite.
double area_at(const FlatScene &flat, const kernel::Instance &instance, const kernel::Triangle &triangle, std::size_t key) {
  if (instance.flags & SUN_INSTANCE_SHAPE) return shape_area(instance);
  const std::size_t first = instance.flags & SUN_INSTANCE_DEFORMING ? key * flat.deforming : 0;
  glm::vec3 corner[3];
  for (std::size_t k = 0; k < 3; k++) corner[k] = transform_point(instance, flat.vertices[first + triangle.vertex[k]].position);
  const glm::dvec3 cross = triangle_cross(corner[0], corner[1], corner[2]);
  const double area = 0.5 * std::sqrt((cross.x * cross.x + cross.y * cross.y) + cross.z * cross.z);
  return std::isfinite(area) ? area : 0;
}

// Of what moves: as at its keys on the mean.
double world_area(const FlatScene &flat, const kernel::Instance &instance, const kernel::Triangle &triangle) {
  if (!(instance.flags & (SUN_INSTANCE_MOVING | SUN_INSTANCE_DEFORMING))) return area_at(flat, instance, triangle, 0);
  const std::size_t keys = flat.motion_steps + 1;
  double sum = 0;
  for (std::size_t key = 0; key < keys; key++) {
    kernel::Instance then = instance;
    if (instance.flags & SUN_INSTANCE_MOVING) {
      const kernel::InstanceKey &place = flat.instance_keys[(instance.flags >> SUN_INSTANCE_MOTION_SHIFT) * keys + key];
      std::copy(std::begin(place.to_world), std::end(place.to_world), then.to_world);
    }
    sum += area_at(flat, then, triangle, key);
  }
  return sum / static_cast<double>(keys);
}

float cosine_of(float angle) {
  float sine, cosine;
  kernel::sin_cos(angle, &sine, &cosine);
  return cosine;
}

kernel::Light light_of(const Light &light) {
  kernel::Light out{};
  const glm::vec3 direction = unit_vector(glm::dvec3(light.direction));
  for (int c = 0; c < 3; c++) {
    out.position[c] = light.position[c];
    out.direction[c] = direction[c];
    out.intensity[c] = light.intensity[c];
  }
  out.kind = light.kind == Light::Kind::point ? SUN_LIGHT_POINT : light.kind == Light::Kind::spot ? SUN_LIGHT_SPOT : SUN_LIGHT_DIRECTIONAL;
  out.cos_outer = cosine_of(light.outer_angle);
  out.cos_inner = cosine_of(light.inner_angle);
  return out;
}

double light_power(const kernel::Light &light, double disk_area) {
  const double intensity = luminance_of(light.intensity);
  const uint kind = light.kind & SUN_LIGHT_KIND;
  if (kind == SUN_LIGHT_POINT) return 4 * pi * intensity;
  if (kind == SUN_LIGHT_DIRECTIONAL) return disk_area * intensity;
  // The square of a ramp from 1 at the inner to 0 at the outer cosine has the integral of a third of its width.
  const double inner = light.cos_inner, outer = light.cos_outer;
  return 2 * pi * intensity * ((1 - inner) + std::max(inner - outer, 0.0) / 3);
}

}  // namespace

void flatten_emitters(const Scene &scene, std::size_t max_bytes, FlatScene &flat, Notices &notices) {
  std::vector<std::vector<uint>> emissive(flat.meshes.size());  // triangles, by mesh
  for (std::size_t m = 0; m < flat.meshes.size(); m++)
    for (uint t = 0; t < flat.meshes[m].triangle_count; t++)
      if (flat.triangle_emitter[flat.meshes[m].first_triangle + t] != SUN_NONE) emissive[m].push_back(flat.meshes[m].first_triangle + t);

  const std::size_t limit = std::min(max_alias_entries, max_bytes / sizeof(kernel::Emitter));
  std::size_t count = 0;
  std::vector<std::size_t> first(flat.instances.size());
  const auto check = [&] {
    if (count > limit)
      throw Error{"flatten", "more than " + std::to_string(limit) + " emitters", "fewer emissive triangles, or fewer instances of meshes that emit"};
  };
  for (std::size_t i = 0; i < flat.instances.size(); i++) {
    first[i] = count;
    const std::size_t here = emissive[flat.instance_mesh[i]].size();
    flat.instances[i].first_emitter = here ? static_cast<uint>(count) : SUN_NONE;
    count += here;
    check();
  }
  std::vector<std::pair<std::size_t, const Light *>> moving;
  for (const Light &light : scene.lights) {
    kernel::Light record = light_of(light);
    if (!(record.intensity[0] > 0 || record.intensity[1] > 0 || record.intensity[2] > 0)) continue;
    if (!light.keys.empty()) moving.emplace_back(flat.lights.size(), &light);
    flat.lights.push_back(record);
  }
  for (const auto &[number, light] : moving) {
    const std::size_t at = flat.lights.size() + flat.light_keys.size();
    if (at + flat.motion_steps >= SUN_NONE >> SUN_LIGHT_KEYS_SHIFT) throw Error{"flatten", "more lights move than 2^24 keys are for"};
    flat.light_keys.push_back(flat.lights[number]);
    for (const LightKey &key : light->keys) {
      Light then = *light;
      then.position = key.position;
      then.direction = key.direction;
      flat.light_keys.push_back(light_of(then));
    }
    flat.lights[number].kind |= static_cast<uint>(at) << SUN_LIGHT_KEYS_SHIFT;
  }
  const std::size_t first_light = count;
  count += flat.lights.size();

  const double sky = flatten_environment(scene, max_bytes, flat, notices);
  const bool sky_shines = flat.environment.kind == SUN_ENVIRONMENT_CONSTANT || !flat.environment_cdf.empty();
  if (sky_shines) flat.environment.emitter = static_cast<uint>(count++);
  check();

  std::vector<double> powers(count);
  flat.emitters.assign(count, {});
  const std::vector<Emission> emissions = emissions_of(flat);
  // By mesh triangle; the same for every instance but for the area.
  std::vector<std::vector<double>> radiance(flat.meshes.size());
  for (std::size_t m = 0; m < flat.meshes.size(); m++) {
    radiance[m].resize(emissive[m].size());
    tbb::parallel_for(std::size_t(0), emissive[m].size(), [&](std::size_t k) {
      const kernel::Triangle &triangle = flat.triangles[emissive[m][k]];
      const bool both = flat.materials[triangle.material].flags & SUN_MATERIAL_DOUBLE_SIDED;
      radiance[m][k] = mean_emission(flat, triangle, emissions[triangle.material]) * (both ? 2 * pi : pi);
    });
  }
  // The triangle that stands for a shape has no place in a texture: the mean of all of it.
  for (std::size_t i = flat.instances.size() - flat.shape_count; i < flat.instances.size(); i++) {
    const std::size_t m = flat.instance_mesh[i];
    if (emissive[m].empty()) continue;
    const uint material = flat.triangles[emissive[m][0]].material;
    const Emission &emission = emissions[material];
    const bool both = flat.materials[material].flags & SUN_MATERIAL_DOUBLE_SIDED;
    radiance[m][0] = (emission.ref == SUN_NONE ? emission.luminance : emission.floor / texture_floor) * (both ? 2 * pi : pi);
  }
  for (std::size_t i = 0; i < flat.instances.size(); i++) {
    const uint mesh = flat.instance_mesh[i];
    tbb::parallel_for(std::size_t(0), emissive[mesh].size(), [&](std::size_t k) {
      const uint t = emissive[mesh][k];
      kernel::Emitter &emitter = flat.emitters[first[i] + k];
      emitter.kind = SUN_EMITTER_TRIANGLE;
      emitter.a = static_cast<uint>(i);
      emitter.b = t;
      powers[first[i] + k] = radiance[mesh][k] * world_area(flat, flat.instances[i], flat.triangles[t]);
    });
  }
  const glm::dvec3 diagonal = glm::dvec3(flat.bounds.upper) - glm::dvec3(flat.bounds.lower);
  const double disk_area = pi * 0.25 * ((diagonal.x * diagonal.x + diagonal.y * diagonal.y) + diagonal.z * diagonal.z);
  for (std::size_t i = 0; i < flat.lights.size(); i++) {
    flat.emitters[first_light + i].kind = SUN_EMITTER_LIGHT;
    flat.emitters[first_light + i].a = static_cast<uint>(i);
    powers[first_light + i] = light_power(flat.lights[i], disk_area);
  }
  if (sky_shines) {
    flat.emitters[count - 1].kind = SUN_EMITTER_ENVIRONMENT;
    powers[count - 1] = disk_area * sky;
  }
  for (double &power : powers)
    if (!(power >= 0) || power > 1e200) power = power > 0 ? 1e200 : 0;
  // A narrow spot has little power, and yet may be all that lights a place: no path runs into it, so whatever its chance leaves out is noise.
  double all = 0;
  for (const double power : powers) all += power;
  for (std::size_t i = 0; i < flat.lights.size(); i++) powers[first_light + i] = std::max(powers[first_light + i], lights_floor * all / static_cast<double>(flat.lights.size()));

  const AliasTable table = make_alias_table(powers);
  for (std::size_t i = 0; i < count; i++) {
    flat.emitters[i].pmf = table.pmf[i];
    flat.emitters[i].threshold = table.threshold[i];
    flat.emitters[i].alias = static_cast<uint>(table.alias[i]);
  }
}

}  // namespace sunstone
