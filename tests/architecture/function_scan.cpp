#include "architecture/function_scan.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <sstream>
#include <string_view>

#include "architecture/bare_source.h"
#include "architecture/nesting.h"

namespace sunder::test {
namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    while (!line.empty() && line.back() == ' ') line.pop_back();
    lines.push_back(line);
  }
  return lines;
}

std::string first_word(const std::string& line, std::size_t column) {
  std::size_t end = column;
  while (end < line.size() &&
         (std::isalnum(static_cast<unsigned char>(line[end])) != 0 || line[end] == '_'))
    ++end;
  return line.substr(column, end - column);
}

bool may_begin_function(const std::string& line, std::size_t column) {
  static constexpr std::array<std::string_view, 20> kOthers = {
      "namespace", "struct", "class", "enum",     "union",  "using",   "return",
      "if",        "for",    "while", "switch",   "public", "private", "protected",
      "else",      "do",     "case",  "template", "extern", "typedef"};
  const std::string word = first_word(line, column);
  if (word.empty() && line[column] != '[' && line[column] != '~') return false;
  return std::find(kOthers.begin(), kOthers.end(), word) == kOthers.end();
}

/// The position of the parenthesis that opens the parameters.
std::size_t parameters_begin(const std::string& signature) {
  const std::size_t open = signature.find('(');
  if (open == std::string::npos || !signature.substr(0, open).ends_with("operator")) return open;
  return signature.find('(', open + 1);
}

std::size_t count_parameters(const std::string& signature) {
  std::size_t parentheses = 0, angles = 0, commas = 0;
  bool is_empty = true;
  for (std::size_t i = parameters_begin(signature); i < signature.size(); ++i) {
    const char c = signature[i];
    if (parentheses == 1 && c != ' ' && c != ')') is_empty = false;
    if (c == '(' || c == '[' || c == '{') ++parentheses;
    if ((c == ')' || c == ']' || c == '}') && --parentheses == 0) break;
    if (c == '<') ++angles;
    if (c == '>' && angles > 0) --angles;
    if (c == ',' && parentheses == 1 && angles == 0) ++commas;
  }
  return is_empty ? 0 : commas + 1;
}

/// The signature that begins at `line`, up to the opening brace of a body of several lines.
struct Signature {
  std::string text;
  std::size_t last_line = 0;
};

std::optional<Signature> signature_at(const std::vector<std::string>& lines, std::size_t line) {
  Signature signature;
  for (std::size_t i = line; i < lines.size(); ++i) {
    signature.text += lines[i] + ' ';
    if (lines[i].empty() || lines[i].back() == ';' || lines[i].back() == '}') return {};
    if (lines[i].back() != '{') continue;
    signature.last_line = i;
    const std::size_t open = parameters_begin(signature.text);
    if (open == std::string::npos || signature.text.substr(0, open).find('=') != std::string::npos)
      return {};
    return signature;
  }
  return {};
}

std::string function_name_in(const std::string& signature) {
  const std::string before = signature.substr(0, parameters_begin(signature));
  const std::size_t space = before.find_last_of(" *&");
  return space == std::string::npos ? before : before.substr(space + 1);
}

}  // namespace

std::vector<ScannedFunction> scan_functions(const std::string& source) {
  const std::vector<std::string> lines = lines_of(without_comments_and_literals(source));
  std::vector<ScannedFunction> functions;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::size_t column = lines[i].find_first_not_of(' ');
    if (column == std::string::npos || column > 4 || !may_begin_function(lines[i], column))
      continue;
    const auto signature = signature_at(lines, i);
    if (!signature) continue;
    const std::string closing = std::string(column, ' ') + '}';
    std::size_t end = signature->last_line + 1;
    while (end < lines.size() && !lines[end].starts_with(closing)) ++end;
    std::string body;
    for (std::size_t k = signature->last_line + 1; k < std::min(end, lines.size()); ++k)
      body += lines[k] + '\n';
    functions.push_back({function_name_in(signature->text), i + 1, end - i + 1,
                         count_parameters(signature->text), nesting_of(body)});
    i = end;
  }
  return functions;
}

}  // namespace sunder::test
