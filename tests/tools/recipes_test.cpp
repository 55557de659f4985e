#include <sunder/scene/character_instance.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/detached_piece.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tools/picture/recipe_rigs.h"
#include "tools/recipes/tissue_recipes.h"  // made of docs/tissue_recipes.md

namespace sunder {
namespace {

/// A thing of which parts are held and pulled.
class Pulled {
 public:
  Pulled(Character thing, SoftTissue tissue, double range)
      : character_(std::make_shared<const Character>(std::move(thing))),
        pose_(*bind_pose(*character_)) {
    tissue.decomposition = {range, false};
    CharacterAssetOptions options;
    options.soft = std::move(tissue);
    auto made = CharacterInstance::create(character_, options);
    EXPECT_TRUE(made) << made.error().text();
    instance_ = std::make_unique<CharacterInstance>(std::move(*made));
    EXPECT_TRUE(instance_->prepare_to_tear());
    step();
  }

  CharacterInstance& instance() { return *instance_; }
  const ModelPose& pose() const { return pose_; }
  void step() { EXPECT_TRUE(instance_->advance(pose_, 1.0 / 60)); }
  /// Holds wanted points that are at least a spacing apart.
  void hold(const std::function<bool(const Vec3d&)>& is_wanted, double spacing) {
    holds_.emplace_back();
    std::vector<Vec3d> held;
    const auto places = instance_->particles()->positions();
    for (Index point = 0; point < places.size(); ++point) {
      const Vec3d at = places[point].cast<double>();
      if (!is_wanted(at) || std::ranges::any_of(held, [&](const Vec3d& other) {
            return (at - other).norm() < spacing;
          }))
        continue;
      held.push_back(at);
      const auto hold = instance_->body()->hold_point(point, at);
      ASSERT_TRUE(hold);
      holds_.back().emplace_back(*hold, at);
    }
    EXPECT_FALSE(holds_.back().empty());
  }
  void move(std::size_t n, const Vec3d& by) {
    for (const auto& [hold, from] : holds_[n])
      EXPECT_TRUE(instance_->body()->move_hold(hold, from + by));
  }
  void release(std::size_t n) {
    for (const auto& [hold, from] : holds_[n]) EXPECT_TRUE(instance_->body()->release(hold));
  }
  bool tear() {
    step();
    const auto report = instance_->tear_overstretched();
    EXPECT_TRUE(report) << report.error().text();
    return report && report->has_torn;
  }
  /// The places at rest of all lips.
  std::vector<Vec3d> lips() const {
    std::vector<Vec3d> places;
    for (const LipEdge& lip : instance_->particles()->lips())
      for (const Index point : lip.points)
        places.push_back(instance_->particles()->positions()[point].cast<double>());
    return places;
  }
  double length_of_lips() const {
    double sum = 0;
    for (const LipEdge& lip : instance_->particles()->lips())
      sum += (instance_->particles()->positions()[lip.points[1]] -
              instance_->particles()->positions()[lip.points[0]])
                 .norm();
    return sum / 2;
  }
  double farthest_displacement() const {
    double most = 0;
    for (Index point = 0; point < instance_->particles()->positions().size(); ++point)
      most = std::max(most, instance_->body()->point_displacement(point).norm());
    return most;
  }
  /// Draws the two borders of a sheet apart until nothing tears any more.
  void draw_apart(const Vec3d& along) {
    const double half = tools::kSheetSize.homogeneous().cwiseProduct(Vec3d(0.5, 0.5, 0)).dot(along);
    for (const double side : {-1.0, 1.0})
      hold([&](const Vec3d& at) { return side * at.dot(along) > half - 1e-4; }, 0.004);
    for (int i = 0; i < 660; ++i) {
      move(0, -std::min(1.0, i / 600.0) * 0.018 * along);
      move(1, std::min(1.0, i / 600.0) * 0.018 * along);
      tear();
    }
  }

