#include "bench/peers/embree_peer.h"

#include <cstring>
#include <embree3/rtcore.h>
#include <limits>

namespace sunder::bench {

struct EmbreePeer::State {
  RTCDevice device = rtcNewDevice("threads=1");
  RTCScene scene = rtcNewScene(device);
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  std::span<Vec3f> positions;
};

EmbreePeer::EmbreePeer(const Mesh& mesh) : state_(std::make_unique<State>()) {
  State& state = *state_;
  rtcSetSceneFlags(state.scene, RTC_SCENE_FLAG_DYNAMIC);
  rtcSetSceneBuildQuality(state.scene, RTC_BUILD_QUALITY_LOW);
  rtcSetGeometryBuildQuality(state.geometry, RTC_BUILD_QUALITY_REFIT);
  auto* vertices = static_cast<Vec3f*>(
      rtcSetNewGeometryBuffer(state.geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                              sizeof(Vec3f), mesh.vertex_count()));
  state.positions = {vertices, mesh.vertex_count()};
  std::memcpy(static_cast<void*>(vertices), mesh.positions.data(),
              mesh.positions.size() * sizeof(Vec3f));
  void* triangles =
      rtcSetNewGeometryBuffer(state.geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              sizeof(Triangle), mesh.triangle_count());
  std::memcpy(triangles, mesh.triangles.data(), mesh.triangles.size() * sizeof(Triangle));
  rtcCommitGeometry(state.geometry);
  rtcAttachGeometry(state.scene, state.geometry);
  rtcCommitScene(state.scene);
}

EmbreePeer::~EmbreePeer() {
  rtcReleaseGeometry(state_->geometry);
  rtcReleaseScene(state_->scene);
  rtcReleaseDevice(state_->device);
}

std::span<Vec3f> EmbreePeer::positions() { return state_->positions; }

void EmbreePeer::refit() {
  rtcUpdateGeometryBuffer(state_->geometry, RTC_BUFFER_TYPE_VERTEX, 0);
  rtcCommitGeometry(state_->geometry);
  rtcCommitScene(state_->scene);
}

std::optional<float> EmbreePeer::cast_ray(const Vec3f& origin, const Vec3f& direction) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit ray = {};
  ray.ray.org_x = origin.x();
  ray.ray.org_y = origin.y();
  ray.ray.org_z = origin.z();
  ray.ray.dir_x = direction.x();
  ray.ray.dir_y = direction.y();
  ray.ray.dir_z = direction.z();
  ray.ray.tfar = std::numeric_limits<float>::infinity();
  ray.ray.mask = ~0u;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(state_->scene, &context, &ray);
  return ray.hit.geomID == RTC_INVALID_GEOMETRY_ID ? std::nullopt : std::optional(ray.ray.tfar);
}

}  // namespace sunder::bench
