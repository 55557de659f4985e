#include "particles/rupture/tip_disc.h"

#include <algorithm>
#include <cmath>

#include "core/internal/elementary.h"
#include "core/internal/ordered.h"
#include "particles/clusters/lip_border.h"

namespace sunder::particles {
namespace {

/// A line ends after this many faces: in a fan of needles it might not get on.
constexpr std::size_t kMostFaces = 4096;

double cross(const Vec2d& a, const Vec2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// A straight line from a tip, across the unfolded faces.
class Line {
 public:
  Line(const Tissue& tissue, double direction)
      : tissue_(tissue),
        surface_(tissue.model.surface()),
        border_(tissue.model),
        along_(elementary::cos(direction), elementary::sin(direction)) {}

  /// Begins in a face of the tip, whose edges there have the given directions.
  void begin(Index corner, double right, double left) {
    exit_ = Surface::next(corner);
    const Vec3d tip = tissue_.position(surface_.corner_point[corner]);
    right_ = end_of(exit_);
    left_ = end_of(Surface::next(exit_));
    const auto place = [&](End& end, double direction) {
      const double length = norm(Vec3d(end.position - tip));
      end.flat = length * Vec2d(elementary::cos(direction), elementary::sin(direction));
    };
    place(right_, right);
    place(left_, left);
    cross_edge();
  }
  /// The distance from the tip where the line leaves the face, and the displacement there.
  [[nodiscard]] double distance() const { return distance_; }
  [[nodiscard]] const Vec3d& displacement() const { return displacement_; }
  [[nodiscard]] Index owner() const { return owner_; }

  /// Enters the next face. @return false at a border.
  bool advance() {
    const Index twin = surface_.twin[exit_];
    const double length = norm(Vec2d(left_.flat - right_.flat));
    if (border_.has(exit_) || twin == kNone || !(length > 0)) return false;
    const Index across = Surface::previous(twin);
    End end = end_of(across);
    const Vec2d edge = (left_.flat - right_.flat) / length;
    const Vec3d in_space = (left_.position - right_.position) / length;
    const Vec3d to_end = end.position - right_.position;
    const double far = dot(to_end, in_space),
                 out = std::sqrt(std::max(0.0, squared_norm(to_end) - far * far));
    end.flat = right_.flat + far * edge + out * Vec2d(edge.y(), -edge.x());
    if (cross(along_, end.flat) > 0) {
      left_ = end;
      exit_ = Surface::next(twin);
    } else {
      right_ = end;
      exit_ = across;
    }
    cross_edge();
    return true;
  }

 private:
  struct End {
    Index point = kNone;
    Vec3d position = Vec3d::Zero(), displacement = Vec3d::Zero();
    Vec2d flat = Vec2d::Zero();  ///< In the plane of the unfolded faces, from the tip.
  };

  [[nodiscard]] End end_of(Index corner) const {
    const Index point = surface_.corner_point[corner];
    return {point, tissue_.position(point), tissue_.displacement(point), Vec2d::Zero()};
  }
  void cross_edge() {
    const double right = cross(along_, right_.flat), left = cross(along_, left_.flat);
    const double t = left > right ? std::clamp(-right / (left - right), 0.0, 1.0) : 0.5;
    distance_ =
        std::max(distance_, dot(along_, Vec2d(right_.flat + t * (left_.flat - right_.flat))));
    displacement_ = (1 - t) * right_.displacement + t * left_.displacement;
    owner_ = tissue_.set.owners()[t < 0.5 ? right_.point : left_.point];
  }

  const Tissue& tissue_;
  const Surface& surface_;
  LipBorder border_;
  Vec2d along_;
  Index exit_ = kNone;  ///< The half-edge through which the line leaves the face, right to left.
  End right_, left_;
  double distance_ = 0;
  Vec3d displacement_ = Vec3d::Zero();
  Index owner_ = kNone;
};

}  // namespace

TipDisc::TipDisc(const Tissue& tissue, Index tip) : tissue_(tissue), tip_(tip) {
  const Surface& surface = tissue.model.surface();
  const LipBorder border(tissue.model);
  Index corner = border.leaving(tip);
  while (corner != kNone && faces_.size() < kMostFaces) {
    const auto edge_to = [&](Index of) {
      return Vec3d(tissue.position(surface.corner_point[of]) - tissue.position(tip));
    };
    const Vec3d to_right = edge_to(Surface::next(corner)),
                to_left = edge_to(Surface::previous(corner));
    const double between =
        elementary::atan2(norm(Vec3d(to_right.cross(to_left))), dot(to_right, to_left));
    faces_.push_back({corner, angle_, angle_ + between});
    angle_ += between;
    if (border.has(Surface::previous(corner))) return;
    corner = surface.rotate_ccw(corner);
  }
  angle_ = 0;  // it has no two lips
}

void TipDisc::sample_line(double direction, double radius,
                          std::array<TipSample, kDistances>& samples) const {
  const auto face = std::ranges::find_if(
      faces_, [&](const Face& of) { return direction < of.ends || &of == &faces_.back(); });
  Line line(tissue_, direction);
  line.begin(face->corner, face->begins, face->ends);
  double before = 0;
  Vec3d there = tissue_.displacement(tip_);
  bool goes_on = true;
  for (std::size_t i = 0, faces = 0; i < kDistances; ++i) {
    while (goes_on && line.distance() < distance(i, radius) && faces < kMostFaces) {
      before = line.distance();
      there = line.displacement();
      goes_on = line.advance();
      ++faces;
    }
    const double width = line.distance() - before;
    const double t = width > 0 ? std::min((distance(i, radius) - before) / width, 1.0) : 1.0;
    samples[i] = {line.owner(), (1 - t) * there + t * line.displacement()};
  }
}

}  // namespace sunder::particles
