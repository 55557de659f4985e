#include "io/usd_write/package.h"

#include <cstdint>
#include <limits>
#include <span>
#include <string_view>

#include "io/gltf/refusal.h"
#include "io/usd_write/checksum.h"

namespace sunder::usd {
namespace {

constexpr std::uint64_t kAlignment = 64;
constexpr std::uint64_t kMostBytes = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t kMostEntries = 65'535;
constexpr std::uint16_t kVersion = 10;      // stored files need no later one
constexpr std::uint16_t kNoDate = 0x0021;   // 1980-01-01, the first that there is
constexpr std::uint16_t kPadding = 0x1986;  // an extra field that readers skip
constexpr std::uint64_t kExtraHeader = 4;

/// A ZIP file of entries that are stored as they are.
class StoredZip {
 public:
  void add(const std::string& name, std::span<const std::byte> content) {
    if (entries_.size() == kMostEntries)
      gltf::refuse(StatusCode::limit_exceeded, kNone, "a USDZ package holds at most %zu files",
                   kMostEntries);
    if (content.size() > kMostBytes) refuse_size();
    const Entry entry = {name, checksum(content), static_cast<std::uint32_t>(content.size()),
                         bytes_.size()};
    const std::uint64_t before = bytes_.size() + kLocalHeader + name.size() + kExtraHeader;
    const std::uint64_t padding = (kAlignment - before % kAlignment) % kAlignment;
    number(0x04034b50u);
    common_header(entry);
    number(static_cast<std::uint16_t>(kExtraHeader + padding));
    text(name);
    number(kPadding);
    number(static_cast<std::uint16_t>(padding));
    bytes_.resize(bytes_.size() + padding);
    bytes_.insert(bytes_.end(), content.begin(), content.end());
    entries_.push_back(entry);
    if (bytes_.size() > kMostBytes) refuse_size();
  }

  std::vector<std::byte> finish() {
    const std::uint64_t directory = bytes_.size();
    for (const Entry& entry : entries_) add_to_directory(entry);
    const std::uint64_t length = bytes_.size() - directory;
    if (bytes_.size() > kMostBytes) refuse_size();
    number(0x06054b50u);
    number(std::uint32_t{0});  // one disk
    number(static_cast<std::uint16_t>(entries_.size()));
    number(static_cast<std::uint16_t>(entries_.size()));
    number(static_cast<std::uint32_t>(length));
    number(static_cast<std::uint32_t>(directory));
    number(std::uint16_t{0});  // no comment
    return std::move(bytes_);
  }

 private:
  struct Entry {
    std::string name;
    std::uint32_t checksum;
    std::uint32_t size;
    std::uint64_t place;
  };
  static constexpr std::uint64_t kLocalHeader = 30;

  [[noreturn]] static void refuse_size() {
    gltf::refuse(StatusCode::limit_exceeded, kNone, "a USDZ package holds at most 4 GiB");
  }

  template <class Integer>
  void number(Integer value) {
    for (std::size_t i = 0; i < sizeof value; ++i)
      bytes_.push_back(static_cast<std::byte>(value >> (8 * i) & 0xffu));
  }

  void text(std::string_view value) {
    for (const char c : value) bytes_.push_back(static_cast<std::byte>(c));
  }

  /// What a local header and the directory say of an entry.
  void common_header(const Entry& entry) {
    number(kVersion);
    number(std::uint32_t{0});  // neither flags nor compression
    number(std::uint16_t{0});  // midnight
    number(kNoDate);
    number(entry.checksum);
    number(entry.size);
    number(entry.size);
    number(static_cast<std::uint16_t>(entry.name.size()));
  }

  void add_to_directory(const Entry& entry) {
    number(0x02014b50u);
    number(kVersion);
    common_header(entry);
    number(std::uint16_t{0});  // no extra field
    number(std::uint16_t{0});  // no comment
    number(std::uint32_t{0});  // disk, attributes
    number(std::uint32_t{0});  // attributes
    number(static_cast<std::uint32_t>(entry.place));
    text(entry.name);
  }

  std::vector<std::byte> bytes_;
  std::vector<Entry> entries_;
};

}  // namespace

std::vector<std::byte> package_of(const UsdLayer& layer, const std::string& name) {
  StoredZip zip;
  zip.add(name, std::as_bytes(std::span(layer.text)));  // the first entry is what is opened
  for (const UsdLayer::Texture& texture : layer.textures) zip.add(texture.path, texture.bytes);
  return zip.finish();
}

}  // namespace sunder::usd
