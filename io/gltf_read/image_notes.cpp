#include "io/gltf_read/image_notes.h"

#include <string>

#include "io/gltf/refusal.h"
#include "io/gltf/uris.h"

namespace sunder::gltf {

void note_images(Reading& reading) {
  const auto images = reading.json().find("images");
  if (images == reading.json().end() || !images->is_array()) return;
  for (std::size_t i = 0; i < images->size(); ++i) {
    const Json& image = (*images)[i];
    if (!image.is_object() || !image.contains("uri") || !image["uri"].is_string()) continue;
    const auto& uri = image["uri"].get_ref<const std::string&>();
    if (is_data_uri(uri)) continue;
    const std::string place = "/images/" + std::to_string(i);
    try {
      if (reading.document.side_files == nullptr) refuse_side_file(uri, place);
      if (!reading.document.side_files->exists(uri, place))
        reading.notes.inform(place, "the image does not exist; its reference stays");
    } catch (const Refusal& refusal) {
      if (refusal.status.code() == StatusCode::path_not_allowed)
        reading.notes.dropped(StatusCode::path_not_allowed, static_cast<std::uint32_t>(i), place,
                              "the image is outside the model's folder and is not read; its "
                              "reference stays");
      else
        reading.notes.inform(place, "the image cannot be found; its reference stays");
    }
  }
}

}  // namespace sunder::gltf
