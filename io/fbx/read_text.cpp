#include <charconv>
#include <cmath>
#include <stdexcept>

#include "io/fbx/record.h"

namespace sunder::fbx {
namespace {

constexpr int kMaximumTextDepth = 64;

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }
bool ends_word(char c) {
  return is_space(c) || c == ',' || c == ':' || c == '{' || c == '}' || c == ';' || c == '"';
}

class TextReader {
 public:
  explicit TextReader(std::string_view file) : file_(file) {}

  Record read() {
    Record document;
    while (skip_blanks(), at_ < file_.size()) {
      Record section = read_record(1, {});
      if (is_needed(section.name, "")) document.children.push_back(std::move(section));
    }
    return document;
  }

 private:
  [[noreturn]] void fail(const char* what) const {
    throw std::runtime_error(std::string(what) + " at byte " + std::to_string(at_));
  }

  /// Spaces, line ends, and comments up to the end of their line.
  void skip_blanks() {
    while (at_ < file_.size() && (is_space(file_[at_]) || file_[at_] == ';'))
      at_ = file_[at_] == ';' ? std::min(file_.find('\n', at_), file_.size()) : at_ + 1;
  }

  [[nodiscard]] char here() const { return at_ < file_.size() ? file_[at_] : '\0'; }

  std::string_view word() {
    const std::size_t begin = at_;
    while (at_ < file_.size() && !ends_word(file_[at_])) ++at_;
    return file_.substr(begin, at_ - begin);
  }

  /// @param section  of the document, in which a record is read; empty at the top.
  Record read_record(int depth, std::string_view section) {
    if (depth > kMaximumTextDepth) fail("FBX records nested too deep");
    Record record;
    record.name = word();
    if (record.name.empty() || here() != ':') fail("FBX text without 'name:'");
    ++at_;
    const bool is_kept = depth > 2 || is_needed(depth == 1 ? record.name : section,
                                                depth == 1 ? std::string_view() : record.name);
    read_values(record, is_kept);
    if (here() != '{') return record;
    ++at_;
    while (skip_blanks(), here() != '}') {
      if (at_ >= file_.size()) fail("an FBX record without its closing brace");
      if (!is_kept) {
        skip_one();
        continue;
      }
      Record inner = read_record(depth + 1, depth == 1 ? record.name : section);
      if (depth > 1 || is_needed(record.name, inner.name))
        record.children.push_back(std::move(inner));
    }
    ++at_;
    return record;
  }

  /// A token or a whole group in braces, of a record that is not needed.
  void skip_one() {
    int depth = 0;
    do {
      skip_blanks();
      if (at_ >= file_.size()) fail("an FBX record without its closing brace");
      const char c = file_[at_];
      if (c == '"') {
        quoted();
        continue;
      }
      depth += c == '{' ? 1 : c == '}' ? -1 : 0;
      ++at_;
    } while (depth > 0);
  }

  std::string quoted() {
    const std::size_t begin = ++at_;
    at_ = file_.find('"', at_);
    if (at_ == std::string_view::npos) {
      at_ = begin;
      fail("an FBX text without its closing quote");
    }
    return std::string(file_.substr(begin, at_++ - begin));
  }

  /// Values end with the line, unless the line ends with a comma. Numbers of `a:` become one array.
  void read_values(Record& record, bool is_kept) {
    const bool is_array = record.name == "a";
    for (;;) {
      while (at_ < file_.size() && (file_[at_] == ' ' || file_[at_] == '\t')) ++at_;
      const char c = here();
      if (c == '\r' || c == '\n' || c == '{' || c == '}' || c == ';' || c == '\0') return;
      Value value;
      if (c == '"') {
        value.text = quoted();
      } else if (c == '*') {
        ++at_;
        word();  // The size of an array, which follows in braces.
      } else {
        value = number_or_word(word());
      }
      if (is_kept && is_array && !record.values.empty() && !value.numbers.empty())
        record.values.front().numbers.push_back(value.number());
      else if (is_kept)
        record.values.push_back(std::move(value));
      while (at_ < file_.size() && (file_[at_] == ' ' || file_[at_] == '\t')) ++at_;
      if (here() != ',') continue;
      ++at_;
      skip_blanks();
    }
  }

  Value number_or_word(std::string_view word) {
    if (word.empty()) fail("an FBX value that is neither text nor number");
    Value value;
    double number = 0.0;
    const char* const end = word.data() + word.size();
    if (std::from_chars(word.data(), end, number).ptr != end) {
      value.text = word;
      return value;
    }
    value.numbers = {number};
    if (std::from_chars(word.data(), end, value.integer).ptr != end)
      value.integer = std::abs(number) < 9e18 ? static_cast<std::int64_t>(number) : 0;
    return value;
  }

  std::string_view file_;
  std::size_t at_ = 0;
};

}  // namespace

Record read_text_records(std::string_view file) { return TextReader(file).read(); }

}  // namespace sunder::fbx
