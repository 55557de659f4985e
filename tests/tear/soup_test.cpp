// Triangle soups: random triangles on a coarse grid, with edges of many faces, duplicate and
// flipped faces, faces without area, unused vertices. Tearing them must keep the invariants.
#include <sunder/tear/topology.h>
#include <sunder/tear/torn_model.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/machine/stress.h"
#include "support/models/rigs.h"
#include "support/oracles/torn_invariants.h"

namespace sunder {
namespace {

using test::Random;
using testing::IsEmpty;

TEST(Soup, tears_do_no_harm) {
  const int count = test::stressed(1000, 20);
  int torn = 0;
  for (int seed = 0; seed < count; ++seed) {
    SCOPED_TRACE(seed);
    Random random(static_cast<std::uint64_t>(seed));
    auto model = TornModel::create(std::make_shared<const Character>(test::make_soup(random)));
    ASSERT_TRUE(model) << model.error().text();
    const ModelPose pose =
        test::random_pose(model->source(), random, random.index(2) == 0 ? 0.0 : 0.8, 1.0);
    for (int i = 0; i < 4; ++i) {
      Stroke stroke;
      const bool on_grid =
          random.index(2) == 0;  // through vertices, along edges, in the planes of faces
      const auto coordinate = [&] {
        return on_grid ? random.index(5) * 0.5 : random.uniform(-0.5, 3);
      };
      Vec3d at{coordinate(), coordinate(),
               coordinate()};  // Braces evaluate in this order with every compiler.
      const Vec3d blade = on_grid ? Vec3d(Vec3d::Unit(random.index(3))) : random.direction();
      for (std::uint32_t b = 0; b < 2 + random.index(3); ++b) {
        stroke.push_back({at + 3 * blade, at - random.uniform(0, 3) * blade});
        const double step = on_grid ? 0.5 * random.index(4) : random.uniform(0, 1);
        at += step * (on_grid ? Vec3d(Vec3d::Unit(random.index(3))) : random.direction());
      }
      if (stroke.size() < 2) continue;
      ChangeRecord change;
      const auto report = model->tear(pose, stroke, {}, &change);
      ASSERT_TRUE(report) << report.error().text();
      torn += report->runs > 0 ? 1 : 0;
      ASSERT_THAT(test::broken_lips(*model, change), IsEmpty());
      ASSERT_THAT(test::broken_laws(*model), IsEmpty());
    }
    ASSERT_THAT(test::broken_closed_form(*model, test::random_pose(model->source(), random)),
                IsEmpty());
  }
  EXPECT_GT(torn, count / 4);
}

}  // namespace
}  // namespace sunder
