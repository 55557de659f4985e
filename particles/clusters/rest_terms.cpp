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
  const MeshVertex at = vertex_at(model, point);
  return {at.mesh, at.vertex};
}

std::vector<MeshRestTerms> rest_terms_of(const TornModel& model,
                                         std::span<const Index> first_slot) {
  std::vector<MeshRestTerms> meshes;
  meshes.reserve(model.character().meshes.size());
  for (Index m = 0; m < model.character().meshes.size(); ++m)
    meshes.emplace_back(model, first_slot, m);
  return meshes;
}

void RestChange::begin(Particle& particle) {
  particle_ = &particle;
  for (Index i = 0; i < particle.terms.size(); ++i) places_[particle.terms[i].slot] = i;
}

void RestChange::add_term(Index slot, const Vec4d& term) {
  Index& place = places_[slot];
  if (place == kNone) {
    particle_->terms.push_back({slot, Vec4d(Vec4d::Zero())});
    place = static_cast<Index>(particle_->terms.size() - 1);
  }
  particle_->terms[place].sum += term;
}

void RestChange::add(const VertexRef& vertex, double sign) {
  meshes_[vertex.mesh].for_each(
      vertex.vertex, [&](Index slot, const Vec4d& term) { add_term(slot, sign * term); },
      [&](Index morph_weight, Index slot, const Vec3d& term) {
        particles::add(particle_->morph_terms, morph_weight, slot, sign * term);
      });
}

void RestChange::replace(const tear::FormerWeights& before) {
  meshes_[before.mesh].for_each_of(
      before.vertex, before.position, before.influences,
      [&](Index slot, const Vec4d& term) { add_term(slot, -term); },
      [&](Index morph_weight, Index slot, const Vec3d& term) {
        particles::add(particle_->morph_terms, morph_weight, slot, -term);
      });
  add({before.mesh, before.vertex}, 1);
}

void RestChange::finish() {
  for (const RestTerm& term : particle_->terms) places_[term.slot] = kNone;
}

RestSums::RestSums(const TornModel& model, std::span<const Index> first_slot,
                   std::span<const VertexRef> vertices)
    : meshes_(rest_terms_of(model, first_slot)), vertices_(vertices), of_slot_(first_slot.back()) {}

void RestSums::sum(std::span<const Index> members, Particle& particle) {
  particle.terms.clear();
  particle.morph_terms.clear();
  for (const Index point : members)
    meshes_[vertices_[point].mesh].for_each(
        vertices_[point].vertex,
        [&](Index slot, const Vec4d& term) {
          OfSlot& of = of_slot_[slot];
          if (!of.is_listed) slots_.push_back(slot);
          of.is_listed = true;
          of.sum += term;
        },
        [&](Index morph_weight, Index slot, const Vec3d& term) {
          add(particle.morph_terms, morph_weight, slot, term);
        });
  std::sort(slots_.begin(), slots_.end());
  particle.terms.reserve(slots_.size());
  for (const Index slot : slots_) {
    particle.terms.push_back({slot, of_slot_[slot].sum});
    of_slot_[slot] = {};
  }
  slots_.clear();
}

}  // namespace sunder::particles
