#include <sunder/io/operation_log.h>

#include <string_view>

#include "bindings/c/bytes.h"
#include "bindings/c/scene.h"
#include "bindings/c/structs.h"

using namespace sunder::c;

extern "C" {

sunder_status sunder_apply_log(sunder_scene scene, sunder_instance instance, const char* json,
                               uint64_t size, uint32_t* operation_count) {
  return guarded([&]() -> sunder_status {
    Found found;
    SUNDER_C_TRY(find_instance(scene, instance, found));
    if (json == nullptr) return null_pointer("json");
    SUNDER_C_TRY(check_size(size, "size"));
    const auto operations = sunder::parse_operations(std::string_view(json, size));
    if (!operations) return report(operations.error());
    ++found.scene->change;
    uint32_t applied = 0;
    sunder_status status = SUNDER_OK;
    for (const sunder::Operation& operation : *operations) {
      const auto done = found.instance->apply(operation);
      if (!done) {
        const std::string text(done.error().text());
        status = fail(static_cast<sunder_status>(done.error().code()), applied, "operation %u: %s",
                      applied, text.c_str());
        break;
      }
      ++applied;
    }
    if (operation_count != nullptr) *operation_count = applied;
    return status;
  });
}

sunder_status sunder_get_log(sunder_scene scene, sunder_instance instance, sunder_bytes* json) {
  return guarded([&]() -> sunder_status {
    Found found;
    SUNDER_C_TRY(find_instance(scene, instance, found));
    if (json == nullptr) return null_pointer("json");
    std::vector<sunder::Operation> operations;
    if (const sunder::TornModel* const model = found.instance->model()) {
      auto history = model->history();
      if (!history) return report(history.error());
      operations = std::move(*history);
    }
    const auto text = sunder::format_operations(operations);
    if (!text) return report(text.error());
    return add_text(*text, json);
  });
}

sunder_status sunder_get_digest(sunder_scene scene, sunder_instance instance, uint64_t* digest) {
  return guarded([&]() -> sunder_status {
    Found found;
    SUNDER_C_TRY(find_instance(scene, instance, found));
    if (digest == nullptr) return null_pointer("digest");
    const sunder::TornModel* const model = found.instance->model();
    *digest = model == nullptr ? 0 : model->digest();
    return SUNDER_OK;
  });
}

sunder_status sunder_get_undo_counts(sunder_scene scene, sunder_instance instance, uint32_t* undo,
                                     uint32_t* redo) {
  Found found;
  SUNDER_C_TRY(find_instance(scene, instance, found));
  if (undo == nullptr) return null_pointer("undo");
  if (redo == nullptr) return null_pointer("redo");
  const sunder::TornModel* const model = found.instance->model();
  *undo = model == nullptr ? 0 : model->undo_count();
  *redo = model == nullptr ? 0 : model->redo_count();
  return SUNDER_OK;
}

}  // extern "C"
