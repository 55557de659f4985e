#include "tear/pieces/describe_piece.h"

#include <algorithm>

#include "core/internal/ordered.h"
#include "tear/internal/surface.h"
#include "tear/surface/connected_faces.h"

namespace sunder::tear {
namespace {

/// The bones that move vertices.
class MovingBones {
 public:
  explicit MovingBones(const Character& character)
      : character_(character), is_moving_(character.skeleton.bones.size(), false) {}

  void add(const Mesh& mesh, Index vertex) {
    const Skin& skin = character_.skins[mesh.skin];
    for (const Influence& influence : mesh.weights.of(vertex))
      is_moving_[skin.bones[influence.slot]] = true;
  }
  [[nodiscard]] std::vector<Index> list() const {
    std::vector<Index> bones;
    for (Index bone = 0; bone < is_moving_.size(); ++bone)
      if (is_moving_[bone]) bones.push_back(bone);
    return bones;
  }

 private:
  const Character& character_;
  std::vector<bool> is_moving_;
};

}  // namespace

PieceDescription describe_piece(Index face, const SurfaceEditor& editor, PosedPoints& posed) {
  const Surface& surface = editor.surface();
  posed.cover(surface.point_count());
  PieceDescription piece;
  std::vector<std::vector<Index>> triangles(editor.character().meshes.size());
  MovingBones bones(editor.character());
  Vec3d moment = Vec3d::Zero(), sum = Vec3d::Zero();
  for (const Index f : connected_faces(face, surface)) {
    const TriangleRef ref = surface.triangle(f);
    const Mesh& mesh = editor.character().meshes[ref.mesh];
    triangles[ref.mesh].push_back(ref.triangle);
    ++piece.triangle_count;
    const Index* points = &surface.corner_point[3 * f];
    const Vec3d &a = posed.position(editor, points[0]), &b = posed.position(editor, points[1]),
                &c = posed.position(editor, points[2]);
    const double area = 0.5 * norm(Vec3d((b - a).cross(c - a)));
    const Vec3d middle = (a + b + c) / 3;
    piece.area_posed += area;
    moment += area * middle;
    sum += middle;
    // All vertices of a point have the same weights, so each point is processed at one corner.
    for (Index k = 0; k < 3; ++k)
      if (surface.point_corner[points[k]] == 3 * f + k)
        bones.add(mesh, mesh.triangles[ref.triangle][k]);
  }
  piece.centroid_posed = piece.area_posed > 0
                             ? Vec3d(moment / piece.area_posed)
                             : Vec3d(sum / static_cast<double>(piece.triangle_count));
  piece.bones = bones.list();
  for (Index mesh = 0; mesh < triangles.size(); ++mesh)
    if (!triangles[mesh].empty()) piece.meshes.push_back({mesh, std::move(triangles[mesh])});
  return piece;
}

}  // namespace sunder::tear
