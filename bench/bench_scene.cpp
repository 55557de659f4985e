// Whole frames of scenes: bench_scene [--summary | --stages [vertices] | --engine [divisions]]
//
// Without an option: tables of frame times for crowds of three models, and of a loop of twenty
// seconds. With --summary: one JSON object. With --stages: what the slowest frames of the loop are
// made of, with large operations in the frame and in the background. With --engine: twenty seconds
// as an engine draws them, with normals, tangents and walls, a row per phase and event: processor
// time of the updating thread, what is uploaded, allocations, and frames that take longer than one
// at 72, 90 and 120 Hz. Divisions 2 and 8 are 13 and 214 thousand vertices.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#if defined(__GLIBC__)
#include <malloc.h>
#endif

#include "bench/scene/engine_loop.h"
#include "bench/scene/scene_loop.h"
#include "bench/scene/scene_summary.h"

namespace {

using sunder::bench::LoopMode;

void print_stages(int argc, char** argv) {
  const auto vertices = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 13'380;
  constexpr LoopMode kModes[] = {LoopMode::in_frame, LoopMode::in_background};
  for (const LoopMode mode : kModes)
    sunder::bench::print_loop_stages(static_cast<std::uint32_t>(vertices), mode, 3);
}

void print_engine(int divisions) {
  for (const bool in_background : {true, false}) {
    const sunder::bench::EngineRun run = sunder::bench::run_engine(divisions, in_background, 2);
    std::printf("%u vertices, large operations %s\n", run.vertices,
                in_background ? "in the background" : "in the frame");
    sunder::bench::print_engine_table(run);
    std::printf("\n");
  }
}

void print_engine(int argc, char** argv) {
  if (argc > 2) return print_engine(std::max(1, std::atoi(argv[2])));
  for (const int divisions : {2, 8}) print_engine(divisions);
}

}  // namespace

/// Makes malloc keep what is freed, as allocators of engines do. By default glibc gives much of it
/// back to the system, which maps it anew in a later frame.
void keep_freed_memory() {
#if defined(__GLIBC__)
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
#endif
}

int main(int argc, char** argv) {
  keep_freed_memory();
  if (argc > 1 && std::strcmp(argv[1], "--summary") == 0)
    sunder::bench::print_scene_summary();
  else if (argc > 1 && std::strcmp(argv[1], "--stages") == 0)
    print_stages(argc, argv);
  else if (argc > 1 && std::strcmp(argv[1], "--engine") == 0)
    print_engine(argc, argv);
  else
    sunder::bench::print_scene_tables();
}
