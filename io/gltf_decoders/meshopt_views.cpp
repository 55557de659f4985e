#include "io/gltf_decoders/meshopt_views.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "io/compression/meshopt_stream.h"
#include "io/gltf/meshopt_extension.h"
#include "io/gltf/refusal.h"
#include "io/gltf_read/decoded_data.h"

namespace sunder::gltf {
namespace {

using compression::MeshoptStream;
using MeshoptSize = unsigned long long;

/// The second is the name under which the first became part of Khronos' extensions.
MeshoptStream::Mode read_mode(const Cursor& at) {
  const std::string& mode = at.to_string();
  if (mode == "ATTRIBUTES") return MeshoptStream::Mode::attributes;
  if (mode == "TRIANGLES") return MeshoptStream::Mode::triangles;
  if (mode == "INDICES") return MeshoptStream::Mode::indices;
  refuse(StatusCode::malformed_file, kNone, "%.120s: unknown mode '%.40s'", at.pointer().c_str(),
         mode.c_str());
}

MeshoptStream::Filter read_filter(const Cursor& at) {
  const std::string& filter = at.to_string();
  if (filter == "NONE") return MeshoptStream::Filter::none;
  if (filter == "OCTAHEDRAL") return MeshoptStream::Filter::octahedral;
  if (filter == "QUATERNION") return MeshoptStream::Filter::quaternion;
  if (filter == "EXPONENTIAL") return MeshoptStream::Filter::exponential;
  refuse(StatusCode::unsupported_feature, kNone, "%.120s: the filter '%.40s' is not supported",
         at.pointer().c_str(), filter.c_str());
}

struct CompressedView {
  std::uint32_t view = 0;
  std::string pointer;  ///< Of the extension.
  MeshoptStream stream;
  std::uint64_t offset = 0;  ///< Of the decoded bytes.
};

std::span<const std::byte> compressed_bytes(const SourceDocument& document, const Cursor& at) {
  const std::uint32_t buffer = at.member("buffer").to_index(document.buffers.size(), "buffer");
  const auto bytes = document.buffers[buffer];
  const std::uint64_t offset = at.unsigned_or("byteOffset", 0),
                      length = at.member("byteLength").to_unsigned();
  if (offset > bytes.size() || length > bytes.size() - offset)
    refuse(StatusCode::index_out_of_range, buffer,
           "%s: offset %llu and length %llu exceed the buffer of %zu bytes", at.pointer().c_str(),
           static_cast<MeshoptSize>(offset), static_cast<MeshoptSize>(length), bytes.size());
  return bytes.subspan(offset, length);
}

void check(const Status& status, const std::string& pointer) {
  if (!status) refuse(status.code(), kNone, "%s: %.160s", pointer.c_str(), status.text().data());
}

CompressedView read_view(const SourceDocument& document, std::uint32_t index, const Cursor& view,
                         const Cursor& at) {
  CompressedView compressed{index, at.pointer(), {}, 0};
  MeshoptStream& stream = compressed.stream;
  stream.bytes = compressed_bytes(document, at);
  stream.count = at.member("count").to_unsigned();
  stream.stride = at.member("byteStride").to_unsigned();
  stream.mode = read_mode(at.member("mode"));
  if (const auto filter = at.find("filter")) stream.filter = read_filter(*filter);
  check(compression::check_stream(stream), at.pointer());
  const std::uint64_t length = view.member("byteLength").to_unsigned();
  if (length != stream.count * stream.stride)
    refuse(StatusCode::malformed_file, index,
           "%s: %llu elements of %llu bytes in a view of %llu bytes", at.pointer().c_str(),
           static_cast<MeshoptSize>(stream.count), static_cast<MeshoptSize>(stream.stride),
           static_cast<MeshoptSize>(length));
  return compressed;
}

std::vector<CompressedView> compressed_views(const SourceDocument& document) {
  std::vector<CompressedView> views;
  for (std::uint32_t i = 0; i < count_of(document.json, "bufferViews"); ++i) {
    const Cursor view = entry(document.json, "bufferViews", i);
    if (const auto at = meshopt_extension_of(view))
      views.push_back(read_view(document, i, view, *at));
  }
  return views;
}

void remove_extension(Json& object) {
  const auto extensions = object.find("extensions");
  if (extensions == object.end()) return;
  for (const char* const name : kMeshoptNames) extensions->erase(name);
  if (extensions->empty()) object.erase("extensions");
}

}  // namespace

std::vector<std::uint32_t> decode_meshopt_views(SourceDocument& document, DecodedData& decoded_data,
                                                Notes& notes) {
  std::vector<CompressedView> views = compressed_views(document);
  std::vector<std::uint32_t> rounded;
  if (views.empty()) return rounded;
  std::uint64_t size = 0;
  for (CompressedView& view : views) {
    view.offset = size;
    size += (view.stream.count * view.stream.stride + 15) / 16 * 16;
  }
  const DecodedData::Buffer decoded =
      decoded_data.add_buffer(size, Cursor(document.json, "/bufferViews"));
  for (const CompressedView& view : views) {
    const MeshoptStream& stream = view.stream;
    check(compression::decode_stream(
              stream, decoded.bytes.subspan(view.offset, stream.count * stream.stride)),
          view.pointer);
    Json& json = document.json["bufferViews"][view.view];
    json["buffer"] = decoded.index;
    json["byteOffset"] = view.offset;
    remove_extension(json);
    if (stream.filter != MeshoptStream::Filter::none) rounded.push_back(view.view);
  }
  for (Json& buffer : document.json["buffers"]) remove_extension(buffer);
  for (const char* const name : kMeshoptNames) unlist_extension(document.json, name);
  drop_unused_buffers(document);
  notes.inform("buffer views", "are compressed (meshopt); saving writes them uncompressed",
               static_cast<std::uint32_t>(views.size()));
  return rounded;
}

}  // namespace sunder::gltf
