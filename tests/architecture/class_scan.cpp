#include "architecture/class_scan.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

#include "architecture/bare_source.h"

namespace sunder::test {
namespace {

bool is_in_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }
bool is_space(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }

std::vector<std::string> words_of(const std::string& text) {
  std::vector<std::string> words;
  bool is_inside = false;
  for (const char c : text) {
    const bool is_part = is_in_word(c) || c == ':';
    if (is_part && !is_inside) words.emplace_back();
    if (is_part) words.back() += c;
    is_inside = is_part;
  }
  return words;
}

/// The text outside all pairs of brackets. The brackets stay: "f(a, b<c>)" becomes "f()".
std::string outside_brackets(const std::string& text) {
  std::string outside;
  std::size_t depth = 0;
  for (const char c : text) {
    if ((c == ')' || c == ']' || c == '}' || c == '>') && depth > 0) --depth;
    if (depth == 0) outside += c;
    if (c == '(' || c == '[' || c == '{' || c == '<') ++depth;
  }
  return outside;
}

enum class Declares { nothing, method, members };

/// The kind of a declaration in a class, given outside its brackets, as far as it was read.
Declares kind_of(const std::string& declaration) {
  static constexpr std::array<std::string_view, 4> kNothing = {"using", "typedef", "friend",
                                                               "static_assert"};
  const std::vector<std::string> words = words_of(declaration);
  const auto has = [&](std::string_view word) {
    return std::find(words.begin(), words.end(), word) != words.end();
  };
  if (words.empty()) return Declares::nothing;
  if (std::find(kNothing.begin(), kNothing.end(), words[0]) != kNothing.end())
    return Declares::nothing;
  if (has("struct") || has("class") || has("enum")) return Declares::nothing;
  const std::size_t parameters = declaration.find('('),
                    value = std::min(declaration.find('='), declaration.find('{'));
  if (declaration.find("operator") != std::string::npos || parameters < value)
    return has("delete") ? Declares::nothing : Declares::method;
  return has("static") ? Declares::nothing : Declares::members;
}

/// Counts the declarations of one class.
class ClassReader {
 public:
  ClassReader(const std::string& text, std::size_t begin, ScannedClass& counts)
      : text_(text), at_(begin), counts_(counts) {}

  void read() {
    for (; at_ < text_.size() && text_[at_] != '}'; ++at_) {
      const char c = text_[at_];
      if (c == ';') {
        count();
      } else if (c == '(') {
        take_pair('(', ')');
      } else if (c == '{') {
        take_pair('{', '}');
        if (kind() == Declares::method && !goes_on()) count();
      } else if (c == ':' && is_access(declaration_)) {
        declaration_.clear();
      } else {
        declaration_ += c;
      }
    }
  }

 private:
  static bool is_access(const std::string& text) {
    const std::vector<std::string> words = words_of(text);
    return words.size() == 1 &&
           (words[0] == "public" || words[0] == "protected" || words[0] == "private");
  }

  /// Takes a pair of brackets into the declaration, without what they hold.
  void take_pair(char open, char close) {
    std::size_t depth = 0;
    for (; at_ < text_.size(); ++at_) {
      if (text_[at_] == open) ++depth;
      if (text_[at_] == close && --depth == 0) break;
    }
    declaration_ += {open, close};
  }

  /// Whether the braces before belong to the initialisers of a constructor.
  [[nodiscard]] bool goes_on() const {
    const std::size_t next = text_.find_first_not_of(" \n", at_ + 1);
    return next != std::string::npos && (text_[next] == ',' || text_[next] == '{');
  }

  [[nodiscard]] Declares kind() const { return kind_of(outside_brackets(declaration_)); }

  void count() {
    const Declares kind = this->kind();
    const std::string outside = outside_brackets(declaration_);
    if (kind == Declares::method) ++counts_.methods;
    if (kind == Declares::members)
      counts_.members +=
          1 + static_cast<std::size_t>(std::count(outside.begin(), outside.end(), ','));
    declaration_.clear();
  }

  const std::string& text_;
  std::size_t at_;
  ScannedClass& counts_;
  std::string declaration_;
};

/// The position after the brace that opens the class whose keyword ends at `at`; npos if this is no
/// definition.
std::size_t body_begin(const std::string& text, std::size_t at) {
  bool has_bases = false;
  for (; at < text.size(); ++at) {
    const char c = text[at];
    if (c == '{') return at + 1;
    if (c == ';' || c == '(' || c == ')' || c == '=') break;
    if ((c == '>' || c == ',') && !has_bases) break;  // a parameter of a template
    if (c == ':') has_bases = true;
  }
  return std::string::npos;
}

/// The name in "SUNDER_API Name final : public Base".
std::string name_in(const std::string& head) {
  std::string name;
  for (const std::string& word : words_of(head)) {
    if (word == ":" || word == "final") break;
    name = word;
  }
  return name;
}

}  // namespace

std::vector<ScannedClass> scan_classes(const std::string& source) {
  const std::string text = without_comments_and_literals(source);
  std::vector<ScannedClass> classes;
  std::string word, before;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (is_in_word(text[i])) {
      word += text[i];
      continue;
    }
    if ((word == "struct" || word == "class") && before != "enum") {
      const std::size_t body = body_begin(text, i);
      if (body != std::string::npos) {
        const auto line =
            std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(i), '\n');
        classes.push_back(
            {name_in(text.substr(i, body - 1 - i)), static_cast<std::size_t>(line) + 1});
        ClassReader(text, body, classes.back()).read();
      }
    }
    if (!word.empty()) before = word;
    if (!is_space(text[i])) before.clear();
    word.clear();
  }
  return classes;
}

}  // namespace sunder::test
