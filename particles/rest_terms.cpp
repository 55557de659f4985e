#include "particles/rest_terms.h"

namespace sunder::particles {
namespace {

void add(std::vector<RestTerm>& terms, Index slot, const Vec4d& term) {
  for (RestTerm& known : terms)
    if (known.slot == slot) {
      known.sum += term;
      return;
    }
  terms.push_back({slot, term});
}

void add(std::vector<RestMorphTerm>& terms, Index morph_weight, Index slot, const Vec3d& term) {
  for (RestMorphTerm& known : terms)
    if (known.slot == slot && known.morph_weight == morph_weight) {
      known.sum += term;
      return;
    }
  terms.push_back({morph_weight, slot, term});
}

}  // namespace

VertexRef vertex_of(const TornModel& model, Index point) {
  const tear::Surface& surface = model.surface();
  const Index corner = surface.point_corner[point];
  if (corner == kNone) return {};
  const tear::TriangleRef ref = surface.triangle(corner / 3);
  return {ref.mesh, model.character().meshes[ref.mesh].triangles[ref.triangle][corner % 3]};
}

void add_rest_terms(const TornModel& model, const Structure& structure, const VertexRef& of, double sign, Particle& particle) {
  for_each_rest_term(
      model, structure.first_slot, of, [&](Index slot, const Vec4d& term) { add(particle.terms, slot, sign * term); },
      [&](Index morph_weight, Index slot, const Vec3d& term) { add(particle.morph_terms, morph_weight, slot, sign * term); });
}

void sum_rest_terms(const TornModel& model, const Structure& structure, std::span<const Index> members, Particle& particle) {
  particle.terms.clear();
  particle.morph_terms.clear();
  for (const Index point : members) add_rest_terms(model, structure, vertex_of(model, point), 1.0, particle);
}

}  // namespace sunder::particles
