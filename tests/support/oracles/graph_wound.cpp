#include "support/oracles/graph_wound.h"

#include <sunder/skinning/pose.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "support/machine/checked.h"
#include "support/models/rigs.h"
#include "support/oracles/membrane.h"
#include "tear/internal/surface.h"

namespace sunder::test {
namespace {

SoftMaterial material_of(const TwoMembranes::Membrane& membrane) {
  SoftMaterial material;
  material.membrane_stiffness = membrane.stiffness;
  material.return_frequency =
      std::sqrt(membrane.foundation / material.areal_density) / (2 * std::numbers::pi);
  return material;
}

/// Per point: whether its faces are on the side of greater y.
std::vector<bool> points_above(const TornModel& model, std::span<const Vec3f> at, double y) {
  const tear::Surface& surface = model.surface();
  std::vector<double> sums(at.size(), 0.0);
  for (std::uint32_t t = 0; t < surface.triangle_count(); ++t) {
    const std::uint32_t* points = &surface.corner_point[std::size_t{3} * t];
    double middle = 0;
    for (std::size_t k = 0; k < 3; ++k) middle += double{at[points[k]].y()} / 3;
    for (std::size_t k = 0; k < 3; ++k) sums[points[k]] += middle - y;
  }
  std::vector<bool> above;
  for (const double sum : sums) above.push_back(sum > 0);
  return above;
}

}  // namespace

GraphWound::GraphWound(const GraphSurface& on, const TwoMembranes& of, const GraphMesh& mesh,
                       double range, std::uint64_t seed_order)
    : surface(on), materials(of) {
  Character sheet = make_sheet(mesh.cells);
  for (Vec3f& at : sheet.meshes[0].positions) {
    const Vec2d place = mesh.place(double{at.x()}, double{at.y()});
    at = Vec3d(place.x(), place.y(), surface.height(place.x(), place.y())).cast<float>();
  }
  character = std::make_shared<const Character>(std::move(sheet));
  model = std::make_unique<TornModel>(checked(TornModel::create(character)));
  pose = checked(bind_pose(*character));
  set = std::make_unique<ParticleSet>(
      checked(ParticleSet::create(*model, pose, {range, false, seed_order})));
  const std::array both = {material_of(materials.first), material_of(materials.second)};
  body = std::make_unique<SoftBody>(checked(SoftBody::create(*set, pose, both)));
  const auto blade = [&](double x) {
    return Blade{{x, surface.slit_y, 2}, {x, surface.slit_y, -2}};
  };
  const std::array<Blade, 2> stroke = {blade(surface.slit_begin), blade(surface.slit_end)};
  ChangeRecord change;
  (void)checked(model->tear(pose, stroke, {}, &change));
  lips = change.lips;
  check(set->follow(*model, {&change, 1}));
  while (set->settle(*model, 100000)) continue;
  (void)body->displacements();  // makes room for the new particles
  for (std::uint32_t p = 0; p < set->particle_count(); ++p) {
    const Vec3f& seed = set->positions()[set->seed(p)];
    const double at =
        materials.across == TwoMembranes::Across::x ? double{seed.x()} : double{seed.y()};
    const bool is_second =
        materials.across != TwoMembranes::Across::nothing && at > materials.border;
    check(body->set_material(p, is_second ? 1 : 0));
  }
}

MembraneDifference GraphWound::difference(const QuadraticMembrane& wanted,
                                          double newtons_per_metre) {
  pull_open(*body, *model, pose, newtons_per_metre);
  return difference_of(wanted, [&](std::uint32_t p) { return body->point_displacement(p); });
}

MembraneDifference GraphWound::difference_of_elements(const QuadraticMembrane& wanted,
                                                      double newtons_per_metre) const {
  const std::vector<Vec3d> moved = solve_membrane(*model, set->positions(), body->materials()[0],
                                                  lip_forces(*set, newtons_per_metre));
  return difference_of(wanted, [&](std::uint32_t p) { return moved[p]; });
}

MembraneDifference GraphWound::difference_of(
    const QuadraticMembrane& wanted,
    const std::function<Vec3d(std::uint32_t point)>& displacement) const {
  const std::span<const Vec3f> at = set->positions();
  const double widest = wanted.widest_gap();
  MembraneDifference found;
  double most = 0, squares = 0;
  for (const LipPair& pair : lips) {
    const double gap = (displacement(pair.left) - displacement(pair.right)).norm();
    most = std::max(most, gap);
    squares += std::pow(gap - wanted.gap(double{at[pair.left].x()}), 2);
  }
  found.width = most / widest;
  found.gap = std::sqrt(squares / static_cast<double>(lips.size())) / widest;
  const std::vector<bool> above = points_above(*model, at, surface.slit_y);
  squares = 0;
  for (std::uint32_t p = 0; p < at.size(); ++p) {
    const bool is_on_slit = std::abs(double{at[p].y()} - surface.slit_y) < 1e-6;
    const double y = is_on_slit ? surface.slit_y : double{at[p].y()};
    squares +=
        (displacement(p) - wanted.displacement(double{at[p].x()}, y, above[p])).squaredNorm();
  }
  found.displacement = std::sqrt(squares / static_cast<double>(at.size())) / (0.5 * widest);
  return found;
}

}  // namespace sunder::test
