#include "tear/posed/posed_points.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/internal/ordered.h"
#include "core/internal/prefetch.h"
#include "tear/geometry/tolerances.h"
#include "tear/internal/surface.h"

namespace sunder::tear {
Status PosedPoints::begin(const Character& character, const ModelPose& pose) {
  if (Status status = pose_.set(character, pose); !status) return status;
  forest_.forget_pose();
  has_pins_ = false;
  if (++epoch_ == 0) {  // wrapped around: once in 2^32 poses
    for (Known& known : known_) known.since = 0;
    epoch_ = 1;
  }
  return {};
}

Frame PosedPoints::frame_along(const Mat3d& axes, const SurfaceEditor& editor) const {
  for (const Mesh& mesh : editor.source().meshes) {
    if (mesh.triangles.empty()) continue;
    const Vec3d place = pose_.position(mesh, mesh.triangles[0][0]);
    if (place.allFinite()) return {axes, place};
  }
  return {axes, Vec3d::Zero()};
}

const Vec3d& PosedPoints::look_up(const SurfaceEditor& editor, Index point) {
  cover(editor.surface().point_count());
  const Index corner = editor.surface().point_corner[point];
  const Mesh& mesh = editor.character().meshes[editor.surface().triangle(corner / 3).mesh];
  const Index of = editor.surface().triangle(corner / 3).mesh, vertex = editor.vertex_at(corner);
  known_[point] = {pose_.position(mesh, vertex, editor.births.position(of, vertex),
                                  editor.births.influences(of, vertex)),
                   epoch_, 0};
  return known_[point].position;
}

void PosedPoints::pin(Index point, const Vec3d& position) {
  cover(point + 1);
  known_[point] = {position, epoch_, 0};
  has_pins_ = true;
}

void PosedPoints::compare_with(const PlaneSide& plane) {
  if (plane.normal == plane_.normal && plane.offset == plane_.offset) return;
  plane_ = plane;
  if (++plane_number_ < 1u << 30) return;
  for (Known& known : known_) known.compared = 0;  // once in 2^30 planes
  plane_number_ = 1;
}

std::uint32_t PosedPoints::find_side(const SurfaceEditor& editor, Index point) {
  const Vec3d at = position(editor, point);
  const double value = plane_.value(at), rounding = plane_.rounding(at);
  const bool is_on_plane =
      std::abs(value) <= rounding || (std::abs(value) <= farthest_on_plane(editor) &&
                                      std::abs(value) <= stored_rounding(editor, point));
  const std::uint32_t bits = (value >= -rounding ? kInside : 0) | (is_on_plane ? kOnPlane : 0);
  known_[point].compared = 4 * plane_number_ + bits;
  return bits;
}

namespace {

/// How far a point that follows `linear` moves across a plane if each bind coordinate changes by 1.
double steepness(const Vec3d& normal, const Mat3d& linear) {
  double sum = 0;
  for (int column = 0; column < 3; ++column) sum += std::abs(dot(normal, linear.col(column)));
  return sum;
}

}  // namespace

double PosedPoints::stored_rounding(const SurfaceEditor& editor, Index point) const {
  const Surface& surface = editor.surface();
  const Index corner = surface.point_corner[point];
  if (corner == kNone) return 0;
  const Index mesh = surface.triangle(corner / 3).mesh;
  const std::vector<Affine3d>& palette = pose_.palette(editor.character().meshes[mesh].skin);
  Mat3d linear = Mat3d::Zero();
  for (const Influence& influence : editor.births.influences(mesh, editor.vertex_at(corner)))
    linear += static_cast<double>(influence.weight) * palette[influence.slot].linear();
  return kOnPlaneCoordinates * static_cast<double>(surface.largest_coordinate[mesh]) *
         steepness(plane_.normal, linear);
}

void PosedPoints::bound_stored_rounding(const SurfaceEditor& editor) {
  bound_of_ = {epoch_, plane_number_};
  farthest_on_plane_ = 0;
  const auto& meshes = editor.character().meshes;
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    double steepest = 0;
    for (const Affine3d& model_from_bind : pose_.palette(meshes[m].skin))
      steepest = std::max(steepest, steepness(plane_.normal, model_from_bind.linear()));
    // The weights of a vertex add up to 1 within rounding.
    const double of_mesh = 1.001 * kOnPlaneCoordinates * steepest *
                           static_cast<double>(editor.surface().largest_coordinate[m]);
    farthest_on_plane_ = std::max(farthest_on_plane_, of_mesh);
  }
}

