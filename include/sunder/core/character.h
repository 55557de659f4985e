#pragma once

#include <sunder/core/clip.h>
#include <sunder/core/mesh.h>
#include <sunder/core/skeleton.h>
#include <sunder/core/status.h>

#include <string>
#include <vector>

namespace sunder {

/// A rigged model: meshes and skins on one skeleton, with its clips. Rigid parts are meshes whose
/// skin has one bone.
struct Character {
  std::string name;
  Skeleton skeleton;
  std::vector<Skin> skins;
  std::vector<Mesh> meshes;
  /// The weights of all meshes, in one array; Mesh::first_morph_weight is each mesh's offset.
  std::vector<float> rest_morph_weights;
  std::vector<Clip> clips;

  bool operator==(const Character&) const = default;
};

/// Checks everything that the rest of the library relies on: lengths, index ranges, finite values,
/// the bone tree, unique bone names, normalised weights, key times. Triangles may be degenerate or
/// non-manifold; tearing accepts them.
///
/// O(size); allocates only a set of bone names.
///
/// @return the first fault: its index, and in the text its place ("mesh 2 'Body': vertex 812: …");
/// limit_exceeded: out of memory.
[[nodiscard]] SUNDER_API Status validate_character(const Character& character);

}  // namespace sunder
