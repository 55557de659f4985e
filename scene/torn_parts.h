#pragma once

#include <sunder/scene/character_asset.h>
#include <sunder/tear/tear_stroke.h>

#include <memory>
#include <optional>

namespace sunder::scene {

/// The parts of an instance that is torn, or is about to be.
struct TornParts {
  explicit TornParts(TornModel made) : model(std::move(made)) {}

  /// Makes a body at rest. @return as the create() of ParticleSet and SoftBody.
  Status make_soft(const SoftTissue& soft, const std::shared_ptr<const ParticleAsset>& asset);
  /// Makes a body of a set.
  Status make_body(const SoftTissue& soft, ParticleSet set);

  TornModel model;
  std::optional<TearStroke> stroke;  // refers to the model
  std::unique_ptr<ParticleSet> particles;
  std::optional<SoftBody> body;  // refers to the particles
};

}  // namespace sunder::scene
