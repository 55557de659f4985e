#include "tools/picture/recipe_pictures.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "tools/messages/lines.h"
#include "tools/messages/messages.h"
#include "tools/messages/printed.h"
#include "tools/picture/recipe_rigs.h"
#include "tools/picture/soft_scene.h"
#include "tools/recipes/tissue_recipes.h"  // made of the page

namespace sunder::tools {
namespace {

constexpr int kRipping = 9;  ///< Tears after which a ripping finger is drawn.

void require(const Status& status) {
  if (status) return;
  print_error("soft_pictures: " + std::string(status.text()));
  std::exit(1);
}

SoftTissue particles_of(double range) {
  SoftTissue tissue;
  tissue.decomposition = {range, false};
  return tissue;
}

/// A thing whose points are held, some where they are, others to be moved.
class PulledScene {
 public:
  PulledScene(Character thing, const SoftTissue& tissue)
      : scene(std::make_shared<const Character>(std::move(thing)), tissue, BindPose()) {}

  /// Holds the points whose places at rest are wanted, at most one per spacing.
  void hold(const std::function<bool(const Vec3d&)>& is_wanted, double spacing) {
    holds_.emplace_back();
    std::vector<Vec3d> held;
    const auto places = scene.particles().positions();
    for (std::uint32_t point = 0; point < places.size(); ++point) {
      const Vec3d at = places[point].cast<double>();
      bool is_near = false;
      for (const Vec3d& other : held) is_near = is_near || (at - other).norm() < spacing;
      if (is_near || !is_wanted(at)) continue;
      const auto hold = scene.body().hold_point(point, at);
      if (!hold) require(hold.error());
      held.push_back(at);
      holds_.back().emplace_back(*hold, at);
    }
  }
  /// Moves what the n-th call of hold() holds.
  void move(std::size_t n, const Vec3d& by) {
    for (const auto& [hold, from] : holds_[n]) require(scene.body().move_hold(hold, from + by));
  }
  void release(std::size_t n) {
    for (const auto& [hold, from] : holds_[n]) require(scene.body().release(hold));
  }
  /// A step, after which the tissue tears where it gives way.
  void tear() {
    scene.step();
    const auto report = scene.tear_overstretched();
    if (!report) print_text(std::string(report.error().text()) + "\n");
    if (!report || !report->has_torn) return;
    ++tears;
    length += report->tear.length_posed;
  }
  void print(const char* name) const {
    print_text(printed("%s: %d tears, %.3f m\n", name, tears, length));
  }

  SoftScene scene;
  int tears = 0;
  double length = 0;

