#include "aim/trial_cut.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "aim/joined_sets.h"
#include "core/internal/ordered.h"

namespace sunder::aim {
namespace {

using tear::Surface;

/// What comes off holds at least this share of what the limb moves, and the limb moves at least
/// this share of a prop.
constexpr double kMost = 0.5;
/// The limb moves at least this share of what comes off, and bones that are neither of the limb nor
/// its parent at most that share: half of a torso is not a shoulder.
constexpr double kLeastMoved = 0.5, kMostOfOthers = 0.25;
/// Where the body holds less than this share of what the limb moves beyond the plane, the other
/// parts count too: the shoe on a leg whose foot nobody has modelled.
constexpr double kLeastBody = 0.05;
/// A limb takes along so much of what its parent moves only if that is less than this share of what
/// the limb moves itself.
constexpr double kMostOfParent = 0.75, kLeastOfParent = 0.1;

int percent(double part, double whole) { return static_cast<int>(std::lround(100 * part / whole)); }

/// The share of a triangle's area where a linear function of the corners is not negative.
double share_beyond(const std::array<double, 3>& heights) {
  const auto count = std::count_if(heights.begin(), heights.end(), [](double h) { return h >= 0; });
  if (count == 0 || count == 3) return count == 3 ? 1.0 : 0.0;
  // The corner that is alone on its side cuts off a triangle that is similar on two edges.
  std::size_t lone = 0;
  while ((heights[lone] >= 0) != (count == 1)) ++lone;
  const double h = heights[lone], a = heights[(lone + 1) % 3], b = heights[(lone + 2) % 3];
  const double tip = h / (h - a) * (h / (h - b));
  return count == 1 ? tip : 1.0 - tip;
}

/// A place inside the part of a triangle where a linear function of the corners is not negative.
Vec3d inside_beyond(const std::array<Vec3d, 3>& corners, const std::array<double, 3>& heights) {
  Vec3d sum = Vec3d::Zero();
  int count = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    if (heights[i] >= 0) {
      sum += corners[i];
      ++count;
    }
    if ((heights[i] >= 0) == (heights[j] >= 0)) continue;
    sum += corners[i] + heights[i] / (heights[i] - heights[j]) * (corners[j] - corners[i]);
    ++count;
  }
  return sum / count;
}

}  // namespace

/// The faces of the surface as nodes: those that the sections cross count as two, the half beyond
/// the plane and the half before it.
class TrialCut::Halves {
 public:
  Halves(const PosedSurface& surface, const std::vector<double>& heights,
         std::span<const Section> sections)
      : surface_(surface), heights_(heights), near_half_(surface.face_count(), kNone) {
    count_ = surface.face_count();
    for (const Section& section : sections)
      for (const Section::Line& line : section.lines)
        if (near_half_[line.face] == kNone) near_half_[line.face] = count_++;
  }

  [[nodiscard]] Index count() const { return count_; }
  [[nodiscard]] bool is_crossed(Index face) const { return near_half_[face] != kNone; }
  [[nodiscard]] Index near_half(Index face) const { return near_half_[face]; }
  /// A face, or its half on one side.
  [[nodiscard]] Index node(Index face, bool is_beyond) const {
    return is_crossed(face) && !is_beyond ? near_half_[face] : face;
  }
  [[nodiscard]] std::array<double, 3> heights(Index face) const {
    return {heights_[surface_.point(3 * face)], heights_[surface_.point(3 * face + 1)],
            heights_[surface_.point(3 * face + 2)]};
  }

  /// The connected piece of each node.
  [[nodiscard]] std::vector<Index> pieces() const {
    JoinedSets joined(count_);
    const Surface& surface = surface_.surface();
    for (Index h = 0; h < 3 * surface_.face_count(); ++h) {
      const Index twin = surface.twin[h];
      if (twin == kNone || twin < h || !surface_.is_live(h / 3) || !surface_.is_live(twin / 3))
        continue;
      for (const Index end : {surface_.point(h), surface_.point(Surface::next(h))}) {
        const bool is_beyond = heights_[end] >= 0;
        joined.join(node(h / 3, is_beyond), node(twin / 3, is_beyond));
      }
    }
    std::vector<Index> piece_of(count_), number(count_, kNone);
    Index pieces = 0;
    for (Index i = 0; i < count_; ++i) {
      Index& piece = number[joined.set_of(i)];
      if (piece == kNone) piece = pieces++;
      piece_of[i] = piece;
    }
    return piece_of;
  }

 private:
  const PosedSurface& surface_;
  const std::vector<double>& heights_;
  std::vector<Index> near_half_;
  Index count_ = 0;
};

TrialCut::TrialCut(const Limb& limb, const SurfaceParts& parts, const LimbPlane& plane,
                   std::span<const Section> sections)
    : limb_(limb), parts_(parts), beyond_of_face_(limb.surface.face_count(), 0.0) {
  std::vector<double> heights(limb.surface.surface().point_count());
  for (Index point = 0; point < heights.size(); ++point)
    heights[point] = dot(plane.normal, limb.surface.position(point)) - plane.offset;
  const Halves halves(limb.surface, heights, sections);
  const std::vector<Index> piece_of = halves.pieces();
  for (const Index piece : piece_of)
    if (piece >= pieces_.size()) pieces_.resize(piece + 1);
  piece_of_face_.assign(piece_of.begin(), piece_of.begin() + limb.surface.face_count());
  for (Index face = 0; face < limb.surface.face_count(); ++face)
    if (limb.surface.is_live(face)) add_face(face, halves, parts, piece_of);
}

