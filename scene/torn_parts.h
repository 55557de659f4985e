#pragma once

#include <sunder/scene/character_asset.h>
#include <sunder/tear/tear_stroke.h>

#include <memory>
#include <optional>

namespace sunder::scene {

/// The tissue of an asset at rest, from which that of instances is copied.
struct TissueAtRest {
  std::unique_ptr<ParticleSet> particles;
  SoftBody body;  // refers to the particles
};

/// The parts of an instance that is torn, or is about to be.
struct TornParts {
  explicit TornParts(TornModel made) : model(std::move(made)) {}

  /// Copies a body at rest. @param asset  that of its particles.
  /// @return as ParticleSet::create(). @throws std::bad_alloc
  Status make_soft(const TissueAtRest& tissue, const std::shared_ptr<const ParticleAsset>& asset);
  /// Takes a set, and a body that was made of it.
  void take(std::unique_ptr<ParticleSet> set, SoftBody made);

  TornModel model;
  std::optional<TearStroke> stroke;  // refers to the model
  std::unique_ptr<ParticleSet> particles;
  std::optional<SoftBody> body;  // refers to the particles
};

/// The tissue of an asset. @return as the create() of ParticleSet and SoftBody.
/// @throws std::bad_alloc
[[nodiscard]] Result<TissueAtRest> make_tissue(const SoftTissue& soft, const TornModel& untorn,
                                               std::shared_ptr<const ParticleAsset> asset);

/// A body of a set, at rest. @throws std::bad_alloc
[[nodiscard]] Result<SoftBody> make_body(const SoftTissue& soft, const Character& source,
                                         ParticleSet& set);

}  // namespace sunder::scene
