#include "support/models/hard_operations.h"

#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cmath>

#include "support/models/rigs.h"

namespace sunder::test {
namespace {

template <class T>
const T& one_of(const std::vector<T>& values, Random& random) {
  return values[random.index(static_cast<std::uint32_t>(values.size()))];
}

}  // namespace

Character hard_character(Random& random) {
  const std::uint32_t a = random.index(10),
                      b = random.index(10);  // evaluated in this order by every compiler
  switch (random.index(5)) {
    case 0: return make_sheet(1 + a);
    case 1: return make_tube(2 + a, 3 + b, 3);
    case 2: return make_two_tubes(2 + a, 3 + b);
    default: return make_soup(random);
  }
}

ModelPose hard_pose(const Character& character, Random& random) {
  ModelPose pose =
      random.index(3) == 0 ? *bind_pose(character) : random_pose(character, random, 0.6, 1.3);
  if (random.index(2) == 0) return pose;
  for (Affine3d& bone : pose.model_from_bone) {
    Mat3d change = Mat3d::Identity();
    const auto any_entry = [&]() -> double& {
      const std::uint32_t column = random.index(3),
                          row = random.index(3);  // evaluated in this order by every compiler
      return change(row, column);
    };
    switch (random.index(6)) {
      case 0: any_entry() = 0; break;  // flat, or nothing
      case 1: change.setZero(); break;
      case 2: change(0, 0) = -1; break;
      case 3: change = -change; break;
      case 4: any_entry() += random.uniform(-2, 2); break;
      default: continue;
    }
    bone.linear() = (bone.linear() * change).eval();
  }
  return pose;
}

Target target_of(const Character& character, const ModelPose& pose) {
  Target target;
  for (std::uint32_t m = 0; m < character.meshes.size(); ++m) {
    const auto positions = posed_positions(character, m, pose);
    target.vertices.insert(target.vertices.end(), positions.begin(), positions.end());
    for (const Triangle& triangle : character.meshes[m].triangles)
      if (!is_retired(triangle))
        target.faces.push_back(
            {positions[triangle[0]], positions[triangle[1]], positions[triangle[2]]});
  }
  target.size = std::max(posed_diagonal(character, pose), 1e-3);
  return target;
}

Vec3d place_on(const Target& target, Random& random) {
  const auto& face = one_of(target.faces, random);
  switch (random.index(4)) {
    case 0: return face[random.index(3)];
    case 1: return 0.5 * (face[0] + face[1]);
    default: {
      const double u = random.uniform(0, 1), v = random.uniform(0, 1 - u);
      return (1 - u - v) * face[0] + u * face[1] + v * face[2];
    }
  }
}

Vec3d direction_at(const Target& target, Random& random) {
  const auto& face = one_of(target.faces, random);
  Vec3d direction = Vec3d::Zero();
  switch (random.index(4)) {
    case 0: return Vec3d::Unit(random.index(3));
    case 1: direction = face[1] - face[0]; break;
    case 2: direction = (face[1] - face[0]).cross(face[2] - face[0]); break;
    default: break;
  }
  return direction.norm() > 1e-12 * target.size ? Vec3d(direction / direction.norm())
                                                : random.direction();
}

Stroke hard_stroke(const Target& target, Random& random) {
  Stroke stroke;
  const Vec3d down = -direction_at(target, random);
  const double reach = any_scale(random, 1e-2, 10) * target.size,
               step = any_scale(random, 1e-6, 10) * target.size;
  Vec3d at = place_on(target, random), along = direction_at(target, random);
  const double start = random.index(2) == 0 ? 0.0 : random.uniform(0, 1);
  at -= start * step * along;
  const std::uint32_t blades = 2 + random.index(5);
  while (stroke.size() < blades) {
    stroke.push_back({at - reach * down, at + random.uniform(0.001, 1) * reach * down});
    at += step * along;
    if (random.index(3) == 0) along = direction_at(target, random);
  }
  return stroke;
}

Stroke far_turn(const Target& target, Random& random) {
  constexpr double kDegree = 0.017453292519943295;
  const auto& face = one_of(target.faces, random);
  const Vec3d place = place_on(target, random);
  Vec3d up = (face[1] - face[0]).cross(face[2] - face[0]);
  up = up.norm() > 1e-12 * target.size * target.size ? Vec3d(up / up.norm()) : random.direction();
  if (random.index(3) == 0) up = (up + 0.3 * random.direction()).normalized();
  Vec3d along = up.cross(direction_at(target, random));
  if (!(along.norm() > 1e-3)) along = up.unitOrthogonal();
  along.normalize();
  const Vec3d aside = up.cross(along);
  const double turn = random.uniform(30, 170) * kDegree, radius = any_scale(random, 10, 1000),
               extent = any_scale(random, 1e-2, 1) * target.size;
  const double length = extent / (2 * radius * std::tan(0.5 * turn));
  // The lines of the blades meet above the surface or below it.
  const double side = random.index(2) == 0 ? 1 : -1;
  // Blades that lean aside too turn out of the plane in which they go.
  const Vec3d lean = random.index(2) == 0 ? Vec3d::Zero() : Vec3d(random.uniform(-1, 1) * aside);
  const double drift = random.index(2) == 0 ? 0.0 : random.uniform(-0.3, 0.3) * extent;
  Stroke stroke;
  double angle = -0.5 * turn;
  const std::uint32_t steps = 2 + random.index(5);
  for (std::uint32_t n = 0; n <= steps + 2; ++n) {
    const Vec3d down =
        (std::cos(angle) * -up + side * std::sin(angle) * along + lean).normalized() * length;
    const Vec3d at =
        place + radius * length * std::tan(angle) * along + drift * angle / turn * aside;
    const double above = random.uniform(0.1, 0.9);
    stroke.push_back({at - above * down, at + (1 - above) * down});
    // Neighbours differ by less than 90 degrees.
    const double step = std::min(turn * random.uniform(0.1, 1.2), 85 * kDegree);
    const bool is_back = stroke.size() > 1 && random.index(3) == 0;
    angle = std::clamp(angle + (is_back ? -0.7 * step : step), -0.5 * turn, 0.5 * turn);
  }
  return stroke;
}

TearOptions hard_options(const Target& target, Random& random) {
  TearOptions options;
  if (random.index(2) == 0) options.width = any_scale(random, 1e-6, 2) * target.size;
  if (random.index(3) == 0) options.layers = Layers::all;
  if (random.index(4) == 0) options.wall_depth = any_scale(random, 1e-4, 0.5) * target.size;
  return options;
}

PlaneCut hard_cut(const Target& target, Random& random) {
  PlaneCut cut;
  const auto& face = one_of(target.faces, random);
  cut.point = face[random.index(3)];
  cut.normal = (face[1] - face[0]).cross(face[2] - face[0]);
  if (random.index(2) == 0 || !(cut.normal.norm() > 1e-12 * target.size * target.size))
    cut.normal = direction_at(target, random);
  if (random.index(2) == 0)
    cut.point += std::pow(10.0, -static_cast<double>(3 + random.index(14))) * target.size *
                 cut.normal.normalized();
  if (random.index(3) == 0) {  // through an edge
    const Vec3d edge = face[1] - face[0], across = edge.cross(random.direction());
    if (across.norm() > 1e-12 * target.size) cut.normal = across;
  }
  cut.caps = random.index(2) == 0;
  if (random.index(3) == 0) {
    const Vec3d x = cut.normal.unitOrthogonal(), y = cut.normal.normalized().cross(x);
    const double radius = any_scale(random, 1e-4, 2) * target.size;
    for (const double angle : {0.1, 1.4, 3.0, 4.4})
      cut.bounds.push_back(cut.point + radius * (std::cos(angle) * x + std::sin(angle) * y));
  }
  return cut;
}

Bore hard_bore(const Target& target, Random& random) {
  Bore bore;
  bore.direction = direction_at(target, random);
  const double above = random.uniform(0, 2) * target.size;
  bore.origin = place_on(target, random) - above * bore.direction;
  bore.depth = any_scale(random, 1e-3, 10) * target.size;
  bore.radius = any_scale(random, 1e-6, 10) * target.size;
  if (random.index(2) == 0) bore.chord_tolerance = any_scale(random, 1e-3, 0.9) * bore.radius;
  bore.wall = random.index(2) == 0;
  return bore;
}

}  // namespace sunder::test
