#include "particles/clusters/point_factors.h"

#include <algorithm>
#include <optional>

namespace sunder::particles {
namespace {

/// The limits of SoftMaterial.
constexpr double kLeastDensity = 1e-12, kMostOfMaterial = 1e12;

/// A place in a triangle of the source.
struct VertexBlend {
  Triangle vertices = {};
  std::array<double, 3> barycentric = {1, 0, 0};
};

/// Where a vertex came from. One within a wall or cap is given to the nearest corner of the
/// triangle in which it was born, and so on, because walls and caps belong to their rims.
std::optional<VertexBlend> source_place(const TornModel& model, Index mesh, Index vertex) {
  const Mesh& source = model.source().meshes[mesh];
  while (vertex >= source.vertex_count()) {
    const Birth birth = model.birth(mesh, vertex);
    if (birth.triangle < source.triangle_count())
      return VertexBlend{source.triangles[birth.triangle], birth.barycentric};
    const auto nearest = std::max_element(birth.barycentric.begin(), birth.barycentric.end());
    const Triangle& filling =
        model.fillings(mesh)[birth.triangle - std::size_t{source.triangle_count()}];
    const Index older = filling[static_cast<std::size_t>(nearest - birth.barycentric.begin())];
    if (older >= vertex) return {};
    vertex = older;
  }
  return VertexBlend{{vertex, vertex, vertex}, {1, 0, 0}};
}

/// Equal values stay what they are, because the sum is rounded to less.
float mean(const std::vector<float>& values, const VertexBlend& place) {
  if (values.empty()) return 1;
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k)
    sum += place.barycentric[k] * double{values[place.vertices[k]]};
  return static_cast<float>(sum);
}

}  // namespace

SoftMaterial with_factors(const SoftMaterial& of, const PointFactors& factors) {
  SoftMaterial made;
  made.return_frequency = of.return_frequency;
  made.damping_ratio = of.damping_ratio;
  made.range = of.range;
  made.stretch_limit = of.stretch_limit;
  const double thickness{factors.thickness};
  const auto limited = [](double value) { return std::min(value, kMostOfMaterial); };
  made.membrane_stiffness =
      limited(of.membrane_stiffness * (thickness * double{factors.stiffness}));
  made.membrane_damping = limited(of.membrane_damping * thickness);
  made.areal_density = std::max(limited(of.areal_density * thickness), kLeastDensity);
  made.toughness = limited(of.toughness * (thickness * double{factors.toughness}));
  made.flaw_length = limited(of.flaw_length * double{factors.toughness});
  made.strength = of.strength > 1 && factors.strength != 1
                      ? 1 + (of.strength - 1) * double{factors.strength}
                      : of.strength;
  made.yield_stretch = of.yield_stretch;
  made.plastic_limit = of.plastic_limit;
  return made;
}

PointFactors AuthoredPoints::at(const TornModel& model, Index mesh, Index vertex) const {
  if (vertex == kNone) return {};
  const std::optional<VertexBlend> place = source_place(model, mesh, vertex);
  if (!place) return {};
  const TissueFactors& of = tissue->meshes[mesh];
  return {mean(of.strength, *place), mean(of.toughness, *place), mean(of.stiffness, *place),
          mean(of.tension, *place), mean(of.thickness, *place)};
}

}  // namespace sunder::particles
