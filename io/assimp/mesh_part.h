#pragma once

#include <sunder/core/mesh.h>

#include <string>
#include <vector>

#include <assimp/mesh.h>

#include "io/assimp/notes.h"

namespace sunder::assimp_import {

/// One attribute: V x components floats.
struct Stream {
  std::string semantic;  ///< As in glTF: "POSITION", "TEXCOORD_0" …
  int components = 3;
  std::uint32_t target = kNone;  ///< The morph target that it displaces, or kNone.
  std::vector<float> values;
};

/// One aiMesh while it is converted to a glTF primitive.
struct MeshPart {
  std::string place;            ///< For notes: "mesh 2 'Body'".
  std::vector<Stream> streams;  ///< POSITION first.
  SkinWeights weights;          ///< V, or none for a rigid part.
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> vertices_without_normal;
  /// The n of TEXCOORD_n per assimp channel; kNone for empty channels.
  std::vector<std::uint32_t> texcoord_of_channel;
  std::uint32_t material = 0;

  [[nodiscard]] std::uint32_t vertex_count() const {
    return static_cast<std::uint32_t>(streams[0].values.size() / 3);
  }
  [[nodiscard]] Vec3d position(std::uint32_t vertex) const {
    const float* p = streams[0].values.data() + std::size_t{vertex} * 3;
    return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
  }
  [[nodiscard]] Stream* find(const char* semantic, std::uint32_t target = kNone);
};

/// Triangles and attributes of a mesh, without weights. If there are no triangles, there is nothing
/// to convert. Faces that name a vertex that does not exist are dropped. Throws ImportFailure if a
/// position is not finite.
[[nodiscard]] MeshPart read_part(const aiMesh& mesh, const std::string& place, Notes& notes);

}  // namespace sunder::assimp_import
