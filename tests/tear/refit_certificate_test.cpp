// What the bounds of fits leave out, and what happens to them without memory.

#include "tear/weights/refit_certificate.h"

#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>

#include <cmath>
#include <new>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "support/machine/allocation_count.h"
#include "support/models/rigs.h"

namespace sunder::tear {
namespace {

/// A tube whose two bones are both roots, or parent and child.
Character two_bones(bool are_roots) {
  Character tube = test::make_tube(4, 8, 2);
  if (are_roots) tube.skeleton.bones[1].parent = kNone;
  return tube;
}

/// A point between both bones, and fitted weights that rounding has moved from one to the other.
struct RoundedPoint {
  explicit RoundedPoint(double moved)
      : fitted{{0, static_cast<float>(0.5 + moved)}, {1, static_cast<float>(0.5 - moved)}} {
    const std::vector<Influence> halves = {{0, 0.5f}, {1, 0.5f}};
    exact.add(1.0, position, halves);
  }

  Vec3d position = Vec3d(0.1, 0.2, 0.3);
  AnimationPoint exact;
  std::vector<Influence> fitted;
};

/// The bound and what docs/weights.md says that roots add.
TEST(RefitCertificate, weight_that_crosses_a_root_adds_what_is_said) {
  const Character roots = two_bones(true);
  const RoundedPoint point(1e-6);
  RefitCertificate certificate(roots);
  certificate.add(point.exact, point.fitted, point.position, 0);
  const double bound = certificate.take_bounds()[0];
  EXPECT_LT(bound, 1e-5);
  // One root slides by a kilometre.
  const auto bind = bind_pose(roots);
  ASSERT_TRUE(bind);
  std::vector<Affine3d> palette(roots.skins[0].bones.size());
  ModelPose slid = *bind;
  slid.model_from_bone[1].translation().x() += 1000;
  ASSERT_TRUE(compute_palette(roots.skins[0], slid, palette));
  Eigen::Vector3d posed = Eigen::Vector3d::Zero();
  for (const Influence& influence : point.fitted)
    posed += static_cast<double>(influence.weight) *
             (palette[influence.slot] * Eigen::Vector3d(point.position));
  const double moved = (posed - Eigen::Vector3d(point.exact.posed(palette))).norm();
  EXPECT_GT(moved, 10 * bound) << "so the bound alone does not hold";
  EXPECT_LT(moved, bound + 1000 * 4e-6);
}

/// Points without memory are no points without a bound: fits would depend on it.
TEST(RefitCertificate, without_memory_there_is_no_answer) {
  if (!test::FailingAllocations::are_possible()) GTEST_SKIP();
  const Character chain = two_bones(false);
  const RoundedPoint point(1e-6);
  bool is_done = false;
  for (std::uint64_t count = 0; !is_done && count < 1000; ++count) {
    RefitCertificate certificate(chain);
    certificate.add(point.exact, point.fitted, point.position, 0);
    std::vector<double> bounds;
    try {
      const test::FailingAllocations failing(count);
      bounds = certificate.take_bounds();
    } catch (const std::bad_alloc&) {
      continue;
    }
    ASSERT_TRUE(std::isfinite(bounds.at(0))) << "after " << count << " allocations";
    is_done = true;
  }
  EXPECT_TRUE(is_done);
}

}  // namespace
}  // namespace sunder::tear
