#include <sunder/io/character_file.h>
#include <sunder/io/robot_file.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "io/contained_import/import_as_glb.h"
#include "io/gltf/container.h"
#include "io/gltf/refusal.h"
#include "io/gltf_decoders/all_decoders.h"
#include "io/gltf_files/folder_files.h"
#include "io/gltf_read/read.h"
#include "io/internal/load_bytes.h"
#include "io/internal/lower_extension.h"

namespace sunder {
namespace {

Result<LoadedCharacter> load_gltf(const std::filesystem::path& file, bool is_glb,
                                  const LoadOptions& options) {
  auto content = gltf::read_file(file, options.maximum_bytes, "file");
  if (content.empty())
    return Status::failure(StatusCode::malformed_file, kNone, "the file is empty");
  if (gltf::has_glb_magic(content) != is_glb)
    return Status::failure(StatusCode::unsupported_format, kNone,
                           "the file extension says %s, but the content is not",
                           is_glb ? "GLB" : "glTF text");
  const std::filesystem::path folder = file.parent_path();
  return gltf::read_character(
      std::move(content),
      std::make_shared<gltf::FolderFiles>(folder.empty() ? "." : folder, options.roots), options,
      gltf::all_decoders());
}

/// The fault of the GLB of an import, in the words of the model's own name.
Status refusal_of_import(const Status& fault, const std::string& name) {
  const StatusCode code = fault.code() == StatusCode::unsupported_format
                              ? StatusCode::malformed_file  // not that of the model
                              : fault.code();
  return Status::failure(code, fault.index(), "%.80s: as imported: %s", name.c_str(),
                         std::string(fault.text()).c_str());
}

/// Other formats arrive as a GLB in memory, which refers to no file.
Result<LoadedCharacter> load_by_assimp(const std::filesystem::path& file,
                                       const LoadOptions& options) {
  auto imported = contained_import::import_as_glb(file, options);
  if (!imported) return imported.error();
  LoadOptions of_glb = options;
  if (of_glb.maximum_memory == 0) of_glb.maximum_memory = imported->maximum_memory;
  auto loaded = load_glb(std::move(imported->glb), of_glb);
  if (!loaded) return refusal_of_import(loaded.error(), file.filename().string());
  LoadReport& report = loaded->report;
  report.format = std::move(imported->report.format);
  report.space = std::move(imported->report.space);
  loaded->stored.clear();  // the file's own weights are not known
  report.notes.insert(report.notes.begin(), std::make_move_iterator(imported->report.notes.begin()),
                      std::make_move_iterator(imported->report.notes.end()));
  return loaded;
}

Result<LoadedCharacter> load_urdf(const std::filesystem::path& file, const LoadOptions& options) {
  RobotLoadOptions of_robot;
  of_robot.strict = options.strict;
  of_robot.meshes = options;
  Result<LoadedRobot> loaded = load_robot(file, of_robot);
  if (!loaded) return loaded.error();
  if (loaded->model.character->meshes.empty())
    return Status::failure(StatusCode::empty_input, kNone,
                           "the robot has no mesh that could be read");
  return std::move(loaded->model);
}

}  // namespace

Result<LoadedCharacter> load_glb(std::vector<std::byte> bytes, const ReadOptions& options,
                                 std::shared_ptr<const FileResolver> resolver) {
  return load_bytes(std::move(bytes), options, std::move(resolver), gltf::all_decoders());
}

Result<LoadedCharacter> load_character(const std::filesystem::path& file,
                                       const LoadOptions& options) {
  return gltf::without_exceptions<LoadedCharacter>([&]() -> Result<LoadedCharacter> {
    const std::string extension = lower_extension(file);
    if (extension == ".glb" || extension == ".vrm" || extension == ".gltf")
      return load_gltf(file, extension != ".gltf", options);
    if (extension == ".urdf") return load_urdf(file, options);
    return load_by_assimp(file, options);
  });
}

}  // namespace sunder
