// Whole frames of scenes: bench_scene [--summary | --stages [vertices]]
//
// Without an option: tables of frame times for crowds of three models, and of a loop of twenty
// seconds. With --summary: one JSON object. With --stages: what the slowest frames of the loop are
// made of, with large operations in the frame and in the background.

#include <cstdlib>
#include <cstring>

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

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1 && std::strcmp(argv[1], "--summary") == 0)
    sunder::bench::print_scene_summary();
  else if (argc > 1 && std::strcmp(argv[1], "--stages") == 0)
    print_stages(argc, argv);
  else
    sunder::bench::print_scene_tables();
}
