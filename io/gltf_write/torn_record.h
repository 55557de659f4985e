#pragma once

#include <sunder/io/character_bytes.h>

#include "io/gltf/glb.h"
#include "io/gltf_write/mesh_writer.h"

namespace sunder::gltf {

/// The extension that tells where the vertices of torn meshes come from; docs/torn_file.md.
inline constexpr const char* kTornMesh = "SUNDER_torn_mesh";
/// Its members that refer to accessors, in a primitive.
inline constexpr const char* kTornMeshAccessors[] = {"parts",   "reduced", "remaining", "sums",
                                                     "parents", "places",  "kinds"};

/// Refuses origins that do not fit the character.
/// @param source  of which the origins speak.
void check_origins(const Character& character, const Character& source,
                   const std::vector<MeshOrigins>& origins);

/// Removes the record of an earlier tear from a document.
void remove_torn_record(Json& document);

/// A mesh that was written.
struct RecordedMesh {
  const Mesh& mesh;
  const MeshWriter::Vertices& vertices;
  std::uint32_t maximum_influences = 0;  ///< Per vertex; 0: all.
  std::size_t source_targets = 0;        ///< Morph targets that the source has.
};

/// Appends the origins of a mesh as accessors.
/// @return what the extension of each primitive of the mesh has.
[[nodiscard]] Json add_origins(const MeshOrigins& origins, const RecordedMesh& of, GlbDraft& draft);

/// Gives a primitive with indices its extension. @param of_mesh  from add_origins().
/// @param source_primitive  whose triangles it has; kNone for walls and caps.
void set_origins(const Json& of_mesh, const SourceDocument::MeshOrigin& origin,
                 std::uint32_t source_primitive, const GlbDraft& draft, Json& primitive);

/// Writes which file was the source.
/// @param gone  per mesh of which no triangle is left its node and primitives in the source.
void add_source_of_record(const LoadedCharacter& loaded, const SaveOptions& options,
                          const Json& gone, Json& document);

}  // namespace sunder::gltf
