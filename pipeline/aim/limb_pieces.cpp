#include "pipeline/aim/limb_pieces.h"

#include <cmath>
#include <vector>

#include "pipeline/aim/joined_sets.h"
#include "pipeline/aim/limb_bones.h"

namespace sunder::aim {
namespace {

/// A piece is of a limb that moves at least so much of its area, and a limb is made of pieces that
/// hold at least so much of what it moves.
constexpr double kLeastOfPiece = 0.9, kLeastHeld = 0.9;

struct LimbPiece {
  Index face = kNone;  ///< The first one.
  double area = 0, moved = 0;
};

/// The connected pieces of the surface, in the order of their first faces.
std::vector<LimbPiece> pieces_of(const PosedSurface& surface, const LimbBones& bones) {
  const std::vector<Index>& twin = surface.surface().twin;
  const Index count = surface.face_count();
  JoinedSets joined(count);
  for (Index h = 0; h < 3 * count; ++h)
    if (twin[h] != kNone && surface.is_live(h / 3) && surface.is_live(twin[h] / 3))
      joined.join(h / 3, twin[h] / 3);
  std::vector<LimbPiece> pieces;
  std::vector<Index> piece_of_set(count, kNone);
  for (Index face = 0; face < count; ++face) {
    if (!surface.is_live(face)) continue;
    Index& piece = piece_of_set[joined.set_of(face)];
    if (piece == kNone) {
      piece = static_cast<Index>(pieces.size());
      pieces.push_back({face});
    }
    const double area = surface.area(face);
    pieces[piece].area += area;
    pieces[piece].moved += area * bones.shares_of_face(face).limb();
  }
  return pieces;
}

}  // namespace

Result<LimbPieces> find_limb_pieces(const PosedSurface& surface, const LimbPlace& place) {
  const Skeleton& skeleton = surface.character().skeleton;
  const Result<Index> bone = find_bone(skeleton, place.bone);
  if (!bone) return bone.error();
  const BoneTree tree(surface);
  const LimbBones bones(surface, tree, *bone);
  LimbPieces limb{{}, tree.is_made_of_parts(skeleton, *bone)};
  double moved = 0, off = 0;
  bool stays = false;
  for (const LimbPiece& piece : pieces_of(surface, bones)) {
    moved += piece.moved;
    const bool is_of_limb = piece.moved > 0 && piece.moved >= kLeastOfPiece * piece.area;
    stays |= !is_of_limb;
    if (!is_of_limb) continue;
    off += piece.moved;
    const tear::TriangleRef ref = surface.surface().triangle(piece.face);
    limb.places.emplace_back(PieceOfTriangle{ref.mesh, ref.triangle});
  }
  if (!(moved > 0))
    return Status::failure(StatusCode::not_found, *bone,
                           "the bone '%.60s' and those below it move nothing", place.bone.c_str());
  if (off < kLeastHeld * moved)
    return Status::failure(
        StatusCode::not_found, *bone, "'%.60s': %d %% of what the limb moves is joined to the rest",
        place.bone.c_str(), static_cast<int>(std::lround(100 * (1 - off / moved))));
  if (!stays)
    return Status::failure(StatusCode::not_found, *bone, "'%.60s': the limb is all of the model",
                           place.bone.c_str());
  return limb;
}

}  // namespace sunder::aim
