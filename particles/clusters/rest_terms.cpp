#include "particles/clusters/rest_terms.h"

#include <algorithm>

#include "tear/internal/surface.h"

namespace sunder::particles {
namespace {

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

void RestOfVertex::set(const TornModel& model, std::span<const Index> first_slot,
                       const VertexRef& of) {
  terms_.clear();
  morph_terms_.clear();
  for_each_rest_term(
      model, first_slot, of,
      [&](Index slot, const Vec4d& term) {
        terms_.push_back({slot, term});
      },
      [&](Index morph_weight, Index slot, const Vec3d& term) {
        morph_terms_.push_back({morph_weight, slot, term});
      });
}

void RestOfVertex::add_to(Particle& particle, double sign) {
  places_.resize(terms_.size(), 0);
  for (std::size_t i = 0; i < terms_.size(); ++i) {
    // Usually the previous particle had the same bone at this place.
    if (places_[i] >= particle.terms.size() || particle.terms[places_[i]].slot != terms_[i].slot) {
      places_[i] = 0;
      while (places_[i] < particle.terms.size() &&
             particle.terms[places_[i]].slot != terms_[i].slot)
        ++places_[i];
      if (places_[i] == particle.terms.size())
        particle.terms.push_back({terms_[i].slot, Vec4d(Vec4d::Zero())});
    }
    particle.terms[places_[i]].sum += sign * terms_[i].sum;
  }
  for (const RestMorphTerm& term : morph_terms_)
    add(particle.morph_terms, term.morph_weight, term.slot, sign * term.sum);
}

RestSums::RestSums(const TornModel& model, std::span<const Index> first_slot,
                   std::span<const VertexRef> vertices)
    : model_(model), first_slot_(first_slot), vertices_(vertices), of_slot_(first_slot.back()) {
  for (Index m = 0; m < model.character().meshes.size(); ++m) {
    const Mesh& mesh = model.character().meshes[m];
    const bool is_plain =
        mesh.morph_targets.empty() && model.influence_positions(m).vertices.empty();
    meshes_.push_back({&mesh, first_slot[mesh.skin], is_plain});
  }
}

void RestSums::sum(std::span<const Index> members, Particle& particle) {
  particle.terms.clear();
  particle.morph_terms.clear();
  const auto of_slot = [&](Index slot) -> OfSlot& {
    OfSlot& of = of_slot_[slot];
    if (!of.is_listed) slots_.push_back(slot);
    of.is_listed = true;
    return of;
  };
  for (const Index point : members) {
    const VertexRef& of = vertices_[point];
    const OfMesh& of_mesh = meshes_[of.mesh];
    if (!of_mesh.is_plain) {
      for_each_rest_term(
          model_, first_slot_, of,
          [&](Index slot, const Vec4d& term) { of_slot(slot).sum += term; },
          [&](Index morph_weight, Index slot, const Vec3d& term) {
            add(particle.morph_terms, morph_weight, slot, term);
          });
      continue;
    }
    const Vec3f& at = of_mesh.mesh->positions[of.vertex];
    const Eigen::Vector4d one = Eigen::Vector4f(at.x(), at.y(), at.z(), 1.0f).cast<double>();
    for (const Influence& influence : of_mesh.mesh->weights.of(of.vertex))
      of_slot(of_mesh.first_slot + influence.slot).sum += double{influence.weight} * one;
  }
  std::sort(slots_.begin(), slots_.end());
  particle.terms.reserve(slots_.size());
  for (const Index slot : slots_) {
    particle.terms.push_back({slot, of_slot_[slot].sum});
    of_slot_[slot] = {};
  }
  slots_.clear();
}

}  // namespace sunder::particles
