#include "particles/repair/lip_points.h"

#include <algorithm>

#include "tear/internal/surface.h"

namespace sunder::particles {
namespace {

/// Finds the lips of older tears on which a new border point may lie: those of its neighbours on
/// the border.
class OlderLips {
 public:
  explicit OlderLips(const StructureEdit& edit)
      : points_(edit.structure().points), tear_(edit.tear()) {}

  std::span<const Particle::OfTear> find(Index point, Index before, Index after) {
    found_.clear();
    const bool is_own = points_.lip_points[point].tear == tear_;
    look_at(before, after, is_own);
    if (is_own) look_at(after, before, is_own);
    return found_;
  }

 private:
  /// @param is_own  whether the point is on a lip of the new tear.
  void look_at(Index beside, Index other, bool is_own) {
    points_.for_each_lip(beside, [&](Index tear, Side side) {
      // If the new lip ends in an old one, the old one continues to one side; elsewhere the old one
      // passes by.
      const bool passes =
          is_own ? points_.lip_points[beside].tear != tear_ : points_.is_on_lip(other, tear, side);
      if (passes && tear != tear_) found_.push_back({tear, side});
    });
  }

  const PointTable& points_;
  Index tear_;
  std::vector<Particle::OfTear> found_;
};

/// @return whether the point was put on a lip.
bool put_on_older_lips(PointTable& points, Index point, std::span<const Particle::OfTear> found) {
  bool is_put = false;
  for (const Particle::OfTear& of : found) {
    const auto is_other_side = [&](const Particle::OfTear& other) {
      return other.tear == of.tear && other.side != of.side;
    };
    const bool is_tip = std::ranges::any_of(found, is_other_side);
    if (is_tip || points.is_on_lip(point, of.tear, Side::left) ||
        points.is_on_lip(point, of.tear, Side::right))
      continue;
    points.put_on_lip(point, of.tear, of.side);
    is_put = true;
  }
  return is_put;
}

/// Points that a tear creates on the lips of older tears are on those too.
void put_new_points_on_older_lips(StructureEdit& edit) {
  PointTable& points = edit.structure().points;
  const LipBorder& border = edit.border();
  OlderLips older(edit);
  bool is_put = true;
  for (int pass = 0; pass < 2 && is_put; ++pass) {  // neighbours may both be new
    is_put = false;
    for (Index point = edit.first_new_point(); point < points.count(); ++point) {
      const Index before = border.previous(point),
                  after = before == kNone ? kNone : border.next(point);
      if (after != kNone)
        is_put |= put_on_older_lips(points, point, older.find(point, before, after));
    }
  }
}

}  // namespace

std::vector<Index> put_points_on_lips(StructureEdit& edit, std::span<const ChangeRecord> changes) {
  std::vector<Index> lips;
  PointTable& points = edit.structure().points;
  const auto add = [&](Index point, Side side) {
    if (point >= points.count() || edit.surface().point_corner[point] == kNone) return;
    const LipPoint& lip = points.lip_points[point];
    if (lip.tear == edit.tear() && lip.side == side) return;
    edit.log_point(point);
    points.put_on_lip(point, edit.tear(), side);
    lips.push_back(point);
  };
  for (const ChangeRecord& change : changes) {
    for (const LipPair& pair : change.lips) {
      add(pair.left, Side::left);
      add(pair.right, Side::right);
    }
    for (const Index point : change.rims.left) add(point, Side::left);
    for (const Index point : change.rims.right) add(point, Side::right);
  }
  put_new_points_on_older_lips(edit);
  return lips;
}

}  // namespace sunder::particles
