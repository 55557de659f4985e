#include "io/assimp/notes.h"

#include <utility>

#include <nlohmann/json.hpp>

namespace sunder::assimp_import {

void Notes::inform(std::string_view place, std::string_view text, std::uint32_t count) {
  add(LoadNote::Kind::information, StatusCode::ok, place, text, count);
}

void Notes::repaired(StatusCode fault, std::string_view place, std::string_view text,
                     std::uint32_t count) {
  add(LoadNote::Kind::repaired, fault, place, text, count);
}

void Notes::dropped(StatusCode fault, std::string_view place, std::string_view text,
                    std::uint32_t count) {
  add(LoadNote::Kind::dropped, fault, place, text, count);
}

void Notes::add(LoadNote::Kind kind, StatusCode fault, std::string_view place,
                std::string_view text, std::uint32_t count) {
  if (count == 0) return;
  std::string key(1, static_cast<char>(kind));
  key.append(place).append(1, '\0').append(text);
  const auto [known, is_new] = note_of_text_.try_emplace(std::move(key), notes_.size());
  if (!is_new) {
    notes_[known->second].count += count;
    return;
  }
  notes_.push_back({kind, std::string(place), std::string(text), count});
  faults_.push_back(fault);
}

Status Notes::first_fault() const {
  for (std::size_t i = 0; i < notes_.size(); ++i)
    if (notes_[i].kind != LoadNote::Kind::information)
      return Status::failure(faults_[i], kNone, "%s: %s (%u)", notes_[i].place.c_str(),
                             notes_[i].text.c_str(), notes_[i].count);
  return {};
}

std::string valid_utf8(std::string_view text) {
  using Json = nlohmann::json;
  return Json::parse(Json(text).dump(-1, ' ', false, Json::error_handler_t::replace))
      .get<std::string>();
}

}  // namespace sunder::assimp_import
