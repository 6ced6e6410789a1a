// SPDX-License-Identifier: Apache-2.0
#include "bench/embree_reference.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

#include "base/error.h"

namespace sunstone {

using kernel::uint;

struct EmbreeReference::State {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  std::vector<RTCScene> meshes;
  std::vector<uint> first_triangle;  // by mesh
  std::vector<uint> instance_mesh;
  bool flat = false;  // one instance of identity: no instancing in Embree either
  unsigned threads = 1;
  ~State() {
    for (RTCScene mesh : meshes)
      if (mesh) rtcReleaseScene(mesh);
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
  }
  RTCScene make_scene(const EmbreeOptions &options) const {
    RTCScene made = rtcNewScene(device);
    rtcSetSceneBuildQuality(made, options.high ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_MEDIUM);
    rtcSetSceneFlags(made, options.robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
    return made;
  }
  void fill(kernel::Hit &hit, float t, float u, float v, uint geometry, uint primitive, uint instance) const {
    hit = {};
    hit.t = t;
    hit.instance = hit.primitive = SUN_NONE;
    if (geometry == RTC_INVALID_GEOMETRY_ID) return;
    hit.u = u;
    hit.v = v;
    hit.instance = flat ? 0 : instance;
    hit.primitive = first_triangle[instance_mesh[hit.instance]] + primitive;
  }
};

namespace {

// Calls trace(begin, end) over chunks of rays in `threads` threads; returns seconds.
template <class Trace>
double in_chunks(std::size_t count, unsigned threads, Trace &&trace) {
  constexpr std::size_t chunk = 1024;
  std::atomic<std::size_t> next{0};
  const auto start = std::chrono::steady_clock::now();
  const auto work = [&] {
    for (;;) {
      const std::size_t begin = next.fetch_add(chunk);
      if (begin >= count) return;
      trace(begin, std::min(begin + chunk, count));
    }
  };
  {
    std::vector<std::jthread> pool;
    for (unsigned i = 1; i < threads; i++) pool.emplace_back(work);
    work();
  }
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

RTCRay embree_ray(const TraceRay &ray) {
  RTCRay to{};
  to.org_x = ray.origin[0];
  to.org_y = ray.origin[1];
  to.org_z = ray.origin[2];
  to.dir_x = ray.direction[0];
  to.dir_y = ray.direction[1];
  to.dir_z = ray.direction[2];
  to.tnear = ray.passed_t;
  to.tfar = ray.t_max;
  to.mask = ~0u;
  return to;
}

void add_triangles(RTCDevice device, RTCScene scene, const FlatScene &from, const MeshRange &mesh, RTCBuildQuality quality) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto *positions = static_cast<float *>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, from.vertices.size()));
  auto *indices =
      static_cast<uint *>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, std::max(mesh.triangle_count, 1u)));
  if (!positions || !indices) throw Error{"Embree", "no memory for the reference's geometry"};
  for (const kernel::Vertex &vertex : from.vertices) positions = std::copy_n(vertex.position, 3, positions);
  std::fill_n(indices, 3, 0u);
  for (uint i = 0; i < mesh.triangle_count; i++) indices = std::copy_n(from.triangles[mesh.first_triangle + i].vertex, 3, indices);
  rtcSetGeometryBuildQuality(geometry, quality);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
}

}  // namespace

