// Operations on the rigged models in files.

#include <sunder/io/character_file.h>

#include <memory>
#include <utility>
#include <vector>

#include "bench/stress/families.h"
#include "bench/stress/steps.h"
#include "support/models/random_operations.h"
#include "support/models/shared_models.h"

namespace sunder::stress {
namespace {

using test::Random;
using Characters = std::vector<std::shared_ptr<const Character>>;

/// Larger ones take seconds for each check of the laws.
constexpr std::uint32_t kMostVertices = 40'000;

/// The models that can be torn; read once per process.
const Characters& rigged_files() {
  static const Characters files = [] {
    Characters read;
    for (const auto& file : test::rigged_gltf_models()) {
      auto loaded = load_character(file);
      if (!loaded) continue;
      std::uint32_t vertices = 0;
      for (const Mesh& mesh : loaded->character->meshes) vertices += mesh.vertex_count();
      if (vertices == 0 || vertices > kMostVertices) continue;
      read.push_back(loaded->character);
    }
    return read;
  }();
  return files;
}

}  // namespace

void models_in_files(std::uint64_t seed, const Steps& steps, CaseReport& report) {
  const Characters& files = rigged_files();
  if (files.empty()) return report.violate("files", "no model could be read");
  Random random = random_of(seed, 0);
  Character character = *files[seed % files.size()];
  // Operations aim at the first mesh.
  std::swap(character.meshes[0],
            character.meshes[random.index(static_cast<std::uint32_t>(character.meshes.size()))]);
  TornSubject subject(std::move(character), report);
  run_steps(subject, seed, steps, 4, [](TornSubject& of, Random& numbers, std::uint32_t) {
    of.operate(test::random_operation(of.model(), numbers));
  });
}

}  // namespace sunder::stress
