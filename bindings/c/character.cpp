#include "bindings/c/character.h"

#include <algorithm>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "bindings/c/bytes.h"
#include "bindings/c/structs.h"
#include "core/internal/wall_material.h"
#include "io/internal/load_bytes.h"

namespace sunder::c {
namespace {

/// The files that the callbacks of the program give.
class CallbackFiles : public FileResolver {
 public:
  explicit CallbackFiles(const sunder_load_options& options) : options_(options) {}

  [[nodiscard]] Result<std::vector<std::byte>> read(std::string_view uri) const override {
    const std::uint8_t* data = nullptr;
    std::uint64_t size = 0;
    const std::string name(uri);
    if (name.find('\0') != std::string::npos)  // the program would get another name
      return Status::failure(StatusCode::path_not_allowed, kNone, "the name contains a NUL");
    const sunder_status status =
        options_.read_file(options_.file_context, name.c_str(), &data, &size);
    if (status != SUNDER_OK || (data == nullptr && size > 0))
      return Status::failure(StatusCode::file_not_found, kNone, "the program has no such file");
    const Release release{options_, data};
    if (size > options_.maximum_bytes || check_size(size, "size") != SUNDER_OK)
      return Status::failure(StatusCode::limit_exceeded, kNone,
                             "%llu bytes exceed sunder_load_options.maximum_bytes",
                             static_cast<unsigned long long>(size));
    const auto* const bytes = reinterpret_cast<const std::byte*>(data);
    return std::vector<std::byte>(bytes, bytes + size);
  }

 private:
  struct Release {
    ~Release() {
      if (options.release_file != nullptr) options.release_file(options.file_context, data);
    }
    const sunder_load_options& options;
    const std::uint8_t* data;
  };

  sunder_load_options options_;
};

std::vector<sunder_note> notes_of(const LoadReport& report) {
  std::vector<sunder_note> notes;
  for (const LoadNote& note : report.notes)
    notes.push_back(
        {note.place.c_str(), note.text.c_str(), static_cast<std::uint32_t>(note.kind), note.count});
  return notes;
}

template <class List>
sunder_status find_named(const List& list, const char* name, std::uint32_t* index,
                         const char* what) {
  if (name == nullptr) return null_pointer("name");
  if (index == nullptr) return null_pointer(what);
  const auto found =
      std::find_if(list.begin(), list.end(), [&](const auto& one) { return one.name == name; });
  if (found == list.end())
    return fail(SUNDER_NOT_FOUND, kNone, "there is no %s '%.200s'", what, name);
  *index = static_cast<std::uint32_t>(found - list.begin());
  return SUNDER_OK;
}

/// A copy in which a mesh has an attribute of one number per vertex, in place of one of that name.
Result<Character> with_numbers(const Character& character, std::uint32_t mesh,
                               std::string_view name, std::span<const float> values) {
  if (mesh >= character.meshes.size())
    return Status::failure(StatusCode::index_out_of_range, mesh, "mesh %u of %zu", mesh,
                           character.meshes.size());
  if (!name.starts_with('_') || name.size() < 2)
    return Status::failure(StatusCode::invalid_argument, mesh,
                           "the attribute is named '%.60s'; names of attributes begin with '_'",
                           std::string(name).c_str());
  Character changed = character;
  std::vector<CustomAttribute>& attributes = changed.meshes[mesh].custom_attributes;
  auto place = std::ranges::find(attributes, name, &CustomAttribute::name);
  if (place == attributes.end()) place = attributes.insert(place, CustomAttribute{});
  const bool is_label = name == kWallMaterialAttribute;
  *place = {std::string(name), 1, !is_label, {values.begin(), values.end()}};
  if (const Status status = validate_character(changed); !status) return status;
  return changed;
}

}  // namespace

CharacterParts::CharacterParts(LoadedCharacter of, std::shared_ptr<const Character> of_source)
    : loaded(std::move(of)),
      in_source(of_source == nullptr ? loaded.character : std::move(of_source)),
      view(*loaded.character),
      notes(notes_of(loaded.report)) {}

Result<std::vector<std::byte>> CharacterParts::save(const Character& character,
                                                    const SaveOptions& options) const {
  if (loaded.source == nullptr) return save_glb(character, options);
  LoadedCharacter before;
  before.character = in_source;
  before.source = loaded.source;
  before.report = loaded.report;
  return save_glb(character, before, options);
}

sunder_status add_character(LoadedCharacter loaded, sunder_character* handle,
                            std::shared_ptr<const Character> in_source) {
  auto object = std::make_unique<CharacterObject>();
  object->parts = std::make_shared<const CharacterParts>(std::move(loaded), std::move(in_source));
  return add(std::move(object), handle);
}

SaveOptions save_options_of(const sunder_save_options* options) {
  SaveOptions save;
  if (options != nullptr) save.maximum_influences = options->maximum_influences;
  return save;
}

}  // namespace sunder::c

using namespace sunder::c;

