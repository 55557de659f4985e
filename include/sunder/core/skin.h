#pragma once

#include <sunder/core/api.h>
#include <sunder/core/math.h>

#include <span>
#include <string>
#include <vector>

namespace sunder {

/// The bones that move a mesh, with their transforms at the time they were attached. Several skins
/// may share bones and bind them differently.
struct Skin {
  std::string name;
  std::vector<std::uint32_t> bones;      ///< Skeleton index of each slot; influences name slots.
  std::vector<Affine3f> bone_from_bind;  ///< One a slot: inverse of the bone's transform at bind.

  bool operator==(const Skin& other) const {
    if (name != other.name || bones != other.bones ||
        bone_from_bind.size() != other.bone_from_bind.size())
      return false;
    for (std::size_t i = 0; i < bone_from_bind.size(); ++i)
      if (bone_from_bind[i].matrix() != other.bone_from_bind[i].matrix()) return false;
    return true;
  }
};

struct Influence {
  std::uint32_t slot = 0;  ///< In Skin::bones.
  float weight = 0.0f;     ///< In (0, 1].

  bool operator==(const Influence&) const = default;
};

/// The influences of a mesh's vertices, any number per vertex, back to back. A vertex has at least
/// one, no slot twice, and its weights sum to one within 2e-7 x their number.
struct SkinWeights {
  std::vector<std::uint32_t> first = {0};  ///< V + 1 offsets into `influences`.
  std::vector<Influence> influences;

  [[nodiscard]] std::uint32_t vertex_count() const {
    return static_cast<std::uint32_t>(first.size() - 1);
  }
  [[nodiscard]] std::span<const Influence> of(std::uint32_t vertex) const {
    SUNDER_ASSERT(vertex < vertex_count());
    return {influences.data() + first[vertex], first[vertex + 1] - first[vertex]};
  }
  void append(std::span<const Influence> of_new_vertex) {
    influences.insert(influences.end(), of_new_vertex.begin(), of_new_vertex.end());
    first.push_back(static_cast<std::uint32_t>(influences.size()));
  }

  bool operator==(const SkinWeights&) const = default;
};

}  // namespace sunder
