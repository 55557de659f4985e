// Weights transferred to targets whose weights are known: the closest place beside inpainting.
// bench_transfer [MODEL...]; default: two procedural rigs, and the shared models if they are there.

#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/transfer/transfer_figures.h"
#include "support/models/rigs.h"
#if SUNDER_BENCH_IO
#include <sunder/io/character_file.h>
#endif

namespace {

using namespace sunder;

void print_table(const std::string& name, const Character& source) {
  std::size_t vertices = 0, triangles = 0;
  for (const Mesh& mesh : source.meshes) {
    vertices += mesh.positions.size();
    triangles += mesh.triangles.size();
  }
  std::printf("%s: %zu vertices, %zu triangles, %zu bones\n", name.c_str(), vertices, triangles,
              source.skeleton.bones.size());
  std::printf("  %-12s %8s | %-31s | %s\n", "", "", "closest place", "inpainting");
  std::printf("  %-12s %8s | %9s %10s %10s | %9s %10s %10s\n", "target", "matched", "L1",
              "RMS/diag", "seconds", "L1", "RMS/diag", "seconds");
  for (const bench::TransferCase& target : bench::transfer_cases(source)) {
    TransferOptions options;
    options.method = TransferMethod::closest_point;
    const auto closest = bench::measure_transfer(source, target.truth, options);
    options.method = TransferMethod::inpainting;
    const auto filled = bench::measure_transfer(source, target.truth, options);
    std::printf("  %-12s %7.2f%% | %9.2e %10.2e %10.3f | %9.2e %10.2e %10.3f\n",
                target.name.c_str(), 100 * filled.matched, closest.l1, closest.rms, closest.seconds,
                filled.l1, filled.rms, filled.seconds);
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::filesystem::path> files(argv + 1, argv + argc);
  if (files.empty()) {
    print_table("tube", test::make_tube(60, 32, 6));
    print_table("ball", test::make_bumpy_ball(10000));
    for (const char* const file : {"fox.glb", "cesium_man.dae", "mannequiny.glb", "vr_glove.fbx"})
      if (const auto path = std::filesystem::path(SUNDER_SHARED_MODELS) / "rigged" / file;
          std::filesystem::exists(path))
        files.push_back(path);
  }
#if SUNDER_BENCH_IO
  for (const auto& file : files) {
    const auto loaded = load_character(file);
    if (loaded)
      print_table(file.stem().string(), *loaded->character);
    else
      std::fprintf(stderr, "%s: %.255s\n", file.c_str(), loaded.error().text().data());
  }
#endif
  return 0;
}
