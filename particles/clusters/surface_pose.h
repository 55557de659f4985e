#pragma once

#include <sunder/tear/torn_model.h>

#include <span>
#include <vector>

#include "core/internal/ordered.h"
#include "particles/clusters/rest_terms.h"

namespace sunder::particles {

/// A pose of the surface, in double: the one definition of the positions of points and particles in
/// a pose. Both are sums of the terms of MeshRestTerms: for a point those of its vertex, for
/// a particle those of its members, which are added up in advance.
class SurfacePose {
 public:
  /// Makes room for the slots of a character's skins and for its morph weights. O(slots),
  /// allocates.
  void begin(std::span<const Skin> skins, std::size_t morph_weights);
  /// Sets the pose; no allocation.
  /// @param skins  those of begin().
  /// @return as compute_palette(). O(slots).
  [[nodiscard]] Status set(std::span<const Skin> skins, const ModelPose& pose);

  /// Per skin, the index of its first slot; the total at the end.
  [[nodiscard]] std::span<const Index> first_slots() const { return first_slots_; }
  [[nodiscard]] const Affine3d& model_from_bind(Index slot) const { return palette_[slot]; }

  [[nodiscard]] Vec3d posed(Index slot, const Vec4d& term) const {
    return multiply(palette_[slot].matrix(), term);
  }
  [[nodiscard]] Vec3d posed_morph(Index morph_weight, Index slot, const Vec3d& term) const {
    return double{morph_weights_[morph_weight]} * multiply(palette_[slot].linear(), term);
  }
  /// Position of a particle in the pose. O(bones of its members).
  [[nodiscard]] ParticleRest rest(const Particle& particle) const;
  /// Position of a point in the pose: metres, model space. Zero for a point without a face.
  /// O(influences of the point).
  [[nodiscard]] Vec3d place(const TornModel& model, Index point) const;
  /// The same for a vertex.
  [[nodiscard]] Vec3d place(const TornModel& model, const VertexRef& of) const;
  /// Unit normal of the posed surface at a point that has a face; zero if the faces around it have
  /// no area.
  [[nodiscard]] Vec3d normal(const TornModel& model, Index point) const;

 private:
  std::vector<Index> first_slots_ = {0};
  std::vector<Affine3d> palette_;  ///< Of all slots.
  std::vector<float> morph_weights_;
};

}  // namespace sunder::particles