void TrialCut::add_face(Index face, const Halves& halves, const SurfaceParts& parts,
                        const std::vector<Index>& piece_of) {
  const double beyond = share_beyond(halves.heights(face));
  const LimbShares shares = limb_.bones.shares_of_face(face);
  const auto add = [&](Piece& piece, double part) {
    const double size = part * parts.size(face), moved = part * parts.moved_size(face);
    piece.size += size;
    piece.moved += moved;
    piece.others += size * shares.other();
    if (parts.is_of_body(face)) piece.body_moved += moved;
  };
  Piece& far = pieces_[piece_of[face]];
  beyond_of_face_[face] = halves.is_crossed(face) ? beyond : 1.0;
  add(far, beyond_of_face_[face]);
  far.going += parts.size(face) * (shares.below() + beyond * shares.own());
  if (halves.is_crossed(face)) {
    Piece& near = pieces_[piece_of[halves.near_half(face)]];
    add(near, 1.0 - beyond);
    far.is_far = true;
    near.is_near = true;
    if (const double size = beyond * parts.size(face); size > far.inside_size) {
      far.inside_size = size;
      far.inside = inside_beyond(limb_.surface.corners(face), halves.heights(face));
    }
  } else if (far.face == kNone) {
    far.face = face;
  }
  beyond_of_all_ += beyond * parts.moved_size(face);
  if (!parts.is_of_body(face)) return;
  beyond_ += beyond * parts.moved_size(face);
  whole_ += parts.moved_size(face);
}

bool TrialCut::is_prop(const Piece& piece) const {
  if (piece.is_far || piece.is_near || !(piece.size > 0)) return false;
  return (is_near_joint(limb_) ? piece.moved : piece.going) >= kMost * piece.size;
}

std::string TrialCut::fault(const SeverJudge& judge) const {
  Piece off;  // all that comes off at the sections
  double held = 0, held_of_all = 0;
  for (const Piece& piece : pieces_) {
    if (!is_severed(piece) && !(judge.counts_props && is_prop(piece))) continue;
    held += piece.body_moved;
    held_of_all += piece.moved;
    if (!is_severed(piece)) continue;
    off.size += piece.size;
    off.moved += piece.moved;
    off.others += piece.others;
  }
  if (!(off.size > 0))
    return "a cut there takes nothing off, because the surface goes on beside it";
  const bool is_of_body = beyond_ >= kLeastBody * beyond_of_all_;
  if (off.moved < kLeastMoved * off.size || off.others > kMostOfOthers * off.size)
    return "other bones move " + std::to_string(percent(off.size - off.moved, off.size)) +
           " % of what would come off there";
  if (const std::string text = taken_along(); !text.empty()) return text;
  const double of = judge.is_whole ? whole_ : is_of_body ? beyond_ : beyond_of_all_;
  const double has = judge.is_whole || is_of_body ? held : held_of_all;
  if (has >= kMost * of) return {};
  return "what would come off there holds " + std::to_string(percent(has, of)) +
         " % of what the bones move on the body";
}

std::string TrialCut::taken_along() const {
  const Index parent = limb_.bones.parent();
  if (parent == kNone) return {};
  double moved = 0, whole = 0, taken = 0;
  for (Index face = 0; face < piece_of_face_.size(); ++face) {
    if (!limb_.surface.is_live(face)) continue;
    const double of_parent = parts_.size(face) * limb_.bones.shares_of_face(face).parent();
    whole += of_parent;
    moved += parts_.moved_size(face);
    if (is_severed(pieces_[piece_of_face_[face]])) taken += beyond_of_face_[face] * of_parent;
  }
  if (whole < kLeastOfParent * moved || taken < kMostOfParent * whole) return {};
  return "a cut there takes along " + std::to_string(percent(taken, whole)) + " % of what '" +
         limb_.surface.character().skeleton.bones[parent].name.substr(0, 60) + "' moves";
}

PiecePlace TrialCut::place_on(const Piece& piece) const {
  if (piece.face == kNone) return PieceNear{piece.inside};
  const tear::TriangleRef ref = limb_.surface.surface().triangle(piece.face);
  return PieceOfTriangle{ref.mesh, ref.triangle};
}

std::vector<PiecePlace> TrialCut::severed() const {
  std::vector<PiecePlace> places;
  for (const Piece& piece : pieces_)
    if (is_severed(piece)) places.push_back(place_on(piece));
  return places;
}

std::vector<PiecePlace> TrialCut::props() const {
  std::vector<PiecePlace> places;
  for (const Piece& piece : pieces_)
    if (is_prop(piece)) places.push_back(place_on(piece));
  return places;
}

}  // namespace sunder::aim
