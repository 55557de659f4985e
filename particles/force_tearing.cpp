#include <sunder/particles/force_tearing.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>

#include <Eigen/Eigenvalues>

#include "core/internal/ordered.h"
#include "particles/clusters/lip_border.h"
#include "particles/clusters/surface_pose.h"
#include "particles/internal/tolerances.h"
#include "particles/motion/tip_load.h"
#include "tear/internal/surface.h"

namespace sunder {
namespace particles {
namespace {

/// Two neighbours whose distance exceeds the strength of their materials.
struct OverstretchedPair {
  Index a = 0, b = 0;
  double over = 0;  ///< Stretch over strength.
};

/// The point where a tear continues or begins.
struct Start {
  Index point = kNone;
  bool is_tip = false;
};

/// Number of pairs that are tried if the surface cannot be torn at the first.
constexpr std::size_t kMostAttempts = 8;

Vec3d rest_place(const SoftBody& body, Index particle) {
  return body.place(particle) - body.displacement(particle);
}

double stretch_of(const SoftBody& body, const ParticleSet& particles, Index a, Index b) {
  const double at_rest = norm(rest_place(body, b) - rest_place(body, a));
  const double farther = norm(body.place(b) - body.place(a)) - at_rest;
  return 1 + farther / std::max(at_rest, kLeastApartRanges * particles.report().range);
}

double strength_of(const SoftBody& body, Index a, Index b) {
  const double of_a = body.materials()[body.material_of(a)].strength,
               of_b = body.materials()[body.material_of(b)].strength;
  if (of_a == 0 || of_b == 0) return std::max(of_a, of_b);
  return std::min(of_a, of_b);
}

double toughness_of(const SoftBody& body, Index a, Index b) {
  const double of_a = body.materials()[body.material_of(a)].toughness,
               of_b = body.materials()[body.material_of(b)].toughness;
  if (of_a == 0 || of_b == 0) return std::max(of_a, of_b);
  return std::min(of_a, of_b);
}

/// A tear to be tried.
struct Attempt {
  OverstretchedPair pair;
  Start start;
};

/// Pairs beyond their strength, the worst first.
/// @param greatest  raised to the greatest stretch of all pairs.
std::vector<OverstretchedPair> find_overstretched(const SoftBody& body,
                                                  const ParticleSet& particles, double& greatest) {
  std::vector<OverstretchedPair> pairs;
  for (Index a = 0; a < body.particle_count(); ++a) {
    for (const ParticleNeighbour& neighbour : particles.neighbours(a)) {
      const Index b = neighbour.particle;
      if (b <= a || neighbour.coupling < kLeastCoupling || (!body.is_awake(a) && !body.is_awake(b)))
        continue;
      const double stretch = stretch_of(body, particles, a, b), strength = strength_of(body, a, b);
      greatest = std::max(greatest, stretch);
      if (strength > 0 && stretch > strength) pairs.push_back({a, b, stretch / strength});
    }
  }
  std::stable_sort(
      pairs.begin(), pairs.end(),
      [](const OverstretchedPair& x, const OverstretchedPair& y) { return x.over > y.over; });
  return pairs;
}

/// The direction in which the tissue around two particles is stretched most, in the plane
/// perpendicular to `normal`. It is that of the linear map that best describes the change of the
/// vectors to their neighbours, so an uneven distribution of neighbours does not rotate it. It is
/// the direction in the current tissue: at a tip, the lips move apart across it.
Vec3d greatest_stretch_around(const SoftBody& body, const ParticleSet& particles,
                              const OverstretchedPair& pair, const Vec3d& normal) {
  Eigen::Matrix<double, 3, 2> plane;
  plane.col(0) = normal.unitOrthogonal();
  plane.col(1) = normal.cross(plane.col(0));
  Eigen::Matrix<double, 3, 2> moved = Eigen::Matrix<double, 3, 2>::Zero();
  Eigen::Matrix2d at_rest = Eigen::Matrix2d::Zero();
  for (const Index particle : {pair.a, pair.b})
    for (const ParticleNeighbour& neighbour : particles.neighbours(particle)) {
      const Eigen::Vector2d along = multiply(
          plane.transpose(), rest_place(body, neighbour.particle) - rest_place(body, particle));
      const Eigen::Vector3d now = body.place(neighbour.particle) - body.place(particle);
      const double weight = neighbour.coupling;
      moved += weight * now * along.transpose();
      at_rest += weight * along * along.transpose();
    }
  const double size = trace(at_rest);
  if (!(at_rest.determinant() > kRowDeterminantFraction * size * size)) {  // all in a row
    const Eigen::Vector2d along =
        multiply(plane.transpose(), rest_place(body, pair.b) - rest_place(body, pair.a));
    return norm(along) > 0 ? Vec3d(plane * normalized(along)) : Vec3d(plane.col(0));
  }
  const Eigen::Matrix<double, 3, 2> map = moved * at_rest.inverse();
  const Eigen::Matrix2d within = multiply(plane.transpose(), map);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(within * within.transpose());
  return plane * solver.eigenvectors().col(1);
}

float weight_of(const ParticleInfluences& of, Index particle) {
  for (std::size_t i = 0; i < 4; ++i)
    if (of.particles[i] == particle) return of.weights[i];
  return 0.0f;
}

/// The tip nearest to the middle of a pair among those with membership in one of the two; kNone if
/// there is none.
Index nearest_tip(const ParticleSet& particles, const OverstretchedPair& pair,
                  std::span<const Index> tips) {
  const auto is_of_pair = [&](const ParticleMembership& m) {
    return m.particle == pair.a || m.particle == pair.b;
  };
  const std::span<const Vec3f> at = particles.positions();
  const Vec3f middle = 0.5f * (at[particles.seed(pair.a)] + at[particles.seed(pair.b)]);
  float nearest = std::numeric_limits<float>::infinity();  // members of a particle are near
  Index found = kNone;
  for (const Index tip : tips) {
    // Memberships and not weights: where particles crowd at a tear, those of its tip do not have
    // weights of all of them.
    if (std::ranges::none_of(particles.memberships(tip), is_of_pair)) continue;
    const float distance = norm(at[tip] - middle);
    if (!(distance < nearest)) continue;
    nearest = distance;
    found = tip;
  }
  return found;
}

/// The point with the largest weight of both particles of a pair, or kNone.
Index most_common_point(const ParticleSet& particles, const TornModel& model,
                        const OverstretchedPair& pair) {
  const auto members = particles.members(pair.a);
  if (!members) throw std::bad_alloc();
  float most = 0;
  Index found = kNone;
  for (const Index point : *members) {
    const ParticleInfluences& of = particles.influences()[point];
    const float both = weight_of(of, pair.a) * weight_of(of, pair.b);
    if (!(both > most) || model.surface().point_corner[point] == kNone) continue;
    most = both;
    found = point;
  }
  return found;
}

/// Where a pair's tear begins; nowhere at a tip that runs by its toughness.
Start find_start(const SoftBody& body, const ParticleSet& particles, const TornModel& model,
                 const OverstretchedPair& pair, std::span<const Index> tips) {
  const Index tip = nearest_tip(particles, pair, tips);
  if (tip == kNone) return {most_common_point(particles, model, pair), false};
  if (toughness_of(body, pair.a, pair.b) > 0) return {};
  return {tip, true};
}

/// A short straight tear on the posed surface.
struct ShortTear {
  Vec3d from = Vec3d::Zero();
  Vec3d direction = Vec3d::Zero();  ///< Unit length.
  Vec3d normal = Vec3d::Zero();     ///< Of the surface; zero if there is none.
};

/// Orients the direction of a tear away from the border edges that end at its tip.
void run_forward(const TornModel& model, const SurfacePose& posed, Index tip, ShortTear& tear) {
  const LipBorder border(model);
  Vec3d forward = tear.from - 0.5 * (posed.place(model, border.next(tip)) +
                                     posed.place(model, border.previous(tip)));
  forward -= dot(forward, tear.normal) * tear.normal;
  if (!(norm(forward) > 0)) return;
  forward /= norm(forward);
  if (dot(tear.direction, forward) < 0) tear.direction = -tear.direction;
  if (dot(tear.direction, forward) < kLeastForwardCosine)
    tear.direction = normalized(tear.direction + forward);
}

/// Places a tear of the given length at a point, across the direction of the greatest stretch.
ShortTear place_tear(const SoftBody& body, const ParticleSet& particles, const TornModel& model,
                     const SurfacePose& posed, const OverstretchedPair& pair, const Start& start,
                     double length) {
  ShortTear tear;
  tear.normal = posed.normal(model, start.point);
  if (tear.normal.isZero(0)) return tear;
  tear.from = posed.place(model, start.point);
  tear.direction = tear.normal.cross(greatest_stretch_around(body, particles, pair, tear.normal));
  if (start.is_tip)
    run_forward(model, posed, start.point, tear);
  else
    tear.from -= 0.5 * length * tear.direction;
  return tear;
}

Result<TearReport> run_tear(TornModel& model, const ModelPose& pose, const ShortTear& tear,
                            double length, ChangeRecord& change) {
  const Vec3d depth = length * tear.normal, to = tear.from + length * tear.direction;
  const std::array<Blade, 2> stroke = {Blade{tear.from + depth, tear.from - depth},
                                       Blade{to + depth, to - depth}};
  return model.tear(pose, stroke, {}, &change);
}

/// The tears to be tried: first those of tips whose toughness is exceeded, the worst first, then
/// those of overstretched pairs.
/// @param greatest_release  raised to that of all tips with a toughness.
std::vector<Attempt> attempts_at(const SoftBody& body, const ParticleSet& particles,
                                 const TornModel& model, std::span<const OverstretchedPair> pairs,
                                 std::span<const Index> tips, double& greatest_release) {
  std::vector<Attempt> attempts;
  for (const TipLoad& load : tip_loads(body, particles, model, tips)) {
    const double toughness = toughness_of(body, load.left, load.right);
    if (!(toughness > 0)) continue;
    greatest_release = std::max(greatest_release, load.release);
    if (load.release >= toughness)
      attempts.push_back({{load.left, load.right, load.release / toughness}, {load.tip, true}});
  }
  std::stable_sort(attempts.begin(), attempts.end(),
                   [](const Attempt& x, const Attempt& y) { return x.pair.over > y.pair.over; });
  for (const OverstretchedPair& pair : pairs.first(std::min(pairs.size(), kMostAttempts)))
    if (const Start start = find_start(body, particles, model, pair, tips); start.point != kNone)
      attempts.push_back({pair, start});
  return attempts;
}

/// Tears at the first of some places where the surface can be torn.
/// @param change  written if it was torn.
Status tear_first(const SoftBody& body, ParticleSet& particles, TornModel& model,
                  const ModelPose& pose, std::span<const Attempt> attempts, double length,
                  ForceTearingReport& report, ChangeRecord& change) {
  SurfacePose posed;
  posed.begin(model.character().skins, pose.morph_weights.size());
  if (Status status = posed.set(model.character().skins, pose); !status) return status;
  for (const auto& [pair, start] : attempts) {
    const ShortTear tear = place_tear(body, particles, model, posed, pair, start, length);
    if (tear.normal.isZero(0)) continue;
    auto torn = run_tear(model, pose, tear, length, change);
    if (!torn) return torn.error();
    if (torn->runs == 0) continue;
    report.has_torn = true;
    report.is_from_tip = start.is_tip;
    report.place = tear.from;
    report.direction = tear.direction;
    report.tear = std::move(*torn);
    return particles.follow(model, std::span(&change, 1));
  }
  return {};
}

bool has_toughness(const SoftBody& body) {
  return std::ranges::any_of(body.materials(),
                             [](const SoftMaterial& material) { return material.toughness > 0; });
}

}  // namespace
}  // namespace particles

Result<ForceTearingReport> tear_overstretched(const SoftBody& body, ParticleSet& particles,
                                              TornModel& model, const ModelPose& pose,
                                              const ForceTearingOptions& options,
                                              std::vector<ChangeRecord>* changes) {
  if (!(options.length > 0) || options.length > 2)
    return Status::failure(
        StatusCode::invalid_argument, kNone,
        "the tear length is %g particle ranges per call; it must be above 0 and at most 2",
        options.length);
  if (body.particle_count() != particles.particle_count())
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "the body has %u particles, the set has %u; step the body first",
                           body.particle_count(), particles.particle_count());
  ForceTearingReport report;
  std::vector<ChangeRecord> own;
  std::vector<ChangeRecord>& records = changes != nullptr ? *changes : own;
  const std::size_t record_count = records.size();
  Status status;
  try {
    const auto pairs = particles::find_overstretched(body, particles, report.greatest_stretch);
    if (pairs.empty() && (body.awake_count() == 0 || !particles::has_toughness(body)))
      return report;
    if (const Status valid = particles.rest(pose, {}, {}); !valid) return valid;
    const auto tips = particles.tips(model);
    if (!tips) return tips.error();
    const auto attempts =
        particles::attempts_at(body, particles, model, pairs, *tips, report.greatest_release);
    if (attempts.empty()) return report;
    // Allocated before the tear, which must not fail because of its record.
    records.emplace_back();
    const double length = options.length * particles.report().range;
    status = particles::tear_first(body, particles, model, pose, attempts, length, report,
                                   records.back());
  } catch (const std::bad_alloc&) {
    status = Status::failure(StatusCode::limit_exceeded, kNone, "out of memory");
  }
  if (!report.has_torn && records.size() > record_count) records.pop_back();
  if (!status) return status;
  return report;
}

}  // namespace sunder
