#include "io/assimp/read_scene.h"

#include <algorithm>
#include <exception>
#include <new>
#include <sstream>
#include <string_view>

#include <assimp/BaseImporter.h>
#include <assimp/config.h>
#include <assimp/importerdesc.h>
#include <assimp/postprocess.h>

#include "io/assimp/failure.h"
#include "io/assimp/importer_log.h"
#include "io/files/read_at.h"
#include "io/import_checks/check_text.h"
#include "io/import_checks/face_check.h"

namespace sunder::assimp_import {
namespace {

/// Sum over all polygons of the square of their corners, to which the time of their triangulation
/// is proportional: about 3 seconds.
constexpr std::uint64_t kMostPolygonWork = 300'000'000;

bool reads(const aiImporterDesc* importer, std::string_view extension) {
  if (importer == nullptr || importer->mFileExtensions == nullptr) return false;
  std::istringstream extensions(importer->mFileExtensions);
  for (std::string one; extensions >> one;)
    if (one == extension) return true;
  return false;
}

/// Removes all importers except that of the format; assimp would otherwise try them on the content.
/// @return whether one is left.
bool keep_importer_of(const Format& format, Assimp::Importer& importer) {
  for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
    if (reads(importer.GetImporterInfo(i), format.extension)) continue;
    Assimp::BaseImporter* const other = importer.GetImporter(i);
    importer.UnregisterLoader(other);
    delete other;
  }
  return importer.GetImporterCount() > 0;
}

std::string beginning_of(const ModelFile& model, std::size_t bytes) {
  std::string text(bytes, '\0');
  text.resize(files::read_at(model.file.descriptor, text.data(), text.size(), 0));
  return text;
}

/// Refuses what assimp cannot read in reasonable time, or would read beyond its arrays.
/// @return what the file refers to without having it.
TextIndices check_content(const ModelFile& model, const Format& format) {
  const std::string start = beginning_of(model, 1024);
  if (const Status status = check_start(format, start, model.name); !status)
    throw ImportFailure{status};
  const bool has_check = has_text_check(format, start);
  if (!has_check && !has_text_indices(format)) return {};
  const std::string content = beginning_of(model, model.file.bytes);
  if (has_check)
    if (const Status status = check_text(format, content, model.name); !status)
      throw ImportFailure{status};
  TextIndices indices = read_text_indices(format, content);
  if (indices.is_dangerous)
    throw ImportFailure{Status::failure(StatusCode::index_out_of_range, kNone,
                                        "%.100s: %u corners refer to normals that do not exist",
                                        model.name.c_str(), indices.normals)};
  return indices;
}

void check_polygons(const aiScene& scene, const ModelFile& model) {
  std::uint64_t work = 0, most = 0;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    for (unsigned f = 0; f < scene.mMeshes[m]->mNumFaces; ++f) {
      const std::uint64_t corners = scene.mMeshes[m]->mFaces[f].mNumIndices;
      if (corners <= 4) continue;
      work +=
          std::min<std::uint64_t>(corners, 1u << 20) * std::min<std::uint64_t>(corners, 1u << 20);
      most = std::max(most, corners);
    }
  }
  if (work > kMostPolygonWork)
    throw ImportFailure{Status::failure(
        StatusCode::limit_exceeded, kNone,
        "%.100s: polygons of up to %llu corners, too large to be divided into triangles",
        model.name.c_str(), static_cast<unsigned long long>(most))};
}

bool is_de_indexed(const aiMesh& mesh) {
  std::vector<bool> used(mesh.mNumVertices, false);
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const aiFace& face = mesh.mFaces[f];
    for (unsigned k = 0; k < face.mNumIndices; ++k) {
      if (face.mIndices[k] >= mesh.mNumVertices || used[face.mIndices[k]]) return false;
      used[face.mIndices[k]] = true;
    }
  }
  return true;
}

[[noreturn]] void fail(const Assimp::Importer& importer, const ModelFile& model) {
  if (const std::exception_ptr thrown = importer.GetException()) {
    try {
      std::rethrow_exception(thrown);
    } catch (const std::bad_alloc&) {
      throw;
    } catch (...) {
    }
  }
  std::string text = importer.GetErrorString();
  if (text.empty()) text = "the importer gives no reason";
  throw ImportFailure{Status::failure(StatusCode::malformed_file, kNone, "%.100s: %s",
                                      model.name.c_str(), text.c_str())};
}

}  // namespace

ReadScene read_scene(Assimp::Importer& importer, const ModelFile& model, const Format& format,
                     AssetFiles& assets) {
  ReadScene result;
  result.in_text = check_content(model, format);
  if (!keep_importer_of(format, importer))
    throw ImportFailure{Status::failure(StatusCode::unsupported_format, kNone,
                                        "%.100s: this assimp has no importer for it",
                                        model.name.c_str())};
  auto* const system = new AssetIOSystem(model, assets);  // The importer takes ownership.
  importer.SetIOHandler(system);
  // Pivots stay separate nodes, by which take_fbx_transforms() recognises the models.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, true);
  // Do not create a mesh around the bones of a file without meshes.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);

  const aiScene* scene = nullptr;
  {
    const ImporterLog log;
    scene = importer.ReadFile(name_for_assimp(model), 0);
    result.messages = log.messages();
  }
  if (!system->refusal()) throw ImportFailure{system->refusal()};
  if (scene == nullptr || scene->mRootNode == nullptr) fail(importer, model);
  // Triangulation would read the vertices. The scene is the importer's, which is not const.
  result.faces_out_of_range =
      remove_faces_out_of_range(const_cast<aiScene&>(*scene), result.in_text);
  check_polygons(*scene, model);
  for (unsigned i = 0; i < scene->mNumMeshes; ++i)
    result.is_de_indexed.push_back(is_de_indexed(*scene->mMeshes[i]));

  // Joining vertices would close tears and mix weights. All checks of assimp's validation are made
  // on the result.
  result.scene = importer.ApplyPostProcessing(aiProcess_Triangulate);
  if (result.scene == nullptr || result.scene->mNumMeshes != result.is_de_indexed.size())
    fail(importer, model);
  return result;
}

}  // namespace sunder::assimp_import
