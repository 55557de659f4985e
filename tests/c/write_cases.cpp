// Writes the cases of print_digests: write_cases FOLDER COUNT.

#include <sunder/io/character_file.h>
#include <sunder/io/operation_log.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "support/models/animated_rig.h"
#include "support/models/random_operations.h"

namespace {

using namespace sunder;

/// A random rig with clips, or a sheet or tube, and operations on it, as far as they succeed.
bool write_case(const std::filesystem::path& folder, int number) {
  test::Random random(static_cast<std::uint64_t>(number));
  const Character character = number % 2 == 0
                                  ? test::make_animated_rig(test::any_animated_rig(random), random)
                                  : test::random_character(random);
  const auto glb = save_glb(character);
  if (!glb) return false;
  const auto read = load_glb(*glb);  // which rounds as its readers do
  if (!read) return false;
  auto model = TornModel::create(read->character);
  if (!model) return false;
  std::vector<Operation> operations;
  for (int i = 0; i < 4; ++i) {
    const Operation one = test::random_operation(*model, random);
    if (apply_operation(*model, one)) operations.push_back(one);
  }
  const std::string name = std::to_string(number);
  return save_glb(folder / (name + ".glb"), character).is_ok() &&
         save_operations(folder / (name + ".json"), operations).is_ok();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return std::fputs("usage: write_cases FOLDER COUNT\n", stderr), 2;
  std::filesystem::create_directories(argv[1]);
  for (int i = 0; i < std::atoi(argv[2]); ++i)
    if (!write_case(argv[1], i)) return std::fprintf(stderr, "case %d\n", i), 1;
  return 0;
}
