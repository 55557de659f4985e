#pragma once

#include <sunder/certificate/certificate.h>
#include <sunder/io/character_file.h>

#include <cstdint>
#include <string>
#include <vector>

namespace sunder::tools {

/// The request of `--max-error` and `--limits`.
struct MaximumError {
  double metres = 0;
  std::string limits = "none";  ///< "none", "clips" or a file.
};

/// The weights of one mesh as they are written.
struct CertifiedMesh {
  std::uint32_t mesh = 0;
  WeightFormat format = WeightFormat::float32;
  std::uint32_t sets = 1;             ///< Number of JOINTS_n and of WEIGHTS_n.
  std::uint64_t bytes_as_floats = 0;  ///< Of joints and weights, all influences as floats.
  std::uint64_t bytes = 0;            ///< Of joints and weights as written.
  std::vector<double> bound;          ///< One per vertex, metres: certified for what is written.
  std::uint32_t changed = 0;          ///< Vertices whose weights differ from the unpruned ones.
  std::uint32_t morphed = 0;          ///< Of these, vertices that a morph target displaces.
  std::uint32_t uncertified = 0;      ///< Vertices that keep all weights, as no change has a bound.
};

/// A character with fewer influences and their certificate against the unpruned one.
struct CertifiedWeights {
  Character character;  ///< The unpruned one with other weights, exactly as the file stores them.
  std::vector<WeightFormat> formats;  ///< One per mesh, for SaveOptions::weights_of_mesh.
  std::vector<CertifiedMesh> meshes;  ///< Those whose weights were chosen, ascending.
  double maximum = 0;                 ///< No vertex moves farther within the limits, metres.
};

/// Chooses influences and number formats such that no pose within the limits moves a vertex farther
/// from the unpruned skin than the maximum error: per vertex the fewest influences, per mesh the
/// format that takes the fewest bytes. Concerned are the meshes that differ from `loaded`, and
/// those that share points with them: vertices that coincide and move alike keep equal weights.
/// Linear blend skinning without morph targets; docs/certificate.md.
///
/// @param unpruned  `loaded.character`, torn or with other weights.
/// @param loaded    with the stored influences, where the file is glTF.
/// @return the failures of joint_limits_named(), JointTree::create() and certified_influences().
[[nodiscard]] Result<CertifiedWeights> certify_weights(const Character& unpruned,
                                                       const LoadedCharacter& loaded,
                                                       const MaximumError& wanted);

}  // namespace sunder::tools
