// Measures aimed operations: where they are found, and what they tear, at the default share of the
// limbs with the most vertices of their own.
// Usage: bench_aim MODEL...
#include <sunder/aim/aim.h>
#include <sunder/io/character_file.h>
#include <sunder/operation/operation.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bench/harness/cpu_seconds.h"
#include "bench/harness/measure.h"

namespace sunder::bench {
namespace {

constexpr std::size_t kLimbs = 5;
constexpr Effort kFifteen = {15, 60, 15};

/// Names of bones, those first that move the most vertices more than any other bone does.
std::vector<std::string> limbs_of(const Character& character) {
  const std::vector<Bone>& bones = character.skeleton.bones;
  std::vector<std::size_t> own(bones.size(), 0);
  for (const Mesh& mesh : character.meshes)
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
      const auto influences = mesh.weights.of(v);
      const auto most = std::max_element(
          influences.begin(), influences.end(),
          [](const Influence& a, const Influence& b) { return a.weight < b.weight; });
      if (most != influences.end()) ++own[character.skins[mesh.skin].bones[most->slot]];
    }
  std::vector<std::size_t> order;
  for (std::size_t b = 0; b < bones.size(); ++b)
    if (own[b] > 0) order.push_back(b);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return own[a] > own[b]; });
  std::vector<std::string> names;
  for (const std::size_t b : order) names.push_back(bones[b].name);
  return names;
}

/// Milliseconds of processor time: the median over limbs of the median of 15. Empty if it is
/// refused at each limb.
template <class Aimed>
std::optional<double> milliseconds(const std::shared_ptr<const Character>& character,
                                   const std::vector<std::string>& limbs) {
  std::vector<double> of_limbs;
  for (const std::string& limb : limbs) {
    if (of_limbs.size() == kLimbs) break;
    Aimed aimed;
    aimed.place.bone = limb;
    bool is_refused = false;
    const auto run = [&] {
      auto model = TornModel::create(character);
      return cpu_seconds_of([&] {
        const auto plain = resolve(*model, aimed);
        is_refused = !plain || !apply_operation(*model, *plain);
      });
    };
    run();  // warms up
    if (!is_refused) of_limbs.push_back(1000 * median(sample(kFifteen, run)));
  }
  if (of_limbs.empty()) return std::nullopt;
  return median(of_limbs);
}

void print_time(const std::optional<double>& time) {
  if (time)
    std::printf(" %.1f |", *time);
  else
    std::printf(" refused |");
}

int run(int count, char** arguments) {
  if (count < 2) {
    std::fprintf(stderr, "usage: bench_aim MODEL...\n");
    return 2;
  }
  std::printf(
      "| processor milliseconds | faces | sever | slash | puncture |\n|---|---|---|---|---|\n");
  for (int i = 1; i < count; ++i) {
    const std::string file = arguments[i];
    const auto loaded = load_character(file);
    if (!loaded) {
      std::fprintf(stderr, "%s: %s\n", file.c_str(), std::string(loaded.error().text()).c_str());
      return 1;
    }
    const std::shared_ptr<const Character>& character = loaded->character;
    std::size_t faces = 0;
    for (const Mesh& mesh : character->meshes) faces += mesh.triangle_count();
    std::printf("| %s | %zu |", file.substr(file.find_last_of('/') + 1).c_str(), faces);
    const std::vector<std::string> limbs = limbs_of(*character);
    print_time(milliseconds<SeverOperation>(character, limbs));
    print_time(milliseconds<SlashOperation>(character, limbs));
    print_time(milliseconds<PunctureOperation>(character, limbs));
    std::printf("\n");
  }
  return 0;
}

}  // namespace
}  // namespace sunder::bench

int main(int count, char** arguments) { return sunder::bench::run(count, arguments); }
