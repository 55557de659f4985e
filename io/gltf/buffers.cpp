#include "io/gltf/buffers.h"

#include "io/gltf/meshopt_extension.h"
#include "io/gltf/refusal.h"
#include "io/gltf/uris.h"

namespace sunder::gltf {
namespace {

using BufferPlace = unsigned long long;

void resolve_buffer(SourceDocument& document, const Container& container, std::size_t index,
                    std::uint64_t& bytes_left) {
  const Cursor buffer = entry(document.json, "buffers", index);
  const std::uint64_t claimed = buffer.member("byteLength").to_unsigned();
  if (is_fallback_buffer(buffer)) {
    document.buffers.emplace_back();  // Its file, if it has one, is not needed.
    return;
  }
  std::span<const std::byte> bytes;
  if (const auto uri = buffer.find("uri")) {
    if (is_data_uri(uri->to_string()))
      document.other_files.push_back(decode_data_uri(uri->to_string(), uri->pointer()));
    else
      document.other_files.push_back(
          document.read_side_file(uri->to_string(), uri->pointer(), bytes_left));
    bytes = document.other_files.back();
    bytes_left -= std::min<std::uint64_t>(bytes_left, bytes.size());
  } else if (index == 0 && container.is_glb) {
    bytes = container.binary;
  } else {
    refuse(StatusCode::unsupported_feature, static_cast<std::uint32_t>(index),
           "%s: the buffer has no data", buffer.pointer().c_str());
  }
  if (claimed > bytes.size())
    refuse(StatusCode::malformed_file, static_cast<std::uint32_t>(index),
           "%s/byteLength: %llu bytes declared, %zu found", buffer.pointer().c_str(),
           static_cast<BufferPlace>(claimed), bytes.size());
  document.buffers.push_back(bytes.first(claimed));
}

}  // namespace

void resolve_buffers(SourceDocument& document, const Container& container) {
  std::uint64_t bytes_left =
      document.maximum_bytes -
      std::min<std::uint64_t>(document.maximum_bytes, document.content.size());
  const std::size_t buffer_count = count_of(document.json, "buffers");
  for (std::size_t i = 0; i < buffer_count; ++i) resolve_buffer(document, container, i, bytes_left);
}

void check_buffer_views(const SourceDocument& document) {
  for (std::size_t i = 0; i < count_of(document.json, "bufferViews"); ++i) {
    const Cursor view = entry(document.json, "bufferViews", i);
    const std::uint32_t buffer = view.member("buffer").to_index(document.buffers.size(), "buffer");
    const std::uint64_t offset = view.unsigned_or("byteOffset", 0),
                        length = view.member("byteLength").to_unsigned();
    const std::uint64_t available = document.buffers[buffer].size();
    if (offset > available || length > available - offset)
      refuse(StatusCode::index_out_of_range, static_cast<std::uint32_t>(i),
             "%s: offset %llu and length %llu exceed the buffer of %llu bytes",
             view.pointer().c_str(), static_cast<BufferPlace>(offset),
             static_cast<BufferPlace>(length), static_cast<BufferPlace>(available));
  }
}

std::span<const std::byte> bytes_of_view(const SourceDocument& document, std::uint32_t view) {
  const Cursor at = entry(document.json, "bufferViews", view);
  const auto& buffer = document.buffers[at.unsigned_of("buffer")];
  return buffer.subspan(at.unsigned_or("byteOffset", 0), at.unsigned_of("byteLength"));
}

}  // namespace sunder::gltf
