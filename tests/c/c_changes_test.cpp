// What C programs are told of the changes by each command.

#include <algorithm>

#include "c/c_twins.h"

namespace sunder::test {
namespace {

std::span<const sunder_result> results_of(const Twins& twins) {
  const sunder_result* results = nullptr;
  std::uint32_t count = 0;
  EXPECT_DONE(sunder_get_results(twins.c_scene, &results, &count));
  return {results, count};
}

std::uint32_t change_count(const Twins& twins, sunder_command command) {
  std::uint32_t count = 0;
  EXPECT_DONE(sunder_get_change_count(twins.c_scene, command, &count));
  return count;
}

sunder_change change_of(const Twins& twins, sunder_command command, std::uint32_t which) {
  sunder_change change = {};
  change.struct_size = sizeof change;
  EXPECT_DONE(sunder_get_change(twins.c_scene, command, which, &change));
  return change;
}

sunder_mesh_change mesh_change_of(const Twins& twins, sunder_command command, std::uint32_t which,
                                  std::uint32_t part) {
  sunder_mesh_change change = {};
  change.struct_size = sizeof change;
  EXPECT_DONE(sunder_get_mesh_change(twins.c_scene, command, which, part, &change));
  return change;
}

void expect_numbers(const std::uint32_t* numbers, std::uint32_t count,
                    const std::vector<std::uint32_t>& expected) {
  ASSERT_EQ(count, expected.size());
  EXPECT_TRUE(std::equal(expected.begin(), expected.end(), numbers));
}

void expect_pairs(const std::uint32_t* points, std::uint32_t count,
                  const std::vector<std::array<std::uint32_t, 2>>& expected) {
  ASSERT_EQ(count, expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(points[2 * i], expected[i][0]);
    EXPECT_EQ(points[2 * i + 1], expected[i][1]);
  }
}

void expect_same(const sunder_change& change, const ChangeRecord& expected) {
  EXPECT_EQ(change.first_point, expected.first_point);
  EXPECT_EQ(change.point_count, expected.point_count);
  EXPECT_EQ(change.mesh_count, expected.meshes.size());
  std::vector<std::array<std::uint32_t, 2>> lips, welds;
  for (const LipPair& lip : expected.lips) lips.push_back({lip.left, lip.right});
  for (const WeldedPoint& weld : expected.welded) welds.push_back({weld.kept, weld.lost});
  expect_pairs(change.lips, change.lip_count, lips);
  expect_pairs(change.welds, change.weld_count, welds);
  expect_numbers(change.left, change.left_count, expected.rims.left);
  expect_numbers(change.right, change.right_count, expected.rims.right);
}

void expect_same(const sunder_mesh_change& change, const MeshChange& expected) {
  EXPECT_EQ(change.mesh, expected.mesh);
  EXPECT_EQ(change.first_vertex, expected.first_vertex);
  EXPECT_EQ(change.vertex_count, expected.vertex_count);
  EXPECT_EQ(change.first_triangle, expected.first_triangle);
  EXPECT_EQ(change.triangle_count, expected.triangle_count);
  ASSERT_EQ(change.rewritten_count, expected.rewritten.size());
  for (std::size_t i = 0; i < expected.rewritten.size(); ++i) {
    EXPECT_EQ(change.rewritten[i].place, expected.rewritten[i].triangle);
    EXPECT_TRUE(std::equal(expected.rewritten[i].before.begin(), expected.rewritten[i].before.end(),
                           change.rewritten[i].vertices));
  }
  expect_numbers(change.retired, change.retired_count, expected.retired);
  expect_numbers(change.released, change.released_count, expected.released);
  expect_numbers(change.returned, change.returned_count, expected.returned);
  EXPECT_EQ(change.dirty_vertex_count, expected.dirty_vertices.size());
  EXPECT_EQ(change.dirty_triangle_count, expected.dirty_triangles.size());
}

/// Copies the triangles that a change names, as a program that keeps a mesh of its own does.
void follow(const sunder_mesh_change& change, const sunder_mesh& torn,
            std::vector<std::uint32_t>& triangles) {
  triangles.resize(3 * std::size_t{change.first_triangle + change.triangle_count});
  for (std::uint32_t i = 0; i < change.dirty_triangle_count; ++i) {
    const sunder_range range = change.dirty_triangles[i];
    std::copy_n(torn.triangles + 3 * std::size_t{range.first}, 3 * std::size_t{range.count},
                triangles.begin() + 3 * std::ptrdiff_t{range.first});
  }
}

TEST(CChanges, are_those_of_the_library_and_keep_a_copy_of_the_mesh) {
  Random random(31);
  Twins twins(make_tube(24, 12, 6));
  twins.update();
  const Mesh& source = twins.asset->character()->meshes[0];
  std::vector<std::uint32_t> own;
  for (const Triangle& triangle : source.triangles)
    own.insert(own.end(), triangle.begin(), triangle.end());
  std::size_t changes = 0, lips = 0, rims = 0, welds = 0, retired = 0;
  for (int frame = 0; frame < 60; ++frame) {
    submit_random(twins, random);
    twins.update();
    const auto expected = twins.scene->results();
    const auto results = results_of(twins);
    ASSERT_EQ(results.size(), expected.size());
    sunder_mesh torn = {};
    EXPECT_DONE(sunder_get_instance_mesh(twins.c_scene, twins.c_id, 0, &torn));
    for (std::size_t r = 0; r < results.size(); ++r) {
      const sunder_command command = results[r].command;
      ASSERT_EQ(change_count(twins, command), expected[r].changes.size());
      for (std::uint32_t i = 0; i < expected[r].changes.size(); ++i) {
        const ChangeRecord& record = expected[r].changes[i];
        const sunder_change change = change_of(twins, command, i);
        expect_same(change, record);
        for (std::uint32_t part = 0; part < record.meshes.size(); ++part) {
          const sunder_mesh_change of_mesh = mesh_change_of(twins, command, i, part);
          expect_same(of_mesh, record.meshes[part]);
          follow(of_mesh, torn, own);
          retired += of_mesh.retired_count;
        }
        ++changes;
        lips += change.lip_count;
        rims += change.left_count;
        welds += change.weld_count;
      }
    }
    ASSERT_EQ(own.size(), 3 * std::size_t{torn.triangle_count});
    ASSERT_TRUE(std::equal(own.begin(), own.end(), torn.triangles)) << frame;
  }
  EXPECT_GT(changes, 30u);
  EXPECT_GT(lips, 50u);
  EXPECT_GT(rims, 10u);
  EXPECT_GT(welds, 5u);
  EXPECT_GT(retired, 10u);
}

TEST(CChanges, scars_are_the_edges_that_a_weld_closed) {
  Random random(32);
  Twins twins(make_tube(24, 12, 6), false);
  twins.update();
  const sunder_weld all = sunder_default_weld();
  std::size_t found = 0;
  for (int frame = 0; frame < 12; ++frame) {
    submit_random(twins, random);
    EXPECT_DONE(sunder_submit_weld(twins.c_scene, twins.c_id, &all, 0, nullptr));
    ASSERT_TRUE(twins.scene->submit(twins.id, Weld{}));
    twins.update();
    const std::uint32_t* points = nullptr;
    std::uint32_t count = 0;
    EXPECT_DONE(sunder_get_scars(twins.c_scene, twins.c_id, &points, &count));
    const auto scars = scars_of(*twins.scene->find(twins.id)->model());
    expect_pairs(points, count, {scars.begin(), scars.end()});
    found += count;
  }
  EXPECT_GT(found, 20u);
}

TEST(CChanges, are_refused_where_there_are_none) {
  Random random(33);
  Twins twins(make_tube(12, 8, 4));
  const std::uint32_t* points = nullptr;
  std::uint32_t count = 7;
  EXPECT_EQ(sunder_get_scars(twins.c_scene, twins.c_id, &points, &count), SUNDER_NOT_FOUND);
  sunder_change change = {};
  sunder_mesh_change of_mesh = {};
  const sunder_cut nowhere = [] {
    sunder_cut cut = sunder_default_cut();
    cut.normal[0] = 1;
    cut.point[0] = 1000;
    return cut;
  }();
  sunder_command command = 0;
  EXPECT_DONE(sunder_submit_cut(twins.c_scene, twins.c_id, &nowhere, 0, &command));
  twins.update();
  const std::uint32_t made = change_count(twins, command);
  EXPECT_EQ(sunder_get_change(twins.c_scene, command, made, &change), SUNDER_INDEX_OUT_OF_RANGE);
  EXPECT_EQ(sunder_last_error_index(), made);
  EXPECT_EQ(sunder_get_change_count(twins.c_scene, command + 1, &count), SUNDER_NOT_FOUND);
  EXPECT_EQ(count, 7u) << "failures write nothing";
  const sunder_command torn = [&] {
    submit_random(twins, random);
    twins.update();
    return results_of(twins)[0].command;
  }();
  EXPECT_EQ(sunder_get_change_count(twins.c_scene, command, &count), SUNDER_NOT_FOUND)
      << "of an earlier update";
  ASSERT_GT(change_count(twins, torn), 0u);
  EXPECT_EQ(sunder_get_change(twins.c_scene, torn, 0, &change), SUNDER_INVALID_STRUCT);
  EXPECT_EQ(sunder_get_change(twins.c_scene, torn, 0, nullptr), SUNDER_NULL_POINTER);
  EXPECT_EQ(sunder_get_change_count(twins.c_scene, torn, nullptr), SUNDER_NULL_POINTER);
  of_mesh.struct_size = sizeof of_mesh;
  const std::uint32_t parts = change_of(twins, torn, 0).mesh_count;
  EXPECT_EQ(sunder_get_mesh_change(twins.c_scene, torn, 0, parts, &of_mesh),
            SUNDER_INDEX_OUT_OF_RANGE);
  // A scene that was not asked to keep them.
  sunder_scene plain = 0;
  EXPECT_DONE(sunder_create_scene(nullptr, &plain));
  EXPECT_EQ(sunder_get_change_count(plain, torn, &count), SUNDER_NOT_FOUND);
  EXPECT_NE(std::string(sunder_last_error()).find("wants_changes"), std::string::npos);
  EXPECT_DONE(sunder_destroy_scene(plain));
}

}  // namespace
}  // namespace sunder::test
