#include "particles/motion/coupling.h"

#include <cmath>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "particles/frequency_of.h"
#include "particles/internal/angular_frequency.h"
#include "support/machine/allocation_count.h"
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

  std::vector<SpringStep> steps_of(double seconds) const {
    std::vector<SpringStep> steps;
    for (const SoftMaterial& m : materials)
      steps.push_back(particles::step_spring(particles::squared_frequency(m.return_frequency),
                                             m.damping_ratio, seconds));
    return steps;
  }

  void step(double seconds, const Vec3d& acceleration = Vec3d::Zero()) {
    const std::vector<SpringStep> steps = steps_of(seconds);
    for (const Index p : active) {
      const SpringStep& s = steps[material_of[p]];
      const Vec3d u = places[p], v = velocities[p];
      places[p] = s.place_from_place * u + s.place_from_velocity * v +
                  s.place_from_acceleration * acceleration;
      velocities[p] = s.velocity_from_place * u + s.velocity_from_velocity * v +
                      s.velocity_from_acceleration() * acceleration;
    }
    solver.solve({graph, active, steps, material_of, places, velocities, pulls, seconds},
                 corrections);
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
             (velocities[p].squaredNorm() +
              particles::squared_frequency(m.return_frequency) * places[p].squaredNorm());
      for (const Spring& s : graph.of(p))
        sum += 0.5 * s.stiffness * (places[p] - places[s.other]).squaredNorm();
    }
    for (const particles::PointPull& pull : pulls) {
      Vec3d place = -pull.target;
      for (std::size_t k = 0; k < 4; ++k) place += pull.weights[k] * places[pull.particles[k]];
      sum += pull.stiffness * place.squaredNorm();
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
  m.return_frequency = test::frequency_of(std::pow(10, random.uniform(least, most)));
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
      steps.push_back(particles::step_spring(particles::squared_frequency(m.return_frequency),
                                             m.damping_ratio, h));
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
    ASSERT_LT((found - wanted).norm(), 1e-8 * (wanted.norm() + 1e-12)) << trial << " h " << h;
  }
}

/// A particle moves with the probability `part`.
void choose_active(test::Random& random, double part, Network& network) {
  network.active.clear();
  for (Index p = 0; p < network.places.size(); ++p)
    if (random.uniform(0, 1) < part) network.active.push_back(p);
}

void pull_at_random(test::Random& random, Index pulls, double most, Network& network) {
  const auto count = static_cast<Index>(network.places.size());
  network.pulls.clear();
  for (Index i = 0; i < pulls; ++i) {
    particles::PointPull& pull = network.pulls.emplace_back();
    const Index particles = std::min(count, 1 + random.index(4));
    const Index first = random.index(count - particles + 1);
    double mass = 0;
    for (Index k = 0; k < particles; ++k) {
      pull.particles[k] = first + k;
      pull.weights[k] = random.uniform(0.01, 1);
      mass += pull.weights[k] * network.graph.masses[first + k];
    }
    const double stiffness = std::pow(10, random.uniform(0, most));
    pull.stiffness = stiffness * mass;
    pull.frequency = std::sqrt(stiffness);
  }
}

/// The equations of a step in x, with a row per particle that moves.
struct DenseStep {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd right;

  DenseStep(const Network& network, double h)
      : matrix(Eigen::MatrixXd::Zero(network.active.size(), network.active.size())),
        right(Eigen::VectorXd::Zero(network.active.size())) {
    const std::vector<SpringStep> steps = network.steps_of(h);
    const auto ratio = [&](Index p) {
      const SpringStep& s = steps[network.material_of[p]];
      return s.velocity_from_acceleration() / s.place_from_acceleration;
    };
    std::vector<Index> row_of(network.places.size(), kNone);
    for (Index row = 0; row < network.active.size(); ++row) row_of[network.active[row]] = row;
    const auto &u = network.places, &v = network.velocities;
    for (const Index p : network.active) {
      const Index row = row_of[p];
      matrix(row, row) +=
          network.graph.masses[p] / steps[network.material_of[p]].place_from_acceleration;
      for (const Spring& s : network.graph.of(p)) {
        const double other = row_of[s.other] == kNone ? ratio(p) : ratio(s.other);
        const double damping = std::min(ratio(p), other) > 0
                                   ? std::max(s.damping, s.stiffness * (h - 2 / s.frequency))
                                   : 0.0;
        const double value = s.stiffness + damping * std::max(ratio(p), other);
        matrix(row, row) += value;
        if (row_of[s.other] != kNone) matrix(row, row_of[s.other]) -= value;
        right[row] -= s.stiffness * (u[p] - u[s.other]).x() + damping * (v[p] - v[s.other]).x();
      }
    }
    for (const particles::PointPull& pull : network.pulls) {
      Eigen::VectorXd weights = Eigen::VectorXd::Zero(right.size());
      double least = 1e300, most = 0, place = -pull.target.x(), velocity = 0;
      for (std::size_t k = 0; k < 4; ++k) {
        const Index p = pull.particles[k];
        if (pull.weights[k] == 0) continue;
        place += pull.weights[k] * u[p].x();
        velocity += pull.weights[k] * v[p].x();
        if (row_of[p] == kNone) continue;
        weights[row_of[p]] = pull.weights[k];
        least = std::min(least, ratio(p));
        most = std::max(most, ratio(p));
      }
      const double damping =
          least > 0 ? std::max(2 * pull.stiffness / pull.frequency, pull.stiffness * h) : 0.0;
      matrix += (pull.stiffness + damping * most) * weights * weights.transpose();
      right -= (pull.stiffness * place + damping * velocity) * weights;
    }
  }
};

