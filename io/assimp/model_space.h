#pragma once

#include <string>

#include <assimp/scene.h>

#include "io/assimp/notes.h"
#include "io/assimp/transform.h"

namespace sunder::assimp_import {

/// The transform from the scene as assimp returns it to model space: metres, y up, z to the front.
struct ModelSpace {
  Trs model_from_scene;  ///< A rotation and a uniform scale.
  bool is_identity = true;
  std::string description;  ///< For LoadReport::space.
};

/// FBX: unit and axes are read from the file's settings, which assimp 5.2 reads but does not apply.
/// COLLADA: assimp has applied both to the root node. Other formats store neither.
[[nodiscard]] ModelSpace model_space_of(const aiScene& scene, const std::string& extension,
                                        Notes& notes);

}  // namespace sunder::assimp_import
