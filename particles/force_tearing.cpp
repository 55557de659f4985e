#include <sunder/particles/force_tearing.h>
#include <sunder/skinning/deform.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>

#include "particles/clusters/lip_border.h"
#include "particles/clusters/rest_terms.h"
#include "skinning/internal/reference.h"
#include "tear/internal/surface.h"

namespace sunder {
namespace {

/// Two neighbours that are farther apart than they bear.
struct Pair {
  Index a = 0, b = 0;
  double over = 0;  ///< Stretch over strength.
};

/// How many pairs are tried, where the surface cannot be torn at the first.
constexpr std::size_t kAttempts = 8;
/// The least that a tear runs on: cosine of the angle between its last edge and where it goes.
constexpr double kLeastForward = 0.2;
/// Particles at a tear may be as good as in one place at rest. What they move apart then counts as if they had been so far apart as
/// seeds are at least: this part of the range.
constexpr double kLeastApart = 0.8;
/// ParticleNeighbour::shared of particles that hang together at all. Splinters at a tear, of a few points that others hold too, are
/// torn in vain: they would be torn at the same place for ever.
constexpr double kLeastShared = 0.05;

Vec3d rest_place(const SoftBody& body, Index particle) { return body.place(particle) - body.displacement(particle); }

double stretch_of(const SoftBody& body, const ParticleSet& particles, Index a, Index b) {
  const double at_rest = (rest_place(body, b) - rest_place(body, a)).norm();
  const double farther = (body.place(b) - body.place(a)).norm() - at_rest;
  return 1 + farther / std::max(at_rest, kLeastApart * particles.report().range);
}

double strength_of(const SoftBody& body, Index a, Index b) {
  const double of_a = body.materials()[body.material_of(a)].strength, of_b = body.materials()[body.material_of(b)].strength;
  if (of_a == 0 || of_b == 0) return std::max(of_a, of_b);
  return std::min(of_a, of_b);
}

/// Pairs beyond their strength, the worst first.
std::vector<Pair> find_overstretched(const SoftBody& body, const ParticleSet& particles, double& greatest) {
  std::vector<Pair> pairs;
  for (Index a = 0; a < body.particle_count(); ++a) {
    for (const ParticleNeighbour& neighbour : particles.neighbours(a)) {
      const Index b = neighbour.particle;
      if (b <= a || neighbour.shared < kLeastShared || (!body.is_awake(a) && !body.is_awake(b))) continue;
      const double stretch = stretch_of(body, particles, a, b), strength = strength_of(body, a, b);
      greatest = std::max(greatest, stretch);
      if (strength > 0 && stretch > strength) pairs.push_back({a, b, stretch / strength});
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& x, const Pair& y) { return x.over > y.over; });
  return pairs;
}

/// Direction into which the tissue around two particles is stretched most, in the plane across `normal`: of the linear map which
/// comes nearest to what happened to the ways to their neighbours, so that neighbours that stand unevenly do not turn it. It is
/// that of the tissue as it is now: at a tip, lips that part move across the way from one to the other.
Vec3d greatest_stretch_around(const SoftBody& body, const ParticleSet& particles, const Pair& pair, const Vec3d& normal) {
  Eigen::Matrix<double, 3, 2> plane;
  plane.col(0) = normal.unitOrthogonal();
  plane.col(1) = normal.cross(plane.col(0));
  Eigen::Matrix<double, 3, 2> moved = Eigen::Matrix<double, 3, 2>::Zero();
  Eigen::Matrix2d at_rest = Eigen::Matrix2d::Zero();
  for (const Index particle : {pair.a, pair.b})
    for (const ParticleNeighbour& neighbour : particles.neighbours(particle)) {
      const Eigen::Vector2d along = plane.transpose() * (rest_place(body, neighbour.particle) - rest_place(body, particle));
      const Eigen::Vector3d now = body.place(neighbour.particle) - body.place(particle);
      const double weight = particles.coupling(particle, neighbour);
      moved += weight * now * along.transpose();
      at_rest += weight * along * along.transpose();
    }
  const double size = at_rest.trace();
  if (!(at_rest.determinant() > 1e-4 * size * size)) {  // all in a row
    const Eigen::Vector2d along = plane.transpose() * (rest_place(body, pair.b) - rest_place(body, pair.a));
    return along.norm() > 0 ? Vec3d(plane * along.normalized()) : Vec3d(plane.col(0));
  }
  const Eigen::Matrix<double, 3, 2> map = moved * at_rest.inverse();
  const Eigen::Matrix2d within = plane.transpose() * map;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(within * within.transpose());
  return plane * solver.eigenvectors().col(1);
}

/// The posed surface around a point.
class PosedFan {
 public:
  PosedFan(const TornModel& model, const ModelPose& pose) : model_(model), pose_(pose) {}

  [[nodiscard]] Vec3d place(Index point) const {
    const particles::VertexRef of = particles::vertex_of(model_, point);
    const Mesh& mesh = model_.character().meshes[of.mesh];
    const Skin& skin = model_.character().skins[mesh.skin];
    std::vector<Affine3d> palette(skin.bones.size());
    (void)compute_palette(skin, pose_, std::span(palette));  // the body has stood in it
    return deform_position_reference(mesh, of.vertex, palette, pose_.morph_weights);
  }

