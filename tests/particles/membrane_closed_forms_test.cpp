// The motion of particles, and the finite elements that other tests compare them with, against
// closed forms of the membrane on its foundation, for random materials.

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "particles/frequency_of.h"
#include "particles/internal/angular_frequency.h"
#include "particles/soft_scene.h"
#include "support/machine/random.h"
#include "support/oracles/bessel.h"
#include "support/oracles/membrane.h"

namespace sunder {
namespace {

using test::bessel_k;
using test::Random;
using test::SoftScene;

constexpr double kPi = std::numbers::pi;

/// A material of a given reach sqrt(S / (rho k)), whose motion dies down quickly.
SoftMaterial with_reach(double reach, Random& random) {
  SoftMaterial material;
  material.membrane_stiffness = std::pow(10, random.uniform(0, 2));
  material.areal_density = std::pow(10, random.uniform(-1, 0));
  material.return_frequency =
      test::frequency_of(material.membrane_stiffness / (material.areal_density * reach * reach));
  material.damping_ratio = 1;
  return material;
}

void step_until_asleep(SoftScene& scene) {
  for (int i = 0; i < 2000 && scene.body->awake_count() > 0; ++i) scene.step(0.1);
}

/// Errors of the radial displacement around a round hole under tension, relative to the closed form
/// at its rim.
struct HoleErrors {
  double rms = 0;                  ///< Over the points around the hole.
  double elements = 0;             ///< The same of finite elements.
  double rim = 0, wanted_rim = 1;  ///< Mean displacement of the rim, metres.
};

HoleErrors errors_around_a_hole(double radius, double reach, double range, Random& random) {
  const SoftMaterial material = with_reach(reach, random);
  SoftScene scene(test::make_sheet(160), material, range / std::sqrt(2.0));
  const Vec3d middle(random.uniform(0.48, 0.52), random.uniform(0.48, 0.52), 0);
  Bore bore;
  bore.origin = middle + Vec3d(0, 0, 0.5);
  bore.radius = radius;
  bore.depth = 1;
  ChangeRecord change;
  EXPECT_TRUE(scene.model->drill(scene.pose, bore, &change));
  EXPECT_TRUE(scene.set->follow(*scene.model, {&change, 1}));
  while (scene.set->settle(*scene.model, 100000)) continue;
  const double tension = 0.1 * material.membrane_stiffness;
  EXPECT_TRUE(scene.body->set_tension({tension, {}}));
  scene.step(1.0 / 60);
  step_until_asleep(scene);
  const auto elements = test::solve_membrane(*scene.model, scene.set->positions(), material,
                                             test::lip_forces(*scene.set, tension));

  // Each component of u(r) e_r satisfies laplace u = u / reach^2, so u is a K1, and -S u' is the
  // tension at the rim.
  const double z = radius / reach;
  const auto wanted = [&](double r) {
    return tension * reach / material.membrane_stiffness * bessel_k(1, r / reach) /
           (bessel_k(0, z) + bessel_k(1, z) / z);
  };
  std::vector<bool> is_rim(scene.set->point_count());
  for (const LipEdge& lip : scene.set->lips())
    for (const std::uint32_t point : lip.points) is_rim[point] = true;
  HoleErrors errors;
  errors.wanted_rim = wanted(radius);
  double count = 0, rim_count = 0;
  for (std::uint32_t p = 0; p < scene.set->point_count(); ++p) {
    const Vec3d from_middle = scene.set->positions()[p].cast<double>() - middle;
    const double r = from_middle.norm();
    if (scene.set->owners()[p] == kNone || r < 0.98 * radius || r > 0.4) continue;
    const double found = scene.body->point_displacement(p).dot(from_middle) / r;
    errors.rms += std::pow(found - wanted(r), 2);
    errors.elements += std::pow(elements[p].dot(from_middle) / r - wanted(r), 2);
    count += 1;
    if (!is_rim[p]) continue;
    errors.rim += found;
    rim_count += 1;
  }
  errors.rms = std::sqrt(errors.rms / count) / errors.wanted_rim;
  errors.elements = std::sqrt(errors.elements / count) / errors.wanted_rim;
  errors.rim /= rim_count;
  return errors;
}

TEST(membrane_closed_forms, a_round_hole_opens_like_a_bessel_function) {
  // A rim of a bore has no small particles, so it opens too little: least where the range is small.
  Random random(30);
  for (const auto& [range, most, least_rim] :
       {std::tuple(0.1, 0.12, 0.75), std::tuple(0.05, 0.06, 0.86), std::tuple(0.025, 0.04, 0.87)})
    for (int i = 0; i < 3; ++i) {
      const double radius = random.uniform(0.08, 0.15), reach = random.uniform(0.06, 0.15);
      const HoleErrors errors = errors_around_a_hole(radius, reach, range, random);
      EXPECT_LT(errors.elements, 0.015) << radius << ' ' << reach;
      EXPECT_LT(errors.rms, most) << range << ' ' << radius << ' ' << reach;
      EXPECT_GT(errors.rim / errors.wanted_rim, least_rim)
          << range << ' ' << radius << ' ' << reach;
      EXPECT_LT(errors.rim / errors.wanted_rim, 1.1) << range << ' ' << radius << ' ' << reach;
    }
}

/// The reach with which K0(r / reach), times any factor, fits displacements best.
double fitted_reach(const std::vector<std::pair<double, double>>& found, double around) {
  double best = 0, least = std::numeric_limits<double>::infinity();
  for (double reach = 0.5 * around; reach < 2 * around; reach *= 1.002) {
    double sum = 0, squares = 0;
    for (const auto& [r, u] : found) {
      const double factor = std::log(u / bessel_k(0, r / reach));
      sum += factor;
      squares += factor * factor;
    }
    const double spread = squares - sum * sum / static_cast<double>(found.size());
    if (spread >= least) continue;
    least = spread;
    best = reach;
  }
  return best;
}

TEST(membrane_closed_forms, a_pull_decays_with_the_reach_of_the_tissue) {
  Random random(31);
  // The distance of seeds has to be below the reach. The error is of second order in it.
  for (const auto& [ranges_of_reach, most_rms, most_reach] :
       {std::tuple(0.7, 0.15, 0.13), std::tuple(0.35, 0.08, 0.04)})
    for (int i = 0; i < 5; ++i) {
      const double reach = random.uniform(0.07, 0.1), range = ranges_of_reach * reach;
      const SoftMaterial material = with_reach(reach, random);
      SoftScene scene(test::make_sheet(160), material, range / std::sqrt(2.0));
      const std::uint32_t pulled = scene.nearest({0.5, 0.5, 0});
      const double force = 0.1 * material.membrane_stiffness;
      ASSERT_TRUE(scene.body->set_force(pulled, {0, 0, force}));
      step_until_asleep(scene);
      const auto place_of = [&](std::uint32_t p) -> Vec3d {
        return scene.set->positions()[scene.set->seed(p)].cast<double>();
      };
      std::vector<std::pair<double, double>> found;
      double errors = 0, squares = 0;
      for (std::uint32_t p = 0; p < scene.count(); ++p) {
        const double r = (place_of(p) - place_of(pulled)).norm();
        if (p == pulled || r > 0.25) continue;
        const double wanted =
            force * bessel_k(0, r / reach) / (2 * kPi * material.membrane_stiffness);
        found.emplace_back(r, scene.body->displacement(p).z());
        errors += std::pow(found.back().second - wanted, 2);
        squares += wanted * wanted;
      }
      EXPECT_LT(std::sqrt(errors / squares), most_rms) << reach;
      EXPECT_NEAR(fitted_reach(found, reach) / reach, 1, most_reach) << reach;
    }
}

double energy(const SoftScene& scene, const SoftMaterial& material) {
  double sum = 0;
  for (std::uint32_t p = 0; p < scene.count(); ++p) {
    const Vec3d u = scene.body->displacement(p);
    sum += 0.5 * scene.body->mass(p) *
           (scene.body->velocity(p).squaredNorm() +
            particles::squared_frequency(material.return_frequency) * u.squaredNorm());
    for (const ParticleNeighbour& neighbour : scene.set->neighbours(p))
      sum += 0.25 * material.membrane_stiffness * neighbour.coupling *
             (u - scene.body->displacement(neighbour.particle)).squaredNorm();
  }
  return sum;
}

TEST(membrane_closed_forms, a_swing_of_the_whole_body_loses_energy_by_its_damping_ratio) {
  Random random(32);
  for (int i = 0; i < 12; ++i) {
    SoftMaterial material;
    const double frequency = random.uniform(5, 60);  // Radians per second.
    material.return_frequency = frequency / (2 * kPi);
    material.damping_ratio = random.uniform(0.02, 0.9);
    const double decay = material.damping_ratio * frequency;
    SoftScene scene(test::make_sheet(20), material, std::array{0.2, 0.1, 0.05}[i % 3]);
    const Vec3d velocity = 10 * random.direction();
    double first = 0;
    for (std::uint32_t p = 0; p < scene.count(); ++p) {
      ASSERT_TRUE(scene.body->add_impulse(p, scene.body->mass(p) * velocity));
      first += 0.5 * scene.body->mass(p) * velocity.squaredNorm();
    }
    // After each half of a swing the displacement is zero again, and the energy on its envelope.
    const double half = kPi / (frequency * std::sqrt(1 - std::pow(material.damping_ratio, 2)));
    const int steps = std::array{1, 2, 3, 7, 40}[random.index(5)];
    for (int swing = 1; swing <= 6; ++swing) {
      for (int s = 0; s < steps; ++s) scene.step(half / steps);
      const double wanted = first * std::exp(-2 * decay * half * swing);
      if (wanted < 1e-7 * first) break;
      EXPECT_NEAR(energy(scene, material) / wanted, 1, 1e-6) << swing << ' ' << steps;
    }
  }
}

/// How much faster a wave across the sheet loses energy than by the damping of the foundation, as a
/// ratio.
double decay_of_a_wave(const SoftMaterial& material, double range, double seconds) {
  SoftScene scene(test::make_sheet(80), material, range);
  for (std::uint32_t p = 0; p < scene.count(); ++p) {
    const double x = double{scene.set->positions()[scene.set->seed(p)].x()};
    EXPECT_TRUE(scene.body->add_impulse(p, {0, 0, scene.body->mass(p) * std::cos(kPi * x)}));
  }
  const double rate =
      2 * material.damping_ratio * particles::angular_frequency(material.return_frequency);
  const double swing =
      kPi / std::sqrt(particles::squared_frequency(material.return_frequency) +
                      kPi * kPi * material.membrane_stiffness / material.areal_density);
  const auto steps_of = [&](double of) { return static_cast<int>(std::lround(of / seconds)); };
  // The energy of a damped swing falls in steps, so its logarithm is averaged over half a swing.
  const int averaged = steps_of(swing), apart = steps_of(4 / rate);
  const auto mean_logarithm = [&] {
    double sum = 0;
    for (int i = 0; i < averaged; ++i) {
      scene.step(seconds);
      sum += std::log(energy(scene, material));
    }
    return sum / averaged;
  };
  for (int i = 0; i < apart; ++i) scene.step(seconds);
  const double before = mean_logarithm();
  for (int i = averaged; i < apart; ++i) scene.step(seconds);
  return (before - mean_logarithm()) / (apart * seconds) / rate;
}

TEST(membrane_closed_forms, a_wave_loses_energy_by_the_damping_ratio_in_the_limit_of_short_steps) {
  Random random(33);
  for (const double range : {0.2, 0.1, 0.05})
    for (int i = 0; i < 3; ++i) {
      SoftMaterial material;
      material.return_frequency = test::frequency_of(random.uniform(200, 600));
      material.damping_ratio = random.uniform(0.1, 0.4);
      material.membrane_stiffness = random.uniform(2, 20);
      material.membrane_damping = 0;
      const double coarse = decay_of_a_wave(material, range, 1.0 / 480),
                   fine = decay_of_a_wave(material, range, 1.0 / 960);
      // The coupling adds damping of first order in the step.
      EXPECT_NEAR(2 * fine - coarse, 1, 0.02) << range;
      EXPECT_LT(fine, 1.03) << range;
    }
}

}  // namespace
}  // namespace sunder
