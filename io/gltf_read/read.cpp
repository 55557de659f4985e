#include "io/gltf_read/read.h"

#include <sunder/core/character.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "io/gltf/accessor_bounds.h"
#include "io/gltf/buffers.h"
#include "io/gltf/container.h"
#include "io/gltf/refusal.h"
#include "io/gltf_read/animations.h"
#include "io/gltf_read/decoded_data.h"
#include "io/gltf_read/image_notes.h"
#include "io/gltf_read/meshes.h"
#include "io/gltf_read/skeleton.h"

namespace sunder::gltf {
namespace {

std::string scene_name(const Json& document) {
  const std::size_t count = count_of(document, "scenes");
  if (count == 0) return {};
  const auto chosen = Cursor(document, "").find("scene");
  return entry(document, "scenes", chosen ? chosen->to_index(count, "scene") : 0).name();
}

void note_other_scenes(Reading& reading) {
  if (const std::size_t count = count_of(reading.json(), "scenes"); count > 1)
    reading.notes.inform(
        "scenes", "only the default scene is loaded; the others stay in the file as they are",
        static_cast<std::uint32_t>(count - 1));
}

[[noreturn]] void refuse_without_triangles(const Json& document) {
  const std::size_t clips = count_of(document, "animations");
  if (count_of(document, "meshes") > 0)
    refuse(StatusCode::empty_input, kNone, "the scene has no triangles");
  if (clips == 0) refuse(StatusCode::empty_input, kNone, "the file has no mesh");
  refuse(StatusCode::empty_input, kNone, "the file has %zu clips but no mesh that they move",
         clips);
}

/// For the decoded data of files of this size; the rest is for the files and what is needed for a
/// moment.
std::uint64_t memory_limit(const ReadOptions& options, std::uint64_t file_bytes) {
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

/// Buffers and buffer views, with compressed data decoded.
void resolve_data(SourceDocument& document, const Container& container, const ReadOptions& options,
                  const Decoders& decoders, Notes& notes) {
  resolve_buffers(document, container);
  DecodedData decoded(document);
  std::vector<std::uint32_t> rounded;
  if (decoders.meshopt_views != nullptr) rounded = decoders.meshopt_views(document, decoded, notes);
  document.maximum_memory = memory_limit(options, bytes_of_files(document));
  check_buffer_views(document);
  if (!rounded.empty()) correct_bounds(document, rounded);
  if (decoders.draco_primitives != nullptr) decoders.draco_primitives(document, decoded, notes);
  document.maximum_memory = memory_limit(options, bytes_of_files(document));
}

LoadedCharacter read(std::vector<std::byte> content, std::shared_ptr<const SideFiles> side_files,
                     const ReadOptions& options, const Decoders& decoders) {
  if (content.size() > options.maximum_bytes)
    refuse(StatusCode::limit_exceeded, kNone,
           "the file has %zu bytes; the limit is %llu (LoadOptions::maximum_bytes)", content.size(),
           static_cast<unsigned long long>(options.maximum_bytes));
  const auto document = std::make_shared<SourceDocument>();
  document->content = std::move(content);
  document->maximum_bytes = options.maximum_bytes;
  document->side_files = std::move(side_files);
  const Container container = split_container(document->content);
  document->is_glb = container.is_glb;
  document->json =
      parse_document(container.json, memory_limit(options, document->content.size()), decoders);

  LoadedCharacter loaded;
  loaded.report.format = container.is_glb ? "glTF 2.0 binary" : "glTF 2.0 text";
  loaded.report.space = "metres, y up; the file's scene space";
  Notes notes(loaded.report, options.strict);
  resolve_data(*document, container, options, decoders, notes);
  Reading reading{*document, AccessorReader(*document), notes, options.keep_stored_influences};
  const auto character = std::make_shared<Character>();
  character->name = scene_name(document->json);
  note_other_scenes(reading);
  NodeSkeleton nodes = read_skeleton(reading);
  ReadMeshes meshes = read_meshes(reading, nodes, *character);
  if (character->meshes.empty()) refuse_without_triangles(document->json);
  note_images(reading);
  character->clips = read_animations(reading, nodes, meshes.morphs_of_node);
  document->node_of_bone.assign(nodes.skeleton.bones.size(), kNone);
  for (std::uint32_t node = 0; node < nodes.bone_from_node.size(); ++node)
    if (nodes.bone_from_node[node] != kNone)
      document->node_of_bone[nodes.bone_from_node[node]] = node;
  character->skeleton = std::move(nodes.skeleton);
  document->mesh_origins = std::move(meshes.origins);
  document->repaired_skins = std::move(meshes.repaired_skins);
  loaded.stored = std::move(meshes.stored);
  if (!document->is_glb) {
    document->text_identity = identity_of(std::span<const std::byte>(document->content));
    document->content = {};  // The text is no longer needed; buffers are stored in other_files.
  }
  if (const Status status = validate_character(*character); !status)
    refuse(StatusCode::internal_error, status.index(),
           "the reader produced an invalid character: %.200s", status.text().data());

  loaded.character = character;
  loaded.source = document;
  return loaded;
}

}  // namespace

Result<LoadedCharacter> read_character(std::vector<std::byte> content,
                                       std::shared_ptr<const SideFiles> side_files,
                                       const ReadOptions& options, const Decoders& decoders) {
  return without_exceptions<LoadedCharacter>(
      [&] { return read(std::move(content), std::move(side_files), options, decoders); });
}

}  // namespace sunder::gltf
