#pragma once

#include <sunder/io/character_file.h>

#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace sunder::assimp_import {

/// Collects the notes of the load report. Equal texts about the same place are counted, not
/// repeated.
class Notes {
 public:
  void inform(std::string_view place, std::string_view text, std::uint32_t count = 1);
  ///
  /// @param fault  the failure of a strict import.
  void repaired(StatusCode fault, std::string_view place, std::string_view text,
                std::uint32_t count = 1);
  void dropped(StatusCode fault, std::string_view place, std::string_view text,
               std::uint32_t count = 1);

  [[nodiscard]] const std::vector<LoadNote>& all() const { return notes_; }
  /// The first note of a repair or loss as a failure; ok if there is none.
  [[nodiscard]] Status first_fault() const;

 private:
  void add(LoadNote::Kind kind, StatusCode fault, std::string_view place, std::string_view text,
           std::uint32_t count);

  std::vector<LoadNote> notes_;
  std::vector<StatusCode> faults_;                             ///< One a note.
  std::unordered_map<std::string, std::size_t> note_of_text_;  ///< By kind, place and text.
};

/// `text` with all bytes that are not UTF-8 replaced by U+FFFD.
[[nodiscard]] std::string valid_utf8(std::string_view text);

}  // namespace sunder::assimp_import
