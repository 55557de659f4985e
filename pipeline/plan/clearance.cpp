#include "pipeline/plan/clearance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include "pipeline/plan/posed_places.h"

namespace sunder::plan {
namespace {

constexpr double kPlaces = 4000;  ///< About so many places of the surface.
/// At so many samples and the first one distances are measured.
constexpr std::size_t kInstants = 64;

/// Places evenly distributed over the surface in a pose: each triangle gets its share by area, by
/// the R2 sequence (Roberts 2018).
Result<std::vector<SurfaceAnchor>> spread_places(const Character& character,
                                                 const ModelPose& pose) {
  std::vector<SurfaceAnchor> corners;
  for (std::uint32_t mesh = 0; mesh < character.meshes.size(); ++mesh)
    for (std::uint32_t i = 0; i < character.meshes[mesh].triangle_count(); ++i)
      for (std::size_t corner = 0; corner < 3; ++corner) {
        SurfaceAnchor anchor{mesh, {i, {0, 0, 0}}};
        anchor.birth.barycentric[corner] = 1;
        corners.push_back(anchor);
      }
  std::vector<Vec3d> posed(corners.size());
  if (const Status status = PosedPlaces(character, corners).pose(pose, posed, {}); !status)
    return status;
  const auto area_of = [&](std::size_t i) {
    return (posed[i + 1] - posed[i]).cross(posed[i + 2] - posed[i]).norm();
  };
  double area = 0;
  for (std::size_t i = 0; i < corners.size(); i += 3) area += area_of(i);
  std::vector<SurfaceAnchor> places;
  double due = 0;
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    due += area > 0 ? kPlaces * area_of(i) / area : 0;
    for (double k = 1; due >= 1; --due, ++k) {
      double u = std::fmod(0.5 + 0.7548776662466927 * k, 1.0);
      double v = std::fmod(0.5 + 0.5698402909980532 * k, 1.0);
      if (u + v > 1) {
        u = 1 - u;
        v = 1 - v;
      }
      places.push_back({corners[i].mesh, {corners[i].birth.triangle, {1 - u - v, u, v}}});
    }
  }
  return places;
}

/// Radius of a ball around the origin of a collider's frame that holds it.
double radius_of(const Collider& collider) {
  if (const auto* const ball = std::get_if<Collider::Sphere>(&collider.shape)) return ball->radius;
  if (const auto* const capsule = std::get_if<Collider::Capsule>(&collider.shape))
    return capsule->radius + capsule->half_length;
  if (const auto* const box = std::get_if<Collider::Box>(&collider.shape))
    return box->half_size.norm();
  return std::numeric_limits<double>::infinity();
}

}  // namespace

Result<Clearance> Clearance::create(const Character& character, const PlanTool& tool,
                                    const PlanTiming& timing,
                                    std::span<const TargetSample> samples) {
  Clearance clearance(tool);
  for (std::size_t i = 0; i < tool.shapes.size(); ++i)
    if (tool.shapes[i].bone != tool.blade.link) clearance.shapes_.push_back(i);
  if (!clearance.is_needed()) return clearance;
  Result<ModelPose> pose = pose_at(character, timing, 0);
  if (!pose) return pose.error();
  const Result<std::vector<SurfaceAnchor>> anchors = spread_places(character, *pose);
  if (!anchors) return anchors.error();
  const PosedPlaces places(character, *anchors);
  for (std::size_t i = 0; i <= kInstants; ++i) {
    Instant instant{samples[i * (samples.size() - 1) / kInstants].time,
                    std::vector<Vec3d>(places.size()), std::vector<Vec3d>(places.size())};
    if (timing.clip_speed > 0) pose = pose_at(character, timing, instant.time);
    if (!pose) return pose.error();
    if (const Status status = places.pose(*pose, instant.places, instant.normals); !status)
      return status;
    clearance.instants_.push_back(std::move(instant));
  }
  return clearance;
}

std::vector<NearPlace> Clearance::find(BladeChain& chain,
                                       const std::function<Values(double)>& values_at,
                                       double margin) const {
  std::vector<NearPlace> found;
  BladePlace blade;
  for (const Instant& instant : instants_) {
    const Values values = values_at(instant.time);
    chain.place({values.data(), chain.size()}, blade, false);
    for (const std::size_t shape : shapes_) {
      const BoneCollider& of_link = tool_->shapes[shape];
      const Collider collider = posed_collider(of_link, chain.frames()[of_link.bone]);
      const double radius = radius_of(collider) + margin;
      NearPlace nearest{instant.time, shape, Vec3d::Zero(), margin, Vec3d::Zero()};
      double to_centre = std::numeric_limits<double>::infinity();
      std::size_t at_centre = 0;
      for (std::size_t i = 0; i < instant.places.size(); ++i) {
        const Vec3d& place = instant.places[i];
        const double square = (place - collider.place).squaredNorm();
        if (square < to_centre) {
          to_centre = square;
          at_centre = i;
        }
        if (square > radius * radius) continue;
        const double distance = distance_to(collider, place).distance;
        if (distance >= nearest.distance) continue;
        nearest.distance = distance;
        nearest.place = place;
      }
      // The middle of the shape is below the surface, which may pass outside of the shape.
      const double above =
          (collider.place - instant.places[at_centre]).dot(instant.normals[at_centre]);
      if (above < -0.5 * std::sqrt(to_centre) && nearest.distance > above) {
        nearest.distance = above;
        nearest.place = instant.places[at_centre];
        nearest.normal = instant.normals[at_centre];
      }
      if (nearest.distance < margin) found.push_back(nearest);
    }
  }
  return found;
}

}  // namespace sunder::plan