EmbreeReference::EmbreeReference(const FlatScene &scene, const EmbreeOptions &options) : state_(std::make_unique<State>()) {
  State &s = *state_;
  s.threads = options.threads ? options.threads : std::max(1u, std::thread::hardware_concurrency());
  s.device = rtcNewDevice(nullptr);
  if (!s.device) throw Error{"Embree", "no device: error " + std::to_string(int(rtcGetDeviceError(nullptr)))};
  const RTCBuildQuality quality = options.high ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_MEDIUM;
  s.scene = s.make_scene(options);
  s.instance_mesh = scene.instance_mesh;
  for (const MeshRange &mesh : scene.meshes) s.first_triangle.push_back(mesh.first_triangle);
  s.flat = scene.instances.size() == 1 && scene.instances[0].flags & SUN_INSTANCE_IDENTITY;
  if (s.flat) {
    add_triangles(s.device, s.scene, scene, scene.meshes[scene.instance_mesh[0]], quality);
  } else {
    for (const MeshRange &mesh : scene.meshes) {
      RTCScene part = s.meshes.emplace_back(s.make_scene(options));
      add_triangles(s.device, part, scene, mesh, quality);
      rtcCommitScene(part);
    }
    for (std::size_t i = 0; i < scene.instances.size(); i++) {
      RTCGeometry geometry = rtcNewGeometry(s.device, RTC_GEOMETRY_TYPE_INSTANCE);
      rtcSetGeometryInstancedScene(geometry, s.meshes[scene.instance_mesh[i]]);
      rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, scene.instances[i].to_world);
      rtcCommitGeometry(geometry);
      rtcAttachGeometryByID(s.scene, geometry, unsigned(i));
      rtcReleaseGeometry(geometry);
    }
  }
  rtcCommitScene(s.scene);
  if (const RTCError error = rtcGetDeviceError(s.device); error != RTC_ERROR_NONE)
    throw Error{"Embree", "the reference does not build: error " + std::to_string(int(error))};
}

EmbreeReference::~EmbreeReference() = default;

double EmbreeReference::closest(std::span<const TraceRay> rays, std::span<kernel::Hit> hits) const {
  return in_chunks(rays.size(), state_->threads, [&](std::size_t begin, std::size_t end) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    for (std::size_t i = begin; i < end; i++) {
      RTCRayHit query{};
      query.ray = embree_ray(rays[i]);
      query.hit.geomID = query.hit.primID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
      rtcIntersect1(state_->scene, &context, &query);
      state_->fill(hits[i], query.ray.tfar, query.hit.u, query.hit.v, query.hit.geomID, query.hit.primID, query.hit.instID[0]);
    }
  });
}

double EmbreeReference::closest16(std::span<const TraceRay> rays, std::span<kernel::Hit> hits) const {
  return in_chunks(rays.size(), state_->threads, [&](std::size_t begin, std::size_t end) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    for (std::size_t first = begin; first < end; first += 16) {
      RTCRayHit16 query;
      alignas(64) int valid[16];
      for (std::size_t k = 0; k < 16; k++) {
        valid[k] = first + k < end ? -1 : 0;
        const RTCRay ray = embree_ray(rays[std::min(first + k, end - 1)]);
        query.ray.org_x[k] = ray.org_x;
        query.ray.org_y[k] = ray.org_y;
        query.ray.org_z[k] = ray.org_z;
        query.ray.dir_x[k] = ray.dir_x;
        query.ray.dir_y[k] = ray.dir_y;
        query.ray.dir_z[k] = ray.dir_z;
        query.ray.tnear[k] = ray.tnear;
        query.ray.tfar[k] = ray.tfar;
        query.ray.time[k] = 0.0f;
        query.ray.mask[k] = ~0u;
        query.ray.id[k] = query.ray.flags[k] = 0;
        query.hit.geomID[k] = query.hit.primID[k] = query.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
      }
      rtcIntersect16(valid, state_->scene, &context, &query);
      for (std::size_t k = 0; k < 16 && first + k < end; k++)
        state_->fill(hits[first + k], query.ray.tfar[k], query.hit.u[k], query.hit.v[k], query.hit.geomID[k], query.hit.primID[k],
                     query.hit.instID[0][k]);
    }
  });
}

double EmbreeReference::any(std::span<const TraceRay> rays, std::span<kernel::Hit> hits) const {
  return in_chunks(rays.size(), state_->threads, [&](std::size_t begin, std::size_t end) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    for (std::size_t i = begin; i < end; i++) {
      RTCRay ray = embree_ray(rays[i]);
      rtcOccluded1(state_->scene, &context, &ray);
      hits[i] = {};
      hits[i].instance = ray.tfar < 0.0f ? 0 : SUN_NONE;
    }
  });
}

}  // namespace sunstone
