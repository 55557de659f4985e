#include "particles/contact/self_contact.h"

#include <algorithm>
#include <cmath>
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

void SelfContact::touch_particles(double thickness, const Contact::World& world,
                                  const Motion& motion, Index mover,
                                  std::span<const Index> others) {
  const SurfacePose& pose = world.poses.at(world.model, world.pose, world.rests.epoch());
  const std::span<const ParticleInfluences> influences = world.set.influences();
  const auto points_of = [&](Index p) -> const ContactPoints::Points& {
    return points_.of(world.set, world.model, pose, world.rests.epoch(), p);
  };
  const ContactPoints::Points& of_mover = points_of(mover);
  for (Index i = 0; i < of_mover.count; ++i) {
    const ParticleInfluences& first = influences[of_mover.points[i]];
    const Vec3d place = of_mover.places[i] + moved_by(first, motion.displacements);
    // The nearest place of the skin, relative to the radius of its disc.
    Index nearest = kNone, of_nearest = kNone;
    double least = 1;
    for (const Index other : others) {
      const ContactPoints::Points& points = points_of(other);
      const double stretch = world.rests.size(other) / kUnposedSize,
                   disc = kDiscRanges * world.set.range(other) * stretch + thickness,
                   separate = kSeparateRanges * world.set.report().range * stretch;
      for (Index k = 0; k < points.count; ++k) {
        const Vec3d there =
            points.places[k] + moved_by(influences[points.points[k]], motion.displacements);
        const double square = squared_norm(Vec3d(place - there)) / (disc * disc);
        if (square >= least ||
            squared_norm(Vec3d(of_mover.places[i] - points.places[k])) < separate * separate)
          continue;
        least = square;
        nearest = k;
        of_nearest = other;
      }
    }
    if (nearest == kNone) continue;
    const ContactPoints::Points& points = points_of(of_nearest);
    const Vec3d& normal = normals_of(world, points, of_nearest).at[nearest];
    if (normal.isZero(0)) continue;
    const ParticleInfluences& second = influences[points.points[nearest]];
    touches_.push_back({second, first, normal,
                        dot(Vec3d(of_mover.places[i] - points.places[nearest]), normal) - thickness,
                        squares_of(first) + squares_of(second),
                        kContactDepthRanges * world.set.range(of_nearest)});
  }
}

void SelfContact::touch_skin(double thickness, const Contact::World& world, const Motion& motion) {
  const Index count = motion.count();
  const double least = kMovedRanges * world.set.report().range;
  const auto has_moved = [&](Index p) {
    return squared_norm(motion.displacements[p]) > 0.25 * least * least;
  };
  const auto place = [&](Index p) { return Vec3d(world.rests.place(p) + motion.displacements[p]); };
  const auto reach = [&](Index p) {
    return kPointRanges / kUnposedSize * world.rests.size(p) * world.set.range(p);
  };
  order_.clear();
  double widest = 0;
  bool has_movers = false;
  for (Index p = 0; p < count; ++p) {
    order_.push_back(p);
    widest = std::max(widest, reach(p));
    has_movers |= motion.awake[p] != 0 && has_moved(p);
  }
  if (!has_movers) return;
  points_.follow(count);
  normals_.resize(count);
  std::sort(order_.begin(), order_.end(), [&](Index a, Index b) {
    const double x = place(a).x(), y = place(b).x();
    return x != y ? x < y : a < b;
  });
  for (Index mover = 0; mover < count; ++mover) {
    if (motion.awake[mover] == 0 || !has_moved(mover)) continue;
    const Vec3d at = place(mover);
    const double within = reach(mover) + widest + thickness;
    near_.clear();
    auto other = std::lower_bound(order_.begin(), order_.end(), at.x() - within,
                                  [&](Index p, double x) { return place(p).x() < x; });
    for (; other != order_.end() && place(*other).x() <= at.x() + within; ++other) {
      const double near = reach(mover) + reach(*other) + thickness;
      if (*other == mover || squared_norm(Vec3d(place(*other) - at)) > near * near) continue;
      // Of the two, the one that moved less is the ground.
      const Vec3d apart = motion.displacements[*other] - motion.displacements[mover];
      if (squared_norm(apart) >= least * least && 4 * squared_norm(motion.displacements[*other]) <
                                                      squared_norm(motion.displacements[mover]))
        near_.push_back(*other);
    }
    if (!near_.empty()) touch_particles(thickness, world, motion, mover, near_);
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
