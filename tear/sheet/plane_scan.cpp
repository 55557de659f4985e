#include "tear/sheet/plane_scan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "tear/geometry/tolerances.h"
#include "tear/internal/surface.h"

namespace sunder::tear {
namespace {

/// Up to so many points, a scan takes less time than the bounds of the patches that are met.
constexpr Index kMostPoints = 8192;

/// Where a vertex may be.
constexpr std::uint8_t kInside = 1, kOutside = 2, kAcross = kInside | kOutside;

bool has_displacements(const Mesh& mesh) {
  return std::any_of(mesh.morph_targets.begin(), mesh.morph_targets.end(),
                     [](const MorphTarget& target) { return !target.position_deltas.empty(); });
}

/// The distances from a plane of a skin's vertices. A bone turns a bind position into a distance by
/// four numbers, so a distance costs a third of a position.
class Distances {
 public:
  Distances(const PlaneSide& plane, std::span<const Affine3d> palette, ScratchMemory& scratch)
      : rows_(&scratch), offset_(plane.offset) {
    rows_.reserve(palette.size());
    const Vec3d size = plane.normal.cwiseAbs();
    for (const Affine3d& model_from_bind : palette) {
      const double* const of = model_from_bind.data();  // columns
      const auto along = [&](std::size_t column) {
        const double* const at = of + 3 * column;
        return plane.normal.x() * at[0] + plane.normal.y() * at[1] + plane.normal.z() * at[2];
      };
      const auto size_of = [&](std::size_t column) {
        const double* const at = of + 3 * column;
        return size.x() * std::abs(at[0]) + size.y() * std::abs(at[1]) + size.z() * std::abs(at[2]);
      };
      rows_.push_back({along(0), along(1), along(2), along(3)});
      steepest_ = std::max({steepest_, size_of(0), size_of(1), size_of(2)});
      farthest_ = std::max(farthest_, size_of(3));
    }
    farthest_ += std::abs(offset_);
  }

  /// The side of a vertex, if rounding cannot change it; otherwise kAcross.
  [[nodiscard]] std::uint8_t side_of(const Vec3f& bind,
                                     std::span<const Influence> influences) const {
    Row sum = Row::Zero();
    double weights = 1;
    for (const Influence& influence : influences) {
      const auto weight = static_cast<double>(influence.weight);
      weights += std::abs(weight);
      sum += weight * Eigen::Map<const Row>(rows_[influence.slot].data());
    }
    const auto x = static_cast<double>(bind.x()), y = static_cast<double>(bind.y()),
               z = static_cast<double>(bind.z());
    const double distance = sum[0] * x + sum[1] * y + (sum[2] * z + sum[3]) - offset_;
    const double error = kPosedCoordinates * weights *
                         (steepest_ * (std::abs(x) + std::abs(y) + std::abs(z)) + farthest_);
    return distance > error ? kInside : distance < -error ? kOutside : kAcross;
  }

 private:
  using Row = Eigen::Array<double, 4, 1>;

  ScratchVector<std::array<double, 4>> rows_;  ///< Per slot.
  double offset_;
  double steepest_ = 0, farthest_ = 0;  ///< Bounds of the terms of a distance.
};

void find_sides(const PlaneSide& plane, Index mesh, const SurfaceEditor& editor,
                const PosedPoints& posed, std::span<std::uint8_t> sides) {
  const Mesh& of = editor.character().meshes[mesh];
  const Distances distances(plane, posed.pose().palette(of.skin), editor.scratch());
  const Index source_count = editor.source().meshes[mesh].vertex_count();
  for (Index v = 0; v < source_count; ++v)
    sides[v] = distances.side_of(of.positions[v], of.weights.of(v));
  for (Index v = source_count; v < sides.size(); ++v)
    sides[v] =
        distances.side_of(editor.births.position(mesh, v), editor.births.influences(mesh, v));
}

}  // namespace

bool is_scanned(const SurfaceEditor& editor, const PosedPoints& posed) {
  const auto& meshes = editor.character().meshes;
  return !posed.has_pins() && editor.surface().point_count() <= kMostPoints &&
         std::none_of(meshes.begin(), meshes.end(), has_displacements);
}

ScratchVector<Index> scan_faces(const PlaneSide& plane, const SurfaceEditor& editor,
                                const PosedPoints& posed) {
  const Surface& surface = editor.surface();
  ScratchVector<Index> faces(&editor.scratch());
  faces.reserve(256);
  for (Index m = 0; m < editor.character().meshes.size(); ++m) {
    const Mesh& mesh = editor.character().meshes[m];
    ScratchVector<std::uint8_t> sides(mesh.vertex_count(), kAcross, &editor.scratch());
    find_sides(plane, m, editor, posed, sides);
    for (Index t = 0; t < mesh.triangle_count(); ++t) {
      const auto& [a, b, c] = mesh.triangles[t];
      if ((sides[a] | sides[b] | sides[c]) != kAcross) continue;
      const Index face = editor.origins.surface_triangle(m, t);
      if (!surface.has_repeated_point(face)) faces.push_back(face);
    }
  }
  return faces;
}

}  // namespace sunder::tear
