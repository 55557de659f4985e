#pragma once

#include <cstdint>
#include <string>
#include <sunder_c.h>
#include <vector>

#include "bindings/godot/variant.h"

namespace sunder::godot {

/// The surfaces of an ArrayMesh as one mesh of a character: submesh i is surface i. Godot's
/// triangles run clockwise, so they are turned round.
class MeshArrays {
 public:
  /// @param slot_count  of the skin.
  /// @return what is wrong with the mesh; empty if nothing is.
  [[nodiscard]] std::string read(const Variant& mesh, std::uint32_t slot_count);

  /// A view of this object.
  [[nodiscard]] sunder_mesh mesh() const;

 private:
  [[nodiscard]] std::string read_surface(const Variant& arrays, std::int64_t surface,
                                         std::uint32_t slot_count);
  [[nodiscard]] std::string read_influences(const Variant& arrays, std::size_t vertices,
                                            std::uint32_t slot_count);

  std::vector<float> positions_, normals_, tangents_, colours_;
  std::vector<std::vector<float>> uvs_ = std::vector<std::vector<float>>(2);
  std::vector<const float*> uv_pointers_, colour_pointers_;
  std::vector<std::uint32_t> first_influence_ = {0}, triangles_, triangle_submesh_;
  std::vector<sunder_influence> influences_;
  std::vector<std::string> names_;
  std::vector<sunder_submesh> submeshes_;
};

/// The arrays of a surface: one submesh of a torn mesh with the vertices that it uses. Without a
/// triangle it has one of no area, because surfaces are counted: materials of later ones belong to
/// their numbers.
/// @param influences  4 or 8 per vertex; the largest, renormalised.
[[nodiscard]] Variant surface_arrays(const sunder_mesh& mesh, std::uint32_t submesh,
                                     std::uint32_t influences);

/// The most influences of a vertex.
[[nodiscard]] std::uint32_t most_influences(const sunder_mesh& mesh);

}  // namespace sunder::godot
