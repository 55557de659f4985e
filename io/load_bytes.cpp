#include "io/internal/load_bytes.h"

#include <string>
#include <utility>

#include "io/gltf/decoders.h"
#include "io/gltf/refusal.h"
#include "io/gltf/side_files.h"
#include "io/gltf_read/read.h"

namespace sunder {
namespace {

/// The files that a resolver of the caller gives.
class ResolvedFiles : public gltf::SideFiles {
 public:
  explicit ResolvedFiles(std::shared_ptr<const FileResolver> resolver)
      : resolver_(std::move(resolver)) {}

  [[nodiscard]] std::vector<std::byte> read(const std::string& uri, const std::string& place,
                                            std::uint64_t maximum_bytes) const override {
    Result<std::vector<std::byte>> bytes = resolver_->read(uri);
    if (!bytes)
      gltf::refuse(bytes.error().code(), kNone, "%.80s: '%.80s': %.80s", place.c_str(), uri.c_str(),
                   std::string(bytes.error().text()).c_str());
    if (bytes->size() > maximum_bytes)
      gltf::refuse(StatusCode::limit_exceeded, kNone,
                   "%.80s: '%.80s' has %zu bytes; %llu are left of ReadOptions::maximum_bytes",
                   place.c_str(), uri.c_str(), bytes->size(),
                   static_cast<unsigned long long>(maximum_bytes));
    return std::move(*bytes);
  }
  [[nodiscard]] bool exists(const std::string& uri, const std::string& /*place*/) const override {
    return resolver_->read(uri).has_value();
  }

 private:
  std::shared_ptr<const FileResolver> resolver_;
};

}  // namespace

Result<LoadedCharacter> load_bytes(std::vector<std::byte> bytes, const ReadOptions& options,
                                   std::shared_ptr<const FileResolver> resolver,
                                   const gltf::Decoders& decoders) {
  return gltf::without_exceptions<LoadedCharacter>([&] {
    std::shared_ptr<const gltf::SideFiles> files;
    if (resolver != nullptr) files = std::make_shared<ResolvedFiles>(std::move(resolver));
    return gltf::read_character(std::move(bytes), std::move(files), options, decoders);
  });
}

Result<LoadedCharacter> load_plain_bytes(std::vector<std::byte> bytes, const ReadOptions& options,
                                         std::shared_ptr<const FileResolver> resolver) {
  return load_bytes(std::move(bytes), options, std::move(resolver), {});
}

}  // namespace sunder
