// Strokes that turn, return, and end at difficult places.

#include <sunder/skinning/pose.h>

#include <cmath>
#include <numbers>

#include "bench/stress/families.h"
#include "bench/stress/steps.h"
#include "support/models/hard_operations.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"

namespace sunder::stress {
namespace {

using test::Random;

Stroke along(const std::vector<Vec2d>& places) {
  Stroke stroke;
  for (const Vec2d& place : places) stroke.push_back(test::down_at(place.x(), place.y()));
  return stroke;
}

Vec2d round_about(const Vec2d& center, double radius, double angle) {
  return center + radius * Vec2d(std::cos(angle), std::sin(angle));
}

std::vector<Vec2d> hairpin(Random& random) {
  const double gap = test::any_scale(random, 1e-9, 0.1);
  const double ay = random.uniform(0.3, 0.7), ax = random.uniform(0.2, 0.4),
               by = random.uniform(0.3, 0.7), bx = random.uniform(0.6, 0.8);
  const Vec2d a(ax, ay), b(bx, by);
  return {a, b, b + Vec2d(0, gap), a + Vec2d(0, gap)};
}

std::vector<Vec2d> spiral(Random& random, bool is_inwards) {
  std::vector<Vec2d> places;
  const double turns = random.uniform(1, 3), start = random.uniform(0, 6);
  for (int i = 0; i <= 40; ++i) {
    const double part = (is_inwards ? 40 - i : i) / 40.0;
    places.push_back(
        round_about({0.5, 0.5}, 0.02 + 0.38 * part, start + 2 * std::numbers::pi * turns * part));
  }
  return places;
}

/// A figure of eight: crosses itself in the middle.
std::vector<Vec2d> crossing(Random& random) {
  std::vector<Vec2d> places;
  const double size = random.uniform(0.1, 0.4);
  for (int i = 0; i <= 24; ++i) {
    const double t = 2 * std::numbers::pi * i / 24;
    places.emplace_back(0.5 + size * std::sin(t), 0.5 + size * std::sin(t) * std::cos(t));
  }
  return places;
}

std::vector<Vec2d> retraced(Random& random) {
  std::vector<Vec2d> places = crossing(random);
  places.resize(8);
  for (std::size_t i = places.size() - 1; i-- > 0;) places.push_back(places[i]);
  return places;
}

std::vector<Vec2d> winding(Random& random) {
  switch (random.index(5)) {
    case 0: return hairpin(random);
    case 1: return spiral(random, random.index(2) == 0);
    case 2: return crossing(random);
    case 3: return retraced(random);
    default: break;
  }
  std::vector<Vec2d> places;
  for (int i = 0; i < 12; ++i) {
    const double x = random.uniform(-0.1, 1.1), y = random.uniform(-0.1, 1.1);
    places.emplace_back(x, y);
  }
  return places;
}

TearOperation on_sheet(const TornModel& model, const std::vector<Vec2d>& places, Random& random) {
  TearOperation tear;
  tear.pose = *bind_pose(model.source());
  tear.stroke = along(places);
  if (random.index(3) == 0) tear.options.width = test::any_scale(random, 1e-4, 0.05);
  if (random.index(4) == 0) tear.options.layers = Layers::all;
  if (random.index(4) == 0) tear.options.wall_depth = test::any_scale(random, 1e-3, 0.1);
  return tear;
}

void perform(TornSubject& subject, const TearOperation& tear, Random& random) {
  if (random.index(3) == 0)
    subject.tear_in_steps(tear);
  else
    subject.operate(tear);
}

}  // namespace

void winding_strokes(std::uint64_t seed, const Steps& steps, CaseReport& report) {
  Random random = random_of(seed, 0);
  TornSubject subject(test::make_sheet(1 + random.index(16)), report);
  run_steps(subject, seed, steps, 4, [](TornSubject& of, Random& numbers, std::uint32_t) {
    perform(of, on_sheet(of.model(), winding(numbers), numbers), numbers);
  });
}

void retraced_strokes(std::uint64_t seed, const Steps& steps, CaseReport& report) {
  Random random = random_of(seed, 0);
  TornSubject subject(test::random_character(random), report);
  run_steps(subject, seed, steps, 3, [](TornSubject& of, Random& numbers, std::uint32_t) {
    Operation operation = test::random_operation(of.model(), numbers);
    auto* const tear = std::get_if<TearOperation>(&operation);
    const ModelPose pose = *bind_pose(of.model().source());
    const double size = test::posed_diagonal(of.model().source(), pose);
    if (tear != nullptr && numbers.index(2) == 0)
      tear->options.wall_depth = numbers.uniform(0.002, 0.03) * size;
    if (tear != nullptr && numbers.index(3) == 0)  // to and fro
      for (std::size_t i = tear->stroke.size() - 1; i-- > 0;)
        tear->stroke.push_back(Blade(tear->stroke[i]));
    for (int n = 0; n < 3; ++n) {
      of.operate(operation);
      if (tear == nullptr || numbers.index(2) == 0) continue;
      const double unsteady = test::any_scale(numbers, 1e-8, 1e-2) * size;
      for (Blade& blade : tear->stroke) {
        const Vec3d aside = unsteady * numbers.direction();
        blade = {blade.base + aside, blade.tip + aside};
      }
    }
  });
}

void strokes_that_end_anywhere(std::uint64_t seed, const Steps& steps, CaseReport& report) {
  Random random = random_of(seed, 0);
  TornSubject subject(test::make_sheet(1 + random.index(10)), report);
  run_steps(subject, seed, steps, 6, [](TornSubject& of, Random& numbers, std::uint32_t) {
    // The torn surface has the tips and lips of older tears among its vertices.
    const test::Target target =
        test::target_of(of.model().character(), *bind_pose(of.model().source()));
    if (target.faces.empty()) return;
    std::vector<Vec2d> places;
    for (std::uint32_t n = 2 + numbers.index(3); n > 0; --n)
      places.push_back(test::place_on(target, numbers).head<2>());
    if (numbers.index(3) == 0)  // as near to a vertex as can be told
      places.back() += test::any_scale(numbers, 1e-16, 1e-3) * Vec2d(1, 1);
    perform(of, on_sheet(of.model(), places, numbers), numbers);
  });
}

void far_turns(std::uint64_t seed, const Steps& steps, CaseReport& report) {
  Random random = random_of(seed, 0);
  TornSubject subject(random.index(2) == 0 ? test::make_sheet(1 + random.index(16))
                                           : test::random_character(random),
                      report);
  run_steps(subject, seed, steps, 5, [](TornSubject& of, Random& numbers, std::uint32_t) {
    const ModelPose pose = numbers.index(2) == 0 ? *bind_pose(of.model().source())
                                                 : test::random_pose(of.model().source(), numbers);
    const test::Target target = test::target_of(of.model().character(), pose);
    if (target.faces.empty()) return;
    TearOperation tear;
    tear.pose = pose;
    tear.stroke = test::far_turn(target, numbers);
    if (numbers.index(3) == 0) tear.options = test::hard_options(target, numbers);
    perform(of, tear, numbers);
  });
}

void long_strokes(std::uint64_t seed, const Steps& steps, CaseReport& report) {
  Random random = random_of(seed, 0);
  TornSubject subject(test::make_sheet(8 + random.index(24)), report);
  run_steps(subject, seed, steps, 1, [](TornSubject& of, Random& numbers, std::uint32_t) {
    std::vector<Vec2d> places;
    Vec2d at(0.5, 0.5);
    double heading = numbers.uniform(0, 6);
    for (int i = 0; i < 10'000; ++i) {
      places.push_back(at);
      heading += numbers.uniform(-0.05, 0.05);
      const Vec2d next = at + 0.002 * Vec2d(std::cos(heading), std::sin(heading));
      if ((next - Vec2d(0.5, 0.5)).cwiseAbs().maxCoeff() > 0.45)
        heading += 0.3;
      else
        at = next;
    }
    perform(of, on_sheet(of.model(), places, numbers), numbers);
  });
}

void tiny_strokes(std::uint64_t seed, const Steps& steps, CaseReport& report) {
  Random random = random_of(seed, 0);
  TornSubject subject(test::random_character(random), report);
  run_steps(subject, seed, steps, 10, [](TornSubject& of, Random& numbers, std::uint32_t) {
    const ModelPose pose = test::random_pose(of.model().source(), numbers, 0.3);
    if (numbers.index(4) == 0) {
      const Blade down = test::random_stroke(of.model().source(), pose, numbers, 0.1, 1)[0];
      Bore bore;
      bore.origin = down.base;
      bore.direction = down.tip - down.base;
      bore.depth = 1.1 * bore.direction.norm();
      bore.radius = test::any_scale(numbers, 1e-9, 1e-2);
      return of.operate(DrillOperation{pose, bore});
    }
    TearOperation tear;
    tear.pose = pose;
    const std::uint32_t segments = 1 + numbers.index(3);
    const double length = test::any_scale(numbers, 1e-9, 1e-2);
    tear.stroke = test::random_stroke(of.model().source(), pose, numbers, length, segments);
    if (numbers.index(2) == 0) tear.options.width = test::any_scale(numbers, 1e-9, 1e-2);
    of.operate(tear);
  });
}

}  // namespace sunder::stress
