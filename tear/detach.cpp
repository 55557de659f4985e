// Pieces come free of a model.

#include <sunder/tear/detached_piece.h>

#include <new>
#include <utility>

#include "core/internal/out_of_memory.h"
#include "tear/detached/find_piece.h"
#include "tear/detached/make_piece.h"
#include "tear/model/model_state.h"
#include "tear/surface/connected_faces.h"

namespace sunder {
namespace {

Status validate(const DetachOptions& options) {
  if (options.motion > PieceMotion::none)
    return Status::failure(StatusCode::invalid_argument, kNone, "unknown motion of a piece %u",
                           static_cast<unsigned>(options.motion));
  if (options.axes > PieceAxes::model)
    return Status::failure(StatusCode::invalid_argument, kNone, "unknown axes of a piece %u",
                           static_cast<unsigned>(options.axes));
  return validate(options.mass);
}

/// The place of a face in the history.
PieceOfTriangle triangle_of(std::uint32_t face, const tear::Surface& surface) {
  const tear::TriangleRef ref = surface.triangle(face);
  return {ref.mesh, ref.triangle};
}

}  // namespace

Result<DetachedPiece> detach(TornModel& model, const ModelPose& pose, const PiecePlace& place,
                             const DetachOptions& options, ChangeRecord* change) {
  if (Status status = model.unpack(); !status) return status;
  TornModel::State& state = *model.state_;
  if (Status status = state.may_begin(); !status) return status;
  if (Status status = validate(options); !status) return status;
  if (Status status = state.stand_in(pose); !status) return status;
  return or_out_of_memory([&]() -> Result<DetachedPiece> {
    state.editor.scratch().reset();
    const Result<std::uint32_t> face = tear::find_piece(place, state.workpiece());
    if (!face) return face.error();
    const tear::Surface& surface = state.editor.surface();
    const std::vector<std::uint32_t> faces = tear::connected_faces(*face, surface);
    if (!tear::has_others(faces, surface))
      return Status::failure(StatusCode::invalid_argument, kNone,
                             "the piece is all that is left of the model");
    // Everything that may fail is made before the surface changes.
    Result<DetachedPiece> piece = tear::make_piece(faces, pose, options, state.editor);
    if (!piece) return piece;
    const PieceOfTriangle named = triangle_of(*face, surface);
    const auto write_entry = [&](DetachOperation& entry) { entry.piece = named; };
    const auto work = [&](tear::Outcome&) { tear::retire_component(faces, state.editor); };
    Result<TearReport> report = state.perform<DetachOperation>(
        {pose, state.weights, change, false, false, true}, write_entry, work);
    if (!report) return report.error();
    piece->report = std::move(*report);
    piece->report.pieces = {};
    piece->report.pieces.push_back(
        {named.mesh, named.triangle, static_cast<std::uint32_t>(faces.size())});
    return piece;
  });
}

Result<std::vector<ConvexHull>> convex_hulls(const DetachedPiece& piece,
                                             const HullOptions& options) {
  if (!piece.character || piece.character->skeleton.bones.size() != 1 ||
      !piece.character->clips.empty())
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the piece is not frozen; its hulls depend on its pose");
  return or_out_of_memory([&]() -> Result<std::vector<ConvexHull>> {
    std::vector<Vec3d> positions;
    std::vector<Triangle> triangles;
    std::vector<std::uint32_t> bones;
    for (std::size_t i = 0; i < piece.meshes.size(); ++i) {
      const Mesh& mesh = piece.character->meshes[i];
      const auto first = static_cast<std::uint32_t>(positions.size());
      for (const Vec3f& position : mesh.positions) positions.push_back(position.cast<double>());
      for (const Triangle& triangle : mesh.triangles)
        triangles.push_back({triangle[0] + first, triangle[1] + first, triangle[2] + first});
      bones.insert(bones.end(), piece.meshes[i].bones.begin(), piece.meshes[i].bones.end());
    }
    return convex_hulls(positions, triangles, bones, options);
  });
}

}  // namespace sunder