  [[nodiscard]] Vec3d normal(Index point) const {
    const tear::Surface& surface = model_.surface();
    Vec3d sum = Vec3d::Zero();
    const Vec3d at = place(point);
    surface.for_each_in_fan(surface.point_corner[point], [&](Index corner) {
      const Vec3d a = place(surface.corner_point[tear::Surface::next(corner)]) - at;
      const Vec3d b = place(surface.corner_point[tear::Surface::previous(corner)]) - at;
      sum += a.cross(b);
    });
    const double length = sum.norm();
    return length > 0 ? Vec3d(sum / length) : Vec3d(Vec3d::Zero());
  }

 private:
  const TornModel& model_;
  const ModelPose& pose_;
};

/// Where a tear goes on or begins.
struct Start {
  Index point = kNone;
  bool is_tip = false;
};

/// The tip nearest to the middle of a pair that one of the two holds; else the point that both hold most.
Start find_start(const ParticleSet& particles, const TornModel& model, const Pair& pair, std::span<const Index> tips) {
  const auto weight_of = [&](Index point, Index particle) {
    const ParticleInfluences& of = particles.influences()[point];
    for (std::size_t i = 0; i < 4; ++i)
      if (of.particles[i] == particle) return of.weights[i];
    return 0.0f;
  };
  Start start;
  const std::span<const Vec3f> at = particles.positions();
  const Vec3f middle = 0.5f * (at[particles.seed(pair.a)] + at[particles.seed(pair.b)]);
  float nearest = std::numeric_limits<float>::infinity();  // what a particle holds is near
  for (const Index tip : tips) {
    // Not by weights: where particles crowd at a tear, those of its tip do not name them all.
    const std::span<const ParticleMembership> of = particles.memberships(tip);
    if (std::none_of(of.begin(), of.end(),
                     [&](const ParticleMembership& m) { return m.particle == pair.a || m.particle == pair.b; }))
      continue;
    const float distance = (at[tip] - middle).norm();
    if (!(distance < nearest)) continue;
    nearest = distance;
    start = {tip, true};
  }
  if (start.is_tip) return start;
  float most = 0;
  for (const Index point : particles.members(pair.a)) {
    const float both = weight_of(point, pair.a) * weight_of(point, pair.b);
    if (!(both > most) || model.surface().point_corner[point] == kNone) continue;
    most = both;
    start.point = point;
  }
  return start;
}

}  // namespace

Result<ForceTearingReport> tear_overstretched(const SoftBody& body, ParticleSet& particles, TornModel& model, const ModelPose& pose,
                                              const ForceTearingOptions& options, std::vector<ChangeRecord>* changes) {
  if (!(options.length > 0) || options.length > 2)
    return Status::failure(StatusCode::invalid_argument, kNone, "a tear of %g particle ranges a call; it must be in (0, 2]",
                           options.length);
  if (body.particle_count() != particles.particle_count())
    return Status::failure(StatusCode::size_mismatch, kNone, "the body has %u particles, the set %u; step the body first",
                           body.particle_count(), particles.particle_count());
  ForceTearingReport report;
  const std::vector<Pair> pairs = find_overstretched(body, particles, report.greatest_stretch);
  if (pairs.empty()) return report;
  const std::vector<Index> tips = particles.tips(model);
  const PosedFan fan(model, pose);
  const particles::LipBorder border(model);
  for (std::size_t i = 0; i < std::min(pairs.size(), kAttempts); ++i) {
    const Pair& pair = pairs[i];
    const Start start = find_start(particles, model, pair, tips);
    if (start.point == kNone) continue;
    const Vec3d at = fan.place(start.point), normal = fan.normal(start.point);
    if (normal.isZero(0)) continue;
    Vec3d direction = normal.cross(greatest_stretch_around(body, particles, pair, normal));
    const double length = options.length * particles.report().range;
    Vec3d from = at;
    if (start.is_tip) {
      Vec3d forward = at - 0.5 * (fan.place(border.next(start.point)) + fan.place(border.previous(start.point)));
      forward -= forward.dot(normal) * normal;
      if (forward.norm() > 0) {
        forward /= forward.norm();
        if (direction.dot(forward) < 0) direction = -direction;
        if (direction.dot(forward) < kLeastForward) direction = (direction + forward).normalized();
      }
    } else {
      from -= 0.5 * length * direction;
    }
    const Vec3d depth = length * normal;
    const std::array<Blade, 2> stroke = {Blade{from + depth, from - depth},
                                         Blade{from + length * direction + depth, from + length * direction - depth}};
    ChangeRecord change;
    auto tear = model.tear(pose, stroke, {}, &change);
    if (!tear) return tear.error();
    if (tear->runs == 0) continue;
    if (Status status = particles.follow(model, std::span(&change, 1)); !status) return status;
    report.has_torn = true;
    report.is_from_tip = start.is_tip;
    report.place = from;
    report.direction = direction;
    report.tear = std::move(*tear);
    if (changes != nullptr) changes->push_back(std::move(change));
    return report;
  }
  return report;
}

}  // namespace sunder
