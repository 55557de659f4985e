// The shape of wounds in pictures: tools/picture/wound_flesh.h, smooth_along.h, taper_wounds.h,
// unfold_skin.h.

#include <sunder/skinning/pose.h>

#include <cmath>

#include <gtest/gtest.h>

#include "support/machine/random.h"
#include "support/models/rigs.h"
#include "tools/demo/demo_rig.h"
#include "tools/picture/taper_wounds.h"
#include "tools/picture/wound_flesh.h"

namespace sunder::tools {
namespace {

TEST(SmoothAlong, goes_by_length_not_by_the_number_of_edges) {
  // A line of 1 m, its values a step in the middle, with 40 edges or with many short ones there.
  const auto smoothed_at_ends_of_the_middle = [](std::uint32_t short_edges) {
    std::vector<SmoothAlong::Edge> edges;
    std::vector<float> places = {0};
    const auto go = [&](float to) {
      const auto last = static_cast<std::uint32_t>(places.size() - 1);
      edges.push_back({last, last + 1, to - places.back()});
      places.push_back(to);
    };
    for (int i = 1; i <= 19; ++i) go(0.025f * static_cast<float>(i));
    for (std::uint32_t i = 1; i <= short_edges; ++i)
      go(0.475f + 0.05f * static_cast<float>(i) / static_cast<float>(short_edges));
    for (int i = 22; i <= 40; ++i) go(0.025f * static_cast<float>(i));
    Eigen::MatrixXd values(places.size(), 2);
    for (std::size_t s = 0; s < places.size(); ++s)
      values.row(static_cast<Eigen::Index>(s)) << (places[s] < 0.5f ? 0.0 : 1.0), 7.0;
    const SmoothAlong smooth(edges, std::vector<bool>(places.size()), 0.1f);
    const Eigen::MatrixXd found = smooth.smoothed(values);
    EXPECT_LT((found.col(1).array() - 7).abs().maxCoeff(), 1e-9) << "constants stay";
    for (std::size_t e = 0; e < edges.size(); ++e)
      EXPECT_LT(std::abs(found(edges[e].b, 0) - found(edges[e].a, 0)),
                6.0 * static_cast<double>(edges[e].length))
          << "no step";
    return found(19, 0);
  };
  EXPECT_NEAR(smoothed_at_ends_of_the_middle(2), smoothed_at_ends_of_the_middle(50), 0.07);
}

TEST(SmoothAlong, fixed_values_stay_and_no_distance_changes_nothing) {
  const std::vector<SmoothAlong::Edge> edges = {{0, 1, 0.1f}, {1, 2, 0.0f}, {2, 3, 0.2f}};
  Eigen::MatrixXd values(4, 1);
  values << 0, 3, 5, 1;
  const Eigen::MatrixXd fixed =
      SmoothAlong(edges, {true, false, false, true}, 0.5f).smoothed(values);
  EXPECT_NEAR(fixed(0, 0), 0, 1e-6);
  EXPECT_NEAR(fixed(3, 0), 1, 1e-6);
  EXPECT_NEAR(fixed(1, 0), fixed(2, 0), 0.01);
  EXPECT_LT((SmoothAlong(edges, std::vector<bool>(4), 0).smoothed(values) - values).norm(), 1e-9);
}

/// The cactus of the demo, torn by a stroke down its trunk, whose lips gape.
struct Gaping {
  std::shared_ptr<const Character> character = std::make_shared<const Character>(make_cactus());
  ModelPose pose = *bind_pose(*character);
  GapingModel model;
  std::vector<DeformedMesh> closed, open;

