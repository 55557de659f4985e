#pragma once

#include <sunder/core/mesh.h>
#include <sunder/io/robot_file.h>

#include <filesystem>
#include <vector>

#include "io/gltf_write/new_document.h"
#include "io/urdf/findings.h"
#include "io/urdf/link_tree.h"
#include "io/urdf/parse_by_urdfdom.h"
#include "io/urdf/tags.h"

namespace sunder::urdf {

struct LinkMeshes {
  std::vector<Mesh> of_link;  ///< In the order of the tree, in the link's frame; without weights.
  gltf::NewMaterials materials;
};

/// Reads and joins the shapes of each link.
[[nodiscard]] LinkMeshes read_link_meshes(const std::filesystem::path& file,
                                          const RobotLoadOptions& options, const RobotTags& tags,
                                          const ParsedRobot& parsed, const LinkTree& tree,
                                          Findings& findings);

}  // namespace sunder::urdf
