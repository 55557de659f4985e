#include <sunder/particles/authored_tissue.h>

#include <cmath>

#include "particles/clusters/point_factors.h"

namespace sunder {
namespace {

constexpr double kSumTolerance = 1e-6;

Status check_field(const Mesh& mesh, const particles::FactorField& field,
                   const TissueFactors& factors) {
  using particles::kMostFactor;
  const std::vector<float>& values = factors.*field.values;
  if (values.empty()) return {};
  const auto name = static_cast<int>(field.name.size());
  if (values.size() != mesh.positions.size())
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "mesh '%.60s': the field %.*s has %zu values; the mesh has %u vertices",
                           mesh.name.c_str(), name, field.name.data(), values.size(),
                           mesh.vertex_count());
  for (Index v = 0; v < values.size(); ++v) {
    const double value{values[v]};
    if (value >= field.least && value <= kMostFactor) continue;
    return Status::failure(
        std::isfinite(value) ? StatusCode::invalid_argument : StatusCode::non_finite_value, v,
        "mesh '%.60s', vertex %u: the factor of %.*s is %g; it must be from %g to %g",
        mesh.name.c_str(), v, name, field.name.data(), value, field.least, kMostFactor);
  }
  return {};
}

Status check_place(const Character& character, const SourcePlace& place, Index perforation,
                   std::size_t at) {
  if (place.mesh >= character.meshes.size())
    return Status::failure(StatusCode::index_out_of_range, perforation,
                           "perforation %u, place %zu: mesh %u does not exist; there are %zu",
                           perforation, at, place.mesh, character.meshes.size());
  const Mesh& mesh = character.meshes[place.mesh];
  if (place.triangle >= mesh.triangle_count())
    return Status::failure(StatusCode::index_out_of_range, perforation,
                           "perforation %u, place %zu: mesh '%.60s' has no triangle %u; it has %u",
                           perforation, at, mesh.name.c_str(), place.triangle,
                           mesh.triangle_count());
  const auto& [a, b, c] = place.barycentric;
  if (a >= 0 && b >= 0 && c >= 0 && std::abs(a + b + c - 1) <= kSumTolerance) return {};
  const bool is_finite = std::isfinite(a) && std::isfinite(b) && std::isfinite(c);
  return Status::failure(
      is_finite ? StatusCode::invalid_argument : StatusCode::non_finite_value, perforation,
      "perforation %u, place %zu: the barycentrics are (%g, %g, %g); they must not be below 0, "
      "and their sum must be 1",
      perforation, at, a, b, c);
}

Status check_perforation(const Character& character, const Perforation& of, Index index) {
  if (of.line.size() < 2)
    return Status::failure(StatusCode::invalid_argument, index,
                           "perforation %u has %zu places; it needs at least two", index,
                           of.line.size());
  if (!(of.strength >= particles::kLeastFactor && of.strength <= 1))
    return Status::failure(
        std::isfinite(of.strength) ? StatusCode::invalid_argument : StatusCode::non_finite_value,
        index, "the strength of perforation %u is %g; it must be from %g to 1", index, of.strength,
        particles::kLeastFactor);
  for (std::size_t i = 0; i < of.line.size(); ++i)
    if (Status status = check_place(character, of.line[i], index, i); !status) return status;
  return {};
}

}  // namespace

Status validate_authored_tissue(const AuthoredTissue& tissue, const Character& character) {
  if (!tissue.meshes.empty() && tissue.meshes.size() != character.meshes.size())
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "there are fields for %zu meshes; the character has %zu",
                           tissue.meshes.size(), character.meshes.size());
  for (std::size_t m = 0; m < tissue.meshes.size(); ++m)
    for (const particles::FactorField& field : particles::kFactorFields)
      if (Status status = check_field(character.meshes[m], field, tissue.meshes[m]); !status)
        return status;
  for (Index i = 0; i < tissue.perforations.size(); ++i)
    if (Status status = check_perforation(character, tissue.perforations[i], i); !status)
      return status;
  return {};
}

std::vector<float>* find_field(TissueFactors& factors, std::string_view name) {
  for (const particles::FactorField& field : particles::kFactorFields)
    if (field.name == name) return &(factors.*field.values);
  return nullptr;
}

}  // namespace sunder
