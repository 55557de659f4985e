#include "io/gltf/read.h"

#include <sunder/core/character.h>

#include <algorithm>
#include <memory>
#include <system_error>
#include <utility>

#include "io/gltf/animations.h"
#include "io/gltf/buffers.h"
#include "io/gltf/container.h"
#include "io/gltf/image_notes.h"
#include "io/gltf/meshes.h"
#include "io/gltf/refusal.h"
#include "io/gltf/skeleton.h"

namespace sunder::gltf {
namespace {

std::string scene_name(const Json& document) {
  const std::size_t count = count_of(document, "scenes");
  if (count == 0) return {};
  const auto chosen = Cursor(document, "").find("scene");
  return entry(document, "scenes", chosen ? chosen->to_index(count, "scene") : 0).name();
}

/// For the decoded data of files of this size; the rest is for the files and what is needed for a
/// moment.
std::uint64_t memory_limit(const LoadOptions& options, std::uint64_t file_bytes) {
  constexpr std::uint64_t kLeast = std::uint64_t{64} << 20, kTimes = 20;
  if (options.maximum_memory != 0) return options.maximum_memory;
  const std::uint64_t files = std::min(file_bytes, options.maximum_bytes);
  return std::max(kLeast, files * kTimes) * 3 / 4;
}

std::uint64_t bytes_of_files(const SourceDocument& document) {
  std::uint64_t bytes = document.content.size();
  for (const auto& file : document.other_files) bytes += file.size();
  return bytes;
}

LoadedCharacter read(std::span<const std::byte> content, const std::filesystem::path& folder,
                     const LoadOptions& options) {
  if (content.size() > options.maximum_bytes)
    refuse(StatusCode::limit_exceeded, kNone,
           "the file has %zu bytes; the limit is %llu (LoadOptions::maximum_bytes)", content.size(),
           static_cast<unsigned long long>(options.maximum_bytes));
  const auto document = std::make_shared<SourceDocument>();
  document->content.assign(content.begin(), content.end());
  document->maximum_bytes = options.maximum_bytes;
  if (!folder.empty()) document->folder = std::filesystem::absolute(folder);
  const Container container = split_container(document->content);
  document->is_glb = container.is_glb;
  document->json = parse_document(container.json, memory_limit(options, content.size()));
  resolve_buffers(*document, container);
  document->maximum_memory = memory_limit(options, bytes_of_files(*document));

  LoadedCharacter loaded;
  loaded.report.format = container.is_glb ? "glTF 2.0 binary" : "glTF 2.0 text";
  loaded.report.space = "metres, y up; the file's scene space";
  Reading reading{*document, AccessorReader(*document), Notes(loaded.report, options.strict),
                  options.keep_stored_influences};
  const auto character = std::make_shared<Character>();
  character->name = scene_name(document->json);
  NodeSkeleton nodes = read_skeleton(reading);
  ReadMeshes meshes = read_meshes(reading, nodes, *character);
  if (character->meshes.empty())
    refuse(StatusCode::empty_input, kNone, "the scene has no triangles");
  note_images(reading);
  character->clips = read_animations(reading, nodes, meshes.morphs_of_node);
  document->node_of_bone.assign(nodes.skeleton.bones.size(), kNone);
  for (std::uint32_t node = 0; node < nodes.bone_from_node.size(); ++node)
    if (nodes.bone_from_node[node] != kNone)
      document->node_of_bone[nodes.bone_from_node[node]] = node;
  character->skeleton = std::move(nodes.skeleton);
  document->mesh_origins = std::move(meshes.origins);
  loaded.stored = std::move(meshes.stored);
  if (!document->is_glb)
    document->content = {};  // The text is no longer needed; buffers are stored in other_files.
  if (const Status status = validate_character(*character); !status)
    refuse(StatusCode::internal_error, status.index(),
           "the reader produced an invalid character: %.200s", status.text().data());

  loaded.character = character;
  loaded.source = document;
  return loaded;
}

}  // namespace

Result<LoadedCharacter> read_character(std::span<const std::byte> content,
                                       const std::filesystem::path& folder,
                                       const LoadOptions& options) {
  return without_exceptions<LoadedCharacter>([&] { return read(content, folder, options); });
}

}  // namespace sunder::gltf
