// A blade that goes along a wound once more finds it open: it adds nearly nothing and sets no
// flakes free.

#include <sunder/skinning/pose.h>

#include <memory>

#include <gtest/gtest.h>

#include "support/models/random_operations.h"
#include "support/models/rigs.h"
#include "support/oracles/torn_invariants.h"

namespace sunder {
namespace {

using test::Random;

std::size_t face_count(const TornModel& model) {
  std::size_t count = 0;
  for (const Mesh& mesh : model.character().meshes)
    for (const Triangle& triangle : mesh.triangles) count += is_retired(triangle) ? 0 : 1;
  return count;
}

/// Sums over strokes.
struct Sums {
  std::size_t faces = 0, more_faces = 0;    ///< That the first strokes made, and further ones.
  std::size_t pieces = 0, more_pieces = 0;  ///< That they set free.
  double length = 0, more_length = 0;       ///< Of the tears, without ways along older lips.
};

enum class Way { once, to_and_fro };

struct Tears {
  bool is_at_bind = false;
  Way way = Way::once;
  double wall_depth = 0;
};

/// Tears a ball along a random stroke, then four times again.
void retrace(std::uint64_t seed, const Tears& tears, Sums& sums) {
  SCOPED_TRACE(seed);
  Random random(seed);
  Character ball = test::make_bumpy_ball(1000);
  test::rig_along(ball, 3);
  TearOperation tear;
  const ModelPose pose = tears.is_at_bind ? *bind_pose(ball) : test::random_pose(ball, random);
  const std::uint32_t segments = 3 + random.index(10);
  tear.stroke = test::random_stroke(ball, pose, random, 0.2, segments);
  tear.pose = pose;
  tear.options.wall_depth = tears.wall_depth;
  if (tears.way == Way::to_and_fro) {
    const Stroke forward = tear.stroke;
    for (int i = 0; i < 3; ++i) {
      tear.stroke.insert(tear.stroke.end(), forward.rbegin() + 1, forward.rend());
      tear.stroke.insert(tear.stroke.end(), forward.begin() + 1, forward.end());
    }
  }
  auto model = TornModel::create(std::make_shared<const Character>(std::move(ball)));
  ASSERT_TRUE(model);
  std::size_t before = face_count(*model);
  for (int n = 0; n < 5; ++n) {
    ChangeRecord change;
    const auto report = test::play(*model, tear, &change);
    ASSERT_TRUE(report) << report.error().text();
    const std::size_t after = face_count(*model);
    (n == 0 ? sums.faces : sums.more_faces) += after - before;
    (n == 0 ? sums.pieces : sums.more_pieces) += report->pieces.size();
    (n == 0 ? sums.length : sums.more_length) += report->length_posed;
    before = after;
    EXPECT_TRUE(test::broken_lips(*model, change).empty());
  }
  EXPECT_TRUE(test::broken_laws(*model).empty());
  EXPECT_TRUE(test::broken_surface(*model).empty());
}

Sums retrace_many(const Tears& tears) {
  Sums sums;
  for (std::uint64_t seed = 0; seed < 40; ++seed) retrace(seed, tears, sums);
  return sums;
}

TEST(RetracedStrokes, add_little_in_the_bind_pose) {
  const Sums once = retrace_many({.is_at_bind = true});
  EXPECT_EQ(once.more_pieces, 0u);
  EXPECT_EQ(once.more_length, 0);
  EXPECT_LT(once.more_faces, once.faces / 5);
  const Sums to_and_fro = retrace_many({.is_at_bind = true, .way = Way::to_and_fro});
  EXPECT_LE(to_and_fro.pieces + to_and_fro.more_pieces, 4u);
  EXPECT_NEAR(to_and_fro.length, once.length, 0.01 * once.length);
  EXPECT_EQ(to_and_fro.more_length, 0);
  EXPECT_LT(to_and_fro.faces, 5 * once.faces / 4);
  EXPECT_LT(to_and_fro.more_faces, once.faces / 3);
}

/// Weights put new points beside the line of the stroke, by more than rounding.
TEST(RetracedStrokes, hardly_set_flakes_free_in_bent_poses) {
  const Sums once = retrace_many({});
  EXPECT_EQ(once.pieces, 0u);
  EXPECT_LE(once.more_pieces, 40u * 4 / 8);
  EXPECT_LT(once.more_faces, once.faces / 5);
  const Sums to_and_fro = retrace_many({.way = Way::to_and_fro});
  EXPECT_LE(to_and_fro.pieces, 8u);
  EXPECT_LE(to_and_fro.more_pieces, 40u * 4 / 4);
  EXPECT_LT(to_and_fro.more_length, to_and_fro.length / 8);
  EXPECT_LT(to_and_fro.more_faces, once.faces / 3);
}

/// Walls stay at their lips.
TEST(RetracedStrokes, leave_walls_as_they_are) {
  for (const Way way : {Way::once, Way::to_and_fro})
    for (const bool is_at_bind : {true, false}) {
      const Sums sums = retrace_many({is_at_bind, way, 0.1});
      EXPECT_LE(sums.pieces, 8u);
      EXPECT_LE(sums.more_pieces, 40u * 4 / 4);
      EXPECT_LT(sums.more_faces, sums.faces / 15);
    }
}

}  // namespace
}  // namespace sunder
