#include "tear/pieces/piece_description.h"

#include "core/internal/ordered.h"
#include "tear/internal/surface.h"

namespace sunder::tear {

PieceDescription::PieceDescription(const SurfaceEditor& editor, PosedPoints& posed)
    : editor_(editor),
      posed_(posed),
      triangles_(editor.character().meshes.size()),
      has_bone_(editor.character().skeleton.bones.size(), false) {
  posed.cover(editor.surface().point_count());
}

void PieceDescription::add(Index face) {
  const Surface& surface = editor_.surface();
  const TriangleRef ref = surface.triangle(face);
  const Mesh& mesh = editor_.character().meshes[ref.mesh];
  triangles_[ref.mesh].push_back(ref.triangle);
  ++piece_.triangle_count;
  const Index* points = &surface.corner_point[3 * face];
  const Vec3d &a = posed_.position(editor_, points[0]), &b = posed_.position(editor_, points[1]),
              &c = posed_.position(editor_, points[2]);
  const double area = 0.5 * norm(Vec3d((b - a).cross(c - a)));
  const Vec3d middle = (a + b + c) / 3;
  piece_.area_posed += area;
  moment_ += area * middle;
  sum_ += middle;
  // All vertices of a point have the same weights, so each point is processed at one corner.
  const Skin& skin = editor_.character().skins[mesh.skin];
  for (Index k = 0; k < 3; ++k)
    if (surface.point_corner[points[k]] == 3 * face + k)
      for (const Influence& influence : mesh.weights.of(mesh.triangles[ref.triangle][k]))
        has_bone_[skin.bones[influence.slot]] = true;
}

TornPiece PieceDescription::piece() {
  piece_.centroid_posed = piece_.area_posed > 0
                              ? Vec3d(moment_ / piece_.area_posed)
                              : Vec3d(sum_ / static_cast<double>(piece_.triangle_count));
  for (Index bone = 0; bone < has_bone_.size(); ++bone)
    if (has_bone_[bone]) piece_.bones.push_back(bone);
  for (Index mesh = 0; mesh < triangles_.size(); ++mesh)
    if (!triangles_[mesh].empty()) piece_.meshes.push_back({mesh, std::move(triangles_[mesh])});
  return std::move(piece_);
}

}  // namespace sunder::tear
