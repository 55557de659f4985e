#include "architecture/nesting.h"

#include <algorithm>
#include <cctype>

namespace sunder::test {
namespace {

bool is_part_of_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}
bool is_blank(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }

/// Whether what stands before a brace is the head of a lambda: `[…]`, `[…](…)`, with `mutable` or a
/// returned type.
bool ends_in_lambda(std::string_view before) {
  const auto trim = [&] {
    while (!before.empty() && is_blank(before.back())) before.remove_suffix(1);
  };
  const std::size_t arrow = before.rfind("->");
  if (arrow != std::string_view::npos &&
      before.find_first_of(";=(){}", arrow) == std::string_view::npos)
    before = before.substr(0, arrow);
  trim();
  if (before.ends_with("mutable")) before.remove_suffix(7);
  trim();
  return before.ends_with(')') || before.ends_with(']');
}

/// Reads the statements of a body, one after another.
class StatementReader {
 public:
  explicit StatementReader(std::string_view text) : text_(text) {}

  std::size_t read() {
    for (; at_ < text_.size(); ++at_) read_block(0);  // each ends at a brace too many
    return deepest_;
  }

 private:
  void skip_space() {
    while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
  }
  std::string_view next_word() const {
    std::size_t end = at_;
    while (end < text_.size() && is_part_of_word(text_[end])) ++end;
    return text_.substr(at_, end - at_);
  }

  void read_statement(std::size_t depth) {
    deepest_ = std::max(deepest_, depth);
    skip_space();
    if (at_ == text_.size()) return;
    const std::string_view word = next_word();
    if (text_[at_] == '{') {
      read_braces(depth);
    } else if (word == "if" || word == "for" || word == "while" || word == "switch" ||
               word == "catch") {
      read_expression(depth, '(');
      read_expression(depth, ')');
      read_statement(depth + 1);
      if (word == "if") read_else(depth);
    } else if (word == "do" || word == "try") {
      at_ += word.size();
      read_statement(depth + 1);
      if (word == "do") read_expression(depth, ';');
    } else if (word == "case" || word == "default") {
      read_label();
    } else {
      read_expression(depth, ';');
    }
  }

  void read_else(std::size_t depth) {
    skip_space();
    if (next_word() != "else") return;
    at_ += 4;
    skip_space();
    read_statement(next_word() == "if" ? depth : depth + 1);
  }

  void read_label() {
    for (; at_ < text_.size(); ++at_) {
      if (text_[at_] != ':') continue;
      if (text_.substr(at_, 2) != "::") break;
      ++at_;
    }
    at_ = std::min(at_ + 1, text_.size());
  }

  void read_braces(std::size_t depth) {
    ++at_;
    read_block(depth);
    at_ = std::min(at_ + 1, text_.size());
  }

  /// Up to the closing brace.
  void read_block(std::size_t depth) {
    for (skip_space(); at_ < text_.size() && text_[at_] != '}'; skip_space()) read_statement(depth);
  }

  /// Up to and with `end`; brackets are read in pairs.
  void read_expression(std::size_t depth, char end) {
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '{' && ends_in_lambda(text_.substr(0, at_))) {
        read_braces(depth + 1);
        continue;
      }
      if (c == '}' && end != '}') return;  // the end of the block around it
      ++at_;
      if (c == end) return;
      if (c == '(') read_expression(depth, ')');
      if (c == '[') read_expression(depth, ']');
      if (c == '{') read_expression(depth, '}');
    }
  }

  std::string_view text_;
  std::size_t at_ = 0, deepest_ = 0;
};

}  // namespace

std::size_t nesting_of(std::string_view body) { return StatementReader(body).read(); }

}  // namespace sunder::test