 private:
  std::shared_ptr<const Character> character_;
  ModelPose pose_;
  std::unique_ptr<CharacterInstance> instance_;
  std::vector<std::vector<std::pair<HoldId, Vec3d>>> holds_;
};

TEST(recipes, paper_parts_along_its_holes) {
  tools::PerforatedPaper paper = tools::make_perforated_paper();
  std::vector<Vec3d> row;
  for (const TissuePlace& hole : paper.holes) {
    const Mesh& mesh = paper.character.meshes[hole.mesh];
    Vec3d at = Vec3d::Zero();
    for (std::size_t i = 0; i < 3; ++i)
      at += hole.barycentric[i] * mesh.positions[mesh.triangles[hole.triangle][i]].cast<double>();
    row.push_back(at);
  }
  double length_of_row = 0;
  for (std::size_t i = 1; i < row.size(); ++i) length_of_row += (row[i] - row[i - 1]).norm();
  SoftTissue tissue;
  ASSERT_TRUE(docs_code::paper_with_holes(tissue, paper.holes));
  Pulled pulled(std::move(paper.character), tissue, 0.015);
  pulled.draw_apart(Vec3d::UnitX());
  for (const Vec3d& lip : pulled.lips()) {
    double nearest = 1;
    for (const Vec3d& at : row) nearest = std::min(nearest, (at - lip).norm());
    EXPECT_LT(nearest, 0.003);  // Places of the row are 2.6 mm apart.
  }
  EXPECT_NEAR(pulled.length_of_lips(), length_of_row, 0.05 * length_of_row);
}

TEST(recipes, cloth_opens_at_its_seam_alone) {
  Character cloth = tools::make_seamed_cloth();
  SoftTissue tissue;
  ASSERT_TRUE(docs_code::cloth_with_seams(cloth, tissue));
  Pulled pulled(std::move(cloth), tissue, 0.015);
  pulled.draw_apart(Vec3d::UnitY());
  EXPECT_GT(pulled.length_of_lips(), tools::kSheetSize.x());
  for (const Vec3d& lip : pulled.lips()) EXPECT_LT(std::abs(lip.y()), 0.03);
}

TEST(recipes, peel_comes_off_in_a_strip_and_stays_bent) {
  SoftTissue tissue;
  ASSERT_TRUE(docs_code::orange_peel(tissue));
  Pulled pulled(tools::make_orange(), tissue, 0.007);
  const auto knife = [](double x, double y) { return Blade{{x, y, 1}, {x, y, 0}}; };
  const Stroke end = {knife(-0.011, 0.018), knife(-0.011, 0.028), knife(0.011, 0.028),
                      knife(0.011, 0.018)};
  ASSERT_TRUE(pulled.instance().tear(pulled.pose(), end));
  pulled.hold([](const Vec3d& at) { return at.z() < 0 || std::abs(at.x()) > 0.015; }, 0.005);
  pulled.hold(
      [](const Vec3d& at) {
        return at.z() > 0 && std::abs(at.x()) < 0.0095 && at.y() > 0.024 && at.y() < 0.0275;
      },
      0.002);
  const double before = pulled.length_of_lips();
  for (int i = 0; i <= 150; ++i) {
    const double share = i / 150.0;
    pulled.move(1, Vec3d(0, -0.04 * share * share, 0.04 * share));
    ASSERT_TRUE(docs_code::orange_peel_2(pulled.instance()));
    pulled.step();
  }
  EXPECT_GT(pulled.length_of_lips(), before + 0.02);
  for (const Vec3d& lip : pulled.lips()) EXPECT_LT(std::abs(lip.x()), 0.02);
  pulled.release(1);
  for (int i = 0; i < 240; ++i) pulled.step();
  EXPECT_GT(pulled.farthest_displacement(), 0.005);
}

TEST(recipes, rubber_stretches_far_before_a_finger_rips_off) {
  const Character glove = tools::make_glove();
  SoftTissue tissue;
  ASSERT_TRUE(docs_code::rubber_glove(glove, tissue));
  Pulled pulled(glove, tissue, 0.01);
  pulled.hold([](const Vec3d& at) { return at.y() < 0.08; }, 0.006);
  pulled.hold([](const Vec3d& at) { return at.y() > 0.18 && at.x() < 0; }, 0.003);
  int first = 0, tears = 0;
  for (int i = 0; i <= 150; ++i) {
    pulled.move(1, i / 150.0 * Vec3d(-0.05, 0.2, 0));
    if (pulled.tear() && ++tears == 1) first = i;
  }
  // The free part of a finger is about 0.09 m long, and its end moves by 0.21 m.
  EXPECT_GT(first, 75);
  EXPECT_GT(tears, 4);
  for (const Vec3d& lip : pulled.lips()) EXPECT_GT(lip.y(), 0.08);
}

}  // namespace
}  // namespace sunder
