#include "bench/io/import_times.h"

#include <sunder/io/character_file.h>

#include <cstdio>
#include <cstdlib>
#include <string>

#include <assimp/Importer.hpp>
#include <assimp/scene.h>
#include <tiny_gltf.h>

#include "bench/harness/cpu_seconds.h"
#include "bench/harness/in_turns.h"

namespace sunder::bench {
namespace {

[[noreturn]] void give_up(const char* reader, const std::filesystem::path& file) {
  std::fprintf(stderr, "%s cannot read %s\n", reader, file.c_str());
  std::exit(1);
}

double load_ours(const std::filesystem::path& file) {
  return cpu_seconds_of([&] {
    if (!load_character(file)) give_up("load_character", file);
  });
}

double load_by_assimp(const std::filesystem::path& file) {
  return cpu_seconds_of([&] {
    Assimp::Importer importer;
    if (importer.ReadFile(file.string(), 0) == nullptr) give_up("assimp", file);
  });
}

/// The image is not decoded: geometry is compared.
bool keep_encoded(tinygltf::Image*, int, std::string*, std::string*, int, int, const unsigned char*,
                  int, void*) {
  return true;
}

double load_by_tinygltf(const std::filesystem::path& file) {
  return cpu_seconds_of([&] {
    tinygltf::TinyGLTF loader;
    loader.SetImageLoader(keep_encoded, nullptr);
    tinygltf::Model model;
    std::string error, warning;
    if (!loader.LoadBinaryFromFile(&model, &error, &warning, file.string()))
      give_up("tinygltf", file);
  });
}

}  // namespace

ImportTimes time_imports(const std::filesystem::path& glb, int rounds) {
  const Effort effort{1000, 5e-4, 1};
  std::vector<Candidate> candidates = {
      {[&] { return load_ours(glb); }, effort, rounds, 1},
      {[&] { return load_by_assimp(glb); }, effort, rounds, 1},
      {[&] { return load_by_tinygltf(glb); }, effort, rounds, 1},
  };
  measure_in_turns(candidates);
  return {median(candidates[0].seconds), median(candidates[1].seconds),
          median(candidates[2].seconds)};
}

}  // namespace sunder::bench
