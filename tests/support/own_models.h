#pragma once

#include <sunder/io/character_file.h>

#include <string>
#include <vector>

namespace sunder::test {

/// A rigged model of our own making, as tests/data/rigged holds it.
struct OwnModel {
  std::string file;  ///< "tube.glb".
  Character character;
  SaveOptions options;
};

/// The models of tests/data/rigged, each small and each with what another lacks. Written there by
/// `write_own_models`.
std::vector<OwnModel> make_own_models();

}  // namespace sunder::test
