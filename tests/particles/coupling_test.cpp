#include "particles/motion/coupling.h"

#include <cmath>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "support/machine/random.h"

namespace sunder {
namespace {

using particles::CouplingSolver;
using particles::Spring;
using particles::SpringGraph;
using particles::SpringStep;

/// Particles on springs of their own, coupled at random, and their state.
struct Network {
  std::vector<SoftMaterial> materials;
  std::vector<Index> material_of, active;
  SpringGraph graph;
  std::vector<particles::PointPull> pulls;
  std::vector<Vec3d> places, velocities, corrections;
  CouplingSolver solver;
  int iterations = 0;

  explicit Network(Index count)
      : material_of(count, 0),
        places(count, Vec3d::Zero()),
        velocities(places),
        corrections(places) {
    for (Index p = 0; p < count; ++p) active.push_back(p);
  }

  void connect_at_random(test::Random& random, Index springs_of_one) {
    std::vector<std::vector<Spring>> springs(places.size());
    const auto join = [&](Index a, Index b) {
      if (a == b) return;
      Spring spring = particles::spring_between(
          materials[material_of[a]], materials[material_of[b]], random.uniform(0.05, 0.6), 0.0);
      spring.other = b;
      springs[a].push_back(spring);
      spring.other = a;
      springs[b].push_back(spring);
    };
    const auto count = static_cast<Index>(places.size());
    for (Index p = 1; p < count; ++p) join(p - 1, p);
    for (Index i = 0; i < count * springs_of_one / 2; ++i) {
      const Index a = random.index(count);
      join(a, random.index(count));
    }
    graph = {};
    for (const auto& of_one : springs) {
      graph.springs.insert(graph.springs.end(), of_one.begin(), of_one.end());
      graph.first.push_back(static_cast<Index>(graph.springs.size()));
    }
    for (const Index material : material_of)
      graph.masses.push_back(materials[material].areal_density);  // cells of a square metre
    particles::set_frequencies(graph);
  }

  void step(double seconds, const Vec3d& acceleration = Vec3d::Zero()) {
    std::vector<SpringStep> steps;
    for (const SoftMaterial& m : materials)
      steps.push_back(particles::step_spring(m.return_stiffness, m.damping_ratio, seconds));
    for (const Index p : active) {
      const SpringStep& s = steps[material_of[p]];
      const Vec3d u = places[p], v = velocities[p];
      places[p] = s.place_from_place * u + s.place_from_velocity * v +
                  s.place_from_acceleration * acceleration;
      velocities[p] = s.velocity_from_place * u + s.velocity_from_velocity * v +
                      s.velocity_from_acceleration() * acceleration;
    }
    iterations = solver.solve(
        {graph, active, steps, material_of, places, velocities, pulls, seconds}, corrections);
    for (const Index p : active) {
      const SpringStep& s = steps[material_of[p]];
      places[p] += corrections[p];
      velocities[p] += s.velocity_from_acceleration() / s.place_from_acceleration * corrections[p];
    }
  }

