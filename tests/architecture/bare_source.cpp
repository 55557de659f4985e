#include "architecture/bare_source.h"

#include <algorithm>
#include <cctype>

namespace sunder::test {
namespace {

bool is_blank(const std::string& text) { return text.find_first_not_of(' ') == std::string::npos; }

}  // namespace

std::string without_comments_and_literals(const std::string& source) {
  std::string bare;
  for (std::size_t i = 0; i < source.size(); ++i) {
    if (source.compare(i, 2, "//") == 0) {
      while (i < source.size() && source[i] != '\n') ++i;
      if (i < source.size()) bare += '\n';
    } else if (source.compare(i, 3, "R\"(") == 0) {
      const std::size_t end = std::min(source.find(")\"", i), source.size());
      bare.append(static_cast<std::size_t>(
                      std::count(source.begin() + static_cast<std::ptrdiff_t>(i),
                                 source.begin() + static_cast<std::ptrdiff_t>(end), '\n')),
                  '\n');
      i = end + 1;
    } else if (source[i] == '"') {
      for (++i; i < source.size() && source[i] != '"' && source[i] != '\n'; ++i)
        if (source[i] == '\\') ++i;
      bare += "\"\"";
    } else if (source[i] == '\'' &&
               (bare.empty() || std::isalnum(static_cast<unsigned char>(bare.back())) == 0)) {
      for (++i; i < source.size() && source[i] != '\'' && source[i] != '\n'; ++i)
        if (source[i] == '\\') ++i;
      bare += "''";
    } else if (source[i] == '#' && is_blank(bare.substr(bare.rfind('\n') + 1))) {
      for (; i < source.size() && (source[i] != '\n' || source[i - 1] == '\\'); ++i)
        if (source[i] == '\n') bare += '\n';
      if (i < source.size()) bare += '\n';
    } else {
      bare += source[i];
    }
  }
  return bare;
}

}  // namespace sunder::test
