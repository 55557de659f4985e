// Whole frames of scenes: bench_scene [--summary]
//
// Without an option: tables of frame times for crowds of three models, and of a loop of twenty
// seconds. With --summary: one JSON object.

#include <cstdio>
#include <cstring>

#include "bench/scene_summary.h"

int main(int argc, char** argv) {
  if (argc > 1 && std::strcmp(argv[1], "--summary") == 0)
    sunder::bench::print_scene_summary();
  else
    sunder::bench::print_scene_tables();
}