 private:
  std::vector<std::vector<std::pair<HoldId, Vec3d>>> holds_;
};

/// A sheet of which two opposite borders are drawn apart, in ten seconds.
/// @param along  unit direction of the pull.
void draw_sheet_pulled(const std::string& picture, PulledScene& pulled, const Vec3d& along,
                       const Vec4f& inner) {
  constexpr int kFrames = 600, kMoreFrames = 60;
  constexpr double kPull = 0.018, kSpacing = 0.004, kBorder = 1e-4;
  const ViewFrame frame = look_from(-14, 18);
  const SoftScene::Sheet sheet = {0.0008, inner, nullptr};
  const Vec3d half = kSheetSize.homogeneous().cwiseProduct(Vec3d(0.5, 0.5, 0));
  for (const double side : {-1.0, 1.0})
    pulled.hold([&](const Vec3d& at) { return side * at.dot(along) > half.dot(along) - kBorder; },
                kSpacing);
  pulled.scene.draw_sheet(picture + "_before.png", frame, Vec3d::Zero(), 0.14, sheet);
  for (int i = 0; i < kFrames + kMoreFrames; ++i) {
    const double share = std::min(1.0, i / double{kFrames});
    pulled.move(0, -share * kPull * along);
    pulled.move(1, share * kPull * along);
    pulled.tear();
  }
  pulled.scene.draw_sheet(picture + "_after.png", frame, Vec3d::Zero(), 0.14, sheet);
}

void draw_paper(const std::string& folder) {
  PerforatedPaper paper = make_perforated_paper();
  SoftTissue tissue = particles_of(0.015);
  require(docs_code::paper_with_holes(tissue, paper.holes));
  PulledScene pulled(std::move(paper.character), tissue);
  draw_sheet_pulled(folder + "/recipe_paper", pulled, Vec3d::UnitX(), {0.7f, 0.7f, 0.7f, 1});
  pulled.print("paper");
}

void draw_cloth(const std::string& folder) {
  Character cloth = make_seamed_cloth();
  SoftTissue tissue = particles_of(0.015);
  require(docs_code::cloth_with_seams(cloth, tissue));
  PulledScene pulled(std::move(cloth), tissue);
  draw_sheet_pulled(folder + "/recipe_cloth", pulled, Vec3d::UnitY(), {0.1f, 0.16f, 0.36f, 1});
  pulled.print("cloth");
}

/// A strip of the peel, whose end is cut, is pulled out and down, and let go. The peel beside it is
/// held.
void draw_orange(const std::string& folder) {
  constexpr double kHalfWidth = 0.011, kEnd = 0.028, kOut = 0.05, kDown = 0.045;
  constexpr int kLifted = 45, kFrames = 300;
  SoftTissue tissue = particles_of(0.005);
  require(docs_code::orange_peel(tissue));
  const Character orange = make_orange();
  Mesh flesh = orange.meshes[0];
  for (Vec3f& at : flesh.positions) at *= 0.94f;
  flesh.color_sets[0].assign(flesh.positions.size(), Vec4f(0.9f, 0.45f, 0.1f, 1));
  PulledScene pulled(orange, tissue);
  pulled.scene.tear(
      {{-kHalfWidth, 0.018}, {-kHalfWidth, kEnd}, {kHalfWidth, kEnd}, {kHalfWidth, 0.018}});
  pulled.hold([&](const Vec3d& at) { return at.z() < 0 || std::abs(at.x()) > kHalfWidth + 0.004; },
              0.005);
  pulled.hold(
      [&](const Vec3d& at) {
        return at.z() > 0 && std::abs(at.x()) < kHalfWidth - 0.0015 && at.y() < kEnd - 0.0005 &&
               at.y() > kEnd - 0.005;
      },
      0.002);
  const auto draw = [&](const char* name) {
    pulled.scene.draw_sheet(folder + "/recipe_orange_" + name + ".png", look_from(40, 20),
                            {0, -0.005, 0.015}, 0.055,
                            {0.0015, Vec4f(0.8f, 0.72f, 0.55f, 1), &flesh});
  };
  for (int i = 0; i <= kFrames; ++i) {
    const double share = i / double{kFrames};
    pulled.move(1, Vec3d(0, -kDown * share * share, kOut * share));
    require(docs_code::orange_peel_2(pulled.scene.instance));
    pulled.scene.step();
    if (i == kLifted) draw("before");
  }
  draw("pulled");
  pulled.release(1);
  const int steps = pulled.scene.step_until_still();
  print_text(printed("orange: still after %d steps\n", steps));
  draw("after");
}

/// A finger is pulled while the palm is held.
void draw_glove(const std::string& folder) {
  constexpr int kFrames = 300;
  const Character glove = make_glove();
  SoftTissue tissue = particles_of(0.01);
  require(docs_code::rubber_glove(glove, tissue));
  PulledScene pulled(glove, tissue);
  const auto draw = [&](const char* name) {
    pulled.scene.draw_sheet(folder + "/recipe_glove_" + name + ".png", look_from(-14, 12),
                            {-0.02, 0.19, 0}, 0.205,
                            {0.0006, Vec4f(0.3f, 0.38f, 0.5f, 1), nullptr});
  };
  draw("before");
  pulled.hold([](const Vec3d& at) { return at.y() < 0.08; }, 0.006);
  pulled.hold([](const Vec3d& at) { return at.y() > 0.18 && at.x() < 0; }, 0.003);
  bool is_ripping = false;
  for (int i = 0; i <= kFrames; ++i) {
    pulled.move(1, i / double{kFrames} * Vec3d(-0.05, 0.2, 0));
    pulled.tear();
    if (is_ripping || pulled.tears < kRipping) continue;
    is_ripping = true;
    draw("ripping");
  }
  pulled.print("glove");
  draw("after");
}

}  // namespace

void draw_recipes(const std::string& folder) {
  draw_paper(folder);
  draw_cloth(folder);
  draw_orange(folder);
  draw_glove(folder);
}

}  // namespace sunder::tools
