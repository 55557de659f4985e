// The side of a plane on which a vertex is in float, against its position in double.
#include "tear/posed/plane_distances.h"

#include <cmath>

#include <gtest/gtest.h>

#include "skinning/internal/character_pose.h"
#include "support/models/rigs.h"

namespace sunder::tear {
namespace {

/// A random pose, scaled and moved away from the origin.
ModelPose pose_at(const Character& character, double size, const Vec3d& place,
                  test::Random& random) {
  ModelPose pose = test::random_pose(character, random, 0.5, 1.1);
  Affine3d placed = Affine3d::Identity();
  placed.linear() *= size;
  placed.translation() = place;
  for (Affine3d& bone : pose.model_from_bone) bone = placed * bone;
  return pose;
}

struct Counts {
  std::size_t known = 0, wrong = 0;
};

/// Compares the sides of all vertices with planes through random vertices.
Counts compare(const Character& character, const ModelPose& pose, test::Random& random) {
  Counts counts;
  CharacterPose posed;
  EXPECT_TRUE(posed.set(character, pose));
  const Mesh& mesh = character.meshes[0];
  ScratchMemory memory;
  for (int i = 0; i < 20; ++i) {
    const Vec3d normal = random.direction();
    const PlaneSide plane = {normal,
                             dot(normal, posed.position(mesh, random.index(mesh.vertex_count())))};
    memory.reset();
    const PlaneDistances distances(plane, posed.palette(mesh.skin), 0, memory);
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      const std::uint8_t side = distances.side_of(mesh.positions[v], mesh.weights.of(v));
      if (side == PlaneDistances::kAcross) continue;
      ++counts.known;
      counts.wrong +=
          plane.contains(posed.position(mesh, v)) == (side == PlaneDistances::kInside) ? 0 : 1;
    }
  }
  return counts;
}

Character undisplaced_tube() {
  Character tube = test::make_tube(24, 32, 6);
  tube.meshes[0].morph_targets.clear();
  tube.rest_morph_weights.clear();
  return tube;
}

TEST(PlaneDistances, a_known_side_is_that_of_the_position) {
  const Character tube = undisplaced_tube();
  const std::size_t all = 20 * tube.meshes[0].positions.size();
  test::Random random(7);
  for (const double size : {1e-12, 1.0, 1e6, 1e15})
    for (const double away : {0.0, 1.0, 1e2, 1e5, 1e9}) {
      SCOPED_TRACE(testing::Message() << "size " << size << ", " << away << " sizes away");
      const Vec3d place = away * size * random.direction();
      const Counts counts = compare(tube, pose_at(tube, size, place, random), random);
      EXPECT_EQ(counts.wrong, 0u);
      if (away <= 1e2) {
        EXPECT_GT(counts.known, all - all / 50);
      }
    }
}

TEST(PlaneDistances, beyond_float_no_side_is_known) {
  const Character tube = undisplaced_tube();
  test::Random random(8);
  for (const double size : {1e25, 1e50}) {
    EXPECT_EQ(compare(tube, pose_at(tube, size, Vec3d::Zero(), random), random).known, 0u);
    const Vec3d place = size * size * random.direction();
    EXPECT_EQ(compare(tube, pose_at(tube, 1, place, random), random).known, 0u);
  }
}

}  // namespace
}  // namespace sunder::tear
