#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>

#include "tear/geometry/plane_side.h"
#include "tear/internal/surface.h"
#include "tear/posed/posed_points.h"
#include "tear/surface/index_map.h"

namespace sunder::tear {

/// The half-spaces of a convex cell in which posed points lie, as one bit per half-space. Each
/// point is compared with the cell once; its memory is the scratch memory of the operation.
class CellSides {
 public:
  using Word = std::uint64_t;
  static constexpr Index kBits = 64;  ///< Per word.

  /// A cylinder without ends that lies inside the first `sides` half-spaces: points in it need not
  /// be compared with them.
  struct Core {
    Vec3d origin = Vec3d::Zero();
    Vec3d axis = Vec3d::Zero();  ///< A unit vector.
    double radius = 0;
    Index sides = 0;
  };

  CellSides(std::span<const PlaneSide> cell, const SurfaceEditor& editor, PosedPoints& posed)
      : CellSides(cell, editor, posed, Core()) {}
  CellSides(std::span<const PlaneSide> cell, const SurfaceEditor& editor, PosedPoints& posed,
            const Core& core);

  /// The bits of a face's corners. Valid until a point is seen for the first time.
  struct OfFace {
    /// Per corner, per word: half-spaces that do not contain it (PlaneSide::contains()), and those
    /// in which it certainly lies, whatever rounding does.
    std::array<const Word*, 3> outside, inside;

    /// Half-spaces on whose plane, or beyond, a corner may lie.
    [[nodiscard]] Word doubtful(Index word) const {
      return ~(inside[0][word] & inside[1][word] & inside[2][word]);
    }
    /// Half-spaces whose planes pass between the corners.
    [[nodiscard]] Word crossed(Index word) const {
      const Word a = outside[0][word], b = outside[1][word], c = outside[2][word];
      return (a | b | c) & ~(a & b & c);
    }
  };
  /// The numbers of a face's corners in this object.
  using Places = std::array<Index, 3>;
  [[nodiscard]] Places places_of(Index face) {
    const Index* points = &editor_.surface().corner_point[3 * face];
    return {place_of(points[0]), place_of(points[1]), place_of(points[2])};
  }
  /// The numbers of the corners of the face across edge k of a face.
  [[nodiscard]] Places places_beyond(const Places& places, Index k, Index twin) {
    Places beyond;
    beyond[twin % 3] = places[(k + 1) % 3];
    beyond[Surface::next(twin) % 3] = places[k];
    const Index third = Surface::previous(twin);
    beyond[third % 3] = place_of(editor_.surface().corner_point[third]);
    return beyond;
  }
  [[nodiscard]] OfFace at(const Places& places) const {
    OfFace of{};
    for (std::size_t k = 0; k < 3; ++k) {
      of.outside[k] = &bits_[std::size_t{2} * words_ * places[k]];
      of.inside[k] = of.outside[k] + words_;
    }
    return of;
  }

  /// The posed position of a face's corner. Valid until a point is seen for the first time.
  [[nodiscard]] const Vec3d& position(Index place) const { return positions_[place]; }

  [[nodiscard]] Index word_count() const { return words_; }
  /// Calls visit(half-space) for the bits of a word, ascending.
  template <class Visit>
  static void for_each_bit(Word bits, Index word, Visit visit) {
    for (; bits != 0; bits &= bits - 1)
      visit(kBits * word + static_cast<Index>(std::countr_zero(bits)));
  }
  /// Whether all corners of a face certainly lie in all half-spaces.
  [[nodiscard]] bool is_surely_inside(const OfFace& of) const {
    Word doubtful = 0;
    for (Index w = 0; w < words_; ++w) doubtful |= of.doubtful(w) & all(w);
    return doubtful == 0;
  }
  /// Whether a corner of a face certainly lies in all half-spaces.
  [[nodiscard]] bool has_corner_surely_inside(const OfFace& of) const {
    return std::any_of(of.inside.begin(), of.inside.end(), [&](const Word* inside) {
      Word doubtful = 0;
      for (Index w = 0; w < words_; ++w) doubtful |= ~inside[w] & all(w);
      return doubtful == 0;
    });
  }
  /// Whether one half-space contains no corner of a face: then no part of it is in the cell.
  [[nodiscard]] bool is_beyond(const OfFace& of) const {
    Word beyond = 0;
    for (Index w = 0; w < words_; ++w)
      beyond |= of.outside[0][w] & of.outside[1][w] & of.outside[2][w];
    return beyond != 0;
  }
  /// The half-spaces of a word that exist.
  [[nodiscard]] Word all(Index word) const {
    const Index count = static_cast<Index>(cell_.size()) - kBits * word;
    return count >= kBits ? ~Word{0} : (Word{1} << count) - 1;
  }

  [[nodiscard]] std::span<const PlaneSide> cell() const { return cell_; }
  [[nodiscard]] const SurfaceEditor& editor() const { return editor_; }
  [[nodiscard]] PosedPoints& posed() { return posed_; }
  [[nodiscard]] ScratchMemory& memory() const { return editor_.scratch(); }

 private:
  /// Half-spaces that are compared at once.
  static constexpr Index kLanes = 4;
  using Lanes = Eigen::Array<float, kLanes, 1>;
  /// Half-spaces relative to the origin, each with what bounds the rounding of a value: the share
  /// of a point's largest coordinate in it, and the rest. Where nothing can be told in floats, the
  /// rest is larger than any value.
  struct Planes {
    Lanes x, y, z, offset, steepness, rounding;
  };

  void begin_at(const Vec3d& origin);
  /// @return the point's number.
  Index place_of(Index point);
  void compare(const Vec3d& position);
  /// Compares a point with single half-spaces of a word, in double.
  void compare(const Vec3d& position, Word sides, Index word, Word& outside, Word& inside) const;
  /// Whether a point certainly lies in the first half-spaces, without a look at them.
  [[nodiscard]] bool is_in_core(const Vec3d& position) const;

  std::span<const PlaneSide> cell_;
  const SurfaceEditor& editor_;
  PosedPoints& posed_;
  Core core_;
  Index words_;
  Vec3d origin_ = Vec3d::Zero();  ///< The first point.
  ScratchVector<Planes> planes_;
  IndexMap places_;
  ScratchVector<Vec3d> positions_;  ///< Per point.
  ScratchVector<Word> bits_;        ///< Per point: outside, then inside.
};

/// A face that may reach into a cell.
struct CellFace {
  Index face;
  CellSides::Places places;
  bool is_inside = false;  ///< Whether it certainly lies in the cell.
};

}  // namespace sunder::tear
