// Which faces have an inside: tools/picture/enclosing_faces.h.

#include "tools/picture/enclosing_faces.h"

#include <sunder/skinning/pose.h>

#include <algorithm>

#include <gtest/gtest.h>

#include "support/models/rigs.h"

namespace sunder::tools {
namespace {

/// A closed tube along y, and a sheet that stands beside it and faces away from it or towards it.
Character tube_and_sheet(bool faces_away) {
  Character character = test::make_tube(24, 16, 3);
  Mesh sheet = test::make_sheet(4).meshes[0];
  Mesh& tube = character.meshes[0];
  float farthest = 0;
  for (const Vec3f& position : tube.positions) farthest = std::max(farthest, position.z());
  for (Vec3f& position : sheet.positions) position += Vec3f(-0.5f, 1, farthest + 0.1f);
  if (!faces_away)
    for (Triangle& triangle : sheet.triangles) std::swap(triangle[0], triangle[1]);
  character.meshes.push_back(std::move(sheet));
  return character;
}

std::size_t enclosing(const std::vector<bool>& faces) {
  return static_cast<std::size_t>(std::ranges::count(faces, true));
}

TEST(EnclosingFaces, are_those_of_a_body_and_not_of_a_sheet_beside_it) {
  for (const bool faces_away : {true, false}) {
    const Character character = tube_and_sheet(faces_away);
    std::vector<DeformedMesh> posed(2);
    for (std::size_t m = 0; m < 2; ++m) posed[m].positions = character.meshes[m].positions;
    const auto faces = enclosing_faces(character, posed);
    ASSERT_EQ(faces.size(), 2u);
    EXPECT_EQ(enclosing(faces[0]), character.meshes[0].triangles.size());
    EXPECT_EQ(enclosing(faces[1]), 0u);
  }
}

TEST(EnclosingFaces, see_the_inside_through_a_wound) {
  Character character = test::make_tube(24, 16, 3);
  std::vector<Triangle>& triangles = character.meshes[0].triangles;
  for (std::size_t t = 40; t < 44; ++t) triangles[t] = {0, 0, 0};  // retired
  std::vector<DeformedMesh> posed(1);
  posed[0].positions = character.meshes[0].positions;
  const auto faces = enclosing_faces(character, posed);
  EXPECT_GE(enclosing(faces[0]) + 8, triangles.size());
  for (std::size_t t = 40; t < 44; ++t) EXPECT_FALSE(faces[0][t]);
}

}  // namespace
}  // namespace sunder::tools
