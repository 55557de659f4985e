#include "io/assimp/mesh_part.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "io/assimp/failure.h"

namespace sunder::assimp_import {
namespace {

bool is_finite(const aiVector3D& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

Vec3d to_eigen(const aiVector3D& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

void append(std::vector<float>& values, const Vec3d& v) {
  for (int i = 0; i < 3; ++i) values.push_back(static_cast<float>(v[i]));
}

/// A unit vector of floats; zero if it has no direction.
Vec3d direction_of(const aiVector3D& v) {
  if (!is_finite(v)) return Vec3d::Zero();
  const Vec3d wide = to_eigen(v);
  const double length = wide.norm();
  if (length < 1e-12) return Vec3d::Zero();
  return std::abs(length - 1.0) <= 1e-6 ? wide : Vec3d(wide / length);
}

void read_triangles(const aiMesh& mesh, MeshPart& part, Notes& notes) {
  std::uint32_t skipped = 0, out_of_range = 0;
  part.triangles.reserve(mesh.mNumFaces);
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const aiFace& face = mesh.mFaces[f];
    if (face.mNumIndices != 3 || face.mIndices == nullptr) {
      ++skipped;
      continue;
    }
    if (std::any_of(face.mIndices, face.mIndices + 3,
                    [&](unsigned index) { return index >= mesh.mNumVertices; })) {
      ++out_of_range;
      continue;
    }
    part.triangles.push_back({face.mIndices[0], face.mIndices[1], face.mIndices[2]});
  }
  notes.dropped(StatusCode::unsupported_feature, part.place, "points, lines and collapsed polygons",
                skipped);
  notes.dropped(StatusCode::index_out_of_range, part.place,
                "faces that refer to vertices that do not exist", out_of_range);
}

void read_positions(const aiMesh& mesh, MeshPart& part) {
  Stream positions{.semantic = "POSITION", .values = {}};
  positions.values.reserve(std::size_t{mesh.mNumVertices} * 3);
  for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
    if (!is_finite(mesh.mVertices[v]))
      throw ImportFailure{Status::failure(StatusCode::non_finite_value, v,
                                          "%s: vertex %u: position is not finite",
                                          part.place.c_str(), v)};
    append(positions.values, to_eigen(mesh.mVertices[v]));
  }
  part.streams.push_back(std::move(positions));
}

void read_normals(const aiMesh& mesh, MeshPart& part) {
  Stream normals{.semantic = "NORMAL", .values = {}};
  normals.values.reserve(std::size_t{mesh.mNumVertices} * 3);
  for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
    const Vec3d normal = mesh.HasNormals() ? direction_of(mesh.mNormals[v]) : Vec3d(Vec3d::Zero());
    if (normal.isZero()) part.vertices_without_normal.push_back(v);
    append(normals.values, normal);
  }
  part.streams.push_back(std::move(normals));
}

/// assimp's v grows upward, glTF's downward. The bitangent follows the image in both, so its sign
/// stays.
void read_tangents(const aiMesh& mesh, MeshPart& part, Notes& notes) {
  if (!mesh.HasTangentsAndBitangents() || !mesh.HasNormals() || !mesh.HasTextureCoords(0)) return;
  Stream tangents{.semantic = "TANGENT", .components = 4, .values = {}};
  tangents.values.reserve(std::size_t{mesh.mNumVertices} * 4);
  for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
    const Vec3d tangent = direction_of(mesh.mTangents[v]);
    if (tangent.isZero() || !is_finite(mesh.mBitangents[v])) {
      notes.dropped(StatusCode::malformed_file, part.place,
                    "tangents, some of which have no direction");
      return;
    }
    const double side =
        direction_of(mesh.mNormals[v]).cross(tangent).dot(to_eigen(mesh.mBitangents[v]));
    append(tangents.values, tangent);
    tangents.values.push_back(side < 0.0 ? -1.0f : 1.0f);
  }
  part.streams.push_back(std::move(tangents));
}

void read_texcoords(const aiMesh& mesh, MeshPart& part, Notes& notes) {
  std::uint32_t bad = 0, set = 0;
  part.texcoord_of_channel.assign(AI_MAX_NUMBER_OF_TEXTURECOORDS, kNone);
  for (unsigned channel = 0; channel < AI_MAX_NUMBER_OF_TEXTURECOORDS; ++channel) {
    if (!mesh.HasTextureCoords(channel)) continue;
    Stream uv{.semantic = "TEXCOORD_" + std::to_string(set), .components = 2, .values = {}};
    uv.values.reserve(std::size_t{mesh.mNumVertices} * 2);
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      const aiVector3D& coordinate = mesh.mTextureCoords[channel][v];
      const bool good = std::isfinite(coordinate.x) && std::isfinite(coordinate.y);
      bad += good ? 0 : 1;
      uv.values.push_back(good ? coordinate.x : 0.0f);
      uv.values.push_back(good ? 1.0f - coordinate.y : 0.0f);
    }
    part.texcoord_of_channel[channel] = set++;
    part.streams.push_back(std::move(uv));
  }
  notes.repaired(StatusCode::non_finite_value, part.place,
                 "texture coordinates not finite, set to zero", bad);
}

