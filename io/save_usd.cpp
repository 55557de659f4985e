#include <sunder/io/usd_file.h>

#include <algorithm>
#include <list>
#include <optional>
#include <span>
#include <system_error>
#include <utility>

#include "io/gltf/refusal.h"
#include "io/internal/lower_extension.h"
#include "io/internal/staged_file.h"
#include "io/usd_write/layer.h"
#include "io/usd_write/package.h"

namespace sunder {
namespace {

/// A file's name without its extension, of characters that no path of USD or ZIP gives a meaning.
std::string plain_stem(const std::filesystem::path& file) {
  std::string stem = file.stem().string();
  std::ranges::replace_if(
      stem,
      [](unsigned char c) {
        return !((c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
                 c == '.' || c == '-' || c == '_');
      },
      '_');
  return stem;
}

/// The folder of a layer's textures, which is made if it is absent. One that was made is gone again
/// if it is still empty at the end.
class TexturesFolder {
 public:
  explicit TexturesFolder(std::filesystem::path folder) : folder_(std::move(folder)) {
    std::error_code error;
    is_made_ = std::filesystem::create_directory(folder_, error);
    if (error || !std::filesystem::is_directory(folder_, error))
      status_ = Status::failure(StatusCode::file_unreadable, kNone,
                                "cannot make the folder '%.200s'", folder_.c_str());
  }
  ~TexturesFolder() {
    if (!is_made_) return;
    std::error_code error;
    std::filesystem::remove(folder_, error);  // of a folder with files it fails
  }
  TexturesFolder(const TexturesFolder&) = delete;
  TexturesFolder& operator=(const TexturesFolder&) = delete;

  [[nodiscard]] const Status& status() const { return status_; }

 private:
  std::filesystem::path folder_;
  bool is_made_ = false;
  Status status_;
};

/// Textures first, so that the text never names one that is absent.
Status write_beside(const std::filesystem::path& file, const UsdLayer& layer) {
  const std::filesystem::path parent = file.parent_path();
  std::optional<TexturesFolder> folder;
  std::list<StagedFile> staged;
  if (!layer.textures.empty()) {
    folder.emplace(parent / std::filesystem::path(layer.textures[0].path).parent_path());
    if (!folder->status()) return folder->status();
  }
  for (const UsdLayer::Texture& texture : layer.textures)
    if (!staged.emplace_back(parent / texture.path, texture.bytes).status())
      return staged.back().status();
  if (!staged.emplace_back(file, std::as_bytes(std::span(layer.text))).status())
    return staged.back().status();
  for (StagedFile& one : staged)
    if (const Status status = one.commit(); !status) return status;
  return {};
}

}  // namespace

Result<UsdLayer> usd_layer(const Character& character, const LoadedCharacter& loaded,
                           const SaveOptions& options, const std::string& textures_folder) {
  return gltf::without_exceptions<UsdLayer>(
      [&] { return usd::layer_of(character, loaded, options, textures_folder); });
}

Result<std::vector<std::byte>> usdz_package(const UsdLayer& layer, const std::string& name) {
  return gltf::without_exceptions<std::vector<std::byte>>(
      [&] { return usd::package_of(layer, name); });
}

Result<std::uint32_t> save_usd(const std::filesystem::path& file, const Character& character,
                               const LoadedCharacter& loaded, const SaveOptions& options) {
  const std::string extension = lower_extension(file);
  const bool is_package = extension == ".usdz";
  if (!is_package && extension != ".usda")
    return Status::failure(StatusCode::unsupported_format, kNone,
                           "USD is written as '.usda' or '.usdz', not as '%.20s'",
                           extension.c_str());
  const std::string stem = plain_stem(file);
  const Result<UsdLayer> layer =
      usd_layer(character, loaded, options, is_package ? "textures" : stem + "_textures");
  if (!layer) return layer.error();
  if (!is_package) {
    if (const Status status = write_beside(file, *layer); !status) return status;
    return layer->left_out_images;
  }
  const Result<std::vector<std::byte>> package = usdz_package(*layer, stem + ".usda");
  if (!package) return package.error();
  if (const Status status = write_file(file, *package); !status) return status;
  return layer->left_out_images;
}

}  // namespace sunder
