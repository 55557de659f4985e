#pragma once

#include <span>
#include <string>
#include <vector>

#include "pipeline/aim/limb_sections.h"
#include "pipeline/aim/surface_parts.h"

namespace sunder::aim {

/// Says how much a cut must take off to count as a sever.
struct SeverJudge {
  bool is_whole =
      false;  ///< Most of all that the limb moves on the body, not only beyond the plane.
  bool counts_props = false;  ///< What comes off beside the cut counts too: a head of loose parts.
};

/// Finds what a cut through some sections of a limb would take off: the surface beyond them, with
/// the separate parts that mostly move with the limb. The model is not changed.
class TrialCut {
 public:
  /// O(faces).
  TrialCut(const Limb& limb, const SurfaceParts& parts, const LimbPlane& plane,
           std::span<const Section> sections);

  /// Why the cut is not of the limb; empty if it is: what comes off holds most of what the limb
  /// moves on the body beyond the plane, and the limb moves most of it.
  [[nodiscard]] std::string fault(const SeverJudge& judge) const;

  /// Places on the connected pieces that come off at the sections.
  [[nodiscard]] std::vector<PiecePlace> severed() const;
  /// Places on the separate parts that mostly move with the limb: hats, beards, eyes, axes. Cut
  /// near its joint, the limb takes all of them along; further out those that lie beyond the plane
  /// or move with the bones below it.
  [[nodiscard]] std::vector<PiecePlace> props() const;

 private:
  /// A connected piece after the cut.
  struct Piece {
    /// Whether it has a lip beyond the plane, and before it.
    bool is_far = false, is_near = false;
    Index face = kNone;  ///< That the plane does not cross; kNone: there is none.
    /// A place inside the largest part of a crossed face, and how large that is. A corner of a
    /// piece may lie on other pieces too.
    Vec3d inside = Vec3d::Zero();
    double inside_size = -1;
    double size = 0, moved = 0;  ///< SurfaceParts::size(), and what the limb moves of it.
    double going = 0;   ///< What the bones below move of it, and the bone itself beyond the plane.
    double others = 0;  ///< What bones move of it that are neither of the limb nor its parent.
    double body_moved = 0;    ///< What the limb moves of it on the body …
    double points_moved = 0;  ///< … and the same of its points alone.
  };
  class Halves;
  void add_face(Index face, const Halves& halves, const SurfaceParts& parts,
                const std::vector<Index>& piece_of);
  /// Finds the pieces that the points are of.
  void place_points(const Halves& halves, const std::vector<double>& heights,
                    const std::vector<Index>& piece_of);
  [[nodiscard]] bool is_severed(const Piece& piece) const { return piece.is_far && !piece.is_near; }
  [[nodiscard]] bool is_prop(const Piece& piece) const;
  [[nodiscard]] PiecePlace place_on(const Piece& piece) const;
  /// Per point, whether it comes off with all that are in its place. @param comes_off  per piece.
  [[nodiscard]] std::vector<bool> points_off(const std::vector<bool>& comes_off) const;
  /// That what comes off holds less than most of what the limb moves; empty if it holds that.
  [[nodiscard]] std::string missing(const SeverJudge& judge) const;
  /// That most of what the parent or another limb moves would come off too; empty if they stay.
  [[nodiscard]] std::string taken_along(const SeverJudge& judge) const;

  const Limb& limb_;
  const SurfaceParts& parts_;
  std::vector<Piece> pieces_;
  std::vector<Index> piece_of_face_;    ///< Of a crossed face, of its half beyond the plane.
  std::vector<double> beyond_of_face_;  ///< The share of a face that is of that piece.
  std::vector<Index> piece_of_point_;   ///< kNone for a point without live faces.
  std::vector<bool> is_point_of_body_;
  double beyond_ = 0, whole_ = 0;  ///< What the limb moves on the body: beyond the plane, and all.
  double beyond_of_all_ = 0;       ///< What it moves beyond the plane on any part.
  double whole_of_all_ = 0;        ///< What it moves on all parts.
};

}  // namespace sunder::aim
