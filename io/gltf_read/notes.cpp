#include "io/gltf_read/notes.h"

#include "io/gltf/refusal.h"

namespace sunder::gltf {

void Notes::inform(const std::string& place, const std::string& text, std::uint32_t count) {
  add(LoadNote::Kind::information, place, text, count);
}

void Notes::repaired(StatusCode code, std::uint32_t index, const std::string& place,
                     const std::string& text, std::uint32_t count) {
  if (strict_) refuse(code, index, "%.90s: %.140s", place.c_str(), text.c_str());
  add(LoadNote::Kind::repaired, place, text, count);
}

void Notes::dropped(StatusCode code, std::uint32_t index, const std::string& place,
                    const std::string& text, std::uint32_t count) {
  if (strict_) refuse(code, index, "%.90s: %.140s", place.c_str(), text.c_str());
  add(LoadNote::Kind::dropped, place, text, count);
}

void Notes::add(LoadNote::Kind kind, const std::string& place, const std::string& text,
                std::uint32_t count) {
  if (!report_.notes.empty()) {
    LoadNote& last = report_.notes.back();
    if (last.kind == kind && last.place == place && last.text == text) {
      last.count += count;
      return;
    }
  }
  report_.notes.push_back({kind, place, text, count});
}

}  // namespace sunder::gltf