TEST(coupling, agrees_with_a_dense_solution) {
  test::Random random(8);
  for (int trial = 0; trial < 90; ++trial) {
    Network network(trial % 30 == 29 ? 1500 : 1 + random.index(trial % 3 == 0 ? 12 : 150));
    for (int m = 0; m < 3; ++m) network.materials.push_back(random_material(random, -2, 6));
    for (Index& m : network.material_of) m = random.index(3);
    network.connect_at_random(random, random.index(8));
    choose_active(random, std::vector{0.1, 0.5, 1.0}[random.index(3)], network);
    for (Vec3d& u : network.places) u = random.direction();
    for (const Index p : network.active) network.velocities[p] = 10 * random.direction();
    pull_at_random(random, random.index(4), 5, network);
    for (auto& pull : network.pulls) pull.target = random.direction();
    const double h = std::pow(10, random.uniform(-5, 0));

    const std::vector<SpringStep> steps = network.steps_of(h);
    network.solver.solve({network.graph, network.active, steps, network.material_of, network.places,
                          network.velocities, network.pulls, h},
                         network.corrections);
    const DenseStep dense(network, h);
    Eigen::VectorXd found(dense.right.size());
    for (Index row = 0; row < network.active.size(); ++row)
      found[row] = network.corrections[network.active[row]].x();
    const Eigen::VectorXd wanted = dense.matrix.ldlt().solve(dense.right);
    ASSERT_LE((found - wanted).norm(), 1e-7 * wanted.norm()) << trial << " h " << h;
  }
}

TEST(coupling, a_kept_factor_gives_the_bits_of_a_new_one) {
  test::Random random(9);
  Network network(300);
  for (int m = 0; m < 2; ++m) network.materials.push_back(random_material(random, 0, 5));
  for (Index& m : network.material_of) m = random.index(2);
  network.connect_at_random(random, 3);
  for (Vec3d& u : network.places) u = random.direction();
  double h = 0.01;
  for (int i = 0; i < 200; ++i) {
    switch (random.index(8)) {
      case 0: choose_active(random, random.uniform(0, 1), network); break;
      case 1: h = random.index(2) == 0 ? 0.01 : 0.02; break;
      case 2: pull_at_random(random, random.index(3), 5, network); break;
      case 3: network.connect_at_random(random, 3); break;
      default: break;
    }
    const std::vector<SpringStep> steps = network.steps_of(h);
    const CouplingSolver::Inputs inputs = {
        network.graph,  network.active,     steps,         network.material_of,
        network.places, network.velocities, network.pulls, h};
    CouplingSolver fresh;
    std::vector<Vec3d> wanted = network.corrections;
    fresh.solve(inputs, wanted);
    network.solver.solve(inputs, network.corrections);
    for (const Index p : network.active) ASSERT_EQ(network.corrections[p], wanted[p]) << i;
    network.step(h);
  }
}

TEST(coupling, does_not_allocate_once_warm) {
  test::Random random(10);
  Network network(400);
  network.materials = {random_material(random, 0, 4)};
  network.connect_at_random(random, 2);
  pull_at_random(random, 3, 4, network);
  std::vector<std::vector<Index>> active_sets;
  for (const double part : {1.0, 0.9, 0.3, 0.05, 0.0}) {
    choose_active(random, part, network);
    active_sets.push_back(network.active);
  }
  const std::vector<SpringStep> steps = network.steps_of(0.01);
  const auto run = [&] {
    for (const auto& active : active_sets)
      network.solver.solve({network.graph, active, steps, network.material_of, network.places,
                            network.velocities, network.pulls, 0.01},
                           network.corrections);
  };
  run();
  run();
  const std::uint64_t before = test::allocation_count();
  run();
  EXPECT_EQ(test::allocation_count(), before);
  EXPECT_GT(network.solver.memory_bytes(), 400 * 100u);
}

TEST(coupling, pulls_of_any_stiffness_add_no_energy) {
  test::Random random(11);
  for (int trial = 0; trial < 300; ++trial) {
    Network network(20 + random.index(40));
    network.materials = {random_material(random)};
    network.connect_at_random(random, 2 + random.index(8));
    pull_at_random(random, 1 + random.index(20), 12, network);
    for (Vec3d& u : network.places) u = random.direction();
    const double h = std::pow(10, random.uniform(-5, 0)), before = network.energy();
    for (int i = 0; i < 200; ++i) {
      network.step(h);
      ASSERT_LT(network.energy(), 1.01 * before) << trial << " h " << h << " step " << i;
    }
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
      const double w = particles::angular_frequency(m.return_frequency), r = m.damping_ratio;
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
    for (SoftMaterial& m : network.materials) m.return_frequency = 0;
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
  network.materials = {{"m", 1.6, 0.3, 30, 1.0, 0.1, 0.1, 0, 0}};
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

TEST(coupling, a_still_body_stays) {
  test::Random random(7);
  Network network(20);
  network.materials = {random_material(random, 1, 3)};
  network.connect_at_random(random, 4);
  network.step(0.01);
  for (const Vec3d& u : network.places) EXPECT_EQ(u, Vec3d::Zero());
}

}  // namespace
}  // namespace sunder
