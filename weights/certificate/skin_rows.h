#pragma once

#include <sunder/certificate/certificate.h>

#include <span>
#include <vector>

namespace sunder::certificate {

/// Faults of a mesh of a character, and of one of its vertices, that append_difference() names.
[[nodiscard]] Status check_mesh(const Character& character, const ModelPose& bind,
                                std::uint32_t mesh);
[[nodiscard]] Status check_vertex(const Character& character, std::uint32_t mesh,
                                  std::uint32_t vertex);

/// Adds share * (posed point) to `terms`, one per influence; the weights are divided by their sum.
void add_point(const Skin& skin, const ModelPose& bind, const Vec3d& position,
               std::span<const Influence> influences, double share, std::vector<SkinTerm>& terms);

/// Sorts by bone, adds the terms of a bone in the order given and drops those that are zero.
void merge_terms(std::vector<SkinTerm>& terms);

}  // namespace sunder::certificate
