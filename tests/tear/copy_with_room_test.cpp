// What a model copies of its asset is equal to it, and has the room that is reserved afterwards.
#include "tear/surface/copy_with_room.h"

#include <gtest/gtest.h>

#include "support/models/random_operations.h"
#include "tear/surface/surface_editor.h"

namespace sunder::tear {
namespace {

using test::Random;

/// Where the long arrays of a model are.
std::vector<const void*> places(const SurfaceEditor& editor) {
  const Surface& surface = editor.surface();
  std::vector<const void*> places = {surface.corner_point.data(), surface.twin.data(),
                                     surface.point_corner.data()};
  for (const Mesh& mesh : editor.character().meshes)
    places.insert(places.end(), {mesh.positions.data(), mesh.normals.data(), mesh.tangents.data(),
                                 mesh.weights.first.data(), mesh.weights.influences.data(),
                                 mesh.triangles.data(), mesh.triangle_submesh.data()});
  return places;
}

TEST(copy_with_room, is_equal_and_does_not_move_when_memory_is_reserved) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const Character source = test::random_character(random);
    const Surface surface = build_surface(source);
    const TornCapacity capacities[] = {{}, {50, 100, 7}, {50, 100, kNone}};
    for (const TornCapacity& capacity : capacities) {
      Character character = copy_with_room(source, capacity);
      ASSERT_EQ(character, source);
      Surface copy = copy_with_room(surface, capacity, source.meshes.size());
      ASSERT_EQ(copy.corner_point, surface.corner_point);
      ASSERT_EQ(copy.twin, surface.twin);
      ASSERT_EQ(copy.point_corner, surface.point_corner);
      ASSERT_EQ(copy.first_triangle, surface.first_triangle);
      ASSERT_EQ(copy.source_side, surface.source_side);
      ASSERT_EQ(copy.is_shared_vertex, surface.is_shared_vertex);
      ASSERT_EQ(copy.largest_coordinate, surface.largest_coordinate);
      ASSERT_EQ(copy.cracks, surface.cracks);
      ASSERT_EQ(copy.non_manifold_edges, surface.non_manifold_edges);
      ASSERT_EQ(copy.non_manifold_half_edges, surface.non_manifold_half_edges);
      SurfaceEditor editor(source, character, std::move(copy), capacity);
      const std::vector<const void*> before = places(editor);
      editor.reserve(capacity);
      ASSERT_EQ(places(editor), before);
      ASSERT_EQ(character, source);
    }
  }
}

}  // namespace
}  // namespace sunder::tear
