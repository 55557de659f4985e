#include "tear/sheet/plane_scan.h"

#include <algorithm>
#include <cstdint>

#include "tear/internal/surface.h"
#include "tear/sheet/plane_distances.h"

namespace sunder::tear {
namespace {

/// Up to so many points, a scan takes less time than the bounds of the patches that are met.
constexpr Index kMostPoints = 8192;

bool has_displacements(const Mesh& mesh) {
  return std::any_of(mesh.morph_targets.begin(), mesh.morph_targets.end(),
                     [](const MorphTarget& target) { return !target.position_deltas.empty(); });
}

void find_sides(const PlaneDistances& distances, Index mesh, const SurfaceEditor& editor,
                std::span<std::uint8_t> sides) {
  const Mesh& of = editor.character().meshes[mesh];
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
                                PosedPoints& posed) {
  constexpr std::uint8_t kAcross = PlaneDistances::kAcross;
  posed.compare_with(plane);
  const Surface& surface = editor.surface();
  ScratchVector<Index> faces(&editor.scratch());
  faces.reserve(256);
  for (Index m = 0; m < editor.character().meshes.size(); ++m) {
    const Mesh& mesh = editor.character().meshes[m];
    ScratchVector<std::uint8_t> sides(mesh.vertex_count(), kAcross, &editor.scratch());
    const PlaneDistances distances(plane, posed.pose().palette(mesh.skin),
                                   posed.farthest_on_plane(editor), editor.scratch());
    find_sides(distances, m, editor, sides);
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
