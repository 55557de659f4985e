// Cracks of a source: edges whose two sides coincide in bind space and have different weights.
// Tears across them leave a surface that is closed in bind space closed there.
#include <sunder/skinning/pose.h>
#include <sunder/tear/tear_stroke.h>
#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <array>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/machine/say.h"
#include "support/machine/stress.h"
#include "support/models/hard_operations.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"
#include "support/oracles/torn_invariants.h"
#include "tear/internal/surface.h"
#include "tear/surface/mesh_vertices.h"

namespace sunder {
namespace {

using test::Random;
using testing::IsEmpty;

/// Gives the triangles on one side of a plane vertices of their own, with other weights: the
/// surface cracks along the plane when bones move.
void crack(Character& character, Random& random) {
  Mesh& mesh = character.meshes[0];
  const Vec3f normal = random.direction().cast<float>(),
              point = mesh.positions[random.index(mesh.vertex_count())];
  std::map<std::uint32_t, std::uint32_t> copies;
  std::vector<bool> stays(mesh.vertex_count(), false);
  const auto is_beyond = [&](const Triangle& t) {
    return normal.dot(mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]] -
                      3 * point) > 0;
  };
  std::vector<bool> beyond;
  for (const Triangle& t : mesh.triangles) beyond.push_back(is_beyond(t));
  for (std::size_t i = 0; i < beyond.size(); ++i)
    for (const std::uint32_t v : mesh.triangles[i]) stays[v] = stays[v] || !beyond[i];
  // Vertices in the same place are copied together.
  std::map<std::array<float, 3>, bool> stays_at;
  const auto place = [&](std::uint32_t v) {
    const Vec3f& at = mesh.positions[v];
    return std::array{at.x(), at.y(), at.z()};
  };
  for (std::uint32_t v = 0; v < stays.size(); ++v) stays_at[place(v)] |= stays[v];
  for (std::size_t i = 0; i < beyond.size(); ++i)
    for (std::uint32_t& v : mesh.triangles[i])
      if (beyond[i] && stays_at[place(v)]) {
        const auto [known, is_new] = copies.emplace(v, mesh.vertex_count());
        if (is_new) {
          const std::uint32_t copy = append_vertex_copy(v, mesh);
          const std::uint32_t slot =
              random.index(static_cast<std::uint32_t>(character.skins[mesh.skin].bones.size()));
          mesh.weights.influences.resize(mesh.weights.first[copy]);
          mesh.weights.influences.push_back({static_cast<std::uint16_t>(slot), 1.0f});
          mesh.weights.first.back() = static_cast<std::uint32_t>(mesh.weights.influences.size());
        }
        v = known->second;
      }
}

/// Edges of the bind surface, welded by position alone, whose faces do not match.
std::vector<std::string> unmatched_edges(const Character& character) {
  using Place = std::array<float, 3>;
  std::map<std::array<Place, 2>, int> balance;
  for (const Mesh& mesh : character.meshes)
    for (const Triangle& t : mesh.triangles) {
      if (is_retired(t)) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto place = [&](std::uint32_t v) {
          const Vec3f& at = mesh.positions[v];
          return Place{at.x() + 0.0f, at.y() + 0.0f, at.z() + 0.0f};
        };
        const Place a = place(t[k]), b = place(t[(k + 1) % 3]);
        if (a < b)
          ++balance[{a, b}];
        else
          --balance[{b, a}];
      }
    }
  std::vector<std::string> open;
  for (const auto& [edge, count] : balance)
    if (count != 0)
      open.push_back(test::say(edge[0][0], " ", edge[0][1], " ", edge[0][2], " to ", edge[1][0],
                               " ", edge[1][1], " ", edge[1][2], ": ", count));
  return open;
}

Character closed_body(Random& random) {
  if (random.index(2) == 0) return test::make_bumpy_ball(50 + random.index(300));
  const std::uint32_t rings = 2 + random.index(12), sides = 3 + random.index(10);
  return test::make_tube(rings, sides, 2 + random.index(4));
}

Character cracked_body(Random& random) {
  Character character = closed_body(random);
  for (std::uint32_t n = 1 + random.index(3); n > 0; --n) crack(character, random);
  return character;
}

/// A tear without width through one layer or all, or a cut.
Operation opening(const TornModel& model, Random& random) {
  const double angle = random.index(3) == 0 ? 0.0 : 0.5;  // at bind the sides coincide
  if (random.index(3) == 0) {
    CutOperation cut;
    cut.pose = test::random_pose(model.source(), random, angle);
    const auto positions = test::posed_positions(model.source(), 0, std::get<ModelPose>(cut.pose));
    cut.cut.point = positions[random.index(static_cast<std::uint32_t>(positions.size()))];
    if (random.index(2) == 0) cut.cut.point += 1e-3 * random.direction();
    cut.cut.normal = random.direction();
    return cut;
  }
  TearOperation tear;
  const ModelPose pose = test::random_pose(model.source(), random, angle);
  tear.pose = pose;
  tear.stroke = test::random_stroke(model.source(), pose, random, random.uniform(0.1, 0.8),
                                    1 + random.index(6));
  if (random.index(3) == 0) tear.options.layers = Layers::all;
  return tear;
}

TEST(Cracks, of_a_source_are_found_from_both_sides) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    EXPECT_THAT(tear::build_surface(closed_body(random)).cracks, IsEmpty());
    const Character cracked = cracked_body(random);
    const tear::Surface surface = tear::build_surface(cracked);
    EXPECT_THAT(unmatched_edges(cracked), IsEmpty());
    // The body is closed in bind space, so each border is a side of a crack.
    const auto borders = std::count(surface.twin.begin(), surface.twin.end(), kNone);
    EXPECT_EQ(surface.cracks.size(), static_cast<std::size_t>(borders));
    for (const auto& [here, there] : surface.cracks) EXPECT_EQ(surface.across_crack(there), here);
  }
}

/// The lips of a tear that was saved are no crack: they are apart on purpose.
TEST(Cracks, lips_are_none) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    Random random(seed);
    auto model = TornModel::create(std::make_shared<const Character>(closed_body(random)));
    ASSERT_TRUE(model);
    ASSERT_TRUE(test::play(*model, opening(*model, random)));
    EXPECT_THAT(tear::build_surface(model->character()).cracks, IsEmpty());
  }
}

TEST(Cracks, a_surface_that_is_closed_at_bind_stays_closed) {
  int torn = 0, split = 0;
  for (int seed = 0; seed < test::stressed(300, 40) && !testing::Test::HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    Random random(static_cast<std::uint64_t>(seed));
    auto model = TornModel::create(std::make_shared<const Character>(cracked_body(random)));
    ASSERT_TRUE(model) << model.error().text();
    const std::uint64_t before = model->digest();
    const Operation operation = opening(*model, random);
    ChangeRecord change;
    const auto report = test::play(*model, operation, &change);
    ASSERT_TRUE(report) << report.error().text();
    torn += report->runs > 0 ? 1 : 0;
    split += report->blocked == 0 ? 1 : 0;
    EXPECT_THAT(test::broken_laws(*model), IsEmpty());
    EXPECT_THAT(test::broken_lips(*model, change), IsEmpty());
    if (report->blocked == 0) {
      EXPECT_THAT(unmatched_edges(model->character()), IsEmpty());
    }
    if (model->undo_count() > 0) {
      ASSERT_TRUE(model->undo());
    }
    EXPECT_EQ(model->digest(), before);
  }
  EXPECT_GT(torn, test::stressed(250, 40));
  EXPECT_GT(split, test::stressed(295, 40));
}

}  // namespace
}  // namespace sunder
