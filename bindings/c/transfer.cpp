#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#if SUNDER_C_VALIDATION
#include <sunder/validation/transfer.h>
#endif

#include "bindings/c/character.h"
#include "bindings/c/structs.h"

namespace sunder::c {
namespace {

#if SUNDER_C_VALIDATION

static_assert(static_cast<int>(TransferMethod::inpainting) == SUNDER_TRANSFER_INPAINTING);
static_assert(static_cast<int>(TransferOutcome::locked) == SUNDER_TRANSFER_LOCKED);

sunder_transfer_options transfer_defaults() {
  const TransferOptions from;
  sunder_transfer_options to = {};
  to.struct_size = sizeof to;
  to.method = static_cast<uint32_t>(from.method);
  to.distance = from.distance;
  to.angle = from.angle;
  to.smoothness = from.smoothness;
  to.smoothing_strength = from.smoothing_strength;
  to.mix = from.mix;
  return to;
}

/// Splits the flags of all vertices into those of the meshes.
sunder_status read_locked(const sunder_transfer_options& from, const Character& target,
                          TransferOptions& to) {
  if (from.locked == nullptr)
    return from.locked_count == 0 ? sunder_status{SUNDER_OK} : null_pointer("locked");
  std::size_t count = 0;
  for (const Mesh& mesh : target.meshes) count += mesh.vertex_count();
  if (from.locked_count != count)
    return fail(SUNDER_SIZE_MISMATCH, kNone, "`locked` is of %u vertices, the target has %zu",
                from.locked_count, count);
  const std::uint8_t* next = from.locked;
  for (const Mesh& mesh : target.meshes) {
    std::vector<bool>& locked = to.locked.emplace_back();
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) locked.push_back(*next++ != 0);
  }
  return SUNDER_OK;
}

sunder_status read_names(const sunder_transfer_options& from, TransferOptions& to) {
  if (from.bone_names == nullptr && from.bone_name_count > 0) return null_pointer("bone_names");
  for (std::uint32_t i = 0; i < from.bone_name_count; ++i) {
    const sunder_bone_names& names = from.bone_names[i];
    if (names.target == nullptr || names.source == nullptr) return null_pointer("bone_names");
    to.bone_names.push_back({names.target, names.source});
  }
  if (from.bones == nullptr && from.bone_count > 0) return null_pointer("bones");
  for (std::uint32_t i = 0; i < from.bone_count; ++i) {
    if (from.bones[i] == nullptr) return null_pointer("bones");
    to.bones.emplace_back(from.bones[i]);
  }
  return SUNDER_OK;
}

sunder_status read_transfer_options(const sunder_transfer_options& from, const Character& target,
                                    TransferOptions& to) {
  SUNDER_C_TRY(check_enum(from.method, SUNDER_TRANSFER_INPAINTING, "method"));
  to.method = static_cast<TransferMethod>(from.method);
  to.distance = from.distance;
  to.angle = from.angle;
  to.flip_normals = from.flips_normals != 0;
  to.isolate_parts = from.isolates_parts != 0;
  to.keep_sides_apart = from.keeps_sides_apart != 0;
  to.smoothness = from.smoothness;
  to.smoothing_sweeps = from.smoothing_sweeps;
  to.smoothing_strength = from.smoothing_strength;
  to.maximum_influences = from.maximum_influences;
  to.mix = from.mix;
  SUNDER_C_TRY(read_names(from, to));
  return read_locked(from, target, to);
}

sunder_transfer_info info_of(const TransferResult& from) {
  sunder_transfer_info to = {};
  to.struct_size = sizeof to;
  to.vertex_count = from.vertices;
  to.coincident = from.coincident;
  to.matched = from.matched;
  to.inpainted = from.inpainted;
  to.nearest = from.nearest;
  to.locked = from.locked;
  to.too_far = from.too_far;
  to.turned_away = from.turned_away;
  to.has_adopted_skeleton = from.has_adopted_skeleton ? 1 : 0;
  to.matched_share = from.matched_share();
  to.largest_distance = from.largest_distance;
  return to;
}

sunder_status transfer(const CharacterParts& source, const CharacterParts& target,
                       const sunder_transfer_options& from, sunder_character* result,
                       sunder_transfer_info* info, uint8_t* outcomes) {
  TransferOptions options;
  SUNDER_C_TRY(read_transfer_options(from, *target.loaded.character, options));
  auto found = transfer_weights(*source.loaded.character, *target.loaded.character, options);
  if (!found) return report(found.error());
  LoadedCharacter loaded;
  loaded.source = target.loaded.source;
  loaded.report.format = target.loaded.report.format;
  loaded.report.space = target.loaded.report.space;
  loaded.character = std::make_shared<const Character>(std::move(found->character));
  SUNDER_C_TRY(add_character(std::move(loaded), result, target.in_source));
  if (info != nullptr) *info = info_of(*found);
  if (outcomes != nullptr)
    for (const auto& of_mesh : found->outcomes)
      outcomes = std::transform(of_mesh.begin(), of_mesh.end(), outcomes,
                                [](TransferOutcome one) { return static_cast<uint8_t>(one); });
  return SUNDER_OK;
}

#else

sunder_transfer_options transfer_defaults() {
  sunder_transfer_options options = {};
  options.struct_size = sizeof options;
  return options;
}

sunder_status transfer(const CharacterParts&, const CharacterParts&, const sunder_transfer_options&,
                       sunder_character*, sunder_transfer_info*, uint8_t*) {
  return fail(SUNDER_UNSUPPORTED_FEATURE, kNone, "this library was built without validation");
}

#endif

}  // namespace
}  // namespace sunder::c

using namespace sunder::c;

extern "C" {

sunder_transfer_options sunder_default_transfer_options(void) { return transfer_defaults(); }

sunder_status sunder_transfer(sunder_character source, sunder_character target,
                              const sunder_transfer_options* options, sunder_character* result,
                              sunder_transfer_info* info, uint8_t* outcomes) {
  return guarded([&]() -> sunder_status {
    const CharacterObject* const from = find<CharacterObject>(source);
    if (from == nullptr) return SUNDER_INVALID_HANDLE;
    const CharacterObject* const to = find<CharacterObject>(target);
    if (to == nullptr) return SUNDER_INVALID_HANDLE;
    SUNDER_C_TRY(check_options(options, "options"));
    SUNDER_C_TRY(check_options(info, "info"));
    if (result == nullptr) return null_pointer("result");
    return transfer(*from->parts, *to->parts, options != nullptr ? *options : transfer_defaults(),
                    result, info, outcomes);
  });
}

}  // extern "C"