extern "C" {

sunder_character_data sunder_default_character_data(void) {
  sunder_character_data data = {};
  data.struct_size = sizeof data;
  return data;
}

sunder_load_options sunder_default_load_options(void) {
  const sunder::ReadOptions defaults;
  sunder_load_options options = {};
  options.struct_size = sizeof options;
  options.maximum_bytes = defaults.maximum_bytes;
  options.maximum_memory = defaults.maximum_memory;
  return options;
}

sunder_save_options sunder_default_save_options(void) { return {sizeof(sunder_save_options), 0}; }

sunder_status sunder_create_character(const sunder_character_data* data,
                                      sunder_character* character) {
  return guarded([&]() -> sunder_status {
    SUNDER_C_TRY(check_struct(data, "data"));
    if (character == nullptr) return null_pointer("character");
    sunder::Result<sunder::Character> copy = copy_character(*data);
    if (!copy) return report(copy.error());
    SUNDER_C_TRY(report(sunder::validate_character(*copy)));
    sunder::LoadedCharacter loaded;
    loaded.character = std::make_shared<const sunder::Character>(std::move(*copy));
    return add_character(std::move(loaded), character);
  });
}

sunder_status sunder_load_glb(const void* bytes, uint64_t size, const sunder_load_options* options,
                              sunder_character* character) {
  return guarded([&]() -> sunder_status {
    SUNDER_C_TRY(check_options(options, "options"));
    if (bytes == nullptr) return null_pointer("bytes");
    SUNDER_C_TRY(check_size(size, "size"));
    if (character == nullptr) return null_pointer("character");
    const sunder_load_options given = options == nullptr ? sunder_default_load_options() : *options;
    sunder::ReadOptions reading;
    reading.strict = given.is_strict != 0;
    reading.maximum_bytes = given.maximum_bytes;
    reading.maximum_memory = given.maximum_memory;
    if (size > reading.maximum_bytes)
      return fail(SUNDER_LIMIT_EXCEEDED, sunder::kNone, "%llu bytes; the limit is %llu",
                  static_cast<unsigned long long>(size),
                  static_cast<unsigned long long>(reading.maximum_bytes));
    std::shared_ptr<const sunder::FileResolver> files;
    if (given.read_file != nullptr) files = std::make_shared<CallbackFiles>(given);
    const auto* const first = static_cast<const std::byte*>(bytes);
    auto loaded = sunder::load_plain_bytes({first, first + size}, reading, std::move(files));
    if (!loaded) return report(loaded.error());
    return add_character(std::move(*loaded), character);
  });
}

sunder_status sunder_add_attribute(sunder_character character, uint32_t mesh, const char* name,
                                   const float* values, uint32_t value_count,
                                   sunder_character* with_attribute) {
  return guarded([&]() -> sunder_status {
    const CharacterObject* const object = find<CharacterObject>(character);
    if (object == nullptr) return SUNDER_INVALID_HANDLE;
    if (name == nullptr) return null_pointer("name");
    if (values == nullptr && value_count > 0) return null_pointer("values");
    if (with_attribute == nullptr) return null_pointer("with_attribute");
    const CharacterParts& parts = *object->parts;
    auto changed = with_numbers(*parts.loaded.character, mesh, name, {values, value_count});
    if (!changed) return report(changed.error());
    sunder::LoadedCharacter loaded = parts.loaded;
    loaded.stored.clear();
    loaded.character = std::make_shared<const sunder::Character>(std::move(*changed));
    return add_character(std::move(loaded), with_attribute, parts.in_source);
  });
}

sunder_status sunder_destroy_character(sunder_character character) {
  return destroy_object(character, Kind::character);
}

sunder_status sunder_get_character(sunder_character character, sunder_character_data* data) {
  const CharacterObject* const object = find<CharacterObject>(character);
  if (object == nullptr) return SUNDER_INVALID_HANDLE;
  SUNDER_C_TRY(check_struct(data, "data"));
  *data = object->parts->view.data;
  return SUNDER_OK;
}

sunder_status sunder_find_bone(sunder_character character, const char* name, uint32_t* bone) {
  const CharacterObject* const object = find<CharacterObject>(character);
  if (object == nullptr) return SUNDER_INVALID_HANDLE;
  return find_named(object->parts->loaded.character->skeleton.bones, name, bone, "bone");
}

sunder_status sunder_find_clip(sunder_character character, const char* name, uint32_t* clip) {
  const CharacterObject* const object = find<CharacterObject>(character);
  if (object == nullptr) return SUNDER_INVALID_HANDLE;
  return find_named(object->parts->loaded.character->clips, name, clip, "clip");
}

sunder_status sunder_get_notes(sunder_character character, const sunder_note** notes,
                               uint32_t* count) {
  const CharacterObject* const object = find<CharacterObject>(character);
  if (object == nullptr) return SUNDER_INVALID_HANDLE;
  if (notes == nullptr) return null_pointer("notes");
  if (count == nullptr) return null_pointer("count");
  *notes = object->parts->notes.data();
  *count = static_cast<uint32_t>(object->parts->notes.size());
  return SUNDER_OK;
}

sunder_status sunder_save_glb(sunder_character character, const sunder_save_options* options,
                              sunder_bytes* glb) {
  return guarded([&]() -> sunder_status {
    const CharacterObject* const object = find<CharacterObject>(character);
    if (object == nullptr) return SUNDER_INVALID_HANDLE;
    SUNDER_C_TRY(check_options(options, "options"));
    if (glb == nullptr) return null_pointer("glb");
    auto bytes = object->parts->save(*object->parts->loaded.character, save_options_of(options));
    if (!bytes) return report(bytes.error());
    return add_bytes(std::move(*bytes), glb);
  });
}

}  // extern "C"
