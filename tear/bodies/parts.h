#pragma once

#include <sunder/core/mesh.h>

#include <span>
#include <vector>

namespace sunder::bodies {

struct Part {
  std::uint32_t number = kNone;         ///< Of those that were joined, the one of the largest area.
  std::vector<std::uint32_t> vertices;  ///< Of its triangles, ascending.
};

/// The parts of a surface. While there are more than `most`, the one with the least area joins the
/// part with which it shares most places; one that shares none joins the part with the nearest
/// centroid.
/// @return ascending by number. Deterministic. @throws std::bad_alloc
[[nodiscard]] std::vector<Part> join_parts(std::span<const Vec3d> positions,
                                           std::span<const Triangle> triangles,
                                           std::span<const std::uint32_t> part_of_triangle,
                                           std::uint32_t most);

}  // namespace sunder::bodies
