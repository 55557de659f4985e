#include "particles/contact/self_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "core/internal/ordered.h"
#include "particles/clusters/influences.h"
#include "particles/clusters/structure_of.h"
#include "particles/internal/tolerances.h"

namespace sunder::particles {
namespace {

constexpr int kSelfSweeps = 24;
/// Contact points of a particle are within this many of its ranges of its place, and each stands
/// for a disc of this radius.
constexpr double kPointRanges = 0.7, kDiscRanges = 0.35;
/// Skin that was nearer at rest, in ranges of the decomposition, is not touched: it is next to the
/// point along the surface. So particles touch that moved apart by a part of this.
constexpr double kSeparateRanges = 1.5, kMovedRanges = 1.0;
/// Particles touch only skin that moved less than half as far as they did. So they moved apart by
/// less than 3/2 of their own displacement, and by less than this part of kMovedRanges touch none.
constexpr double kMoverPart = 0.66;
/// RestMotion::size() of a particle whose members the pose does not lengthen.
const double kUnposedSize = std::sqrt(3.0);

Vec3d moved_by(const ParticleInfluences& whom, const std::vector<Vec3d>& values) {
  Vec3d sum = Vec3d::Zero();
  for_each_influence(whom, [&](Index p, double weight) { sum += weight * values[p]; });
  return sum;
}

double squares_of(const ParticleInfluences& whom) {
  double sum = 0;
  for (const float weight : whom.weights) sum += double{weight} * double{weight};
  return sum;
}

bool is_any_awake(const ParticleInfluences& whom, const Motion& motion) {
  bool is_awake = false;
  for_each_influence(whom, [&](Index p, double) { is_awake |= motion.awake[p] != 0; });
  return is_awake;
}

/// Whether of two particles the one that moved less can be the ground of the other.
/// @param moved, by_mover  squares of their displacements.
bool is_ground(double moved, double by_mover) { return 4 * moved < by_mover; }

/// From the nearest place of a box to a place.
Vec3d beside(const Eigen::AlignedBox3d& box, const Vec3d& place) {
  return (box.min() - place).cwiseMax(place - box.max()).cwiseMax(0.0);
}

}  // namespace

void SelfContact::find_lips(const Contact::World& world) {
  if (revision_ == world.set.revision() + 1) return;
  const PointTable& points = StructureOf::in(world.set).points;
  struct OfLip {
    Index tear = 0;
    std::array<float, 3> place = {};
    Side side = Side::left;
    Index point = 0, edge = 0;
    bool operator<(const OfLip& other) const {
      return std::tie(tear, place, side, point) <
             std::tie(other.tear, other.place, other.side, other.point);
    }
  };
  const std::span<const LipEdge> lips = world.set.lips();
  std::vector<OfLip> found;
  for (Index edge = 0; edge < lips.size(); ++edge)
    for (const Index point : lips[edge].points) {
      const LipPoint& on = points.lip_points[point];
      const Vec3f& at = points.positions[point];
      if (on.tear != kNone)
        found.push_back({on.tear, {at.x(), at.y(), at.z()}, on.side, point, edge});
    }
  std::sort(found.begin(), found.end());
  pairs_.clear();
  for (std::size_t i = 1; i < found.size(); ++i) {
    const OfLip &a = found[i - 1], &b = found[i];
    if (a.tear != b.tear || a.place != b.place || a.side == b.side || a.point == b.point) continue;
    LipPoints pair{{a.point, b.point}};
    const auto inward = [&](const OfLip& of) { return lips[of.edge].inward.cast<double>(); };
    pair.across = normalized(Vec3d(inward(b) - inward(a)));
    const Vec3d along =
        (points.positions[lips[b.edge].points[1]] - points.positions[lips[b.edge].points[0]])
            .cast<double>();
    pair.out = normalized(Vec3d(pair.across.cross(along)));
    if (!pair.across.isZero(0)) pairs_.push_back(pair);
  }
  revision_ = world.set.revision() + 1;
}

void SelfContact::touch_lips(double thickness, const Contact::World& world, const Motion& motion) {
  const std::span<const ParticleInfluences> influences = world.set.influences();
  for (const LipPoints& pair : pairs_) {
    const ParticleInfluences &first = influences[pair.points[0]],
                             &second = influences[pair.points[1]];
    if (!(first.weights[0] > 0) || !(second.weights[0] > 0)) continue;
    if (!is_any_awake(first, motion) && !is_any_awake(second, motion)) continue;
    const Index owner = second.particles[0];
    const Mat3d& turn = world.rests.turn(owner);
    const Vec3d apart =
        moved_by(second, motion.displacements) - moved_by(first, motion.displacements);
    const Vec3d across = multiply(turn, pair.across);
    const double range = world.set.range(owner);
    if (dot(apart, across) > kContactMarginRanges * range ||
        std::abs(dot(apart, multiply(turn, pair.out))) > thickness)
      continue;
    touches_.push_back({first, second, across, 0, squares_of(first) + squares_of(second),
                        kContactDepthRanges * range});
  }
}

const SelfContact::Normals& SelfContact::normals_of(const Contact::World& world,
                                                    const ContactPoints::Points& points,
                                                    Index particle) {
  Normals& normals = normals_[particle];
  if (normals.revision == points.revision && normals.epoch == points.epoch) return normals;
  const SurfacePose& pose = world.poses.at(world.model, world.pose, world.rests.epoch());
  for (Index i = 0; i < points.count; ++i)
    normals.at[i] = world.model.surface().point_corner[points.points[i]] == kNone
                        ? Vec3d(Vec3d::Zero())
                        : pose.normal(world.model, points.points[i]);
  normals.revision = points.revision;
  normals.epoch = points.epoch;
  return normals;
}

const SelfContact::MovedPoints& SelfContact::moved_points(const Contact::World& world,
                                                          const Motion& motion, Index particle) {
  MovedPoints& moved = moved_[particle];
  if (moved.search == search_) return moved;
  const SurfacePose& pose = world.poses.at(world.model, world.pose, world.rests.epoch());
  const std::span<const ParticleInfluences> influences = world.set.influences();
  moved.points = &points_.of(world.set, world.model, pose, world.rests.epoch(), particle);
  for (Index i = 0; i < moved.points->count; ++i)
    moved.at[i] = moved.points->places[i] +
                  moved_by(influences[moved.points->points[i]], motion.displacements);
  moved.box.setEmpty();
  for (Index i = 0; i < moved.points->count; ++i) moved.box.extend(moved.at[i]);
  moved.search = search_;
  return moved;
}

void SelfContact::touch_particles(double thickness, const Contact::World& world,
                                  const Motion& motion, Index mover) {
  const std::span<const ParticleInfluences> influences = world.set.influences();
  for (Near& near : near_) {
    const double stretch = world.rests.size(near.particle) / kUnposedSize,
                 disc = kDiscRanges * world.set.range(near.particle) * stretch + thickness,
                 separate = kSeparateRanges * world.set.report().range * stretch;
    near.moved = &moved_points(world, motion, near.particle);
    near.disc_square = disc * disc;
    near.separate_square = separate * separate;
  }
  const MovedPoints& of_mover = moved_points(world, motion, mover);
  for (Index i = 0; i < of_mover.points->count; ++i) {
    const Vec3d &rest = of_mover.points->places[i], &place = of_mover.at[i];
    // The nearest place of the skin, relative to the radius of its disc.
    const Near* of_nearest = nullptr;
    Index nearest = kNone;
    double least = 1;
    for (const Near& near : near_) {
      const ContactPoints::Points& points = *near.moved->points;
      // No point of the box is nearer than this, not even by rounding.
      const double apart = squared_norm(beside(near.moved->box, place));
      if (apart >= near.disc_square || apart / near.disc_square >= least) continue;
      for (Index k = 0; k < points.count; ++k) {
        const double distance = squared_norm(Vec3d(place - near.moved->at[k]));
        if (distance >= near.disc_square || distance / near.disc_square >= least ||
            squared_norm(Vec3d(rest - points.places[k])) < near.separate_square)
          continue;
        least = distance / near.disc_square;
        nearest = k;
        of_nearest = &near;
      }
    }
    if (of_nearest == nullptr) continue;
    const ContactPoints::Points& points = *of_nearest->moved->points;
    const Vec3d& normal = normals_of(world, points, of_nearest->particle).at[nearest];
    if (normal.isZero(0)) continue;
    const ParticleInfluences &first = influences[of_mover.points->points[i]],
                             &second = influences[points.points[nearest]];
    touches_.push_back({second, first, normal,
                        dot(Vec3d(rest - points.places[nearest]), normal) - thickness,
                        squares_of(first) + squares_of(second),
                        kContactDepthRanges * world.set.range(of_nearest->particle)});
  }
}

void SelfContact::find_balls(double thickness, const Contact::World& world, const Motion& motion) {
  movers_.clear();
  ground_.clear();
  const double least = kMovedRanges * world.set.report().range;
  double farthest = 0;
  for (Index p = 0; p < motion.count(); ++p) {
    const double square = squared_norm(motion.displacements[p]);
    if (motion.awake[p] == 0 || !(square > kMoverPart * kMoverPart * least * least)) continue;
    movers_.push_back({.moved_square = square, .particle = p});
    farthest = std::max(farthest, square);
  }
  if (movers_.empty()) return;
  widest_ = 0;
  for (Index p = 0; p < motion.count(); ++p) {
    const double reach = kPointRanges / kUnposedSize * world.rests.size(p) * world.set.range(p);
    widest_ = std::max(widest_, reach);
    const double square = squared_norm(motion.displacements[p]);
    if (is_ground(square, farthest))
      ground_.push_back({Vec3d(world.rests.place(p) + motion.displacements[p]), reach, square, p});
  }
  Vec3d low = Vec3d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (Ball& ball : movers_) {
    const Index p = ball.particle;
    ball.at = world.rests.place(p) + motion.displacements[p];
    ball.reach = kPointRanges / kUnposedSize * world.rests.size(p) * world.set.range(p);
    const Vec3d within = Vec3d::Constant(ball.reach + widest_ + thickness);
    low = low.cwiseMin(ball.at - within);
    high = high.cwiseMax(ball.at + within);
  }
  std::erase_if(ground_, [&](const Ball& ball) {
    return (ball.at.array() < low.array()).any() || (ball.at.array() > high.array()).any();
  });
  grid_.fill(ground_, 2 * widest_ + thickness);
}

void SelfContact::touch_skin(double thickness, const Contact::World& world, const Motion& motion) {
  find_balls(thickness, world, motion);
  if (ground_.empty()) return;
  const double least = kMovedRanges * world.set.report().range;
  points_.follow(motion.count());
  normals_.resize(motion.count());
  moved_.resize(motion.count());
  ++search_;
  for (const Ball& mover : movers_) {
    near_.clear();
    grid_.for_each_near(mover.at, [&](const Ball& other) {
      const double near = mover.reach + other.reach + thickness;
      if (squared_norm(Vec3d(other.at - mover.at)) <= near * near &&
          is_ground(other.moved_square, mover.moved_square) &&
          squared_norm(Vec3d(motion.displacements[other.particle] -
                             motion.displacements[mover.particle])) >= least * least)
        near_.push_back({.particle = other.particle, .x = other.at.x()});
    });
    // Of equally near skin that of the first is touched, whatever the cells.
    std::sort(near_.begin(), near_.end(), [](const Near& a, const Near& b) {
      return a.x != b.x ? a.x < b.x : a.particle < b.particle;
    });
    if (!near_.empty()) touch_particles(thickness, world, motion, mover.particle);
  }
}

///
/// @return the largest depth, in tolerances.
double SelfContact::push_once(double friction, Motion& motion) {
  double deepest = 0;
  for (Touch& touch : touches_) {
    const Vec3d apart =
        moved_by(touch.second, motion.displacements) - moved_by(touch.first, motion.displacements);
    const double gap = touch.gap + dot(apart, touch.normal);
    if (!(gap < 0)) continue;
    deepest = std::max(deepest, -gap / touch.tolerance);
    Vec3d by = -gap * touch.normal;
    touch.depth -= gap;
    if (friction > 0) {
      Vec3d slid =
          apart - moved_by(touch.second, motion.starts) + moved_by(touch.first, motion.starts);
      slid -= dot(slid, touch.normal) * touch.normal;
      const double length = norm(slid);
      const double back = std::clamp(friction * touch.depth - touch.dragged, 0.0, length);
      touch.dragged += back;
      if (length > 0) by -= back / length * slid;
    }
    const auto add = [&](const ParticleInfluences& whom, const Vec3d& change) {
      for_each_influence(whom, [&](Index p, double weight) {
        motion.displacements[p] += weight / touch.squares * change;
        if (motion.awake[p] == 0) motion.rouse(p);
        motion.touched[p] = motion.bound[p] = 1;
      });
    };
    add(touch.second, by);
    add(touch.first, Vec3d(-by));
  }
  return deepest;
}

void SelfContact::slow_down(const Contact::World& world, Motion& motion) {
  for (const Touch& touch : touches_) {
    if (!(touch.depth > 0)) continue;
    for (const auto* whom : {&touch.first, &touch.second})
      for_each_influence(*whom, [&](Index p, double) {
        const Vec3d mean = (motion.displacements[p] - motion.starts[p]) / world.seconds;
        if (squared_norm(mean) < squared_norm(motion.velocities[p])) motion.velocities[p] = mean;
      });
    const double into =
        -dot(moved_by(touch.second, motion.velocities) - moved_by(touch.first, motion.velocities),
             touch.normal);
    if (!(into > 0)) continue;
    const Vec3d change = into / touch.squares * touch.normal;
    for_each_influence(touch.second,
                       [&](Index p, double weight) { motion.velocities[p] += weight * change; });
    for_each_influence(touch.first,
                       [&](Index p, double weight) { motion.velocities[p] -= weight * change; });
  }
}

void SelfContact::push_apart(const sunder::SelfContact& options, const Contact::World& world,
                             Motion& motion) {
  if (!(options.thickness > 0) || motion.awake_count == 0 || world.set.lips().empty() ||
      !(world.seconds > 0))
    return;
  find_lips(world);
  touches_.clear();
  touch_lips(options.thickness, world, motion);
  touch_skin(options.thickness, world, motion);
  if (touches_.empty()) return;
  for (int sweep = 0; sweep < kSelfSweeps; ++sweep)
    if (push_once(options.friction, motion) <= 1) break;
  slow_down(world, motion);
}

}  // namespace sunder::particles
