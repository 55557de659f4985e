#include "io/assimp/convert_scene.h"

#include <string>
#include <utility>

#include <assimp/Importer.hpp>
#include <assimp/version.h>

#include "io/assimp/collada_joints.h"
#include "io/assimp/convert_animations.h"
#include "io/assimp/convert_meshes.h"
#include "io/assimp/failure.h"
#include "io/assimp/fbx_nodes.h"
#include "io/assimp/importer_log.h"
#include "io/assimp/model_space.h"
#include "io/assimp/read_scene.h"

namespace sunder::assimp_import {
namespace {

std::string format_name(const Format& format) {
  return std::string(format.name) + " by assimp " + std::to_string(aiGetVersionMajor()) + "." +
         std::to_string(aiGetVersionMinor()) + "." + std::to_string(aiGetVersionPatch());
}

void note_losses_of_importer(const ReadScene& read, Notes& notes) {
  for (unsigned mesh = 0; mesh < read.scene->mNumMeshes; ++mesh)
    notes.dropped(StatusCode::index_out_of_range,
                  "mesh " + std::to_string(mesh) + " '" +
                      valid_utf8(to_string(read.scene->mMeshes[mesh]->mName)) + "'",
                  "faces that refer to vertices that do not exist", read.faces_out_of_range[mesh]);
  notes.dropped(StatusCode::index_out_of_range, "file",
                "corners that refer to normals that do not exist", read.in_text.normals);
  notes.dropped(StatusCode::index_out_of_range, "file",
                "corners that refer to texture coordinates that do not exist",
                read.in_text.coordinates);
  add_notes(read.messages, notes);
}

}  // namespace

ImportedGlb read_and_convert(const ModelFile& model, AssetFiles& assets,
                             const LoadOptions& options) {
  const Result<Format> format = format_of(model.name);
  if (!format) throw ImportFailure{format.error()};
  const std::string extension(format->extension);
  Assimp::Importer importer;
  const ReadScene read = read_scene(importer, model, *format, assets);
  const aiScene& scene = *read.scene;

  Notes notes;
  // The scene is the importer's, which is not const.
  if (extension == "fbx") take_fbx_transforms(const_cast<aiScene&>(scene), model, notes);
  JointNodes joints = extension == "dae" ? collada_joints(scene, model, notes) : JointNodes();
  note_losses_of_importer(read, notes);
  const ModelSpace space = model_space_of(scene, extension, notes);
  ImportedGlb result;
  result.report.format = format_name(*format);
  result.report.space = space.description;

  GlbBuilder glb(options.maximum_bytes);
  glb.document["asset"] = {{"version", "2.0"},
                           {"generator", "Sunder, from " + result.report.format}};
  SceneTree tree(scene, space, std::move(joints), notes);
  MaterialWriter materials(scene, assets, glb, notes);
  const std::vector<MorphedNode> morphed =
      convert_meshes(scene, read.is_de_indexed, extension, tree, materials, glb, notes);
  if (!glb.document.contains("meshes"))
    throw ImportFailure{
        Status::failure(StatusCode::empty_input, kNone, "%s: no triangles", model.name.c_str())};
  convert_animations(scene, tree, morphed, glb, notes);
  if (scene.mNumCameras + scene.mNumLights > 0)
    notes.inform("scene", "cameras and lights are not imported",
                 scene.mNumCameras + scene.mNumLights);
  tree.write(glb);

  if (const Status fault = notes.first_fault(); options.strict && !fault)
    throw ImportFailure{fault};
  result.report.notes = notes.all();
  result.glb = glb.finish();
  return result;
}

}  // namespace sunder::assimp_import
