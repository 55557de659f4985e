#include "io/import_checks/check_ply.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "io/import_checks/text_lines.h"

namespace sunder::assimp_import {
namespace {

/// assimp's time is proportional to the square of the header.
constexpr std::size_t kMostHeaderBytes = std::size_t{1} << 18;

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::uint64_t least_bytes = 0;  ///< Of one instance.
};

struct Header {
  bool is_ascii = true;
  bool is_complete = false;
  std::vector<Element> elements;
  std::size_t bytes = 0;
};

std::uint64_t size_of_type(std::string_view type) {
  struct Size {
    std::string_view type;
    std::uint64_t bytes;
  };
  static constexpr std::array kSizes = {
      Size{"char", 1},  Size{"uchar", 1},   Size{"int8", 1},   Size{"uint8", 1},
      Size{"short", 2}, Size{"ushort", 2},  Size{"int16", 2},  Size{"uint16", 2},
      Size{"int", 4},   Size{"uint", 4},    Size{"int32", 4},  Size{"uint32", 4},
      Size{"float", 4}, Size{"float32", 4}, Size{"double", 8}, Size{"float64", 8},
  };
  for (const Size& size : kSizes)
    if (size.type == type) return size.bytes;
  return 1;
}

/// Adds the least that the property needs: a digit and a separator in text, the count of a list.
void add_property(std::string_view rest, bool is_ascii, Element& element) {
  std::string_view type = next_word(rest);
  if (type == "list") type = next_word(rest);
  element.least_bytes += is_ascii ? 2 : size_of_type(type);
}

/// @return false if an element has no count.
bool read_element(std::string_view rest, Header& header) {
  Element element;
  element.name = next_word(rest);
  const auto count = parse_count(next_word(rest));
  if (!count) return false;
  element.count = *count;
  header.elements.push_back(std::move(element));
  return true;
}

Status read_header(std::string_view content, const std::string& file_name, Header& header) {
  TextLines lines(content.substr(0, kMostHeaderBytes));
  while (!header.is_complete && lines.next()) {
    std::string_view rest = lines.line();
    const std::string_view word = next_word(rest);
    if (word == "format") header.is_ascii = next_word(rest) == "ascii";
    if (word == "element" && !read_element(rest, header))
      return Status::failure(StatusCode::malformed_file, kNone,
                             "%.100s: header: an element has no count", file_name.c_str());
    if (word == "property" && !header.elements.empty())
      add_property(rest, header.is_ascii, header.elements.back());
    header.is_complete = word == "end_header";
  }
  header.bytes = lines.offset();
  return {};
}

}  // namespace

Status check_ply(std::string_view content, const std::string& file_name) {
  Header header;
  if (const Status status = read_header(content, file_name, header); !status) return status;
  if (!header.is_complete && content.size() > kMostHeaderBytes)
    return Status::failure(StatusCode::limit_exceeded, kNone,
                           "%.100s: the header does not end within %zu bytes", file_name.c_str(),
                           kMostHeaderBytes);
  if (!header.is_complete)
    return Status::failure(StatusCode::malformed_file, kNone,
                           "%.100s: the header has no 'end_header'; the file is cut off",
                           file_name.c_str());
  std::uint64_t rest = content.size() - header.bytes + (header.is_ascii ? 1 : 0);
  for (const Element& element : header.elements) {
    const std::uint64_t each = std::max<std::uint64_t>(element.least_bytes, 1);
    if (element.count > rest / each)
      return Status::failure(StatusCode::malformed_file, kNone,
                             "%.80s: the header announces %llu × '%.40s', more than the file's "
                             "%zu bytes can hold",
                             file_name.c_str(), static_cast<unsigned long long>(element.count),
                             element.name.c_str(), content.size());
    rest -= element.count * each;
  }
  return {};
}

}  // namespace sunder::assimp_import
