// Measures the stages of every frame of a soft character that is torn again and again.

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "bench/harness/measure.h"
#include "bench/particles/particles_loop.h"

namespace sunder::bench {
namespace {

using Stage = double (*)(const LoopTimes&);
struct Column {
  const char* name;
  Stage stage;
};
constexpr Column kColumns[] = {
    {"frame", [](const LoopTimes& t) { return t.frame(); }},
    {"operate", [](const LoopTimes& t) { return t.operate; }},
    {"after it", [](const LoopTimes& t) { return t.after_tear(); }},
    {"follow", [](const LoopTimes& t) { return t.follow; }},
    {"settle", [](const LoopTimes& t) { return t.settle; }},
    {"moved", [](const LoopTimes& t) { return t.moved; }},
    {"gradients", [](const LoopTimes& t) { return t.gradients; }},
    {"update", [](const LoopTimes& t) { return t.update; }},
    {"step", [](const LoopTimes& t) { return t.step; }},
    {"deform", [](const LoopTimes& t) { return t.deform; }},
};

void print(const LoopFigures& figures) {
  std::printf(
      "%s: %zu vertices, %zu points, %zu bones, %zu particles; microseconds, median and most\n",
      figures.name.c_str(), figures.vertices, figures.points, figures.bones, figures.particles);
  std::printf("%-7s %6s", "frame", "count");
  for (const Column& column : kColumns) std::printf(" %15s", column.name);
  std::printf("\n");
  for (int kind = 0; kind < 8; ++kind) {
    const auto is_of = [&](const LoopTimes& t) { return static_cast<int>(t.kind) == kind; };
    const auto count = std::count_if(figures.frames.begin(), figures.frames.end(), is_of);
    if (count == 0) continue;
    std::printf("%-7s %6td", name_of(static_cast<LoopFrame>(kind)), count);
    for (const Column& column : kColumns) {
      std::vector<double> values;
      for (const LoopTimes& t : figures.frames)
        if (is_of(t)) values.push_back(1e6 * column.stage(t));
      std::printf(" %7.0f %7.0f", median(values), *std::max_element(values.begin(), values.end()));
    }
    std::printf("\n");
  }
  std::fflush(stdout);
}

}  // namespace
}  // namespace sunder::bench

int main(int argc, char** argv) {
  const int only = argc > 1 ? std::atoi(argv[1]) : 0;
  for (const int divisions : {2, 8})
    if (only == 0 || only == divisions) sunder::bench::print(sunder::bench::play_loop(divisions));
}
