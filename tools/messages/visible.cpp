#include "tools/messages/visible.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <span>

namespace sunder::tools {
namespace {

/// A character of UTF-8. Bytes that are none have no code.
struct CodePoint {
  std::size_t bytes = 1;
  char32_t code = 0;
  bool is_valid = false;
};

CodePoint character_at(std::string_view text, std::size_t place) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[place + i]); };
  const unsigned first = byte(0);
  if (first < 0x80) return {1, first, true};
  const std::size_t bytes = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4 || text.size() - place < bytes) return {};
  char32_t code = first & (0xffu >> (bytes + 1));
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return {};
    code = code << 6 | (byte(i) & 0x3f);
  }
  constexpr std::array<char32_t, 5> kLeast = {0, 0, 0x80, 0x800, 0x10000};
  const bool is_surrogate = code >= 0xd800 && code <= 0xdfff;
  if (code < kLeast[bytes] || code > 0x10ffff || is_surrogate) return {};
  return {bytes, code, true};
}

struct Range {
  char32_t first, last;
};

/// What acts on a terminal or changes what is read, and is not seen itself. Joiners (U+200C,
/// U+200D) are left out: scripts and emoji need them.
constexpr Range kUnseen[] = {
    {0x00, 0x1f},       // C0
    {0x7f, 0x9f},       // delete, C1
    {0xad, 0xad},       // soft hyphen
    {0x61c, 0x61c},     // Arabic letter mark
    {0x180e, 0x180e},   // Mongolian vowel separator
    {0x200b, 0x200b},   // space without width
    {0x200e, 0x200f},   // left-to-right and right-to-left marks
    {0x2028, 0x202e},   // separators of lines and paragraphs, embeddings and overrides
    {0x2060, 0x206f},   // word joiner, isolates, deprecated controls
    {0xfeff, 0xfeff},   // byte order mark
    {0xfff9, 0xfffb},   // interlinear annotations
    {0xe0000, 0xe007f}  // tags
};

/// White space of Unicode that is not in kUnseen. GitHub's runner skips it before a command.
constexpr Range kSpaces[] = {{' ', ' '},       {0xa0, 0xa0},     {0x1680, 0x1680}, {0x2000, 0x200a},
                             {0x202f, 0x202f}, {0x205f, 0x205f}, {0x3000, 0x3000}};

bool is_in(std::span<const Range> ranges, char32_t code) {
  return std::ranges::any_of(
      ranges, [&](const Range& range) { return code >= range.first && code <= range.last; });
}

bool is_unseen(char32_t code) { return is_in(kUnseen, code); }

/// Where the white space ends with which a line begins.
std::size_t end_of_indent(std::string_view line) {
  std::size_t end = 0;
  while (end < line.size()) {
    const CodePoint character = character_at(line, end);
    if (!character.is_valid || !is_in(kSpaces, character.code)) break;
    end += character.bytes;
  }
  return end;
}

std::string numbered(const char* format, unsigned number) {
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), format, number);
  return text.data();
}

std::string escape(char32_t code) {
  switch (code) {
    case '\n': return "\\n";
    case '\r': return "\\r";
    case '\t': return "\\t";
    default: break;
  }
  if (code < 0x80) return numbered("\\x%02x", code);
  return numbered(code < 0x10000 ? "\\u%04x" : "\\U%08x", code);
}

std::string json_escape(char32_t code) {
  if (code < 0x10000) return numbered("\\u%04x", code);
  const char32_t rest = code - 0x10000;
  return numbered("\\u%04x", 0xd800 + (rest >> 10)) + numbered("\\u%04x", 0xdc00 + (rest & 0x3ff));
}

}  // namespace

std::string visible(std::string_view text) {
  std::string shown;
  shown.reserve(text.size());
  for (std::size_t i = 0; i < text.size();) {
    const CodePoint character = character_at(text, i);
    if (!character.is_valid)
      shown += numbered("\\x%02x", static_cast<unsigned char>(text[i]));
    else if (is_unseen(character.code))
      shown += escape(character.code);
    else if (character.code == '#' && shown.ends_with('#'))
      shown += "\\x23";
    else
      shown += text.substr(i, character.bytes);
    i += character.bytes;
  }
  return shown;
}

std::string visible_line(std::string_view line) {
  std::string shown = visible(line);
  const std::size_t begin = end_of_indent(shown);
  if (shown.compare(begin, 2, "::") == 0) shown.replace(begin, 1, "\\x3a");
  return shown;
}

std::string visible_json(std::string json) {
  std::string shown;
  bool is_same = true;
  for (std::size_t i = 0; i < json.size();) {
    const CodePoint character = character_at(json, i);
    const std::string_view as_it_is = std::string_view(json).substr(i, character.bytes);
    i += character.bytes;
    // Outside of strings there are no characters beyond ASCII, and no controls but line breaks.
    const bool is_escaped =
        character.is_valid && character.code >= 0x7f && is_unseen(character.code);
    const bool is_sign = character.code == '#' && i >= 2 && json[i - 2] == '#';
    if (is_same && !is_escaped && !is_sign) continue;
    if (is_same) shown.assign(json, 0, i - character.bytes);
    is_same = false;
    if (is_escaped || is_sign)
      shown += json_escape(character.code);
    else
      shown += as_it_is;
  }
  return is_same ? std::move(json) : shown;
}

}  // namespace sunder::tools
