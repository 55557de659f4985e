#pragma once

#include <sunder/core/status.h>

#include <string>

#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>

#include "io/assimp/asset_files.h"

namespace sunder::assimp_import {

/// The model file, opened by the caller.
struct ModelFile {
  std::string name;  ///< Without folders.
  files::OpenFile file;
};

/// The name under which assimp opens the model. References of the model become relative to it.
[[nodiscard]] std::string name_for_assimp(const ModelFile& model);

/// Gives assimp the model and the files that AssetFiles allows, for reading, and stores the first
/// refusal. assimp opens no file itself.
class AssetIOSystem : public Assimp::IOSystem {
 public:
  AssetIOSystem(const ModelFile& model, AssetFiles& assets) : model_(model), assets_(assets) {}

  bool Exists(const char* path) const override;
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* path, const char* mode) override;
  void Close(Assimp::IOStream* stream) override { delete stream; }
  bool CreateDirectory(const std::string&) override { return false; }
  bool ChangeDirectory(const std::string&) override { return false; }
  bool DeleteFile(const std::string&) override { return false; }

  [[nodiscard]] const Status& refusal() const { return refusal_; }

 private:
  const ModelFile& model_;
  AssetFiles& assets_;
  Status refusal_;
};

}  // namespace sunder::assimp_import
