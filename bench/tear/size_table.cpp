#include "bench/tear/size_table.h"

#include <cstdio>
#include <cstdlib>

#include "bench/tear/tear_scene.h"

namespace sunder::bench {
namespace {

/// Benchmarks by name, and what they measure.
constexpr const char* kRows[][2] = {
    {"tear_warm", "tear, warm"},
    {"tear_cold", "tear, caches swept before, including code"},
    {"entry_query", "query: where the blade meets the surface"},
    {"undo", "undo"},
    {"redo", "redo"},
    {"width_warm", "tear with a width"},
    {"drill_open_warm", "bore without a wall across as many faces"},
    {"drill_warm", "bore with a wall, of half the radius"},
    {"long_stroke", "a long stroke: each of the last 20 of 1,000 extensions"},
    {"cut_whole", "plane cut of the whole model, pieces named"},
    {"cut_whole_with_caps", "the same with caps"},
    {"vtk_plane_clipper", "`vtkPolyDataPlaneClipper` of the same mesh"},
    {"pose_whole_model", "posing the whole model once, double"},
    {"touch_warm", "reading and writing only the data that a tear must touch, warm"},
    {"touch_cold", "the same, caches swept"},
};

}  // namespace

std::string SizeTable::filter() {
  std::string names;
  for (const auto& row : kRows) names += (names.empty() ? "^(" : "|") + std::string(row[0]);
  return names + ")/";
}

bool SizeTable::ReportContext(const Context&) { return true; }

void SizeTable::ReportRuns(const std::vector<Run>& runs) {
  for (const Run& run : runs)
    if (!run.error_occurred)
      microseconds_[run.run_name.function_name][std::atoi(run.run_name.args.c_str())] =
          run.GetAdjustedRealTime();
}

void SizeTable::Finalize() {
  std::printf("| µs |");
  for (const int divisions : kDivisions) std::printf(" %s points |", size_name(divisions).c_str());
  std::printf("\n|---|");
  for (std::size_t i = 0; i < kDivisions.size(); ++i) std::printf("---|");
  for (const auto& [name, text] : kRows) {
    const auto found = microseconds_.find(name);
    if (found == microseconds_.end()) continue;
    std::printf("\n| %s |", text);
    for (const int divisions : kDivisions)
      std::printf(" %.*f |", found->second[divisions] < 10 ? 1 : 0, found->second[divisions]);
  }
  std::printf("\n");
}

}  // namespace sunder::bench