void PosedPoints::fetch(const SurfaceEditor& editor, Index mesh,
                        std::span<const Index> origins) const {
  // Each loop reads what the previous one has prefetched.
  const Surface& surface = editor.surface();
  if (surface.point_count() < kCachedPoints) return;
  const Mesh& of = editor.character().meshes[mesh];
  const Index source_count = editor.source().meshes[mesh].triangle_count();
  std::array<Index, 3 * std::size_t{PatchTree::kPatchSize}> corners;
  std::size_t count = 0;
  for (const Index origin : origins) {
    if (origin >= source_count) continue;
    const Index first = 3 * editor.origins.surface_triangle(mesh, origin);
    prefetch(&surface.corner_point[first]);
    for (Index k = 0; k < 3; ++k) corners[count++] = first + k;
  }
  // The faces share most of their points. A bit that two of them have in common costs no more than
  // a prefetch. The faces that share a point cannot be predicted, so nothing branches there.
  std::uint64_t met = 0;
  std::size_t point_count = 0;
  for (const Index corner : std::span(corners).first(count)) {
    const Index point = surface.corner_point[corner];
    if (point >= known_.size()) continue;
    const std::uint64_t is_met = met >> point % 64 & 1;
    met |= std::uint64_t{1} << point % 64;
    corners[point_count] = point;
    point_count += 1 - is_met;
    prefetch(&known_[point]);
    prefetch(&surface.point_corner[point]);
  }
  const std::span<Index> points = std::span(corners).first(point_count);
  std::size_t vertex_count = 0;
  for (const Index point : points) {
    const Index corner = surface.point_corner[point];
    points[vertex_count] = corner;
    vertex_count += static_cast<std::size_t>((known_[point].since != epoch_) & (corner != kNone));
  }
  const std::span<Index> wanted = points.first(vertex_count);
  for (const Index corner : wanted)
    prefetch(
        &of.triangles[std::min(surface.triangle(corner / 3).triangle, of.triangle_count() - 1)]);
  for (Index& corner : wanted) {
    const TriangleRef ref = surface.triangle(corner / 3);
    const Index vertex = ref.mesh == mesh ? of.triangles[ref.triangle][corner % 3] : 0;
    corner = vertex;
    prefetch(&of.positions[vertex]);
    prefetch(&of.weights.first[vertex]);
    for (const MorphTarget& target : of.morph_targets)
      if (!target.position_deltas.empty()) prefetch(&target.position_deltas[vertex]);
  }
  for (const Index vertex : wanted) prefetch(&of.weights.influences[of.weights.first[vertex]]);
}

void PosedPoints::fetch(const SurfaceEditor& editor, Index point) const {
  if (point >= known_.size()) return;
  prefetch(&known_[point]);
  const Index corner = editor.surface().point_corner[point];
  if (corner == kNone) return;
  const TriangleRef ref = editor.surface().triangle(corner / 3);
  const Mesh& mesh = editor.character().meshes[ref.mesh];
  const Index vertex = mesh.triangles[ref.triangle][corner % 3];
  prefetch(&mesh.positions[vertex]);
  if (!mesh.normals.empty()) prefetch(&mesh.normals[vertex]);
  prefetch(&mesh.weights.influences[mesh.weights.first[vertex]]);
}

void PosedPoints::forget_from(Index first_point) {
  if (known_.size() > first_point) known_.resize(first_point);
}

}  // namespace sunder::tear
