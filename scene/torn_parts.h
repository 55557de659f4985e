#pragma once

#include <sunder/scene/character_asset.h>
#include <sunder/tear/tear_stroke.h>

#include <optional>

namespace sunder::scene {

/// What an instance has once it is torn, or is about to be.
struct TornParts {
  explicit TornParts(TornModel made) : model(std::move(made)) {}

  /// Divides the surface into particles, and makes a body at rest of them.
  /// @return as the create() of ParticleSet and SoftBody. @throws std::bad_alloc
  Status make_soft(const SoftTissue& soft);

  TornModel model;
  std::optional<TearStroke> stroke;  // refers to the model
  std::optional<ParticleSet> particles;
  std::optional<SoftBody> body;  // refers to the particles
};

}  // namespace sunder::scene
