#include "bench/tear/long_stroke.h"

#include <sunder/tear/tear_stroke.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <numeric>

#include "bench/harness/measure.h"
#include "support/models/rigs.h"

namespace sunder::bench {
namespace {

constexpr std::uint32_t kBones = 64;  // one unit of height each
constexpr int kSegments = 1000, kCompared = 20;

/// From the inside of one side of the tube to the inside of the next side. It rises, so that no
/// turn of the helix meets the previous one.
Blade blade_at(int segment, std::uint32_t sides) {
  const double angle = 2 * std::numbers::pi * (segment + 0.4) / sides,
               height = 4 + 0.05 * segment * kBones / sides;
  const Vec3d outwards(std::cos(angle), 0, -std::sin(angle)), axis(0, height, 0);
  return {axis + outwards, axis + 0.2 * outwards};
}

double mean_microseconds(std::vector<double>::const_iterator begin) {
  return std::accumulate(begin, begin + kCompared, 0.0) / kCompared * 1e6;
}

}  // namespace

LongStroke time_long_stroke(int divisions) {
  const auto sides = static_cast<std::uint32_t>(59 * divisions);
  const auto character = std::make_shared<const Character>(test::make_tube(sides, sides, kBones));
  test::Random random(1);
  const ModelPose rest = test::random_pose(*character, random, 0.0, 1.0);
  auto model = TornModel::create(character);
  auto stroke = TearStroke::create(*model, rest, blade_at(0, sides));
  std::vector<double> seconds;
  ChangeRecord change;
  for (int i = 1; i <= kSegments; ++i) {
    Result<TearReport> done = Status();
    seconds.push_back(
        seconds_of([&] { done = stroke->extend(rest, blade_at(i, sides), 0.0, &change); }));
    if (done && done->segments_missed == 0) continue;
    std::fprintf(stderr, "segment %d of the long stroke tore nothing\n", i);
    std::exit(1);
  }
  if (!stroke->end()) std::abort();
  return {seconds[0] * 1e6, mean_microseconds(seconds.begin() + 1),
          mean_microseconds(seconds.end() - kCompared)};
}

}  // namespace sunder::bench
