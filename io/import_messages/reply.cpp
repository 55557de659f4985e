#include "io/import_messages/reply.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <nlohmann/json.hpp>

namespace sunder::import_messages {
namespace {

using nlohmann::json;

constexpr std::size_t kMostNotes = 100'000;
constexpr std::size_t kMostTextBytes = 4096;

/// Control characters could change the state of a terminal that prints the text.
std::string text_of(const json& value) {
  std::string text = value.get<std::string>();
  if (text.size() > kMostTextBytes) throw std::out_of_range("text");
  std::replace_if(
      text.begin(), text.end(), [](char c) { return (c >= 0 && c < 0x20) || c == 0x7F; }, ' ');
  return text;
}

/// get<T>() would convert numbers of other types silently.
std::uint32_t number_of(const json& value, std::uint32_t most) {
  if (!value.is_number_unsigned()) throw std::out_of_range("number");
  const auto number = value.get<std::uint64_t>();
  if (number > most) throw std::out_of_range("number");
  return static_cast<std::uint32_t>(number);
}

LoadReport report_of(const json& head) {
  LoadReport report;
  report.format = text_of(head.at("format"));
  report.space = text_of(head.at("space"));
  const json& notes = head.at("notes");
  if (!notes.is_array() || notes.size() > kMostNotes) throw std::out_of_range("notes");
  for (const json& note : notes) {
    if (!note.is_array() || note.size() != 4) throw std::out_of_range("note");
    const auto kind = number_of(note[0], static_cast<std::uint32_t>(LoadNote::Kind::dropped));
    report.notes.push_back({static_cast<LoadNote::Kind>(kind), text_of(note[1]), text_of(note[2]),
                            number_of(note[3], ~0u)});
  }
  return report;
}

}  // namespace

std::string encode_head(const Status& status, const LoadReport& report) {
  json head = {{"code", static_cast<unsigned>(status.code())},
               {"index", status.index()},
               {"text", status.text().substr(0, kMostTextBytes)},
               {"format", report.format},
               {"space", report.space},
               {"notes", json::array()}};
  for (const LoadNote& note : report.notes)
    head["notes"].push_back({static_cast<unsigned>(note.kind), note.place.substr(0, kMostTextBytes),
                             note.text.substr(0, kMostTextBytes), note.count});
  return head.dump(-1, ' ', false, json::error_handler_t::replace);
}

Result<LoadReport> decode_head(std::string_view text, const std::string& name) {
  try {
    if (text.size() > kMostHeadBytes) throw std::out_of_range("head");
    const json head = json::parse(text);
    const auto code = static_cast<StatusCode>(
        number_of(head.at("code"), static_cast<std::uint32_t>(StatusCode::internal_error)));
    const std::uint32_t index = number_of(head.at("index"), ~0u);
    const std::string reason = text_of(head.at("text"));
    if (code != StatusCode::ok) return Status::failure(code, index, "%s", reason.c_str());
    return report_of(head);
  } catch (const std::bad_alloc&) {
    return Status::failure(StatusCode::limit_exceeded, kNone, "%.100s: out of memory",
                           name.c_str());
  } catch (const std::exception&) {
    return Status::failure(StatusCode::malformed_file, kNone,
                           "%.100s: the importer's reply is not valid", name.c_str());
  }
}

}  // namespace sunder::import_messages
