#pragma once

#include <functional>
#include <map>
#include <string>

#include "io/assimp/asset_files.h"
#include "io/import_messages/messages.h"
#include "io/import_messages/socket.h"

namespace sunder::import_helper {

/// Files that the caller opens for this process.
class CallerFiles : public assimp_import::AssetFiles {
 public:
  explicit CallerFiles(import_messages::Socket& socket) : socket_(socket) {}

  [[nodiscard]] Status look_up(std::string_view reference) override;
  [[nodiscard]] Result<files::OpenFile> open(std::string_view reference) override;

 private:
  Result<files::OpenFile> request(import_messages::RequestKind kind, std::string_view reference);

  import_messages::Socket& socket_;
  /// The names of files that cannot be read. Importers ask for a missing file again and again,
  /// under many names.
  std::map<std::string, Status, std::less<>> refused_;
};

}  // namespace sunder::import_helper
