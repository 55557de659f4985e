// Writes the model of scripts/bench_platforms: a tube of 13 k vertices with a clip.
// write_platform_model FILE.glb

#include <sunder/io/character_file.h>

#include <cstdio>

#include "support/models/rigs.h"

int main(int argc, char** argv) {
  if (argc != 2) return std::fputs("usage: write_platform_model FILE.glb\n", stderr), 2;
  const sunder::Status status = sunder::save_glb(argv[1], sunder::test::make_tube(120, 110, 12));
  if (!status) std::fprintf(stderr, "%s\n", status.text().data());
  return status ? 0 : 1;
}
