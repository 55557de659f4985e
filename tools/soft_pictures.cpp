// The pictures of docs/particles.md: soft_pictures FOLDER. What it measures on the way, it says.

#include <sunder/particles/force_tearing.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "tools/soft_scene.h"

namespace sunder::tools {
namespace {

constexpr double kRange = 0.1;  ///< Of the diagonal.

/// Down the trunk's front, a little curved.
std::vector<Vec2d> along_trunk(double from, double to) {
  std::vector<Vec2d> path;
  for (int i = 0; i <= 12; ++i) path.emplace_back(0.02 * std::sin(0.5 * i), from + (to - from) * i / 12);
  return path;
}

void draw_decomposition(const std::string& folder) {
  const SoftScene scene({}, kRange);
  std::printf("decomposition: %u particles of %u points\n", scene.particles->particle_count(), scene.particles->report().points);
  scene.draw_particles(folder + "/particles_decomposition.png");
}

/// The same point pulled the same way, before and after a tear beside it.
void draw_pull(const std::string& folder, bool is_torn) {
  SoftScene scene({}, kRange);
  std::uint32_t held = scene.point_at({0, 1.3, 0.16}), other = held;
  if (is_torn) {
    scene.tear(along_trunk(1.58, 1.02));
    const LipPair& middle = scene.changes[0].lips[scene.changes[0].lips.size() / 2];
    held = middle.left, other = middle.right;
  }
  const Vec3d at = scene.place(held);
  if (!scene.body->hold_point(held, at + Vec3d(0.10, 0, 0.14))) std::exit(1);
  const int steps = scene.step_until_still();
  std::printf("%s: %d steps; the held point moved by %.4f m, the other lip by %.4f m\n", is_torn ? "pull_after" : "pull_before",
              steps, scene.body->point_displacement(held).norm(), scene.body->point_displacement(other).norm());
  scene.draw(folder + (is_torn ? "/particles_pull_after.png" : "/particles_pull_before.png"), look_from(-38, 12), at, 0.42);
}

void draw_gap(const std::string& folder) {
  SoftScene scene({}, kRange);
  scene.tear(along_trunk(1.58, 1.02));
  if (!scene.body->set_tension({60, {}})) std::exit(1);
  const int steps = scene.step_until_still();
  std::printf("gap: %d steps; %.4f of the diagonal wide\n", steps, scene.widest_gap() / scene.diagonal());
  const Vec3d at = scene.place(scene.changes[0].lips[scene.changes[0].lips.size() / 2].left);
  scene.draw(folder + "/particles_gap.png", look_from(12, 10), at, 0.42);
  if (!scene.body->set_tension({})) std::exit(1);
  const int back = scene.step_until_still();
  std::printf("gap: without tension, after %d steps: %.2e of the diagonal\n", back, scene.widest_gap() / scene.diagonal());
}

void draw_running(const std::string& folder) {
  Material material;
  material.strength = 1.5;
  SoftScene scene(material, 0.05);
  scene.tear(along_trunk(1.34, 1.26));
  const Vec3d at = scene.place(scene.point_at({0, 1.3, 0.16}));
  std::vector<HoldId> holds;
  std::vector<Vec3d> from;
  std::vector<double> side;
  for (const double x : {-1.0, 1.0})
    for (const double y : {1.22, 1.3, 1.38}) {
      const std::uint32_t point = scene.point_at({0.1 * x, y, 0.14});
      from.push_back(scene.place(point));
      side.push_back(x);
      auto hold = scene.body->hold_point(point, from.back());
      if (!hold) std::exit(1);
      holds.push_back(*hold);
    }
  int tears = 0, picture = 0;
  double length = 0;
  for (int i = 0; i < 240; ++i) {
    for (std::size_t h = 0; h < holds.size(); ++h)
      (void)scene.body->move_hold(holds[h], from[h] + Vec3d(side[h] * std::min(0.12, 0.001 * i), 0, std::min(0.05, 0.0004 * i)));
    scene.step();
    std::vector<ChangeRecord> changes;
    const auto report = tear_overstretched(*scene.body, *scene.particles, *scene.model, scene.pose, {}, &changes);
    if (!report) {
      std::printf("running: step %d: %s\n", i, report.error().text().data());
      continue;
    }
    if (report->has_torn) {
      ++tears, length += report->tear.length_posed;
      std::printf("running: step %d, stretch %.2f, %s at (%.3f %.3f %.3f) towards (%.2f %.2f %.2f), %.4f m\n", i,
                  report->greatest_stretch, report->is_from_tip ? "ran on" : "began", report->place.x() - at.x(),
                  report->place.y() - at.y(), report->place.z() - at.z(), report->direction.x(), report->direction.y(),
                  report->direction.z(), report->tear.length_posed);
    }
    if (i == 40 || i == 80 || i == 239) {
      std::printf("running_%d: step %d: %d tears, %.3f m\n", picture + 1, i, tears, length);
      scene.draw(folder + "/particles_running_" + std::to_string(++picture) + ".png", look_from(8, 8), at, 0.42);
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
}
