#include "tools/messages/exit_code.h"

#include <array>
#include <string_view>
#include <utility>

#include "tools/messages/messages.h"

namespace sunder::tools {
namespace {

/// The lengths at which io cuts the name of a file.
constexpr std::size_t kNameLengths[] = {std::string_view::npos, 100, 80};

/// The length of the name of a file, with its colon, with which a text begins; 0 without it.
std::size_t length_of_name(std::string_view text, std::string_view place) {
  const std::string_view file = place.substr(place.rfind('/') + 1);
  for (const std::size_t length : kNameLengths) {
    const std::string_view name = file.substr(0, length);
    if (!name.empty() && text.starts_with(name) && text.substr(name.size()).starts_with(": "))
      return name.size() + 2;
  }
  return 0;
}

}  // namespace

std::string with_option_names(std::string text) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 3> kOptions = {
      {{"LoadOptions::import_seconds", "--import-seconds"},
       {"LoadOptions::maximum_memory", "--memory"},
       {"LoadOptions::strict", "--strict"}}};
  for (const auto& [member, option] : kOptions)
    if (const std::size_t found = text.find(member); found != std::string::npos)
      text.replace(found, member.size(), option);
  return text;
}

std::string failure_text(const std::string& place, const Status& status) {
  std::string text(status.text());
  text.erase(0, length_of_name(text, place));
  if (status.code() == StatusCode::capacity_exceeded) text += "; --max-vertices allows more";
  return with_option_names(std::move(text));
}

ExitCode exit_code_of(StatusCode code, ExitCode otherwise) {
  switch (code) {
    case StatusCode::ok: return ExitCode::ok;
    case StatusCode::file_not_found:
    case StatusCode::file_unreadable: return ExitCode::unreadable_input;
    case StatusCode::limit_exceeded:
    case StatusCode::capacity_exceeded: return ExitCode::limit_exceeded;
    case StatusCode::internal_error: return ExitCode::internal_error;
    default: return otherwise;
  }
}

ExitCode complain(const std::string& place, const Status& status, ExitCode otherwise,
                  const std::string& advice) {
  print_error("sunder: " + place + ": " + failure_text(place, status) + advice + " (" +
              std::string(status_name(status.code())) + ")");
  return exit_code_of(status.code(), otherwise);
}

}  // namespace sunder::tools
