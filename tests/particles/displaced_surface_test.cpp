// Normals and tangents of displaced surfaces, compared with their faces.

#include "support/oracles/displaced_surface.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "particles/soft_scene.h"

namespace sunder::test {
namespace {

/// A torn sheet or tube with walls, whose lips a tension displaces.
struct Gaping {
  SoftScene scene;

  Gaping(Character from, double range) : scene(with_tangents(std::move(from)), {}, range) {}

  static Character with_tangents(Character character) {
    add_tangents(character.meshes[0]);
    return character;
  }
  /// @param gap  wanted displacement, as a fraction of a particle's range.
  void open(const Stroke& stroke, double depth, double gap) {
    TearOptions options;
    options.wall_depth = depth;
    ChangeRecord change;
    ASSERT_TRUE(scene.model->tear(scene.pose, stroke, options, &change));
    ASSERT_TRUE(scene.set->follow(*scene.model, std::span(&change, 1)));
    double tension = 1e-3;
    for (int i = 0; i < 3; ++i) {
      ASSERT_TRUE(scene.body->set_tension({tension, {}}));
      scene.run(2);
      tension *= gap * scene.set->report().range / std::max(scene.farthest(), 1e-9);
    }
  }
  /// Without the surroundings of tips, where particles of the two lips meet.
  [[nodiscard]] DisplacedSurface measure() {
    return measure_displaced(*scene.model, scene.pose, *scene.set, *scene.body,
                             0.5 * scene.set->report().range);
  }
};

TEST(DisplacedSurface, normals_are_those_of_its_faces_and_tangents_lie_across) {
  // Where the small particles of a lip are only two edges apart, faces show their blending
  // coarsely.
  std::vector<double> of_seeds;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const bool is_flat = seed % 2 == 0;
    Gaping gaping(is_flat ? make_sheet(48) : make_tube(40, 48, 3), 0.08);
    const Character& source = *gaping.scene.character;
    const Stroke stroke = random_stroke(source, gaping.scene.pose, random, 0.3, 3);
    gaping.open(stroke, 0.01 * posed_diagonal(source, gaping.scene.pose), 0.1);
    if (gaping.scene.farthest() == 0) continue;
    const DisplacedSurface found = gaping.measure();
    of_seeds.push_back(found.normal_p99);
    EXPECT_LT(found.normal_p99, 15.0);
    EXPECT_LT(found.tangent_dot, 1e-6);
  }
  ASSERT_FALSE(of_seeds.empty());
  std::sort(of_seeds.begin(), of_seeds.end());
  EXPECT_LT(of_seeds[of_seeds.size() / 2], 5.0);
}

TEST(DisplacedSurface, of_a_body_at_rest_is_the_surface) {
  Gaping gaping(make_tube(12, 16, 3), 0.2);
  gaping.open({down_at(0.3, 0.5), down_at(0.6, 0.5)}, 0.05, 0.0);
  const DisplacedSurface found = gaping.measure();
  EXPECT_EQ(found.normal_worst, 0.0);
  EXPECT_EQ(found.jump, 0.0);
}

}  // namespace
}  // namespace sunder::test
