// Planes that meet vertices and edges, and one another.

#include <sunder/skinning/pose.h>

#include <cmath>
#include <limits>

#include "bench/stress/families.h"
#include "bench/stress/steps.h"
#include "support/models/hard_operations.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"

namespace sunder::stress {
namespace {

using test::Random;
using test::Target;

template <class T>
const T& one_of(const std::vector<T>& values, Random& random) {
  return values[random.index(static_cast<std::uint32_t>(values.size()))];
}

Character plane_subject(Random& random) {
  switch (random.index(4)) {
    case 0: return test::make_sheet(2 + random.index(10));
    case 1: return test::make_bumpy_ball(60 + random.index(400));
    default: break;
  }
  const std::uint32_t sides = 5 + random.index(8), rings = 4 + random.index(8);
  return test::make_tube(rings, sides, 3);
}

/// Nothing, or a distance of 1e-4 to 1e-16 sizes.
double slightly_off(const Target& target, Random& random) {
  if (random.index(3) == 0) return 0;
  return (random.index(2) == 0 ? -1 : 1) * target.size * test::any_scale(random, 1e-16, 1e-4);
}

/// Through one, two or three vertices, along an edge, or in a face.
PlaneCut plane_at_vertices(const Target& target, Random& random) {
  PlaneCut cut;
  const Vec3d a = one_of(target.vertices, random), b = one_of(target.vertices, random),
              c = one_of(target.vertices, random);
  const auto& face = one_of(target.faces, random);
  cut.point = a;
  switch (random.index(5)) {
    case 0: cut.normal = random.direction(); break;
    case 1: cut.normal = (b - a).cross(random.direction()); break;
    case 2: cut.normal = (b - a).cross(c - a); break;
    case 3:
      cut.point = face[0];
      cut.normal = (face[1] - face[0]).cross(random.direction());
      break;
    default:
      cut.point = face[0];
      cut.normal = (face[1] - face[0]).cross(face[2] - face[0]);
      break;
  }
  if (!(cut.normal.norm() > 1e-9 * target.size * target.size)) cut.normal = random.direction();
  cut.normal.normalize();
  cut.point += slightly_off(target, random) * cut.normal;
  cut.caps = random.index(2) == 0;
  return cut;
}

/// `count` units in the last place further in each coordinate.
Vec3d next_places(Vec3d place, std::uint32_t count) {
  for (std::uint32_t n = 0; n < count; ++n)
    for (double& coordinate : place)
      coordinate = std::nextafter(coordinate, std::numeric_limits<double>::infinity());
  return place;
}

}  // namespace

void planes_at_vertices(std::uint64_t seed, const Steps& steps, CaseReport& report) {
  Random random = random_of(seed, 0);
  TornSubject subject(plane_subject(random), report);
  run_steps(subject, seed, steps, 6, [](TornSubject& of, Random& numbers, std::uint32_t) {
    const Character& torn = of.model().character();
    const ModelPose pose =
        numbers.index(2) == 0 ? *bind_pose(torn) : test::random_pose(torn, numbers);
    const Target target = test::target_of(torn, pose);
    if (!target.faces.empty()) of.operate(CutOperation{pose, plane_at_vertices(target, numbers)});
  });
}

void plane_bundles(std::uint64_t seed, const Steps& steps, CaseReport& report) {
  Random random = random_of(seed, 0);
  TornSubject subject(plane_subject(random), report);
  const ModelPose pose = *bind_pose(subject.model().source());
  const Target target = test::target_of(subject.model().source(), pose);
  const Vec3d place = test::place_on(target, random), axis = test::direction_at(target, random);
  const double step = test::any_scale(random, 1e-12, 0.5);
  const double start = random.uniform(0, 3);
  run_steps(subject, seed, steps, 8, [&](TornSubject& of, Random& numbers, std::uint32_t index) {
    const double angle = start + index * step;
    const Vec3d x = axis.unitOrthogonal(), y = axis.cross(x);
    PlaneCut cut;
    cut.normal = std::cos(angle) * x + std::sin(angle) * y;
    cut.point = place + slightly_off(target, numbers) * cut.normal;
    cut.caps = numbers.index(2) == 0;
    of.operate(CutOperation{pose, cut});
  });
}

void plane_stacks(std::uint64_t seed, const Steps& steps, CaseReport& report) {
  Random random = random_of(seed, 0);
  TornSubject subject(plane_subject(random), report);
  const ModelPose pose = random.index(2) == 0 ? *bind_pose(subject.model().source())
                                              : test::random_pose(subject.model().source(), random);
  const Target target = test::target_of(subject.model().source(), pose);
  const Vec3d place = test::place_on(target, random), normal = test::direction_at(target, random);
  const bool is_ulps = random.index(3) == 0;
  const double step = target.size * test::any_scale(random, 1e-15, 1e-2);
  run_steps(subject, seed, steps, 8, [&](TornSubject& of, Random& numbers, std::uint32_t index) {
    PlaneCut cut;
    cut.normal = normal;
    cut.point = is_ulps ? next_places(place, index) : Vec3d(place + index * step * normal);
    cut.caps = numbers.index(2) == 0;
    of.operate(CutOperation{pose, cut});
  });
}

}  // namespace sunder::stress
