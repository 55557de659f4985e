// A ball is pressed into a soft tube that bends, held there, and taken away.

#include <sunder/scene/character_instance.h>

#include <algorithm>
#include <cstdio>
#include <memory>

#include "samples/tube.h"

namespace {

constexpr double kRadius = 0.15;  ///< Of the tube, metres.
constexpr double kFrame = 1.0 / 60, kBall = 0.08;

double deepest_dent(sunder::SoftBody& body) {
  double most = 0;
  for (const sunder::Vec4f& d : body.displacements())
    most = std::max(most, double{d.head<3>().norm()});
  return most;
}

int fail(const char* what, const sunder::Status& status) {
  std::printf("%s: %s\n", what, status.text().data());
  return 1;
}

}  // namespace

int main() {
  const auto character = std::make_shared<const sunder::Character>(samples::make_tube({32, 60}));
  sunder::CharacterAssetOptions options;
  options.soft.emplace();
  options.soft->materials = {sunder::find_material("fat").value()};
  options.soft->decomposition.range = options.soft->materials[0].range / 2;
  auto instance = sunder::CharacterInstance::create(character, options);
  if (!instance) return fail("create", instance.error());
  if (const auto status = instance->prepare_to_tear(); !status) return fail("create", status);
  sunder::SoftBody& body = *instance->body();

  const sunder::Collider ball = {
      sunder::Collider::Sphere{kBall}, {0, 0.25, 0.4}, sunder::Quatd::Identity(), 0.3};
  if (const sunder::Status status = body.set_colliders({&ball, 1}); !status)
    return fail("colliders", status);
  const auto frame = [&](double angle, double distance) {
    (void)body.move_collider(0, {0, 0.25, distance}, sunder::Quatd::Identity());
    return instance->advance(samples::bent(*character, angle), kFrame);
  };

  // The ball moves in by six centimetres within a second while the tube bends, stays for a second,
  // and moves out again.
  const double touches = kRadius + kBall, far = touches + 0.1, near = touches - 0.06;
  double angle = 0, dent = 0, left_inside = 0;
  std::uint32_t most_awake = 0;
  for (int i = 1; i <= 180; ++i) {
    const double in = i <= 60 ? i / 60.0 : i <= 120 ? 1.0 : (180 - i) / 60.0;
    angle = 0.6 * std::min(1.0, i / 60.0);
    if (const sunder::Status status = frame(angle, far + in * (near - far)); !status)
      return fail("advance", status);
    dent = std::max(dent, deepest_dent(body));
    left_inside = std::max(left_inside, body.contacts().deepest);
    most_awake = std::max(most_awake, body.awake_count());
  }
  std::printf("the deepest dent: %.1f mm; contact points were inside the ball by %.2f mm at most\n",
              1e3 * dent, 1e3 * left_inside);
  std::printf("of %u particles at most %u were awake\n", body.particle_count(), most_awake);

  int frames = 0;
  for (; frames < 600 && body.awake_count() > 0; ++frames)
    if (const sunder::Status status = frame(angle, far); !status) return fail("advance", status);
  std::printf("it was at rest %.2f s after the ball had gone, %.3g mm from where it was\n",
              frames * kFrame, 1e3 * deepest_dent(body));

  const bool held = dent > 0.04 && dent < 0.1 && left_inside < 1e-3 && body.awake_count() == 0 &&
                    deepest_dent(body) == 0;
  std::puts(held ? "the tube gave way and came back" : "the tube did NOT do what it should");
  return held ? 0 : 1;
}
