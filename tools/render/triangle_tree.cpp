#include "tools/render/triangle_tree.h"

#include <algorithm>
#include <cstddef>
#include <embree3/rtcore.h>
#include <new>
#include <utility>

namespace sunder::tools {
namespace {

/// One thread builds, so that the order of the triangles, which decides between equal distances,
/// does not depend on their number; instructions that every CPU of the last fifteen years
/// has, so that it does not depend on the CPU.
constexpr const char* kSettings = "threads=1,isa=sse4.2";

}  // namespace

struct TriangleTree::State {
  /// Triangles without holes are one geometry, those with holes another.
  enum Part : std::size_t { solid, holed };

  State(std::span<const Corners> triangles, Holes with_holes)
      : holes(std::move(with_holes)), device(rtcNewDevice(kSettings)) {
    for (Index t = 0; t < triangles.size(); ++t)
      given[!holes.may_be_in.empty() && holes.may_be_in[t] ? holed : solid].push_back(t);
    scene = rtcNewScene(device);
    // Rays do not slip through between triangles that share an edge.
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    for (const Part part : {solid, holed}) attach(triangles, part);
    rtcCommitScene(scene);
    if (rtcGetDeviceError(device) == RTC_ERROR_NONE) return;
    release();
    throw std::bad_alloc();
  }
  ~State() { release(); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  void attach(std::span<const Corners> triangles, Part part) {
    const std::vector<Index>& chosen = given[part];
    if (chosen.empty()) return;
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* corner = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                               RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                                               3 * chosen.size()));
    auto* index = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), chosen.size()));
    if (corner != nullptr && index != nullptr) {
      unsigned next = 0;
      for (const Index t : chosen)
        for (const Vec3f& place : triangles[t]) {
          for (int i = 0; i < 3; ++i) *corner++ = place[i];
          *index++ = next++;
        }
      if (part == holed) {
        rtcSetGeometryUserData(geometry, this);
        rtcSetGeometryIntersectFilterFunction(geometry, &drop_holes<Ray::sight>);
        rtcSetGeometryOccludedFilterFunction(geometry, &drop_holes<Ray::shadow>);
      }
      rtcCommitGeometry(geometry);
      rtcAttachGeometryByID(scene, geometry, static_cast<unsigned>(part));
    }
    rtcReleaseGeometry(geometry);
  }

  template <Ray kRay>
  static void drop_holes(const RTCFilterFunctionNArguments* found) {
    const auto& state = *static_cast<const State*>(found->geometryUserPtr);
    for (unsigned i = 0; i < found->N; ++i) {
      if (found->valid[i] != -1) continue;
      const float u = RTCHitN_u(found->hit, found->N, i), v = RTCHitN_v(found->hit, found->N, i);
      const Index triangle = state.given[holed][RTCHitN_primID(found->hit, found->N, i)];
      if (state.holes.lets_pass(triangle, Vec3f(1 - u - v, u, v), kRay)) found->valid[i] = 0;
    }
  }

  void release() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }

  Holes holes;
  std::array<std::vector<Index>, 2> given;  ///< Per part: the index of each triangle.
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
};

namespace {

RTCRay ray_of(const Vec3f& from, const Vec3f& along, float nearest, float farthest) {
  RTCRay ray = {};
  ray.org_x = from.x(), ray.org_y = from.y(), ray.org_z = from.z();
  ray.dir_x = along.x(), ray.dir_y = along.y(), ray.dir_z = along.z();
  ray.tnear = nearest;
  ray.tfar = farthest;
  ray.mask = ~0u;
  return ray;
}

/// Whether Embree takes the ray: it aborts at numbers beyond its own limit, which a model of a
/// stranger may have.
bool is_sound(const Vec3f& from, const Vec3f& along, float nearest, float farthest) {
  constexpr float kLargest = 1.8e18f;
  return (from.array().abs() <= kLargest).all() && (along.array().abs() <= kLargest).all() &&
         nearest <= farthest;
}

/// Rays from one place, as Embree takes four; those without a sound direction are marked as left
/// out.
void set_rays(const Vec3f& from, std::span<const Vec3f> along, RTCRay4& rays,
              std::array<int, TriangleTree::kBundle>& valid) {
  for (std::size_t i = 0; i < TriangleTree::kBundle; ++i) {
    const bool is_there = i < along.size() && is_sound(from, along[i], 0, TriangleTree::kFar);
    const Vec3f direction = is_there ? along[i] : Vec3f::UnitX();
    valid[i] = is_there ? -1 : 0;
    rays.org_x[i] = from.x(), rays.org_y[i] = from.y(), rays.org_z[i] = from.z();
    rays.dir_x[i] = direction.x(), rays.dir_y[i] = direction.y(), rays.dir_z[i] = direction.z();
    rays.tfar[i] = TriangleTree::kFar;
    rays.mask[i] = ~0u;
  }
}

}  // namespace

TriangleTree::TriangleTree(std::span<const Corners> triangles) : TriangleTree(triangles, {}) {}

TriangleTree::TriangleTree(std::span<const Corners> triangles, Holes holes)
    : state_(std::make_unique<State>(triangles, std::move(holes))) {}

TriangleTree::~TriangleTree() = default;

TriangleTree::Hit TriangleTree::first_hit(const Vec3f& from, const Vec3f& along, float farthest,
                                          float nearest) const {
  if (!is_sound(from, along, nearest, farthest)) return {kNone, farthest};
  RTCRayHit query = {};
  query.ray = ray_of(from, along, nearest, farthest);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(state_->scene, &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {kNone, farthest};
  return {state_->given[query.hit.geomID][query.hit.primID], query.ray.tfar};
}

bool TriangleTree::is_blocked(const Vec3f& from, const Vec3f& along, float farthest) const {
  if (!is_sound(from, along, 0, farthest)) return false;
  RTCRay ray = ray_of(from, along, 0, farthest);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(state_->scene, &context, &ray);
  return ray.tfar < 0;
}

std::array<TriangleTree::Hit, TriangleTree::kBundle> TriangleTree::first_hits(
    const Vec3f& from, const std::array<Vec3f, kBundle>& along) const {
  alignas(16) std::array<int, kBundle> valid;
  RTCRayHit4 query = {};
  set_rays(from, along, query.ray, valid);
  std::ranges::fill(query.hit.geomID, RTC_INVALID_GEOMETRY_ID);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect4(valid.data(), state_->scene, &context, &query);
  std::array<Hit, kBundle> hits;
  for (std::size_t i = 0; i < kBundle; ++i)
    if (const unsigned part = query.hit.geomID[i]; part != RTC_INVALID_GEOMETRY_ID)
      hits[i] = {state_->given[part][query.hit.primID[i]], query.ray.tfar[i]};
  return hits;
}

std::array<bool, TriangleTree::kBundle> TriangleTree::are_blocked(
    const Vec3f& from, std::span<const Vec3f> along) const {
  alignas(16) std::array<int, kBundle> valid;
  RTCRay4 rays = {};
  set_rays(from, along, rays, valid);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded4(valid.data(), state_->scene, &context, &rays);
  std::array<bool, kBundle> blocked;
  for (std::size_t i = 0; i < kBundle; ++i) blocked[i] = valid[i] != 0 && rays.tfar[i] < 0;
  return blocked;
}

}  // namespace sunder::tools
