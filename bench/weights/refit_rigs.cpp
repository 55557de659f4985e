#include "bench/weights/refit_rigs.h"

#include <algorithm>
#include <cstdio>

#include "support/models/animated_rig.h"

#if SUNDER_BENCH_IO
#include <sunder/io/character_file.h>

#include <filesystem>
#endif

namespace sunder::bench {
namespace {

constexpr int kSeeds = 3;
constexpr int kRandomRigs = 200;

#if SUNDER_BENCH_IO
/// In the order of their names.
std::vector<std::filesystem::path> files_below(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder, error))
    if (entry.is_regular_file()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

bool bends(const Character& character) {
  return !character.clips.empty() &&
         std::any_of(character.meshes.begin(), character.meshes.end(), [&](const Mesh& mesh) {
           return mesh.weights.influences.size() > mesh.vertex_count();
         });
}

void add_files(std::vector<BendingRig>& rigs) {
  for (const char* folder : {SUNDER_SHARED_MODELS "/rigged", "/usr/share/assimp/models"})
    for (const std::filesystem::path& file : files_below(folder)) {
      const auto loaded = load_character(file);
      if (loaded && bends(*loaded->character))
        rigs.push_back({file.filename().string(), loaded->character});
    }
}
#endif

}  // namespace

std::vector<BendingRig> bending_rigs(int random_rigs) {
  std::vector<BendingRig> rigs;
#if SUNDER_BENCH_IO
  add_files(rigs);
#endif
  for (int i = 0; i < random_rigs; ++i) {
    test::Random random(static_cast<std::uint64_t>(i));
    const test::AnimatedRig rig = test::any_animated_rig(random);
    rigs.push_back({"random rig " + std::to_string(i),
                    std::make_shared<const Character>(test::make_animated_rig(rig, random))});
  }
  return rigs;
}

std::vector<test::RefitGains> measure_refit_rigs() {
  std::vector<test::RefitGains> all;
  const std::vector<BendingRig> rigs = bending_rigs(kRandomRigs);
  for (std::size_t i = 0; i < rigs.size(); ++i) {
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      test::RefitGains gains = test::measure_refit_gains(rigs[i].name, rigs[i].character, seed);
      if (gains.points > 0) all.push_back(std::move(gains));
    }
    if (i % 20 == 19) std::fprintf(stderr, "%zu of %zu rigs\n", i + 1, rigs.size());
  }
  return all;
}

}  // namespace sunder::bench
