#include "io/gltf_read/decoded_data.h"

#include <algorithm>
#include <vector>

#include "io/gltf/glb.h"
#include "io/gltf/refusal.h"

namespace sunder::gltf {
namespace {

constexpr std::uint64_t kAllowance = std::uint64_t{16} << 20, kLargestRatio = 1024;

}  // namespace

DecodedData::DecodedData(SourceDocument& document) : document_(document) {
  std::uint64_t file_bytes = document.content.size();
  for (const auto& file : document.other_files) file_bytes += file.size();
  bytes_left_ = std::min(document.maximum_bytes, kAllowance + kLargestRatio * file_bytes);
}

DecodedData::Buffer DecodedData::add_buffer(std::uint64_t size, const Cursor& claims) {
  if (size > bytes_left_)
    refuse(StatusCode::limit_exceeded, kNone,
           "%.120s: %llu bytes of decoded data; the file may have %llu more",
           claims.pointer().c_str(), static_cast<unsigned long long>(size),
           static_cast<unsigned long long>(bytes_left_));
  bytes_left_ -= size;
  document_.other_files.emplace_back(size);
  document_.buffers.emplace_back(document_.other_files.back());
  Json& buffers = list_of(document_.json, "buffers");
  buffers.push_back({{"byteLength", size}});
  return {static_cast<std::uint32_t>(buffers.size() - 1), document_.other_files.back()};
}

std::uint32_t DecodedData::add_view(const Buffer& buffer) {
  Json& views = list_of(document_.json, "bufferViews");
  views.push_back({{"buffer", buffer.index}, {"byteLength", buffer.bytes.size()}});
  return static_cast<std::uint32_t>(views.size() - 1);
}

void unlist_extension(Json& document, const char* name) {
  for (const char* const list : {"extensionsUsed", "extensionsRequired"}) {
    const auto found = document.find(list);
    if (found == document.end() || !found->is_array()) continue;
    Json kept = Json::array();
    for (Json& extension : *found)
      if (extension != name) kept.push_back(std::move(extension));
    if (kept.empty())
      document.erase(list);
    else
      *found = std::move(kept);
  }
}

void drop_unused_buffers(SourceDocument& document) {
  std::vector<bool> is_used(document.buffers.size());
  for (std::size_t i = 0; i < count_of(document.json, "bufferViews"); ++i)
    is_used[entry(document.json, "bufferViews", i)
                .member("buffer")
                .to_index(is_used.size(), "buffer")] = true;
  for (std::size_t i = 0; i < is_used.size(); ++i)
    if (!is_used[i]) document.buffers[i] = {};
}

}  // namespace sunder::gltf
