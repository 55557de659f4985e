#include "io/urdf/check_text.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <string_view>

namespace sunder::urdf {
namespace {

/// Length of the UTF-8 character at the start of the text; 0 if it is none.
std::size_t length_of_character(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((byte(i) & 0xC0) != 0x80) return 0;
  const bool is_overlong = (first == 0xE0 && byte(1) < 0xA0) || (first == 0xF0 && byte(1) < 0x90);
  const bool is_surrogate = first == 0xED && byte(1) >= 0xA0;
  const bool is_beyond = first == 0xF4 && byte(1) >= 0x90;
  return is_overlong || is_surrogate || is_beyond ? 0 : length;
}

/// Replaces bytes that are not UTF-8. @return their number.
std::size_t repair_encoding(std::string& text) {
  std::size_t repaired = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = length_of_character(std::string_view(text).substr(at));
    if (length == 0) {
      text[at] = '?';
      ++repaired;
    }
    at += std::max<std::size_t>(length, 1);
  }
  return repaired;
}

/// Walks over the markup of a text.
class TagScan {
 public:
  TagScan(std::string_view text, Findings& findings) : text_(text), findings_(findings) {}

  /// Stops at the first fault.
  void run() {
    while (step()) {
    }
  }

 private:
  bool step() {
    const std::size_t open = text_.find('<', at_);
    if (open == std::string_view::npos) return false;
    at_ = open;
    if (starts("<!--")) return skip_past("-->", "a comment");
    if (starts("<![CDATA[")) return skip_past("]]>", "a CDATA section");
    if (starts("<?")) return skip_past("?>", "a processing instruction");
    if (starts("<!")) return check_declaration();
    return check_tag();
  }

  [[nodiscard]] bool starts(std::string_view with) const {
    return text_.substr(at_, with.size()) == with;
  }

  bool fail(std::string_view code, std::string text) {
    const auto line =
        std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(at_), '\n');
    findings_.add(code, {"", static_cast<std::uint32_t>(line + 1)}, std::move(text));
    return false;
  }

  bool skip_past(std::string_view end, const char* kind) {
    const std::size_t found = text_.find(end, at_);
    if (found == std::string_view::npos)
      return fail("xml_malformed", std::string(kind) + " has no end");
    at_ = found + end.size();
    return true;
  }

  /// A document type without declarations of its own is harmless.
  bool check_declaration() {
    const std::size_t end = text_.find_first_of("[>", at_);
    if (end == std::string_view::npos) return fail("xml_malformed", "a declaration has no end");
    if (text_[end] == '[' || starts("<!ENTITY"))
      return fail("xml_entity",
                  "entities are declared, which URDF does not need; they can make a "
                  "small file huge, so the file is refused");
    at_ = end + 1;
    return true;
  }

  bool check_tag() {
    const bool is_end = starts("</");
    std::size_t end = at_ + 1;
    char quote = 0;
    std::size_t attributes = 0;
    for (; end < text_.size() && (quote != 0 || text_[end] != '>'); ++end) {
      const char c = text_[end];
      if (quote != 0) {
        if (c == quote) quote = 0;
      } else if (c == '"' || c == '\'') {
        quote = c;
        ++attributes;
      }
    }
    if (end >= text_.size()) return fail("xml_malformed", "a tag has no end");
    const bool is_empty = text_[end - 1] == '/';
    count_ += 1 + attributes;
    if (count_ > kMaximumTags)
      return fail("xml_too_large", "the file has more than " + std::to_string(kMaximumTags) +
                                       " tags and attributes");
    if (is_end)
      depth_ -= depth_ > 0 ? 1 : 0;
    else if (!is_empty && ++depth_ > kMaximumDepth)
      return fail("xml_too_deep",
                  "tags are nested deeper than " + std::to_string(kMaximumDepth) + " levels");
    at_ = end + 1;
    return true;
  }

  std::string_view text_;
  Findings& findings_;
  std::size_t at_ = 0, depth_ = 0, count_ = 0;
};

}  // namespace

void check_text(std::string& text, Findings& findings) {
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")) {
    findings.add("xml_malformed", {}, "the text is UTF-16; UTF-8 is expected");
    return;
  }
  if (text.find('\0') != std::string::npos) {
    findings.add("xml_malformed", {}, "the text has a zero byte; it is not XML");
    return;
  }
  if (text.find_first_not_of(" \t\r\n") == std::string::npos) {
    findings.add("xml_malformed", {}, "the file is empty");
    return;
  }
  if (const std::size_t repaired = repair_encoding(text); repaired > 0)
    findings.add("xml_encoding", {},
                 std::to_string(repaired) + " bytes are not UTF-8 and were replaced by '?'");
  TagScan(text, findings).run();
}

}  // namespace sunder::urdf