  /// Twice the energy of motion and of all springs.
  double energy() const {
    double sum = 0;
    for (Index p = 0; p < places.size(); ++p) {
      const SoftMaterial& m = materials[material_of[p]];
      sum += graph.masses[p] *
             (velocities[p].squaredNorm() + m.return_stiffness * places[p].squaredNorm());
      for (const Spring& s : graph.of(p))
        sum += 0.5 * s.stiffness * (places[p] - places[s.other]).squaredNorm();
    }
    return sum;
  }
  double farthest() const {
    double most = 0;
    for (const Vec3d& u : places) most = std::max(most, u.norm());
    return most;
  }
};

SoftMaterial random_material(test::Random& random, double least = -3, double most = 12) {
  SoftMaterial m;
  m.return_stiffness = std::pow(10, random.uniform(least, most));
  m.damping_ratio = random.index(2) == 0 ? random.uniform(0.02, 2) : 1.0;
  m.areal_density = std::pow(10, random.uniform(-3, 1));
  const double frequency = std::pow(10, 0.5 * random.uniform(least, most));
  m.membrane_stiffness = std::min(m.areal_density * frequency * frequency, 1e12);
  m.membrane_damping = 2 * m.damping_ratio * m.areal_density * frequency;
  return m;
}

TEST(coupling, solves_its_equations) {
  test::Random random(3);
  for (int trial = 0; trial < 40; ++trial) {
    Network network(30);
    for (int m = 0; m < 3; ++m) network.materials.push_back(random_material(random, -2, 6));
    for (Index& m : network.material_of) m = random.index(3);
    network.connect_at_random(random, 6);
    network.pulls = {{{0, 4, 7, 9}, {0.4, 0.3, 0.2, 0.1}, 1e4, 1e3, {1, 0, 0}}};
    for (Vec3d& u : network.places) u = random.direction();
    const double h = std::pow(10, random.uniform(-5, 0));
    std::vector<SpringStep> steps;
    for (const SoftMaterial& m : network.materials)
      steps.push_back(particles::step_spring(m.return_stiffness, m.damping_ratio, h));
    // The dense matrix column by column: displaces one particle at a time, by the definition of the
    // forces.
    const auto force_on = [&](const std::vector<Vec3d>& u, const std::vector<Vec3d>& v,
                              bool has_target) {
      std::vector<Vec3d> force(30, Vec3d::Zero());
      const auto ratio = [&](Index p) {
        const SpringStep& s = steps[network.material_of[p]];
        return s.velocity_from_acceleration() / s.place_from_acceleration;
      };
      for (Index p = 0; p < 30; ++p)
        for (const Spring& s : network.graph.of(p)) {
          double damping = std::min(ratio(p), ratio(s.other)) > 0 ? s.damping : 0;
          if (damping > 0 || (s.damping == 0 && std::min(ratio(p), ratio(s.other)) > 0))
            damping = std::max(damping, s.stiffness * (h - 2 / s.frequency));
          const double by = has_target ? 0 : std::max(ratio(p), ratio(s.other));
          force[p] -= s.stiffness * (u[p] - u[s.other]) +
                      damping * (v[p] - v[s.other] + by * (u[p] - u[s.other]));
        }
      const auto& pull = network.pulls[0];
      Vec3d place = has_target ? Vec3d(-pull.target) : Vec3d::Zero(), velocity = Vec3d::Zero();
      double least = 1e300, most = 0;
      for (int k = 0; k < 4; ++k) {
        place += pull.weights[k] * u[pull.particles[k]];
        velocity += pull.weights[k] * v[pull.particles[k]];
        least = std::min(least, ratio(pull.particles[k]));
        most = std::max(most, ratio(pull.particles[k]));
      }
      const double damping =
          least > 0 ? std::max(2 * pull.stiffness / pull.frequency, pull.stiffness * h) : 0;
      for (int k = 0; k < 4; ++k)
        force[pull.particles[k]] -=
            pull.weights[k] *
            (pull.stiffness * place + damping * (velocity + (has_target ? 0 : most) * place));
      return force;
    };
    Network moved = network;
    const std::vector<Vec3d> none(30, Vec3d::Zero());
    std::vector<Vec3d> free_places = network.places, free_velocities = none;
    for (Index p = 0; p < 30; ++p) {
      const SpringStep& s = steps[network.material_of[p]];
      free_places[p] *= s.place_from_place;
      free_velocities[p] = s.velocity_from_place * network.places[p];
    }
    moved.step(h);
    Eigen::MatrixXd a(30, 30);
    for (Index p = 0; p < 30; ++p) {
      std::vector<Vec3d> one = none;
      one[p].x() = 1;
      const auto force = force_on(one, none, false);
      for (Index q = 0; q < 30; ++q) a(q, p) = -force[q].x();
      a(p, p) += network.graph.masses[p] / steps[network.material_of[p]].place_from_acceleration;
    }
    ASSERT_LT((a - a.transpose()).norm(), 1e-12 * a.norm());
    const auto force = force_on(free_places, free_velocities, true);
    Eigen::VectorXd right(30), found(30);
    for (Index p = 0; p < 30; ++p) {
      right[p] = force[p].x();
      found[p] = moved.corrections[p].x();
    }
    const Eigen::VectorXd wanted = a.ldlt().solve(right);
    ASSERT_LT((found - wanted).norm(), 1e-5 * (wanted.norm() + 1e-12)) << trial << " h " << h;
  }
}

TEST(coupling, is_bounded_and_comes_to_rest_at_any_step_and_stiffness) {
  test::Random random(4);
  double worst_growth = 0, worst_left = 0;

  for (int trial = 0; trial < 300; ++trial) {
    const bool is_mixed = trial % 2 == 0;
    Network network(20 + random.index(40));
    for (int m = 0; m < (is_mixed ? 3 : 1); ++m)
      network.materials.push_back(random_material(random));
    if (is_mixed)
      for (Index& m : network.material_of) m = random.index(3);
    network.connect_at_random(random, 2 + random.index(8));
    for (Vec3d& u : network.places) u = random.direction();
    const double h = std::pow(10, random.uniform(-5, 0));
    const double before = network.energy();
    double most = 0;
    for (int i = 0; i < 400; ++i) {
      network.step(h);
      most = std::max(most, network.energy());

      ASSERT_TRUE(std::isfinite(most));
      ASSERT_LT(network.farthest(), 4) << trial << " h " << h << " step " << i;
    }
    worst_growth = std::max(worst_growth, most / before);
    // The slowest of all motions is the return spring of the softest particle; after several of its
    // time constants nothing is left.
    double slowest = 1e300;
    for (const SoftMaterial& m : network.materials) {
      const double w = std::sqrt(m.return_stiffness), r = m.damping_ratio;
      slowest = std::min(slowest, r < 1 ? w * r : w / (2 * r));
    }
    if (slowest * h * 400 > 40) worst_left = std::max(worst_left, network.farthest());
  }

  EXPECT_LT(worst_growth, 1.5);
  EXPECT_LT(worst_left, 1e-3);
}

TEST(coupling, forces_of_neighbours_add_up_to_nothing) {
  test::Random random(5);
  for (const double h : {1e-4, 1.0 / 60, 0.5}) {
    Network network(50);
    network.materials = {random_material(random, 2, 4), random_material(random, 2, 4)};
    for (SoftMaterial& m : network.materials) m.return_stiffness = 0;
    for (Index& m : network.material_of) m = random.index(2);
    network.connect_at_random(random, 8);
    for (Vec3d& v : network.velocities) v = random.direction();
    const auto momentum = [&] {
      Vec3d sum = Vec3d::Zero();
      for (Index p = 0; p < 50; ++p) sum += network.graph.masses[p] * network.velocities[p];
      return sum;
    };
    const Vec3d before = momentum();
    double scale = 0;
    for (Index p = 0; p < 50; ++p) scale += network.graph.masses[p];
    for (int i = 0; i < 100; ++i) network.step(h);
    EXPECT_LT((momentum() - before).norm(), 1e-6 * scale) << h;
  }
}

TEST(coupling, converges_to_the_motion_as_steps_shrink) {
  test::Random random(6);
  Network network(12);
  network.materials = {{"m", 100, 0.3, 30, 1.0, 0.1, 0.1, 0, 0}};
  network.connect_at_random(random, 4);
  for (Vec3d& u : network.places) u = random.direction();
  const auto after = [&](double h) {
    Network copy = network;
    for (int i = 0; i < static_cast<int>(std::lround(0.25 / h)); ++i) copy.step(h);
    return copy.places;
  };
  const auto finest = after(1e-5);
  double last = 1e300;
  for (const double h : {1e-2, 1e-3, 1e-4}) {
    const auto found = after(h);
    double error = 0;
    for (std::size_t p = 0; p < found.size(); ++p)
      error = std::max(error, (found[p] - finest[p]).norm());
    EXPECT_LT(error, 0.2 * last) << h;
    last = error;
  }
  EXPECT_LT(last, 2e-3);
}

TEST(coupling, a_still_body_needs_no_iteration) {
  test::Random random(7);
  Network network(20);
  network.materials = {random_material(random, 1, 3)};
  network.connect_at_random(random, 4);
  network.step(0.01);
  EXPECT_EQ(network.iterations, 0);
  for (const Vec3d& u : network.places) EXPECT_EQ(u, Vec3d::Zero());
}

}  // namespace
}  // namespace sunder
