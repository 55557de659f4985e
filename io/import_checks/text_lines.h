#pragma once

#include <charconv>
#include <cstdint>
#include <optional>
#include <string_view>

namespace sunder::assimp_import {

/// Visits the lines of a text; LF, CR or both end a line.
class TextLines {
 public:
  explicit TextLines(std::string_view text) : text_(text) {}

  /// Moves to the next line. @return whether there is one.
  bool next() {
    if (at_ >= text_.size()) return false;
    const std::size_t end = text_.find_first_of("\r\n", at_);
    line_ = text_.substr(at_, end == std::string_view::npos ? end : end - at_);
    at_ = end == std::string_view::npos ? text_.size() : end + 1;
    if (end != std::string_view::npos && text_[end] == '\r' && at_ < text_.size() &&
        text_[at_] == '\n')
      ++at_;
    return true;
  }
  /// Without its end.
  [[nodiscard]] std::string_view line() const { return line_; }
  /// Offset of the next line.
  [[nodiscard]] std::size_t offset() const { return at_; }

 private:
  std::string_view text_, line_;
  std::size_t at_ = 0;
};

/// Removes the first word from `text` and returns it; empty if there is none.
inline std::string_view next_word(std::string_view& text) {
  const std::size_t begin = text.find_first_not_of(" \t");
  if (begin == std::string_view::npos) return text = {};
  std::size_t end = text.find_first_of(" \t", begin);
  if (end == std::string_view::npos) end = text.size();
  const std::string_view word = text.substr(begin, end - begin);
  text.remove_prefix(end);
  return word;
}

/// A number without sign; the largest one if it is larger.
inline std::optional<std::uint64_t> parse_count(std::string_view word) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (word.empty() || end != word.data() + word.size()) return std::nullopt;
  return error == std::errc() ? value : ~std::uint64_t{0};
}

}  // namespace sunder::assimp_import
