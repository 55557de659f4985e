#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/aim/limb.h"

namespace sunder::aim {

/// A connected run of faces that a plane crosses.
struct Section {
  struct Line {
    Index face = 0;
    std::array<Vec3d, 2> ends = {Vec3d(Vec3d::Zero()), Vec3d(Vec3d::Zero())};
  };
  std::vector<Line> lines;
  double length = 0;
  bool is_closed = true;         ///< Whether it ends nowhere at a border.
  LimbShares shares;             ///< Mean over the length.
  double turns = 0;              ///< How often it winds round the place on the bone.
  Vec3d middle = Vec3d::Zero();  ///< Mean over the length.
};

/// A plane through the limb: normal . p = offset.
struct LimbPlane {
  Vec3d normal = Vec3d::Zero();
  double offset = 0;
};

/// All sections of the posed surface with a plane. O(faces + crossed faces x log).
[[nodiscard]] std::vector<Section> sections_of(const Limb& limb, const LimbPlane& plane);

/// Whether a section winds round the place on the bone.
[[nodiscard]] bool is_round_bone(const Section& section);
/// The least distance of a place from a section's lines.
[[nodiscard]] double distance(const Vec3d& place, const Section& section);

/// Those of some sections that belong to the limb: loops round the bone that are moved by the bone,
/// its subtree and, near the joint, its parent; and others on or inside those, such as the linings
/// and plates of a sleeve, that the bone itself moves. Neither a club held in the fist nor a skirt
/// round both legs. Where none goes round the bone, the nearest section that the bone moves.
[[nodiscard]] std::vector<Section> sections_of_limb(const Limb& limb,
                                                    std::vector<Section> sections);

/// Why none of the sections is of the limb: the bones that move what is there instead.
[[nodiscard]] std::string other_movers(const Limb& limb, const std::vector<Section>& sections);

/// "; at 0.65 it has a section of its own", or an empty text.
[[nodiscard]] std::string proposal(const std::optional<double>& share);

/// The sections with a plane that belong to the limb, at least one on its body or round its bone.
/// @return never empty; not_found, which says why and names the nearest share of the bone at which
///         the limb has a section.
[[nodiscard]] Result<std::vector<Section>> limb_sections(const Limb& limb, const LimbPlane& plane);

}  // namespace sunder::aim
