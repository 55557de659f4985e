#include "tear/detached/find_piece.h"

#include <sunder/bodies/convex_hulls.h>

#include <algorithm>
#include <limits>

#include "core/internal/ordered.h"
#include "tear/geometry/nearest_on_face.h"

namespace sunder::tear {
namespace {

/// Whether a bone moves a face more than any other does.
bool is_of_bone(Index face, Index bone, const SurfaceEditor& editor) {
  const TriangleRef ref = editor.surface().triangle(face);
  const Mesh& mesh = editor.character().meshes[ref.mesh];
  return main_bone(mesh.triangles[ref.triangle], mesh.weights,
                   editor.character().skins[mesh.skin]) == bone;
}

struct PieceFinder {
  const Workpiece& work;

  Result<Index> operator()(const PieceOfTriangle& place) const {
    const auto& meshes = work.editor.character().meshes;
    if (place.mesh >= meshes.size())
      return Status::failure(StatusCode::index_out_of_range, place.mesh,
                             "the piece is to be in mesh %u; the model has %zu meshes", place.mesh,
                             meshes.size());
    if (place.triangle >= meshes[place.mesh].triangle_count())
      return Status::failure(StatusCode::index_out_of_range, place.triangle,
                             "the piece is to have triangle %u; mesh %u '%s' has %u",
                             place.triangle, place.mesh, meshes[place.mesh].name.c_str(),
                             meshes[place.mesh].triangle_count());
    const Index face = work.editor.origins.surface_triangle(place.mesh, place.triangle);
    if (work.editor.surface().has_repeated_point(face))
      return Status::failure(
          StatusCode::not_found, place.triangle,
          "triangle %u of mesh %u '%s' is %s, so it is on no piece", place.triangle, place.mesh,
          meshes[place.mesh].name.c_str(),
          is_retired(meshes[place.mesh].triangles[place.triangle]) ? "removed" : "degenerate");
    return face;
  }

  Result<Index> operator()(const PieceNear& place) const {
    if (!place.point.allFinite())
      return Status::failure(StatusCode::non_finite_value, kNone,
                             "the place of the piece is not finite");
    if (place.point.cwiseAbs().maxCoeff() > kFarthestMetres)
      return Status::failure(StatusCode::invalid_argument, kNone,
                             "the place of the piece lies beyond 1e60");
    const auto& bones = work.editor.character().skeleton.bones;
    const auto bone = std::find_if(bones.begin(), bones.end(),
                                   [&](const Bone& of) { return of.name == place.bone; });
    if (!place.bone.empty() && bone == bones.end())
      return Status::failure(StatusCode::not_found, kNone, "the model has no bone '%s'",
                             place.bone.c_str());
    const Index number = place.bone.empty() ? kNone : static_cast<Index>(bone - bones.begin());
    const Index face = nearest_face(place.point, number);
    if (face != kNone) return face;
    return number == kNone
               ? Status::failure(StatusCode::not_found, kNone, "nothing is left of the model")
               : Status::failure(StatusCode::not_found, number,
                                 "bone '%s' moves no triangle more than other bones do",
                                 place.bone.c_str());
  }

 private:
  /// The first one of several equally near faces. @param bone  kNone: any.
  [[nodiscard]] Index nearest_face(const Vec3d& point, Index bone) const {
    const Surface& surface = work.editor.surface();
    const Frame frame = work.posed.frame_along(axes_along(Vec3d::Zero()), work.editor);
    const Vec3d place = frame.place_of(point);
    const auto least_distance = [&](const FrameBox& tight) {
      const FrameBox box = tight.widened(frame.reach());
      const Vec3d away = (box.low - place).cwiseMax(place - box.high).cwiseMax(0.0);
      const double distance = norm(away);
      return distance == distance ? distance : 0.0;  // infinite boxes
    };
    Index nearest = kNone;
    double least = std::numeric_limits<double>::max();
    work.posed.visit_faces(work.editor, frame, least_distance, [&](Index face) {
      const Index* points = &surface.corner_point[3 * face];
      const Vec3d a = work.posed.position(work.editor, points[0]),
                  b = work.posed.position(work.editor, points[1]),
                  c = work.posed.position(work.editor, points[2]);
      const double distance = norm(Vec3d(nearest_on_face(point, a, b, c) - point));
      if (distance > least || (distance == least && face > nearest)) return least;
      if (bone != kNone && !is_of_bone(face, bone, work.editor)) return least;
      nearest = face;
      least = distance;
      return least;
    });
    return nearest;
  }
};

}  // namespace

Result<Index> find_piece(const PiecePlace& place, const Workpiece& work) {
  return std::visit(PieceFinder{work}, place);
}

}  // namespace sunder::tear
