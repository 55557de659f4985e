// The quality of faces after many tears on top of one another.
#include <sunder/tear/torn_model.h>

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>

#include "support/machine/stress.h"
#include "support/models/rigs.h"
#include "support/oracles/face_quality.h"
#include "support/oracles/torn_invariants.h"
#include "tear/geometry/tolerances.h"

namespace sunder {
namespace {

using test::Random;
using testing::IsEmpty;

class FaceQuality : public testing::TestWithParam<int> {};

TEST_P(FaceQuality, stays_above_the_limit_set_by_snapping) {
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
    // A crossed face is split in two at each edge that the path passes; an end inside a face adds
    // at most two faces, and so does the point in the middle of a tear of one edge.
    EXPECT_LE(report->triangles_added,
              2 * report->faces_crossed + 2 * (report->segments + 2 * report->runs))
        << "tear " << i;
    runs += report->runs;
  }
  EXPECT_GT(runs, static_cast<std::uint32_t>(tears / 2));
  EXPECT_THAT(test::broken_laws(*model), IsEmpty());
  EXPECT_THAT(test::broken_surface(*model), IsEmpty());

  // A path keeps away from the ends of edges created by tears by kSliverSizes of the longest side.
  // A face that it leaves there has such a short side between two long ones. If these meet at the
  // source's smallest angle, its own angle is the sine of that times kSliverSizes. Tips, edges of
  // the source that are crossed for the first time, and lips that meet may be closer: half of the
  // floor allows for them.
  const test::FaceQuality quality = test::face_quality(*model);
  EXPECT_EQ(quality.faces_without_area, 0u);
  EXPECT_GT(quality.angle_at(0.01), 0.5 * tear::kSliverSizes *
                                        std::sin(smallest_of_source * std::numbers::pi / 180) *
                                        180 / std::numbers::pi);
}

INSTANTIATE_TEST_SUITE_P(seeds, FaceQuality, testing::Range(0, 5));

}  // namespace
}  // namespace sunder
