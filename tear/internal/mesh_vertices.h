#pragma once

#include <sunder/core/mesh.h>
#include <sunder/core/status.h>

#include <array>
#include <span>

namespace sunder {

/// The barycentric mean of three corners' influences, normalised, largest first.
/// @param mean  written; has room for the influences of all three.
/// @return the number of influences.
SUNDER_API std::size_t mean_influences(const std::array<std::span<const Influence>, 3>& of_corners,
                                       const std::array<double, 3>& barycentric, Influence* mean);

/// Appends the vertex at `barycentric` between three vertices of the mesh. Position, normal,
/// tangent, texture coordinates, colours, custom attributes and morph deltas are linear in the
/// coordinates; directions are renormalised, labels come from the nearest corner. Weights are
/// mean_influences().
///
/// @return the index of the new vertex. O(attributes + influences); allocates only if an array of
/// `mesh` has to grow.
SUNDER_API std::uint32_t append_interpolated_vertex(const Triangle& corners,
                                                    const std::array<double, 3>& barycentric,
                                                    Mesh& mesh);

/// Appends a copy of `vertex`, bit for bit.
SUNDER_API std::uint32_t append_vertex_copy(std::uint32_t vertex, Mesh& mesh);

/// Gives `vertex`, the newest of `mesh`, the position, morph displacements and weights of vertex
/// `like` of `like_mesh`, bit for bit, because the two are duplicates of one surface point. Both
/// meshes have the same skin.
SUNDER_API void copy_surface_point(const Mesh& like_mesh, std::uint32_t like, std::uint32_t vertex,
                                   Mesh& mesh);

/// Whether two vertices have the same position, morph displacements and weights, bit for bit.
[[nodiscard]] SUNDER_API bool is_same_surface_point(const Mesh& mesh, std::uint32_t vertex,
                                                    const Mesh& other_mesh, std::uint32_t other);

/// Whether two vertices of a mesh differ in nothing but their value of _TEARSIDE.
[[nodiscard]] SUNDER_API bool is_same_but_for_tear_side(const Mesh& mesh, std::uint32_t vertex,
                                                        std::uint32_t other);

/// The number of vertices that can be appended before an array of `mesh`, other than the
/// influences, has to grow.
[[nodiscard]] SUNDER_API std::size_t room_for_vertices(const Mesh& mesh);

/// Gives all arrays room for `vertex_count` more vertices with `influence_count` more influences in
/// all.
SUNDER_API void reserve_vertices(std::size_t vertex_count, std::size_t influence_count, Mesh& mesh);

/// Vertices, and influences of them all, that fit into a mesh without moving its arrays.
struct VertexRoom {
  std::size_t vertices = 0, influences = 0;
};

/// A copy with room for more vertices and triangles, without copying twice.
[[nodiscard]] SUNDER_API Mesh copy_with_room(const Mesh& mesh, const VertexRoom& room,
                                             std::size_t triangle_count);

/// Removes the newest vertices, down to `vertex_count`.
SUNDER_API void remove_vertices_from(std::uint32_t vertex_count, Mesh& mesh);

/// Makes the vertices of `tail` copies of those from `first_vertex` on. The memory of `tail` is
/// reused; its triangles and submeshes stay as they are.
SUNDER_API void copy_vertices_from(std::uint32_t first_vertex, const Mesh& mesh, Mesh& tail);

/// Gives `vertex`, the newest of `mesh`, another bind position and other influences.
SUNDER_API void set_position_and_influences(const Vec3f& position,
                                            std::span<const Influence> influences,
                                            std::uint32_t vertex, Mesh& mesh);

/// Appends all vertices of `tail`, which has the same attributes.
SUNDER_API void append_vertices(const Mesh& tail, Mesh& mesh);

}  // namespace sunder
