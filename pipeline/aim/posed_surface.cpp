#include "pipeline/aim/posed_surface.h"

#include <sunder/skinning/pose.h>

#include <algorithm>
#include <utility>

#include "core/internal/ordered.h"
#include "skinning/internal/character_pose.h"

namespace sunder::aim {

using tear::Surface;

std::array<Index, 2> PosedSurface::vertex(Index point) const {
  const Index corner = surface_->point_corner[point];
  if (corner == kNone) return {kNone, kNone};
  const tear::TriangleRef ref = surface_->triangle(corner / 3);
  return {ref.mesh, character_->meshes[ref.mesh].triangles[ref.triangle][corner % 3]};
}

double PosedSurface::area(Index face) const {
  const auto [a, b, c] = corners(face);
  return 0.5 * norm((b - a).cross(c - a));
}

Result<PosedSurface> PosedSurface::create(const TornModel& model, const PoseSpec& spec) {
  PosedSurface posed;
  posed.character_ = &model.character();
  posed.surface_ = &model.surface();
  auto pose = make_pose(model.character(), spec);
  if (!pose) return pose.error();
  posed.pose_ = std::move(*pose);
  CharacterPose palettes;
  if (const Status status = palettes.set(model.character(), posed.pose_); !status) return status;

  const Surface& surface = model.surface();
  posed.is_live_.resize(surface.triangle_count());
  for (Index face = 0; face < surface.triangle_count(); ++face) {
    const tear::TriangleRef ref = surface.triangle(face);
    posed.is_live_[face] = !surface.has_repeated_point(face) &&
                           !is_retired(model.character().meshes[ref.mesh].triangles[ref.triangle]);
  }
  posed.positions_.assign(surface.point_count(), Vec3d::Zero());
  Vec3d low = Vec3d::Zero(), high = Vec3d::Zero();
  bool is_first = true;
  for (Index point = 0; point < surface.point_count(); ++point) {
    const auto [mesh, vertex] = posed.vertex(point);
    if (mesh == kNone) continue;
    const Vec3d position = palettes.position(model.character().meshes[mesh], vertex);
    posed.positions_[point] = position;
    low = is_first ? position : Vec3d(low.cwiseMin(position));
    high = is_first ? position : Vec3d(high.cwiseMax(position));
    is_first = false;
  }
  posed.size_ = (high - low).maxCoeff();
  return posed;
}

}  // namespace sunder::aim
