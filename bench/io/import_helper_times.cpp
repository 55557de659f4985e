#include "bench/io/import_helper_times.h"

#include <sunder/io/character_file.h>

#include <cstdint>
#include <system_error>
#include <vector>

#include <assimp/Exporter.hpp>
#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include "bench/harness/measure.h"

namespace sunder::bench {

namespace fs = std::filesystem;

/// The options of io/assimp/read_scene.cpp.
std::size_t read_by_assimp(const fs::path& file) {
  Assimp::Importer importer;
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, true);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
  const aiScene* const scene = importer.ReadFile(file.string(), aiProcess_Triangulate);
  std::size_t vertices = 0;
  for (unsigned i = 0; scene != nullptr && i < scene->mNumMeshes; ++i)
    vertices += scene->mMeshes[i]->mNumVertices;
  return vertices;
}

fs::path fbx_file() {
  fs::path largest;
  std::uintmax_t most = 0;
  for (const char* const folder :
       {SUNDER_SHARED_MODELS "/rigged", "/usr/share/assimp/models/FBX"}) {
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error)) {
      if (entry.path().extension() != ".fbx" || entry.file_size() <= most) continue;
      largest = entry.path();
      most = entry.file_size();
    }
    if (!largest.empty()) break;
  }
  return largest;
}

fs::path write_fbx(const fs::path& model, const fs::path& folder) {
  Assimp::Importer importer;
  const aiScene* const scene = importer.ReadFile(model.string(), 0);
  if (scene == nullptr) return {};
  const fs::path file = folder / (model.stem().string() + ".fbx");
  Assimp::Exporter exporter;
  return exporter.Export(scene, "fbxa", file.string()) == aiReturn_SUCCESS ? file : fs::path();
}

FbxTimes time_fbx(const fs::path& file, int rounds) {
  FbxTimes times;
  if (file.empty()) return times;
  times.file = file.filename().string();
  LoadOptions here;
  here.import_place = ImportPlace::in_process;
  std::vector<double> ours, in_process, assimp, overhead;
  for (int round = 0; round < rounds; ++round) {
    bool loaded = true;
    ours.push_back(seconds_of([&] { loaded = load_character(file).has_value(); }));
    in_process.push_back(
        seconds_of([&] { loaded = load_character(file, here).has_value() && loaded; }));
    assimp.push_back(seconds_of([&] { times.vertices = read_by_assimp(file); }));
    overhead.push_back(ours.back() - in_process.back());
    if (!loaded) return {};
  }
  times.ours = median(ours);
  times.in_process = median(in_process);
  times.assimp = median(assimp);
  times.child_overhead = median(overhead);
  return times;
}

}  // namespace sunder::bench
