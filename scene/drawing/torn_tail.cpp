#include "scene/drawing/torn_tail.h"

#include <algorithm>

namespace sunder::scene {
namespace {

/// The elements of an array from `first` on; nothing of an absent one.
void copy_tail(const std::vector<Vec3f>& all, Index first, Index from, std::vector<Vec3f>& tail) {
  if (all.empty()) return;
  tail.resize(from - first);
  tail.insert(tail.end(), all.begin() + from, all.end());
}

}  // namespace

void TornTail::update(const Mesh& mesh, const InfluencePositions& exact, Index first_changed) {
  const Index from = std::max(first_, std::min(first_changed, mesh.vertex_count()));
  weights_.first.resize(std::min<std::size_t>(weights_.first.size(), from - first_ + 1));
  weights_.influences.resize(weights_.first.back());
  for (Index v = first_ + weights_.vertex_count(); v < mesh.vertex_count(); ++v)
    weights_.append(mesh.weights.of(v));
  morph_targets_.resize(mesh.morph_targets.size());
  for (std::size_t t = 0; t < morph_targets_.size(); ++t) {
    const MorphTarget& of = mesh.morph_targets[t];
    MorphTarget& tail = morph_targets_[t];
    const Index kept =
        std::min<Index>(from, first_ + static_cast<Index>(std::max({tail.position_deltas.size(),
                                                                    tail.normal_deltas.size(),
                                                                    tail.tangent_deltas.size()})));
    copy_tail(of.position_deltas, first_, kept, tail.position_deltas);
    copy_tail(of.normal_deltas, first_, kept, tail.normal_deltas);
    copy_tail(of.tangent_deltas, first_, kept, tail.tangent_deltas);
  }
  if (exact_.vertices.empty() && exact.vertices.empty()) return;
  exact_ = exact;
  for (Index& vertex : exact_.vertices) vertex -= first_;
}

VertexSource TornTail::source(const Mesh& mesh) const {
  VertexSource source;
  source.vertex_count = weights_.vertex_count();
  source.positions.data = mesh.positions[first_].data();
  source.normals.data = mesh.normals.empty() ? nullptr : mesh.normals[first_].data();
  source.tangents.data = mesh.tangents.empty() ? nullptr : mesh.tangents[first_].data();
  source.weights = &weights_;
  source.morph_targets = morph_targets_;
  source.first_morph_weight = mesh.first_morph_weight;
  if (!exact_.vertices.empty()) source.per_influence = &exact_;
  return source;
}

}  // namespace sunder::scene
