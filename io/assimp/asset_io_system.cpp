#include "io/assimp/asset_io_system.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "io/files/read_at.h"

namespace sunder::assimp_import {
namespace {

/// An open file as assimp reads it.
class AssetStream : public Assimp::IOStream {
 public:
  /// @param owned  keeps the file open; empty if another owner does.
  AssetStream(const files::Descriptor& descriptor, std::uint64_t bytes,
              files::Descriptor owned = {})
      : owned_(std::move(owned)),
        descriptor_(owned_.is_open() ? owned_ : descriptor),
        bytes_(static_cast<std::size_t>(bytes)) {}

  std::size_t Read(void* target, std::size_t size, std::size_t count) override {
    if (size == 0 || count == 0) return 0;
    const std::size_t whole = std::min(count, (bytes_ - at_) / size);
    const std::size_t got = files::read_at(descriptor_, target, whole * size, at_);
    at_ += got;
    return got / size;
  }
  std::size_t Write(const void*, std::size_t, std::size_t) override { return 0; }
  aiReturn Seek(std::size_t offset, aiOrigin origin) override {
    std::size_t from = 0;
    if (origin == aiOrigin_CUR) from = at_;
    if (origin == aiOrigin_END) from = bytes_;
    const std::size_t to = from + offset;  // A negative offset wraps around, as in fseek().
    if (to > bytes_) return aiReturn_FAILURE;
    at_ = to;
    return aiReturn_SUCCESS;
  }
  std::size_t Tell() const override { return at_; }
  std::size_t FileSize() const override { return bytes_; }
  void Flush() override {}

 private:
  files::Descriptor owned_;
  const files::Descriptor& descriptor_;
  std::size_t bytes_;
  std::size_t at_ = 0;
};

constexpr const char* kFolder = "./";

/// A reference as the model wrote it: assimp prepends the folder of the model's name.
std::string_view reference_of(std::string_view path) {
  while (path.starts_with(kFolder)) path.remove_prefix(2);
  return path;
}

}  // namespace

std::string name_for_assimp(const ModelFile& model) { return kFolder + model.name; }

bool AssetIOSystem::Exists(const char* path) const {
  const std::string_view reference = reference_of(path);
  return reference == model_.name || assets_.look_up(reference).is_ok();
}

Assimp::IOStream* AssetIOSystem::Open(const char* path, const char* mode) {
  if (std::strpbrk(mode, "wa+") != nullptr) return nullptr;
  const std::string_view reference = reference_of(path);
  if (reference == model_.name) return new AssetStream(model_.file.descriptor, model_.file.bytes);
  Result<files::OpenFile> file = assets_.open(reference);
  if (file) return new AssetStream({}, file->bytes, std::move(file->descriptor));
  if (file.error().code() != StatusCode::file_not_found && refusal_.is_ok())
    refusal_ = file.error();
  return nullptr;
}

}  // namespace sunder::assimp_import
