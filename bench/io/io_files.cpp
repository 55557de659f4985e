#include "bench/io/io_files.h"

#include <sunder/io/character_file.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "bench/harness/skinned_subdivision.h"
#include "tools/demo/demo_rig.h"

namespace sunder::bench {
namespace {

namespace fs = std::filesystem;

const fs::path kShared = SUNDER_SHARED_MODELS "/rigged";

std::size_t vertices_of(const Character& character) {
  std::size_t count = 0;
  for (const Mesh& mesh : character.meshes) count += mesh.positions.size();
  return count;
}

Character load(const fs::path& file) {
  const auto loaded = load_character(file);
  if (loaded) return *loaded->character;
  std::fprintf(stderr, "%s: %s\n", file.c_str(), loaded.error().text().data());
  std::exit(1);
}

IoFile write(const Character& character, const std::string& name, const fs::path& folder) {
  const fs::path file = folder / (name + ".glb");
  SaveOptions options;
  options.maximum_influences = 4;
  if (const Status status = save_glb(file, character, options); !status) {
    std::fprintf(stderr, "%s: %s\n", file.c_str(), status.text().data());
    std::exit(1);
  }
  return {name, file, vertices_of(character), character.clips.size()};
}

struct Base {
  std::string name;
  Character character;
};

Base load_base() {
  const fs::path shared = kShared / "mannequiny.glb";
  if (fs::exists(shared)) return {"mannequiny", load(shared)};
  std::fprintf(stderr, "%s is not there: the demo's rig instead\n", shared.c_str());
  return {"cactus", tools::make_cactus()};
}

/// The divisions per edge for about `vertices` vertices: a face gets the square of the divisions
/// as faces, and somewhat more than half a vertex for each.
int divisions_for(const Base& base, std::size_t vertices) {
  std::size_t faces = 0;
  for (const Mesh& mesh : base.character.meshes) faces += mesh.triangles.size();
  const double per_division = 0.55 * static_cast<double>(faces);
  return std::max(
      1, static_cast<int>(std::lround(std::sqrt(static_cast<double>(vertices) / per_division))));
}

IoFile write_subdivided(const Base& base, std::size_t vertices, const fs::path& folder) {
  const int divisions = divisions_for(base, vertices);
  return write(subdivide_skinned(base.character, divisions),
               base.name + " x" + std::to_string(divisions), folder);
}

}  // namespace

std::vector<IoFile> small_characters(const fs::path& folder) {
  std::vector<IoFile> files;
  for (const char* name : {"cactoro", "mannequiny", "fox", "robot_expressive"}) {
    const fs::path file = kShared / (std::string(name) + ".glb");
    if (!fs::exists(file)) continue;
    const Character character = load(file);
    files.push_back({name, file, vertices_of(character), character.clips.size()});
  }
  if (files.empty()) files.push_back(write(tools::make_cactus(), "cactus", folder));
  return files;
}

std::vector<IoFile> growing_files(const fs::path& folder, std::size_t largest) {
  const Base base = load_base();
  std::vector<IoFile> files;
  for (std::size_t vertices = 10000; vertices <= largest; vertices *= 10)
    for (const std::size_t size : {vertices, 4 * vertices})
      if (size <= largest) files.push_back(write_subdivided(base, size, folder));
  return files;
}

IoFile large_file(const fs::path& folder, std::size_t vertices) {
  return write_subdivided(load_base(), vertices, folder);
}

}  // namespace sunder::bench
