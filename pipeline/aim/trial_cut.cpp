#include "pipeline/aim/trial_cut.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/internal/ordered.h"
#include "pipeline/aim/joined_sets.h"

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
/// the limb moves itself …
constexpr double kMostTaken = 0.75, kLeastOfParent = 0.1;
/// … and of what another limb moves only if that is less than this share of the model.
constexpr double kLeastOfOther = 0.01;

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
  place_points(halves, heights, piece_of);
}

void TrialCut::place_points(const Halves& halves, const std::vector<double>& heights,
                            const std::vector<Index>& piece_of) {
  piece_of_point_.assign(heights.size(), kNone);
  is_point_of_body_.assign(heights.size(), false);
  for (Index corner = 0; corner < 3 * limb_.surface.face_count(); ++corner) {
    const Index face = corner / 3, point = limb_.surface.point(corner);
    if (!limb_.surface.is_live(face) || piece_of_point_[point] != kNone) continue;
    piece_of_point_[point] = piece_of[halves.node(face, heights[point] >= 0)];
    is_point_of_body_[point] = parts_.is_of_body(face);
  }
}

std::vector<bool> TrialCut::points_off(const std::vector<bool>& comes_off) const {
  std::vector<bool> stays(piece_of_point_.size(), false), is_off(piece_of_point_.size(), false);
  for (Index point = 0; point < piece_of_point_.size(); ++point)
    if (piece_of_point_[point] != kNone && !comes_off[piece_of_point_[point]])
      stays[parts_.place_of(point)] = true;
  for (Index point = 0; point < piece_of_point_.size(); ++point)
    is_off[point] = piece_of_point_[point] != kNone && !stays[parts_.place_of(point)];
  return is_off;
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
  whole_of_all_ += parts.moved_size(face);
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
  for (const Piece& piece : pieces_) {
    if (!is_severed(piece)) continue;
    off.size += piece.size;
    off.moved += piece.moved;
    off.others += piece.others;
  }
  if (!(off.size > 0))
    return "a cut there takes nothing off, because the surface goes on beside it";
  if (off.moved < kLeastMoved * off.size || off.others > kMostOfOthers * off.size)
    return "other bones move " + std::to_string(percent(off.size - off.moved, off.size)) +
           " % of what would come off there";
  if (std::string text = taken_along(judge); !text.empty()) return text;
  return missing(judge);
}

std::string TrialCut::missing(const SeverJudge& judge) const {
  double held = 0, held_of_all = 0, all_with_props = 0;
  std::vector<bool> comes_off;
  for (const Piece& piece : pieces_) {
    // A part that meets the body at an edge is of it, and goes along as a prop does.
    const bool is_counted = judge.counts_props || (judge.is_whole && piece.body_moved > 0);
    comes_off.push_back(is_severed(piece) || (is_counted && is_prop(piece)));
    if (comes_off.back()) held += piece.body_moved;
    if (comes_off.back()) held_of_all += piece.moved;
    if (is_severed(piece) || is_prop(piece)) all_with_props += piece.moved;
  }
  const auto check = [](double has, double of, const char* where) -> std::string {
    if (has >= kMost * of) return {};
    return "what would come off there holds " + std::to_string(percent(has, of)) +
           " % of what the bones move" + where;
  };
  constexpr const char* kOnBody = " on the body";
  const bool is_of_body = beyond_ >= kLeastBody * beyond_of_all_;
  if (!judge.is_whole)
    return is_of_body ? check(held, beyond_, kOnBody) : check(held_of_all, beyond_of_all_, kOnBody);
  if (std::string text = check(held, whole_, kOnBody); !text.empty()) return text;
  // Where triangles are large, a cut may halve them while most of the weights stay before it.
  double held_of_points = 0, whole_of_points = 0;
  const std::vector<bool> is_off = points_off(comes_off);
  for (Index point = 0; point < is_off.size(); ++point) {
    if (!is_point_of_body_[point]) continue;
    const double moved = parts_.size_of_point(point) * limb_.bones.shares(point).limb();
    whole_of_points += moved;
    if (is_off[point]) held_of_points += moved;
  }
  if (std::string text = check(held_of_points, whole_of_points, kOnBody); !text.empty())
    return text;
  return check(all_with_props, whole_of_all_, "");
}

std::string TrialCut::taken_along(const SeverJudge& judge) const {
  const std::vector<Bone>& bones = limb_.surface.character().skeleton.bones;
  struct Sums {
    std::vector<double> whole, taken;
  };
  Sums by_faces{std::vector<double>(bones.size(), 0.0), std::vector<double>(bones.size(), 0.0)};
  Sums by_points = by_faces;
  const auto add = [&](Sums& sums, Index point, double size, double taken) {
    for_each_influence(limb_.surface, point, [&](Index bone, double weight) {
      limb_.bones.add_to_others(sums.whole, bone, size * weight);
      limb_.bones.add_to_others(sums.taken, bone, taken * size * weight);
    });
  };
  std::vector<bool> comes_off;
  for (const Piece& piece : pieces_)
    comes_off.push_back(is_severed(piece) || (judge.is_whole && is_prop(piece)));
  double moved = 0;
  for (Index face = 0; face < piece_of_face_.size(); ++face) {
    if (!limb_.surface.is_live(face)) continue;
    moved += parts_.moved_size(face);
    const double taken = comes_off[piece_of_face_[face]] ? beyond_of_face_[face] : 0.0;
    for (Index corner = 3 * face; corner < 3 * face + 3; ++corner)
      add(by_faces, limb_.surface.point(corner), parts_.size(face) / 3, taken);
  }
  const std::vector<bool> is_off = points_off(comes_off);
  for (Index point = 0; point < is_off.size(); ++point)
    if (piece_of_point_[point] != kNone)
      add(by_points, point, parts_.size_of_point(point), is_off[point] ? 1.0 : 0.0);
  const auto share_of = [](const Sums& sums, Index bone) {
    return sums.whole[bone] > 0 ? sums.taken[bone] / sums.whole[bone] : 0.0;
  };
  const double most = judge.is_whole ? kMost : kMostTaken;
  for (Index bone = 0; bone < bones.size(); ++bone) {
    const bool is_parent = bone == limb_.bones.parent();
    double share = share_of(by_faces, bone);
    if (judge.is_whole) share = std::max(share, share_of(by_points, bone));
    if (by_faces.whole[bone] < (is_parent ? kLeastOfParent * moved : kLeastOfOther) || share < most)
      continue;
    return "a cut there takes along " + std::to_string(percent(share, 1.0)) + " % of what '" +
           bones[bone].name.substr(0, 60) + "' moves";
  }
  return {};
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
