#include "io/import_checks/check_nesting.h"

#include <algorithm>
#include <array>

namespace sunder::assimp_import {
namespace {

constexpr std::size_t kMostLevels = 1024;

Status too_deep(const std::string& file_name) {
  return Status::failure(StatusCode::limit_exceeded, kNone,
                         "%.100s: more than %zu levels of nesting", file_name.c_str(), kMostLevels);
}

/// Offset after the tag that begins at `at`; quotes may contain '>'.
std::size_t end_of_tag(std::string_view text, std::size_t at) {
  while (at < text.size() && text[at] != '>') {
    if (text[at] == '"' || text[at] == '\'') {
      at = text.find(text[at], at + 1);
      if (at == std::string_view::npos) return text.size();
    }
    ++at;
  }
  return std::min(at + 1, text.size());
}

/// Offset after a comment, CDATA section or declaration at `at`, or `at` if there is none.
std::size_t end_of_skipped(std::string_view text, std::size_t at) {
  struct Skipped {
    std::string_view begin, end;
  };
  static constexpr std::array kSkipped = {Skipped{"<!--", "-->"}, Skipped{"<![CDATA[", "]]>"},
                                          Skipped{"<?", "?>"}, Skipped{"<!", ">"}};
  for (const Skipped& one : kSkipped) {
    if (!text.substr(at).starts_with(one.begin)) continue;
    const std::size_t end = text.find(one.end, at + one.begin.size());
    return end == std::string_view::npos ? text.size() : end + one.end.size();
  }
  return at;
}

/// Levels of braces, without strings and comments. A comment begins with a character of `comment`
/// and ends with the line; "//" is one where `comment` has a '/'.
Status check_braces(std::string_view content, const std::string& comment,
                    const std::string& file_name) {
  const std::string marks = "{}\"" + comment;
  std::size_t levels = 0;
  for (std::size_t at = content.find_first_of(marks); at != std::string_view::npos;
       at = content.find_first_of(marks, at + 1)) {
    if (content[at] == '{') {
      if (++levels > kMostLevels) return too_deep(file_name);
    } else if (content[at] == '}') {
      if (levels > 0) --levels;
    } else if (content[at] == '"') {
      at = std::min(content.find('"', at + 1), content.size());
    } else if (content[at] != '/' || content.substr(at).starts_with("//")) {
      at = std::min(content.find_first_of("\r\n", at + 1), content.size());
    }
  }
  return {};
}

}  // namespace

Status check_fbx_depth(std::string_view content, const std::string& file_name) {
  return check_braces(content, ";", file_name);
}

Status check_x_depth(std::string_view content, const std::string& file_name) {
  return check_braces(content, "#/", file_name);
}

Status check_xml_depth(std::string_view content, const std::string& file_name) {
  std::size_t levels = 0;
  for (std::size_t at = content.find('<'); at != std::string_view::npos;
       at = content.find('<', at)) {
    if (const std::size_t end = end_of_skipped(content, at); end != at) {
      at = end;
      continue;
    }
    const bool closes = at + 1 < content.size() && content[at + 1] == '/';
    at = end_of_tag(content, at);
    const bool is_empty = at >= 2 && content[at - 2] == '/';
    if (closes && levels > 0) --levels;
    if (!closes && !is_empty && ++levels > kMostLevels) return too_deep(file_name);
  }
  return {};
}

}  // namespace sunder::assimp_import
