#include "io/import_checks/face_check.h"

#include <algorithm>
#include <set>
#include <utility>

namespace sunder::assimp_import {
namespace {

bool is_out_of_range(const aiFace& face, unsigned vertex_count) {
  return std::any_of(face.mIndices, face.mIndices + face.mNumIndices,
                     [&](unsigned index) { return index >= vertex_count; });
}

/// The kinds of faces that are left; assimp requires that they are right.
unsigned primitive_types(const aiMesh& mesh) {
  unsigned types = 0;
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const unsigned corners = mesh.mFaces[f].mNumIndices;
    types |= corners == 1   ? aiPrimitiveType_POINT
             : corners == 2 ? aiPrimitiveType_LINE
             : corners == 3 ? aiPrimitiveType_TRIANGLE
                            : aiPrimitiveType_POLYGON;
  }
  return types;
}

std::uint32_t remove_faces(aiMesh& mesh, const std::set<std::uint32_t>& in_text) {
  unsigned kept = 0;
  const unsigned before = mesh.mNumFaces;
  for (unsigned f = 0; f < before; ++f) {
    aiFace& face = mesh.mFaces[f];
    if (in_text.contains(f) || is_out_of_range(face, mesh.mNumVertices)) continue;
    if (kept != f) {
      std::swap(mesh.mFaces[kept].mIndices, face.mIndices);
      std::swap(mesh.mFaces[kept].mNumIndices, face.mNumIndices);
    }
    ++kept;
  }
  // The array keeps its length; assimp deletes it as a whole.
  mesh.mNumFaces = kept;
  if (kept != before && mesh.mPrimitiveTypes != 0) mesh.mPrimitiveTypes = primitive_types(mesh);
  return before - kept;
}

}  // namespace

std::vector<std::uint32_t> remove_faces_out_of_range(aiScene& scene, const TextIndices& in_text) {
  std::vector<std::uint32_t> removed;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m)
    removed.push_back(remove_faces(*scene.mMeshes[m], m < in_text.faces.size()
                                                          ? in_text.faces[m]
                                                          : std::set<std::uint32_t>()));
  return removed;
}

}  // namespace sunder::assimp_import
