#include "io/import_checks/check_text.h"

#include <array>

#include "io/import_checks/check_nesting.h"
#include "io/import_checks/check_ply.h"
#include "io/import_checks/check_x.h"
#include "io/import_checks/text_lines.h"

namespace sunder::assimp_import {
namespace {

/// assimp compares each object's name with those of all earlier ones.
constexpr std::uint64_t kMostObjObjects = 20'000;
/// assimp searches all nodes for the children of each.
constexpr std::uint64_t kMostSmdNodes = 4'096;

Status check_obj(std::string_view content, const std::string& file_name) {
  std::uint64_t objects = 0;
  for (TextLines lines(content); lines.next();)
    if (lines.line().starts_with("o ")) ++objects;
  if (objects > kMostObjObjects)
    return Status::failure(StatusCode::limit_exceeded, kNone,
                           "%.100s: %llu objects ('o'); the limit is %llu", file_name.c_str(),
                           static_cast<unsigned long long>(objects),
                           static_cast<unsigned long long>(kMostObjObjects));
  return {};
}

/// A vertex and a face take at least two bytes each.
Status check_off(std::string_view content, const std::string& file_name) {
  std::array<std::uint64_t, 2> counts{};
  std::size_t found = 0;
  for (TextLines lines(content); found < 2 && lines.next();) {
    std::string_view rest = lines.line().substr(0, lines.line().find('#'));
    for (std::string_view word = next_word(rest); !word.empty() && found < 2;
         word = next_word(rest)) {
      const auto number = parse_count(word);
      if (number) counts[found++] = *number;
      // The keyword comes first, and the number of dimensions follows an 'n' in it.
      if (!number && found > 0) return {};
      if (!number && word.find('n') != std::string_view::npos) next_word(rest);
    }
  }
  const std::uint64_t most = content.size() / 2 + 1;
  if (counts[0] <= most && counts[1] <= most && counts[0] + counts[1] <= most) return {};
  return Status::failure(StatusCode::malformed_file, kNone,
                         "%.100s: the header announces %llu vertices and %llu faces, more than "
                         "%zu bytes can hold",
                         file_name.c_str(), static_cast<unsigned long long>(counts[0]),
                         static_cast<unsigned long long>(counts[1]), content.size());
}

Status check_smd(std::string_view content, const std::string& file_name) {
  std::string section;
  std::uint64_t nodes = 0;
  for (TextLines lines(content); lines.next();) {
    std::string_view rest = lines.line();
    const std::string_view word = next_word(rest);
    if (word == "end")
      section.clear();
    else if (section.empty() && (word == "nodes" || word == "skeleton" || word == "triangles" ||
                                 word == "vertexanimation"))
      section = word;
    else if (section == "nodes" && ++nodes > kMostSmdNodes)
      return Status::failure(StatusCode::limit_exceeded, kNone, "%.100s: more than %llu nodes",
                             file_name.c_str(), static_cast<unsigned long long>(kMostSmdNodes));
  }
  if (section.empty()) return {};
  return Status::failure(StatusCode::malformed_file, kNone,
                         "%.100s: the section '%s' has no 'end'; the file is cut off",
                         file_name.c_str(), section.c_str());
}

struct TextCheck {
  std::string_view extension;
  /// A text that only binary variants have in the first bytes; empty: all files are text.
  std::string_view binary;
  Status (*check)(std::string_view content, const std::string& file_name);
};

constexpr std::array kChecks = {
    TextCheck{"dae", "", check_xml_depth}, TextCheck{"fbx", "Kaydara FBX Binary", check_fbx_depth},
    TextCheck{"obj", "", check_obj},       TextCheck{"off", "", check_off},
    TextCheck{"ply", "", check_ply},       TextCheck{"smd", "", check_smd},
    TextCheck{"x", "", check_x},
};

const TextCheck* check_of(const Format& format) {
  for (const TextCheck& check : kChecks)
    if (check.extension == format.extension) return &check;
  return nullptr;
}

}  // namespace

bool has_text_check(const Format& format, std::string_view first_kilobyte) {
  const TextCheck* const check = check_of(format);
  if (check == nullptr) return false;
  // The header of an X file names its variant: "xof 0303txt 0032".
  if (format.extension == "x")
    return first_kilobyte.substr(0, 16).find("txt") != std::string_view::npos;
  return check->binary.empty() || !first_kilobyte.starts_with(check->binary);
}

Status check_text(const Format& format, std::string_view content, const std::string& file_name) {
  return check_of(format)->check(content, file_name);
}

}  // namespace sunder::assimp_import
