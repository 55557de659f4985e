// Writes the models of tests/data/rigged into a folder: write_own_models FOLDER

#include <cstdio>
#include <filesystem>
#include <fstream>

#include "io/assimp_text_models.h"
#include "support/models/own_models.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "write_own_models FOLDER\n");
    return 2;
  }
  for (const sunder::test::OwnModel& model : sunder::test::make_own_models()) {
    const auto file = std::filesystem::path(argv[1]) / model.file;
    const sunder::Status status = sunder::save_glb(file, model.character, model.options);
    if (!status) {
      std::fprintf(stderr, "%s: %s\n", model.file.c_str(), status.text().data());
      return 1;
    }
  }
  const std::filesystem::path folder = argv[1];
  std::ofstream(folder / "strip.x") << sunder::test::kSkinnedX;
  std::ofstream(folder / "sail.dae") << sunder::test::kSixBoneCollada;
  return 0;
}
