#include "tools/page_parts/page_file.h"

#include <cstring>
#include <string>
#include <string_view>

#include "tools/messages/text_file.h"
#include "tools/page_parts/base64.h"

namespace sunder::tools {
namespace {

constexpr std::uint32_t kVersion = 2;

}  // namespace

Status has_pages() {
  if (!view_page_template().empty()) return {};
  return Status::failure(StatusCode::unsupported_feature, kNone,
                         "this build has no HTML page: run scripts/setup page, configure and "
                         "build again");
}

std::vector<std::byte> page_bytes(const Json& json, const DataArrays& arrays) {
  std::string text = dump_line(json);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const std::uint32_t head[] = {kVersion, static_cast<std::uint32_t>(text.size())};
  std::vector<std::byte> bytes(4 + sizeof head);
  std::memcpy(bytes.data(), "SNDP", 4);
  std::memcpy(bytes.data() + 4, head, sizeof head);
  const auto text_bytes = std::as_bytes(std::span(text));
  bytes.insert(bytes.end(), text_bytes.begin(), text_bytes.end());
  bytes.insert(bytes.end(), arrays.bytes().begin(), arrays.bytes().end());
  return bytes;
}

Status write_page(const std::filesystem::path& file, PageTemplate page,
                  std::span<const std::byte> data) {
  if (Status status = has_pages(); !status) return status;
  std::string text;
  for (const std::string_view piece : page) text += piece;
  text.replace(text.find(kPageDataMark), kPageDataMark.size(), base64(data));
  return write_text(file, text);
}

}  // namespace sunder::tools