void read_colors(const aiMesh& mesh, MeshPart& part, Notes& notes) {
  std::uint32_t clamped = 0;
  for (unsigned channel = 0, set = 0; channel < AI_MAX_NUMBER_OF_COLOR_SETS; ++channel) {
    if (!mesh.HasVertexColors(channel)) continue;
    Stream colors{.semantic = "COLOR_" + std::to_string(set++), .components = 4, .values = {}};
    colors.values.reserve(std::size_t{mesh.mNumVertices} * 4);
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      const aiColor4D& color = mesh.mColors[channel][v];
      for (const float value : {color.r, color.g, color.b, color.a}) {
        const float inside = value >= 0.0f ? std::min(value, 1.0f) : 0.0f;  // NaN too.
        clamped += inside == value ? 0 : 1;
        colors.values.push_back(inside);
      }
    }
    part.streams.push_back(std::move(colors));
  }
  notes.repaired(StatusCode::invalid_argument, part.place,
                 "colour components outside 0 to 1, clamped", clamped);
}

/// assimp stores the shape of a morph target, glTF the difference.
void read_morph_target(const aiMesh& mesh, std::uint32_t target, MeshPart& part, Notes& notes) {
  const aiAnimMesh& shape = *mesh.mAnimMeshes[target];
  std::uint32_t bad = 0;
  const auto add = [&](const char* semantic, const aiVector3D* values, auto&& value_of,
                       auto&& is_fixed) {
    Stream deltas{.semantic = semantic,
                  .target = target,
                  .values = std::vector<float>(std::size_t{mesh.mNumVertices} * 3, 0.0f)};
    const Stream& base = *part.find(semantic);
    for (unsigned v = 0; values != nullptr && v < mesh.mNumVertices; ++v) {
      if (is_fixed(v)) continue;
      if (!is_finite(values[v])) {
        ++bad;
        continue;
      }
      const Vec3d value = value_of(values[v]);
      for (int i = 0; i < 3; ++i) {
        const std::size_t at = std::size_t{v} * 3 + static_cast<std::size_t>(i);
        deltas.values[at] = static_cast<float>(value[i] - static_cast<double>(base.values[at]));
      }
    }
    part.streams.push_back(std::move(deltas));
  };
  const bool fits = shape.mNumVertices == mesh.mNumVertices;
  if (!fits)
    notes.repaired(StatusCode::size_mismatch, part.place,
                   "morph targets with another number of vertices; emptied");
  add(
      "POSITION", fits ? shape.mVertices : nullptr, [](const aiVector3D& v) { return to_eigen(v); },
      [](unsigned) { return false; });
  if (mesh.HasNormals() && part.vertices_without_normal.empty() && fits &&
      shape.mNormals != nullptr)
    add(
        "NORMAL", shape.mNormals, [](const aiVector3D& v) { return direction_of(v); },
        [&](unsigned v) { return direction_of(shape.mNormals[v]).isZero(); });
  notes.repaired(StatusCode::non_finite_value, part.place,
                 "morph displacements not finite, set to zero", bad);
}

}  // namespace

Stream* MeshPart::find(const char* semantic, std::uint32_t target) {
  for (Stream& stream : streams)
    if (stream.target == target && stream.semantic == semantic) return &stream;
  return nullptr;
}

MeshPart read_part(const aiMesh& mesh, const std::string& place, Notes& notes) {
  MeshPart part;
  part.place = place;
  part.material = mesh.mMaterialIndex;
  if (mesh.mVertices == nullptr || mesh.mFaces == nullptr) return part;
  read_triangles(mesh, part, notes);
  if (part.triangles.empty()) return part;
  read_positions(mesh, part);
  read_normals(mesh, part);
  read_tangents(mesh, part, notes);
  read_texcoords(mesh, part, notes);
  read_colors(mesh, part, notes);
  for (unsigned target = 0; target < mesh.mNumAnimMeshes; ++target)
    if (mesh.mAnimMeshes[target] != nullptr) read_morph_target(mesh, target, part, notes);
  return part;
}

}  // namespace sunder::assimp_import
