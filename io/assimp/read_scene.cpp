#include "io/assimp/read_scene.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <fstream>
#include <new>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include <assimp/BaseImporter.h>
#include <assimp/DefaultIOSystem.h>
#include <assimp/ai_assert.h>
#include <assimp/config.h>
#include <assimp/importerdesc.h>
#include <assimp/postprocess.h>

#include "io/assimp/child_process.h"
#include "io/assimp/face_check.h"
#include "io/assimp/failure.h"
#include "io/assimp/importer_log.h"

// Debian builds assimp with assertions, and some valid files violate them. In the child a failed
// assertion becomes an import error; in the rest of the program, which may use assimp itself, it
// works as before. If the linker keeps assimp's own version of this function, the child aborts and
// the parent reports that.
namespace Assimp {
__attribute__((visibility("default"))) void aiAssertViolation(const char* expression,
                                                              const char* file, int line) {
  if (sunder::assimp_import::is_import_child())
    throw std::runtime_error(std::string("assertion failed: ") + expression);
  std::fprintf(stderr, "ai_assert failure in %s(%d): %s\n", file, line, expression);
  std::abort();
}
}  // namespace Assimp

namespace sunder::assimp_import {

namespace fs = std::filesystem;

namespace {

/// Lets assimp open only files that AssetFolder allows, and stores the first refusal.
class FolderIOSystem : public Assimp::DefaultIOSystem {
 public:
  explicit FolderIOSystem(AssetFolder& folder) : folder_(folder) {}

  bool Exists(const char* path) const override { return folder_.resolve(path).has_value(); }

  Assimp::IOStream* Open(const char* path, const char* mode) override {
    if (std::strpbrk(mode, "wa+") != nullptr) return nullptr;
    const Result<fs::path> file = folder_.resolve(path);
    Status status = file.error();
    if (file) status = folder_.charge(*file);
    if (status) return DefaultIOSystem::Open(file->c_str(), mode);
    if (status.code() != StatusCode::file_not_found && refusal_.is_ok()) refusal_ = status;
    return nullptr;
  }

  bool CreateDirectory(const std::string&) override { return false; }
  bool ChangeDirectory(const std::string&) override { return false; }
  bool DeleteFile(const std::string&) override { return false; }

  [[nodiscard]] const Status& refusal() const { return refusal_; }

 private:
  AssetFolder& folder_;
  Status refusal_;
};

/// Whether the importer supports the file's extension; some have two parts, such as ".mesh.xml".
bool claims(const aiImporterDesc* description, const std::string& lower_name) {
  if (description == nullptr || description->mFileExtensions == nullptr) return false;
  std::istringstream extensions(description->mFileExtensions);
  for (std::string one; extensions >> one;)
    if (lower_name.ends_with("." + one)) return true;
  return false;
}

/// Removes all importers except those of the file's extension; assimp would otherwise try them on
/// the content. They are not freed, because the child exits.
/// @return whether any importer is left.
bool keep_loaders_of(Assimp::Importer& importer, const std::string& lower_name) {
  for (std::size_t i = importer.GetImporterCount(); i-- > 0;)
    if (!claims(importer.GetImporterInfo(i), lower_name))
      importer.UnregisterLoader(importer.GetImporter(i));
  return importer.GetImporterCount() > 0;
}

/// The first bytes of a format, or a text within its first kilobyte, if the format prescribes one.
void check_magic(const fs::path& file, const std::string& extension) {
  struct Magic {
    std::string_view extension, begins, contains;
  };
  static constexpr std::array kMagic = {
      Magic{"x", "xof ", ""},
      Magic{"b3d", "BB3D", ""},
      Magic{"ply", "ply", ""},
      Magic{"fbx", "Kaydara FBX Binary", "FBX"},
      Magic{"md5mesh", "", "MD5Version"},
      Magic{"md5anim", "", "MD5Version"},
  };
  const auto magic = std::find_if(kMagic.begin(), kMagic.end(),
                                  [&](const Magic& one) { return one.extension == extension; });
  if (magic == kMagic.end()) return;
  std::string start(1024, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(start.data(), static_cast<std::streamsize>(start.size()));
  start.resize(static_cast<std::size_t>(stream.gcount()));
  if (!magic->begins.empty() && start.starts_with(magic->begins)) return;
  if (!magic->contains.empty() && start.find(magic->contains) != std::string::npos) return;
  throw ImportFailure{Status::failure(StatusCode::malformed_file, kNone,
                                      "%s: the content is not that of a .%s file",
                                      file.filename().c_str(), extension.c_str())};
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
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

[[noreturn]] void fail(const Assimp::Importer& importer, const fs::path& file) {
  const std::string name = file.filename().string();
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
  // assimp's texts often contain whole paths, which must not be shown.
  const std::string folder = file.parent_path().string() + "/";
  for (std::size_t at = text.find(folder); at != std::string::npos; at = text.find(folder, at))
    text.erase(at, folder.size());
  throw ImportFailure{
      Status::failure(StatusCode::malformed_file, kNone, "%s: %s", name.c_str(), text.c_str())};
}

}  // namespace

std::string lower_extension(const fs::path& file) {
  const std::string extension = lower(file.extension().string());
  return extension.empty() ? extension : extension.substr(1);
}

ReadScene read_scene(Assimp::Importer& importer, const fs::path& file, AssetFolder& folder) {
  const std::string extension = lower_extension(file);
  if (!keep_loaders_of(importer, lower(file.filename().string())))
    throw ImportFailure{Status::failure(StatusCode::unsupported_format, kNone,
                                        "%s: no reader for .%s files", file.filename().c_str(),
                                        extension.c_str())};
  check_magic(file, extension);

  auto* const system = new FolderIOSystem(folder);  // The importer takes ownership.
  importer.SetIOHandler(system);
  // Pivots stay separate nodes, which is exact; collapsing them loses animation (assimp issues
  // 1068, 4005).
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, true);
  // Do not create a mesh around the bones of a file without meshes.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);

  ReadScene result;
  result.in_text = read_text_indices(file);
  if (result.in_text.is_dangerous)
    throw ImportFailure{Status::failure(StatusCode::index_out_of_range, kNone,
                                        "%s: %u corners refer to normals that do not exist",
                                        file.filename().c_str(), result.in_text.normals)};
  const aiScene* scene = nullptr;
  {
    const ImporterLog log;
    scene = importer.ReadFile(file.string(), 0);
    result.messages = log.messages();
  }
  if (!system->refusal()) throw ImportFailure{system->refusal()};
  if (scene == nullptr || scene->mRootNode == nullptr) fail(importer, file);
  // Triangulation would read the vertices. The scene is the importer's, which is not const.
  result.faces_out_of_range =
      remove_faces_out_of_range(const_cast<aiScene&>(*scene), result.in_text);
  for (unsigned i = 0; i < scene->mNumMeshes; ++i)
    result.is_de_indexed.push_back(is_de_indexed(*scene->mMeshes[i]));

  // Joining vertices would close tears and mix weights. All checks of assimp's validation are made
  // on the result.
  result.scene = importer.ApplyPostProcessing(aiProcess_Triangulate);
  if (result.scene == nullptr || result.scene->mNumMeshes != result.is_de_indexed.size())
    fail(importer, file);
  return result;
}

}  // namespace sunder::assimp_import
