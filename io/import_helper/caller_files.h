#pragma once

#include "io/assimp/asset_files.h"
#include "io/import_messages/socket.h"

namespace sunder::import_helper {

/// Files that the caller opens for this process.
class CallerFiles : public assimp_import::AssetFiles {
 public:
  explicit CallerFiles(import_messages::Socket& socket) : socket_(socket) {}

  [[nodiscard]] Status look_up(std::string_view reference) override;
  [[nodiscard]] Result<files::OpenFile> open(std::string_view reference) override;

 private:
  import_messages::Socket& socket_;
};

}  // namespace sunder::import_helper
