// Measures poses: layers of clips, pulls at points, key frames.

#include <sunder/animation/clip_editor.h>
#include <sunder/animation/clip_player.h>
#include <sunder/animation/pull.h>
#include <sunder/skinning/pose.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bench/harness/cpu_seconds.h"
#include "bench/harness/measure.h"
#include "support/machine/random.h"
#include "support/models/animated_rig.h"

namespace sunder::bench {
namespace {

using test::Random;

/// The median over runs of the processor time of one call, microseconds.
double microseconds(int calls, const std::function<void()>& call) {
  std::vector<double> runs;
  for (int run = 0; run < 15; ++run)
    runs.push_back(1e6 * cpu_seconds_of([&] {
                     for (int i = 0; i < calls; ++i) call();
                   }) /
                   calls);
  return median(runs);
}

void measure_layers() {
  Random random(1);
  test::AnimatedRig wanted;
  wanted.bones = 163;
  const auto character = std::make_shared<const Character>(test::make_animated_rig(wanted, random));
  auto player = *ClipPlayer::create(character);
  Pose pose = *local_rest_pose(*character), sampled = pose;
  double time = 0;
  const double plain = microseconds(500, [&] {
    time = std::fmod(time + 0.011, static_cast<double>(character->clips[0].duration));
    (void)sample_clip(character->clips[0], time, sampled);
  });
  (void)player.play(clip_of(character, 0));
  const auto frame = [&] {
    (void)player.advance(0.011);
    if (player.has_changed()) (void)player.evaluate(pose);
  };
  std::printf("| %zu bones, %zu channels | µs |\n|---|---|\n", pose.parent_from_bone.size(),
              character->clips[0].channels.size());
  std::printf("| `sample_clip()` | %.2g |\n", plain);
  std::printf("| one layer | %.2g |\n", microseconds(500, frame));
  LayerOptions options;
  options.fade_in = 1e9;
  (void)player.cross_fade(clip_of(character, 1), options);
  std::printf("| a cross-fade of two | %.2g |\n", microseconds(500, frame));
  options = {};
  options.kind = LayerKind::additive;
  (void)player.play(clip_of(character, 2), options);
  std::printf("| the same and an additive layer | %.2g |\n", microseconds(500, frame));
  player.stop_all();
  (void)player.evaluate(pose);
  std::printf("| nothing plays | %.2g |\n", microseconds(5000, frame));
}

struct Arm {
  Skeleton skeleton;
  std::vector<std::uint32_t> bones;
  std::vector<BoneLimit> limits;
  Pose rest;
};

Arm make_arm(std::uint32_t count, bool is_limited) {
  Arm arm;
  for (std::uint32_t i = 0; i < count; ++i) {
    Bone bone;
    bone.name = std::to_string(i);
    bone.parent = i == 0 ? kNone : i - 1;
    bone.rest.translation = Vec3f(0.0f, i == 0 ? 0.0f : 1.0f, 0.0f);
    arm.skeleton.bones.push_back(bone);
    arm.bones.push_back(i);
    arm.rest.parent_from_bone.push_back(bone.rest);
    if (is_limited && i % 2 == 0)
      arm.limits.push_back({BoneLimit::Kind::cone, i, Vec3d(0, 1, 0), -0.7, 0.7, 1.2});
    if (is_limited && i % 2 == 1)
      arm.limits.push_back({BoneLimit::Kind::hinge, i, Vec3d(1, 0, 0), 0.0, 2.5, 0.0});
  }
  return arm;
}

void measure_pulls() {
  std::printf(
      "\n| chain | dragged by 1 %% of the reach, µs | from rest to anywhere in reach, µs | steps "
      "| from rest, out of reach, µs | steps |\n|---|---|---|---|---|---|\n");
  for (const std::uint32_t count : {2u, 4u, 10u, 30u})
    for (const bool is_limited : {false, true}) {
      const Arm arm = make_arm(count, is_limited);
      auto puller = *PosePuller::create(arm.skeleton, arm.bones, arm.limits);
      const PullHandle handle = handle_on_bone(arm.bones.back(), Vec3d(0, 1, 0));
      const double reach = count;
      Random random(count);
      Pose pose = arm.rest;
      double angle = 0, steps = 0;
      std::uint32_t calls = 0;
      const auto pull = [&](const Vec3d& place) {
        const PullTarget target = {&handle, place, 1.0};
        steps += puller.pull({&target, 1}, pose)->iterations;
        ++calls;
      };
      // A hand that moves along a curve, as a mouse drags it: 1 % of the reach per frame.
      const double drag = microseconds(200, [&] {
        angle += 0.02;
        pull(0.5 * reach * Vec3d(0.4 * std::sin(angle), 1.0, 0.6 + 0.4 * std::cos(angle)));
      });
      steps = calls = 0;
      const double far = microseconds(50, [&] {
        pose = arm.rest;
        const Vec3d direction = random.direction();
        pull(0.5 * reach * Vec3d(direction.x(), direction.y(), std::abs(direction.z())));
      });
      const double far_steps = steps / calls;
      steps = calls = 0;
      const double beyond = microseconds(50, [&] {
        pose = arm.rest;
        pull(1.5 * reach * random.direction());
      });
      std::printf("| %u bones%s | %.2g | %.2g | %.0f | %.2g | %.0f |\n", count,
                  is_limited ? " with limits" : "", drag, far, far_steps, beyond, steps / calls);
    }
}

void measure_keys() {
  Random random(2);
  test::AnimatedRig wanted;
  wanted.bones = 163;
  const auto character = std::make_shared<const Character>(test::make_animated_rig(wanted, random));
  auto editor = *ClipEditor::create(character, "recorded");
  Pose pose = *local_rest_pose(*character);
  int frame = 0;
  std::vector<double> runs;
  for (; frame < 600; ++frame) {
    (void)sample_clip(character->clips[0], std::fmod(frame / 60.0, 1.0), pose);
    runs.push_back(1e6 * cpu_seconds_of([&] { (void)editor.insert(frame / 60.0, pose); }));
  }
  std::printf("\n| 600 key frames of 163 bones | µs |\n|---|---|\n");
  std::printf("| `insert()` | %.2g |\n", median(runs));
  std::printf("| `snapshot()` | %.3g |\n", microseconds(3, [&] { (void)editor.snapshot(); }));
}

}  // namespace
}  // namespace sunder::bench

int main() {
  sunder::bench::measure_layers();
  sunder::bench::measure_pulls();
  sunder::bench::measure_keys();
  return 0;
}
