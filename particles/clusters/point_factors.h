#pragma once

#include <sunder/particles/authored_tissue.h>
#include <sunder/particles/material.h>
#include <sunder/tear/torn_model.h>

#include <array>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace sunder::particles {

/// A field of TissueFactors.
struct FactorField {
  std::string_view name;
  std::vector<float> TissueFactors::*values;
  double least;
};
inline constexpr std::array<FactorField, 5> kFactorFields = {
    {{"strength", &TissueFactors::strength, 1e-3},
     {"toughness", &TissueFactors::toughness, 1e-3},
     {"stiffness", &TissueFactors::stiffness, 1e-3},
     {"tension", &TissueFactors::tension, 0.0},
     {"thickness", &TissueFactors::thickness, 1e-3}}};
inline constexpr double kLeastFactor = 1e-3, kMostFactor = 1e3;

/// TissueFactors at one point.
struct PointFactors {
  float strength = 1, toughness = 1, stiffness = 1, tension = 1, thickness = 1;

  bool operator==(const PointFactors&) const = default;
};

/// A material with factors, without its name. A factor of 1 changes no bit.
[[nodiscard]] SoftMaterial with_factors(const SoftMaterial& material, const PointFactors& factors);

/// What an author gave a surface, and its factors at the points of the surface.
struct AuthoredPoints {
  std::shared_ptr<const AuthoredTissue> tissue;  ///< Null: nothing.
  /// Per point, if there are factors. While operations are undone, entries of theirs may follow.
  std::vector<PointFactors> of_points;

  /// Follows the points that an operation created: those from `first` on.
  /// @param vertices  per point: (mesh, vertex) of the model.
  template <class Vertices>
  void follow(const TornModel& model, const Vertices& vertices, std::size_t first) {
    if (!has_factors()) return;
    of_points.resize(first);
    for (std::size_t p = first; p < vertices.size(); ++p)
      of_points.push_back(at(model, vertices[p].mesh, vertices[p].vertex));
  }
  [[nodiscard]] bool has_factors() const { return tissue != nullptr && !tissue->meshes.empty(); }

 private:
  /// @param vertex  kNone: none.
  [[nodiscard]] PointFactors at(const TornModel& model, Index mesh, Index vertex) const;
};

}  // namespace sunder::particles
