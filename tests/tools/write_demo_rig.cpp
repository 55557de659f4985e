#include <sunder/io/character_file.h>

#include <cstdio>

#include "tools/demo/demo_rig.h"

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const sunder::Status status = sunder::save_glb(argv[1], sunder::tools::make_cactus());
  if (!status) std::fprintf(stderr, "%s\n", status.text().data());
  return status ? 0 : 1;
}
