#include "tear/weld/choose_lips.h"

#include <algorithm>
#include <limits>
#include <queue>

#include "core/internal/ordered.h"
#include "core/operation/internal/field_ranges.h"

namespace sunder::tear {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

/// A lip of a wound, and the way to it along the wound.
struct Reached {
  double way;
  Index lip;

  bool operator>(const Reached& other) const {
    return way != other.way ? way > other.way : lip > other.lip;
  }
};

/// Lips that follow one another at common points, and lie on one another.
class Wounds {
 public:
  Wounds(std::span<const Lip> lips, std::span<const LipOverlap> overlaps, const Workpiece& work)
      : lips_(lips),
        work_(work),
        opposite_(&work.editor.scratch()),
        at_points_(&work.editor.scratch()),
        is_paired_(lips.size(), false, &work.editor.scratch()) {
    for (const LipOverlap& of : overlaps) {
      opposite_.push_back({of.a, of.b});
      opposite_.push_back({of.b, of.a});
      is_paired_[of.a] = is_paired_[of.b] = true;
    }
    for (Index i = 0; i < lips.size(); ++i)
      for (const Index point : lips[i].points)
        if (is_paired_[i]) at_points_.push_back({point, i});
    std::sort(opposite_.begin(), opposite_.end());
    std::sort(at_points_.begin(), at_points_.end());
  }

  [[nodiscard]] bool is_paired(Index lip) const { return is_paired_[lip]; }

  /// Marks the lips whose beginning is less than `reach` away, along the wound, from the place on
  /// it that is nearest to `from`.
  void mark(const Vec3d& from, double reach, ScratchVector<bool>& is_chosen) const {
    const Index first = nearest(from);
    if (first == kNone) return;
    const ScratchMemory::Frame memory_of_step(work_.editor.scratch());
    ScratchVector<double> ways(lips_.size(), kFar, &work_.editor.scratch());
    std::priority_queue<Reached, ScratchVector<Reached>, std::greater<>> queue(
        std::greater<>(), ScratchVector<Reached>(&work_.editor.scratch()));
    const auto reach_lip = [&](Index lip, double way) {
      if (!(way < reach) || !(way < ways[lip])) return;
      ways[lip] = way;
      queue.push({way, lip});
    };
    reach_lip(first, 0);
    const Vec3d start = place_on(first, from);
    while (!queue.empty()) {
      const double way = queue.top().way;
      const Index lip = queue.top().lip;
      queue.pop();
      if (way > ways[lip]) continue;
      is_chosen[lip] = true;
      for_each(opposite_, lip, [&](Index other) { reach_lip(other, way); });
      for (const Index point : lips_[lip].points) {
        const double along = lip == first ? norm(Vec3d(position(point) - start)) : length_of(lip);
        for_each(at_points_, point, [&](Index other) { reach_lip(other, way + along); });
      }
    }
  }

 private:
  using Pairs = ScratchVector<std::array<Index, 2>>;

  template <class Visit>
  static void for_each(const Pairs& pairs, Index key, Visit visit) {
    auto at = std::lower_bound(pairs.begin(), pairs.end(), std::array{key, Index{0}});
    for (; at != pairs.end() && (*at)[0] == key; ++at) visit((*at)[1]);
  }
  [[nodiscard]] const Vec3d& position(Index point) const {
    return work_.posed.position(work_.editor, point);
  }
  [[nodiscard]] double length_of(Index lip) const {
    const Vec3d begin = position(lips_[lip].points[0]);
    return norm(Vec3d(position(lips_[lip].points[1]) - begin));
  }
  /// The place on a lip that is nearest to another one.
  [[nodiscard]] Vec3d place_on(Index lip, const Vec3d& to) const {
    const Vec3d begin = position(lips_[lip].points[0]);
    const Vec3d along = position(lips_[lip].points[1]) - begin;
    const double squared = squared_norm(along);
    const double share = squared > 0 ? dot(along, Vec3d(to - begin)) / squared : 0;
    return begin + std::clamp(share, 0.0, 1.0) * along;
  }
  [[nodiscard]] Index nearest(const Vec3d& to) const {
    Index found = kNone;
    double least = kFar;
    for (Index i = 0; i < lips_.size(); ++i) {
      if (!is_paired_[i]) continue;
      const double squared = squared_norm(Vec3d(place_on(i, to) - to));
      if (!(squared < least)) continue;
      least = squared;
      found = i;
    }
    return found;
  }

  std::span<const Lip> lips_;
  const Workpiece& work_;
  Pairs opposite_;   ///< Ascending: a lip, and one that lies on it.
  Pairs at_points_;  ///< Ascending: a point, and a lip that ends there.
  ScratchVector<bool> is_paired_;
};

}  // namespace

Status ChosenWounds::validate(const char* what) const {
  for (Index i = 0; i < places.size(); ++i) {
    if (!places[i].allFinite())
      return Status::failure(StatusCode::non_finite_value, i,
                             "place %u near the wounds to %s is not finite", i, what);
    if (places[i].cwiseAbs().maxCoeff() > kFarthestMetres)
      return Status::failure(StatusCode::invalid_argument, i,
                             "place %u near the wounds to %s lies beyond 1e60", i, what);
  }
  return {};
}

ScratchVector<bool> choose_lips(const ChosenWounds& wounds, std::span<const Lip> lips,
                                std::span<const LipOverlap> overlaps, const Workpiece& work) {
  work.posed.cover(work.editor.surface().point_count());
  const Wounds known(lips, overlaps, work);
  ScratchVector<bool> is_chosen(lips.size(), false, &work.editor.scratch());
  for (Index i = 0; wounds.places.empty() && i < lips.size(); ++i)
    is_chosen[i] = known.is_paired(i);
  for (const Vec3d& place : wounds.places)
    known.mark(place, wounds.reach > 0 ? wounds.reach : kFar, is_chosen);
  return is_chosen;
}

}  // namespace sunder::tear