  explicit Gaping(std::uint64_t seed) : model(make(seed)) {
    EXPECT_TRUE(open_lips(model.instance, pose));
    closed = *pose_model(model.instance.character(), pose);
    open = closed;
    displace(model.instance, open);
  }
  [[nodiscard]] GapingModel make(std::uint64_t seed) const {
    test::Random random(seed);
    TearOperation tear;
    tear.pose = RestPose{};
    const double x = random.uniform(-0.05, 0.05), slope = random.uniform(-0.15, 0.15),
                 top = random.uniform(1.4, 1.6), bottom = random.uniform(0.7, 1.0);
    for (int i = 0; i <= 6; ++i) {
      const double y = top + (bottom - top) * i / 6;
      tear.stroke.push_back({{x + slope * (y - 1), y, 1}, {x + slope * (y - 1), y, 0}});
    }
    const Operation history[] = {tear};
    return std::move(*make_gaping_model(character, history, pose));
  }
  [[nodiscard]] double gap(const std::vector<DeformedMesh>& posed,
                           const WoundFlesh::Section& section) const {
    return static_cast<double>((posed[section.left.mesh].positions[section.left.vertex] -
                                posed[section.right.mesh].positions[section.right.vertex])
                                   .norm());
  }
};

TEST(WoundFlesh, lies_along_the_wound_without_a_step) {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    SCOPED_TRACE(seed);
    Gaping gaping(seed);
    const WoundFlesh flesh(*gaping.model.instance.model(), gaping.model.wounds, gaping.closed);
    ASSERT_GT(flesh.spans().size(), 20u);
    const WoundFlesh::Ground ground = flesh.ground(gaping.closed, gaping.open, 8);
    for (const WoundFlesh::Span& span : flesh.spans()) {
      const WoundFlesh::Section &a = flesh.sections()[span.a], &b = flesh.sections()[span.b];
      const double length =
          static_cast<double>((gaping.closed[a.left.mesh].positions[a.left.vertex] -
                               gaping.closed[b.left.mesh].positions[b.left.vertex])
                                  .norm());
      EXPECT_LE(std::abs(a.along - b.along), length + 1e-5);
      const auto middle = [&](std::uint32_t section) {
        const std::size_t left = ground.at({section, 0}), right = ground.at({section, 8});
        return Vec3d(
            (ground.open[ground.at({section, 4})] - (ground.open[left] + ground.open[right]) / 2)
                .cast<double>());
      };
      EXPECT_LT((middle(span.a) - middle(span.b)).norm(), 3 * length + 1e-4) << "depth";
      const Vec3f turn =
          ground.normals[ground.at({span.a, 4})] - ground.normals[ground.at({span.b, 4})];
      EXPECT_LT(static_cast<double>(turn.norm()), 0.1 + 4 * length / ground.widest) << "normals";
    }
  }
}

TEST(TaperWounds, tips_are_pointed_and_the_skin_beside_lips_does_not_fold) {
  std::size_t all_folds_before = 0;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    SCOPED_TRACE(seed);
    Gaping gaping(seed);
    const auto folds = [&] {
      std::size_t count = 0;
      for (std::size_t m = 0; m < gaping.open.size(); ++m)
        for (const Triangle& triangle : gaping.model.instance.character().meshes[m].triangles) {
          if (is_retired(triangle)) continue;
          const auto normal = [&](const std::vector<DeformedMesh>& posed) {
            const std::vector<Vec3f>& at = posed[m].positions;
            return Vec3f(
                (at[triangle[1]] - at[triangle[0]]).cross(at[triangle[2]] - at[triangle[0]]));
          };
          count += normal(gaping.open).dot(normal(gaping.closed)) < 0;
        }
      return count;
    };
    all_folds_before += folds();
    taper_wounds(gaping.model.instance, gaping.model.wounds, gaping.closed, gaping.open);
    EXPECT_EQ(folds(), 0u);
    for (std::size_t m = 0; m < gaping.open.size(); ++m)
      for (std::size_t v = 0; v < gaping.open[m].normals.size(); ++v) {
        const Vec3f &opened = gaping.open[m].normals[v], &shut = gaping.closed[m].normals[v];
        EXPECT_NEAR(opened.norm(), 1, 1e-4);
        EXPECT_GT(opened.dot(shut), 0.2f) << "a normal was left turned over at vertex " << v;
      }
    const WoundFlesh flesh(*gaping.model.instance.model(), gaping.model.wounds, gaping.closed);
    double widest = 0, length = flesh.length();
    for (const WoundFlesh::Section& section : flesh.sections())
      widest = std::max(widest, gaping.gap(gaping.open, section));
    ASSERT_GT(widest, 0.01 * length);
    std::size_t near = 0;
    for (const WoundFlesh::Section& section : flesh.sections()) {
      const double along = static_cast<double>(section.along);
      const double from_end = std::max(0.0, std::min(along, length - along));
      if (from_end > 0.02 * length) continue;
      ++near;
      // An ellipse whose half axis is 0.4 of the length.
      EXPECT_LE(gaping.gap(gaping.open, section),
                1.1 * widest * std::sqrt(2 * from_end / (0.4 * length)) + 1e-5);
    }
    EXPECT_GT(near, 1u);
  }
  EXPECT_GT(all_folds_before, 0u) << "nothing to unfold";
}

}  // namespace
}  // namespace sunder::tools
