// Draws the pictures of docs/particles.md and docs/tissue_recipes.md, and prints their
// measurements: soft_pictures FOLDER.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

#include "tools/messages/lines.h"
#include "tools/messages/printed.h"
#include "tools/picture/recipe_pictures.h"
#include "tools/picture/soft_scene.h"

namespace sunder::tools {
namespace {

constexpr double kRange = 0.1;  ///< Of the diagonal.

constexpr double kFarthest = 0.1;          ///< To each side, metres.
constexpr int kMoments[] = {60, 92, 120};  ///< Steps at which a running tear is drawn.

/// A slightly curved path down the front of the trunk.
std::vector<Vec2d> along_trunk(double from, double to) {
  std::vector<Vec2d> path;
  for (int i = 0; i <= 12; ++i)
    path.emplace_back(0.02 * std::sin(0.5 * i), from + (to - from) * i / 12);
  return path;
}

void draw_decomposition(const std::string& folder) {
  const SoftScene scene({SoftMaterial()}, kRange);
  print_text(printed("decomposition: %u particles of %u points\n",
                     scene.particles().particle_count(), scene.particles().report().points));
  scene.draw_particles(folder + "/particles_decomposition.png");
}

/// The same point is pulled in the same way before and after a tear next to it.
void draw_pull(const std::string& folder, bool is_torn) {
  SoftScene scene({SoftMaterial()}, kRange);
  std::uint32_t held = scene.point_at({0, 1.3, 0.16}), other = held;
  if (is_torn) {
    scene.tear(along_trunk(1.58, 1.02));
    const LipPair& middle = scene.changes[0].lips[scene.changes[0].lips.size() / 2];
    held = middle.left, other = middle.right;
  }
  const Vec3d at = scene.place(held);
  if (!scene.body().hold_point(held, at + Vec3d(0.05, 0, 0.11))) std::exit(1);
  const int steps = scene.step_until_still();
  print_text(printed("%s: %d steps; the held point moved by %.4f m, the other lip by %.4f m\n",
                     is_torn ? "pull_after" : "pull_before", steps,
                     scene.body().point_displacement(held).norm(),
                     scene.body().point_displacement(other).norm()));
  scene.draw(folder + (is_torn ? "/particles_pull_after.png" : "/particles_pull_before.png"),
             look_from(-8, 24), at, 0.36);
}

void draw_gap(const std::string& folder) {
  SoftScene scene({SoftMaterial()}, kRange);
  scene.tear(along_trunk(1.58, 1.02));
  if (!scene.body().set_tension({1.2, {}})) std::exit(1);
  const int steps = scene.step_until_still();
  print_text(printed("gap: %d steps; %.4f of the diagonal wide\n", steps,
                     scene.widest_gap() / scene.diagonal()));
  const Vec3d at = scene.place(scene.changes[0].lips[scene.changes[0].lips.size() / 2].left);
  scene.draw(folder + "/particles_gap.png", look_from(12, 10), at, 0.42);
  if (!scene.body().set_tension({})) std::exit(1);
  const int back = scene.step_until_still();
  print_text(printed("gap: without tension, after %d steps: %.2e of the diagonal\n", back,
                     scene.widest_gap() / scene.diagonal()));
}

void draw_running(const std::string& folder) {
  SoftMaterial tough;
  tough.return_frequency = 1.6;
  tough.membrane_stiffness = 8;
  tough.damping_ratio = 1.5;
  SoftMaterial weak = tough;
  weak.strength = 1.8;
  weak.toughness = 0.25;
  SoftScene scene({tough, weak}, 0.05);
  // Only the front is weak, so that the held parts do not tear out.
  for (std::uint32_t p = 0; p < scene.particles().particle_count(); ++p) {
    const Vec3f& seed = scene.particles().positions()[scene.particles().seed(p)];
    if (seed.x() > 0.0f && seed.z() > 0.0f) (void)scene.body().set_material(p, 1);
  }
  scene.tear(along_trunk(1.39, 1.21));
  const Vec3d at = scene.place(scene.point_at({0, 1.3, 0.16}));
  std::vector<HoldId> holds;
  std::vector<Vec3d> from;
  std::vector<double> side;
  for (const double x : {-1.0, 1.0})
    for (const double y : {1.27, 1.33}) {
      const std::uint32_t point = scene.point_at({0.075 * x, y, 0.15});
      from.push_back(scene.place(point));
      side.push_back(x);
      auto hold = scene.body().hold_point(point, from.back());
      if (!hold) std::exit(1);
      holds.push_back(*hold);
    }
  int tears = 0, picture = 0;
  double length = 0;
  for (int i = 0; i <= kMoments[2]; ++i) {
    for (std::size_t h = 0; h < holds.size(); ++h)
      (void)scene.body().move_hold(holds[h],
                                   from[h] + Vec3d(side[h] * std::min(kFarthest, 0.001 * i), 0, 0));
    scene.step();
    const auto report = scene.tear_overstretched();
    if (!report) {
      print_text(printed("running: step %d: %s\n", i, report.error().text().data()));
      continue;
    }
    if (report->has_torn) {
      ++tears, length += report->tear.length_posed;
      print_text(printed(
          "running: step %d, stretch %.2f, %s at (%.3f %.3f %.3f) towards (%.2f %.2f %.2f), %.4f "
          "m\n",
          i, report->greatest_stretch, report->is_from_tip ? "continued" : "began",
          report->place.x() - at.x(), report->place.y() - at.y(), report->place.z() - at.z(),
          report->direction.x(), report->direction.y(), report->direction.z(),
          report->tear.length_posed));
    }
    if (i == kMoments[0] || i == kMoments[1] || i == kMoments[2]) {
      print_text(printed("running_%d: step %d: %d tears, %.3f m\n", picture + 1, i, tears, length));
      scene.draw(folder + "/particles_running_" + std::to_string(++picture) + ".png",
                 look_from(8, 8), at, 0.3);
    }
  }
}

}  // namespace
}  // namespace sunder::tools

int main(int count, char** arguments) {
  if (count != 2) return 2;
  using namespace sunder::tools;
  const std::string folder = arguments[1];
  draw_decomposition(folder);
  draw_pull(folder, false);
  draw_pull(folder, true);
  draw_gap(folder);
  draw_running(folder);
  draw_recipes(folder);
}
