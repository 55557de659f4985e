// The cells of a surface: connected, complete, and with the neighbours that faces have.
#include "tear/surface/surface_cells.h"

#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <numeric>
#include <set>

#include <gtest/gtest.h>

#include "support/models/make_model.h"
#include "support/models/rigs.h"
#include "tear/internal/surface.h"

namespace sunder {
namespace {

using test::Random;

/// All faces of a node.
std::vector<Index> faces_of(const tear::SurfaceCells& cells, Index node) {
  if (cells.is_of_faces(node)) {
    const auto faces = cells.faces(node);
    return {faces.begin(), faces.end()};
  }
  std::vector<Index> all;
  for (const Index child : cells.children(node)) {
    EXPECT_EQ(cells.parent(child), node);
    const std::vector<Index> faces = faces_of(cells, child);
    all.insert(all.end(), faces.begin(), faces.end());
  }
  return all;
}

bool are_connected(const std::vector<Index>& faces, const tear::Surface& surface) {
  const std::set<Index> wanted(faces.begin(), faces.end());
  std::set<Index> found = {faces[0]};
  std::vector<Index> open = {faces[0]};
  while (!open.empty()) {
    const Index face = open.back();
    open.pop_back();
    for (Index h = 3 * face; h < 3 * face + 3; ++h)
      if (surface.twin[h] != kNone && wanted.count(surface.twin[h] / 3) != 0 &&
          found.insert(surface.twin[h] / 3).second)
        open.push_back(surface.twin[h] / 3);
  }
  return found == wanted;
}

/// Faces of the level on which a node is, by node.
void expect_cells(const Character& character) {
  const TornModel model = test::make_model(character);
  const tear::Surface& surface = model.surface();
  const Index count = surface.triangle_count();
  std::vector<float> areas(count);
  std::iota(areas.begin(), areas.end(), 1.0f);
  const tear::SurfaceCells cells(surface.twin, areas);
  ASSERT_EQ(cells.face_count(), count);
  std::vector<Index> seen(count, 0);
  for (Index face = 0; face < count; ++face)
    EXPECT_EQ(cells.faces(cells.cell_of(face))[cells.place_of(face)], face);
  for (Index node = 0; node < cells.node_count(); ++node) {
    const std::vector<Index> faces = faces_of(cells, node);
    ASSERT_FALSE(faces.empty());
    EXPECT_TRUE(are_connected(faces, surface)) << node;
    EXPECT_EQ(cells.face_count(node), faces.size());
    double area = 0;
    for (const Index face : faces) area += static_cast<double>(areas[face]);
    EXPECT_NEAR(cells.area(node), area, 1e-4 * area);
    if (cells.is_of_faces(node)) {
      EXPECT_LE(faces.size(), tear::SurfaceCells::kMostFaces);
      for (const Index face : faces) ++seen[face];
    } else {
      EXPECT_LE(cells.children(node).size(), tear::SurfaceCells::kMostChildren);
    }
    // Neighbours are the nodes beyond the edges, each once.
    const std::set<Index> within(faces.begin(), faces.end());
    std::set<Index> beyond, told;
    for (const Index face : faces)
      for (Index h = 3 * face; h < 3 * face + 3; ++h)
        if (surface.twin[h] != kNone && within.count(surface.twin[h] / 3) == 0)
          beyond.insert(surface.twin[h] / 3);
    for (const Index other : cells.neighbours(node)) {
      EXPECT_TRUE(told.insert(other).second);
      EXPECT_EQ(cells.is_of_faces(other), cells.is_of_faces(node));
      const std::vector<Index> of_other = faces_of(cells, other);
      EXPECT_TRUE(std::any_of(of_other.begin(), of_other.end(),
                              [&](Index face) { return beyond.erase(face) == 1; }));
      for (const Index face : of_other) beyond.erase(face);
    }
    EXPECT_TRUE(beyond.empty());
    EXPECT_EQ(cells.parent(node) == kNone, cells.neighbours(node).empty());
  }
  EXPECT_EQ(std::count(seen.begin(), seen.end(), 1u), count);
}

TEST(SurfaceCells, of_a_tube) { expect_cells(test::make_tube(20, 16, 3)); }

TEST(SurfaceCells, of_meshes_that_share_points) { expect_cells(test::make_two_tubes(8, 12)); }

TEST(SurfaceCells, of_a_ball) { expect_cells(test::make_bumpy_ball(800)); }

TEST(SurfaceCells, of_soups) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    expect_cells(test::make_soup(random));
  }
}

TEST(SurfaceCells, are_small) {
  const TornModel model = test::make_model(test::make_bumpy_ball(3000));
  const Index count = model.surface().triangle_count();
  const tear::SurfaceCells cells(model.surface().twin, std::vector<float>(count, 1.0f));
  EXPECT_LT(cells.bytes(), 16 * std::size_t{count});
}

TEST(SurfaceCells, of_nothing) {
  const tear::SurfaceCells cells({}, {});
  EXPECT_EQ(cells.face_count(), 0u);
  EXPECT_EQ(cells.node_count(), 0u);
}

}  // namespace
}  // namespace sunder
