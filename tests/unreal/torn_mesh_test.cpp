// Meshes of Unreal, as stubs, take the ranges of an instance that is torn at random: they show what
// is drawn, and only what changed is touched.

#include "samples/unreal/torn_mesh.h"

#include <algorithm>
#include <array>
#include <vector>

#include "c/c_twins.h"

namespace sunder::test {
namespace {

/// The corners of all drawn triangles, sorted.
using Soup = std::vector<std::array<double, 9>>;

Soup sorted(Soup soup) {
  std::ranges::sort(soup);
  return soup;
}

void add(const FVector& at, std::array<double, 9>& triangle, int corner) {
  triangle[3 * corner] = at.X, triangle[3 * corner + 1] = at.Y, triangle[3 * corner + 2] = at.Z;
}

/// What an instance draws, by its own index buffer.
Soup drawn(const Twins& twins, std::vector<std::uint32_t>& indices, std::uint64_t& seen) {
  sunder_posed_mesh posed = {};
  posed.struct_size = sizeof posed;
  EXPECT_DONE(sunder_get_posed_mesh(twins.c_scene, twins.c_id, 0, seen, &posed));
  if (posed.initial_triangle_count > 0)
    indices.assign(posed.initial_triangles,
                   posed.initial_triangles + 3 * posed.initial_triangle_count);
  indices.resize(3 * posed.triangle_capacity);
  for (std::uint32_t i = 0; i < posed.triangle_write_count; ++i)
    std::copy_n(posed.triangle_writes[i].vertices, 3,
                indices.begin() + 3 * posed.triangle_writes[i].place);
  seen = posed.epoch;
  Soup soup;
  for (std::uint32_t r = 0; r < posed.range_count; ++r)
    for (std::uint32_t t = 0; t < posed.ranges[r].triangle_count; ++t) {
      const std::uint32_t* const at = indices.data() + 3 * (posed.ranges[r].first_triangle + t);
      if (at[0] == at[1]) continue;
      auto& triangle = soup.emplace_back();
      for (int corner = 0; corner < 3; ++corner) {
        const float* const p = posed.positions + 3 * at[corner];
        add(FVector(100.0 * p[2], -100.0 * p[0], 100.0 * p[1]), triangle, corner);
      }
    }
  return sorted(soup);
}

Soup soup_of(const UE::Geometry::FDynamicMesh3& mesh) {
  Soup soup;
  for (const auto& [id, of] : mesh.Triangles) {
    auto& triangle = soup.emplace_back();
    int corner = 0;
    for (const int vertex : {of.A, of.B, of.C})
      add(mesh.Vertices.at(std::size_t(vertex)), triangle, corner++);
  }
  return sorted(soup);
}

Soup soup_of(const UProceduralMeshComponent& component) {
  Soup soup;
  for (const auto& [index, section] : component.Sections)
    for (int32 i = 0; i < section.Triangles.Num(); i += 3) {
      auto& triangle = soup.emplace_back();
      for (int corner = 0; corner < 3; ++corner)
        add(section.Vertices[section.Triangles[i + corner]], triangle, corner);
    }
  return sorted(soup);
}

TEST(UnrealMesh, shows_what_the_instance_draws_through_random_operations) {
  for (int seed = 0; seed < 4; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    Twins twins(make_tube(16, 12, 3));
    UE::Geometry::FDynamicMesh3 mesh;
    UProceduralMeshComponent component;
    Sunder::FTornDynamicMesh dynamic;
    Sunder::FTornSections sections;
    std::vector<std::uint32_t> indices;
    std::uint64_t seen = 0;
    for (int frame = 0; frame < 40; ++frame) {
      if (frame % 7 == 6)
        EXPECT_DONE(sunder_submit_undo(twins.c_scene, twins.c_id, nullptr));
      else if (frame % 3 == 2)
        submit_random(twins, random);
      twins.update();
      const auto posed_since = [&](std::uint64_t epoch) {
        sunder_posed_mesh posed = {};
        posed.struct_size = sizeof posed;
        EXPECT_DONE(sunder_get_posed_mesh(twins.c_scene, twins.c_id, 0, epoch, &posed));
        return posed;
      };
      const sunder_posed_mesh posed = posed_since(dynamic.Epoch());
      std::size_t dirty = 0;
      for (std::uint32_t r = 0; r < posed.dirty_vertex_count; ++r)
        dirty += posed.dirty_vertices[r].count;
      mesh.VerticesSet = mesh.TrianglesTouched = 0;
      dynamic.Update(posed, mesh);
      EXPECT_EQ(mesh.VerticesSet, dirty);
      if (frame > 0 && posed.triangle_write_count == 0) {
        EXPECT_EQ(mesh.TrianglesTouched, 0u);
      }
      sections.Update(posed_since(sections.Epoch()), 8, component);
      const Soup expected = drawn(twins, indices, seen);
      ASSERT_EQ(soup_of(component), expected) << frame;
      ASSERT_EQ(soup_of(mesh), expected) << frame;
    }
  }
}

}  // namespace
}  // namespace sunder::test
