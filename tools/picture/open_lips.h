#pragma once

#include <sunder/operation/operation.h>
#include <sunder/scene/character_instance.h>

#include <memory>
#include <span>
#include <vector>

#include "tools/model/posed_model.h"

namespace sunder::tools {

constexpr double kPictureStep = 1.0 / 60;  ///< Seconds per step of the tissue in pictures.

/// The lips that one operation parted.
struct Wound {
  std::vector<LipPair> lips;  ///< Points.
  double length = 0;          ///< Metres, posed; 0 of a cut, whose lips may gape as they will.
};

/// A torn character of soft tissue under a tension that pulls its lips apart. Its share in each
/// wound is chosen such that the wound gapes by a share of its length, or less where the body is
/// thin; see choose_tensions().
struct GapingModel {
  CharacterInstance instance;       ///< Closed yet: no time has passed.
  std::vector<Wound> wounds;        ///< Those with lips.
  std::vector<TearReport> reports;  ///< One per operation.
  Tension tension;
};

/// @param history  operations that are valid for the character.
/// @param pose     in which the tension is chosen, for uniform tissue.
/// @param authored  the fields of the tissue that gapes under it; empty: uniform.
/// @return the first failure of an operation; as validate_authored_tissue().
[[nodiscard]] Result<GapingModel> make_gaping_model(std::shared_ptr<const Character> character,
                                                    std::span<const Operation> history,
                                                    const ModelPose& pose,
                                                    const AuthoredTissue& authored = {});

/// The lips that the changes by one operation list.
[[nodiscard]] Wound wound_of(std::span<const ChangeRecord> changes);

/// Steps the tissue in one pose until nothing moves, or for three seconds.
[[nodiscard]] Status open_lips(CharacterInstance& instance, const ModelPose& pose);

/// The greatest distance between two points of a wound that were one.
[[nodiscard]] double widest_gap(const CharacterInstance& instance, const Wound& wound);

/// The vertices of the last draw(), in model space.
[[nodiscard]] std::vector<DeformedMesh> drawn(CharacterInstance& instance);

/// Moves posed vertices by the displacements of the last draw(), with mend_normals().
void displace(CharacterInstance& instance, std::vector<DeformedMesh>& posed);

}  // namespace sunder::tools
