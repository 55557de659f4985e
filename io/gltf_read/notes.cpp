#include "io/gltf_read/notes.h"

#include "io/gltf/refusal.h"

namespace sunder::gltf {

void Notes::inform(const std::string& place, const std::string& text, std::uint32_t count) {
  report_.notes.push_back({LoadNote::Kind::information, place, text, count});
}

void Notes::repaired(StatusCode code, std::uint32_t index, const std::string& place,
                     const std::string& text, std::uint32_t count) {
  if (strict_) refuse(code, index, "%.90s: %.140s", place.c_str(), text.c_str());
  report_.notes.push_back({LoadNote::Kind::repaired, place, text, count});
}

void Notes::dropped(StatusCode code, std::uint32_t index, const std::string& place,
                    const std::string& text, std::uint32_t count) {
  if (strict_) refuse(code, index, "%.90s: %.140s", place.c_str(), text.c_str());
  report_.notes.push_back({LoadNote::Kind::dropped, place, text, count});
}

}  // namespace sunder::gltf
