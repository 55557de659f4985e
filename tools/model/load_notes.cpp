#include "tools/model/load_notes.h"

#include <algorithm>
#include <cstddef>

#include "tools/messages/exit_code.h"

namespace sunder::tools {
namespace {

constexpr std::size_t kMostLines = 20;

}  // namespace

bool is_change(const LoadNote& note) {
  return note.kind == LoadNote::Kind::repaired || note.kind == LoadNote::Kind::dropped;
}

void warn_of_protection(const std::string& model, const LoadReport& report,
                        const Messages& messages) {
  for (const LoadNote& note : report.notes)
    if (note.kind == LoadNote::Kind::warning) messages.warn(model + ": " + note.text);
}

void warn_of_repairs(const std::string& model, const LoadReport& report, const Messages& messages) {
  warn_of_protection(model, report, messages);
  std::size_t lines = 0;
  for (const LoadNote& note : report.notes) {
    if (!is_change(note)) continue;
    if (++lines > kMostLines) continue;
    const bool is_loss = note.kind == LoadNote::Kind::dropped;
    messages.warn(model + ": " + (is_loss ? "dropped: " : "repaired: ") + note.place + ": " +
                  with_option_names(note.text) + " (" + std::to_string(note.count) + ")");
  }
  if (lines > kMostLines)
    messages.warn(model + ": " + std::to_string(lines - kMostLines) +
                  " more repairs; `sunder info` lists all");
}

bool has_losses(const LoadReport& report) {
  return std::ranges::any_of(
      report.notes, [](const LoadNote& note) { return note.kind == LoadNote::Kind::dropped; });
}

}  // namespace sunder::tools
