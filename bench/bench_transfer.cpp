// Weights transferred to targets whose weights are known: the closest place beside inpainting.
// bench_transfer [MODEL...]; default: two procedural rigs, and the shared models if they are there.

#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "bench/transfer/transfer_figures.h"
#include "support/models/rigs.h"
#if SUNDER_BENCH_IO
#include <sunder/io/character_file.h>
#endif

namespace {

using namespace sunder;

/// What one model's transfers gave, by target.
struct Column {
  std::string model;
  std::vector<std::pair<std::string, std::string>> cells;
};

/// Prints the figures of a model as they come, and keeps those of the last table.
Column measure_model(const std::string& name, const Character& source) {
  Column column = {name, {}};
  std::size_t vertices = 0, triangles = 0;
  for (const Mesh& mesh : source.meshes) {
    vertices += mesh.positions.size();
    triangles += mesh.triangles.size();
  }
  std::printf("%s: %zu vertices, %zu triangles, %zu bones\n\n", name.c_str(), vertices, triangles,
              source.skeleton.bones.size());
  std::printf(
      "| target | matched | L1, closest place | RMS / diagonal | seconds | L1, inpainting | RMS / "
      "diagonal | seconds |\n|---|---|---|---|---|---|---|---|\n");
  for (const bench::TransferCase& target : bench::transfer_cases(source)) {
    TransferOptions options;
    options.method = TransferMethod::closest_point;
    const auto closest = bench::measure_transfer(source, target.truth, options);
    options.method = TransferMethod::inpainting;
    const auto filled = bench::measure_transfer(source, target.truth, options);
    std::printf("| %s | %.1f %% | %.2e | %.2e | %.3f | %.2e | %.2e | %.3f |\n", target.name.c_str(),
                100 * filled.matched, closest.l1, closest.rms, closest.seconds, filled.l1,
                filled.rms, filled.seconds);
    char cell[64];
    std::snprintf(cell, sizeof cell, "%.2g / %.2g, %.3g %%", 100 * closest.rms, 100 * filled.rms,
                  100 * filled.matched);
    column.cells.emplace_back(target.name, cell);
  }
  std::printf("\n");
  return column;
}

/// Posed RMS in per cent of the diagonal, closest place / inpainting, and the share matched.
void print_models(const std::vector<Column>& columns) {
  std::string head = "| target |", dashes = "|---|";
  for (const Column& column : columns) {
    head += " " + column.model + " |";
    dashes += "---|";
  }
  std::printf("%s\n%s\n", head.c_str(), dashes.c_str());
  for (std::size_t row = 0; row < columns.front().cells.size(); ++row) {
    std::printf("| %s |", columns.front().cells[row].first.c_str());
    for (const Column& column : columns) std::printf(" %s |", column.cells[row].second.c_str());
    std::printf("\n");
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::filesystem::path> files(argv + 1, argv + argc);
  std::vector<Column> columns;
  if (files.empty()) {
    columns.push_back(measure_model("tube", test::make_tube(60, 32, 6)));
    columns.push_back(measure_model("ball", test::make_bumpy_ball(10000)));
    for (const char* const file : {"fox.glb", "cesium_man.dae", "mannequiny.glb", "vr_glove.fbx"})
      if (const auto path = std::filesystem::path(SUNDER_SHARED_MODELS) / "rigged" / file;
          std::filesystem::exists(path))
        files.push_back(path);
  }
#if SUNDER_BENCH_IO
  for (const auto& file : files) {
    const auto loaded = load_character(file);
    if (loaded)
      columns.push_back(measure_model(file.stem().string(), *loaded->character));
    else
      std::fprintf(stderr, "%s: %.255s\n", file.c_str(), loaded.error().text().data());
  }
#endif
  if (!columns.empty()) print_models(columns);
  return 0;
}
