// What many tears on top of one another leave of the faces.
#include <sunder/tear/torn_model.h>

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>

#include "support/face_quality.h"
#include "support/rigs.h"
#include "support/stress.h"
#include "support/torn_invariants.h"
#include "tear/geometry/tolerances.h"

namespace sunder {
namespace {

using test::Random;
using testing::IsEmpty;

class FaceQuality : public testing::TestWithParam<int> {};

TEST_P(FaceQuality, stays_above_what_snapping_leaves) {
  const int tears = test::stressed(200, 5);
  auto model = TornModel::create(std::make_shared<const Character>(test::make_bumpy_ball(1000)));
  ASSERT_TRUE(model);
  const double smallest_of_source = test::face_quality(*model).angle_at(0);
  Random random(static_cast<std::uint64_t>(GetParam()));
  std::uint32_t runs = 0;
  for (int i = 0; i < tears; ++i) {
    const ModelPose pose = test::random_pose(model->source(), random, 0.4, 1.1);
    const double length = random.uniform(0.02, 0.3);
    const Stroke stroke =
        test::random_stroke(model->source(), pose, random, length, 1 + random.index(6));
    const auto report = model->tear(pose, stroke);
    ASSERT_TRUE(report);
    // A face crossed is split in two at each of the edges that the path passes; an end inside a
    // face takes two more at most, and so does the point in the middle of a tear of one edge.
    EXPECT_LE(report->triangles_added,
              2 * report->faces_crossed + 2 * (report->segments + 2 * report->runs))
        << "tear " << i;
    runs += report->runs;
  }
  EXPECT_GT(runs, static_cast<std::uint32_t>(tears / 2));
  EXPECT_THAT(test::broken_laws(*model), IsEmpty());
  EXPECT_THAT(test::broken_surface(*model), IsEmpty());

  // A path keeps away from the ends of edges that tears made by kSliverSizes of the longest side. A
  // face that it leaves there has a side as short as that between two long ones; where these meet
  // the source's smallest angle, its own is that angle's sine times kSliverSizes. Nearer than that
  // come tips, edges of the source that are crossed for the first time, and lips that meet: half of
  // the floor is for them.
  const test::FaceQuality quality = test::face_quality(*model);
  EXPECT_EQ(quality.faces_without_area, 0u);
  EXPECT_GT(quality.angle_at(0.01), 0.5 * tear::kSliverSizes *
                                        std::sin(smallest_of_source * std::numbers::pi / 180) *
                                        180 / std::numbers::pi);
}

INSTANTIATE_TEST_SUITE_P(seeds, FaceQuality, testing::Range(0, 5));

}  // namespace
}  // namespace sunder
