#include "io/contained_import/import_as_glb.h"

#include <new>
#include <string>
#include <system_error>
#include <utility>

#include "io/assimp/import_scene.h"
#include "io/contained_import/run_helper.h"
#include "io/import_checks/formats.h"

namespace sunder::contained_import {

namespace fs = std::filesystem;
using assimp_import::ModelFile;

namespace {

/// AllowedFiles for an import in this process.
class LocalFiles : public assimp_import::AssetFiles {
 public:
  explicit LocalFiles(files::AllowedFiles& allowed) : allowed_(allowed) {}

  [[nodiscard]] Status look_up(std::string_view reference) override {
    return allowed_.resolve(reference).error();
  }
  [[nodiscard]] Result<files::OpenFile> open(std::string_view reference) override {
    return allowed_.open(reference);
  }

 private:
  files::AllowedFiles& allowed_;
};

Status check_options(const LoadOptions& options) {
  if (!(options.import_seconds > 0.0))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "LoadOptions::import_seconds must be above 0");
  return {};
}

Result<ModelFile> open_model(const fs::path& file, const LoadOptions& options) {
  const std::string name = file.filename().string();
  Result<files::OpenFile> opened = files::open_regular_file(file);
  if (!opened) return opened.error();  // Before the format: a folder is called one.
  if (const auto format = assimp_import::format_of(name); !format) return format.error();
  if (opened->bytes == 0)
    return Status::failure(StatusCode::empty_input, kNone, "%.200s: the file is empty",
                           name.c_str());
  if (opened->bytes > options.maximum_bytes)
    return Status::failure(StatusCode::limit_exceeded, kNone,
                           "%.100s: %llu bytes; LoadOptions::maximum_bytes is %llu", name.c_str(),
                           static_cast<unsigned long long>(opened->bytes),
                           static_cast<unsigned long long>(options.maximum_bytes));
  return ModelFile{name, std::move(*opened)};
}

Result<ImportedGlb> import(const fs::path& file, const LoadOptions& options) {
  if (const Status checked = check_options(options); !checked) return checked;
  const Result<ModelFile> model = open_model(file, options);
  if (!model) return model.error();
  std::error_code error;
  const fs::path whole = fs::canonical(file, error);
  if (error)
    return Status::failure(StatusCode::file_not_found, kNone, "no file '%.200s'",
                           model->name.c_str());
  files::AllowedFiles allowed(whole.parent_path(), options.roots, options.maximum_bytes);
  if (const Status fits = allowed.charge(whole, model->file.bytes); !fits) return fits;
  if (options.import_place == ImportPlace::helper_process)
    return run_helper(*model, allowed, options);
  LocalFiles assets(allowed);
  return assimp_import::import_scene(*model, assets, options);
}

}  // namespace

Result<ImportedGlb> import_as_glb(const fs::path& file, const LoadOptions& options) {
  try {
    return import(file, options);
  } catch (const std::bad_alloc&) {
    return Status::failure(StatusCode::limit_exceeded, kNone, "%.200s: out of memory",
                           file.filename().c_str());
  } catch (const std::exception& error) {
    return Status::failure(StatusCode::internal_error, kNone, "%.100s: %s", file.filename().c_str(),
                           error.what());
  }
}

}  // namespace sunder::contained_import
