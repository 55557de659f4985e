#pragma once

#include <sunder/core/character.h>
#include <sunder/io/character_bytes.h>

#include <cstdint>
#include <string>
#include <vector>

#include "io/usd_write/joints.h"
#include "io/usd_write/materials.h"
#include "io/usd_write/usd_text.h"

namespace sunder::usd {

/// Writes meshes as Mesh prims of a SkelRoot.
class MeshesWriter {
 public:
  /// @param shapes     names of the morph weights, as blend_shape_names().
  /// @param skeleton   path of the Skeleton.
  MeshesWriter(const Joints& joints, const Materials& materials,
               const std::vector<std::string>& shapes, std::string skeleton)
      : joints_(joints), materials_(materials), shapes_(shapes), skeleton_(std::move(skeleton)) {}

  /// @param path                of the prim; its last name is an identifier.
  /// @param maximum_influences  per vertex; 0: all.
  /// @throws gltf::Refusal  for weights without a positive sum.
  void write(UsdText& text, const Mesh& mesh, const std::string& path,
             std::uint32_t maximum_influences) const;

 private:
  void write_attributes(UsdText& text, const Mesh& mesh) const;
  void write_influences(UsdText& text, const Mesh& mesh, std::uint32_t maximum) const;
  void write_binding(UsdText& text, const std::vector<std::uint32_t>& joints) const;

  const Joints& joints_;
  const Materials& materials_;
  const std::vector<std::string>& shapes_;
  std::string skeleton_;
};

}  // namespace sunder::usd
