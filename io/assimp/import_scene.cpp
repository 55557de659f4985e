#include "io/assimp/import_scene.h"

#include <exception>
#include <new>
#include <stdexcept>

#include "io/assimp/assertions.h"
#include "io/assimp/convert_scene.h"
#include "io/assimp/failure.h"

namespace sunder::assimp_import {

Result<ImportedGlb> import_scene(const ModelFile& model, AssetFiles& assets,
                                 const LoadOptions& options) {
  const AssertionsThrow during_import;
  try {
    return read_and_convert(model, assets, options);
  } catch (const ImportFailure& failure) {
    return failure.status;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::length_error&) {
    return Status::failure(StatusCode::malformed_file, kNone,
                           "%.100s: an array is declared with an impossible size",
                           model.name.c_str());
  } catch (const std::exception& error) {
    return Status::failure(StatusCode::malformed_file, kNone, "%.100s: %s", model.name.c_str(),
                           error.what());
  }
}

}  // namespace sunder::assimp_import
