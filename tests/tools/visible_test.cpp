// How texts of files are shown.

#include "tools/messages/visible.h"

#include <algorithm>
#include <cstdint>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tools/messages/json.h"
#include "tools/messages/lines.h"

namespace sunder::tools {
namespace {

TEST(Visible, texts_stay_and_controls_are_shown) {
  for (const char* const text :
       {"", "Bone.001", "a b", "Größe \u6f22\u5b57 \U0001f468\u200d\U0001f469", "a:b::c", "#1",
        "C:\\models\\x.fbx"})
    EXPECT_EQ(visible(text), text);
  EXPECT_EQ(visible("a\nb\rc\td"), "a\\nb\\rc\\td");
  EXPECT_EQ(visible(std::string("a\0b", 3)), "a\\x00b");
  EXPECT_EQ(visible("\x1b[31m\x7f"), "\\x1b[31m\\x7f");
  EXPECT_EQ(visible("\u009b31m\u202ex\u2066\u200f"), "\\u009b31m\\u202ex\\u2066\\u200f");
  EXPECT_EQ(visible("\u2028\u2029\ufeff\U000e0041"), "\\u2028\\u2029\\ufeff\\U000e0041");
  EXPECT_EQ(visible("##[error]###"), "#\\x23[error]#\\x23#");
}

TEST(Visible, bytes_that_are_not_utf8_are_shown) {
  EXPECT_EQ(visible("\xff\xfe"), "\\xff\\xfe");
  EXPECT_EQ(visible("a\x80z"), "a\\x80z");
  EXPECT_EQ(visible("\xc0\x8a"), "\\xc0\\x8a");  // an overlong line break
  EXPECT_EQ(visible("\xe0\x80\x8a"), "\\xe0\\x80\\x8a");
  EXPECT_EQ(visible("\xed\xa0\x80"), "\\xed\\xa0\\x80");  // a surrogate
  EXPECT_EQ(visible("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");
  EXPECT_EQ(visible("\xe6\xbc"), "\\xe6\\xbc");  // cut off
  EXPECT_EQ(visible("\xe6\n"), "\\xe6\\n");
}

/// No text, however it is composed, breaks a line or leaves a control character.
TEST(Visible, any_bytes_become_one_line_of_utf8) {
  std::uint64_t state = 42;
  const auto next = [&] {
    return static_cast<unsigned>((state = state * 6364136223846793005u + 1) >> 33);
  };
  const char* const pieces[] = {"\n",   "::",       "#",    "\x1b", "\xc2",
                                "\x9b", "\xe2\x80", "\xae", "a",    " "};
  for (int i = 0; i < 20'000; ++i) {
    std::string text;
    for (unsigned k = next() % 12; k-- > 0;)
      text += next() % 2 == 0 ? std::string(pieces[next() % 10])
                              : std::string(1, static_cast<char>(next() % 256));
    const std::string shown = visible_line(text);
    for (const char c : shown) ASSERT_GE(static_cast<unsigned char>(c), 0x20);
    ASSERT_NO_THROW((void)nlohmann::json(shown).dump()) << "not UTF-8";
    ASSERT_EQ(visible(shown), shown) << "not the same when it is shown again";
    ASSERT_NE(shown.substr(std::min(shown.find_first_not_of(' '), shown.size()), 2), "::");
    ASSERT_EQ(shown.find("##"), std::string::npos);
    ASSERT_EQ(shown.find("\u202e"), std::string::npos);
    ASSERT_EQ(shown.find("\u009b"), std::string::npos);
  }
}

TEST(Visible, json_keeps_its_value) {
  const std::string name = "a\n\x1b\u009b\u202e##[x]\U000e0041\x7f\u6f22";
  const Json json = {{"name", name}, {"##", 1}};
  for (const std::string& text : {dump(json), dump_line(json)}) {
    EXPECT_EQ(Json::parse(text), json);
    for (const char* const sign : {"\x1b", "\u009b", "\u202e", "##", "\U000e0041", "\x7f"})
      EXPECT_EQ(text.find(sign), std::string::npos) << text;
    EXPECT_NE(text.find("\u6f22"), std::string::npos);
  }
}

TEST(Lines, a_name_neither_ends_a_line_nor_begins_a_command) {
  Lines lines;
  lines.add("::error::x");
  lines.add("  ::error::x");
  lines.add("a\n::error::x");
  lines.add(Colour::red, "error", " b\x1b[0m\n");
  EXPECT_EQ(
      lines.text(),
      "\\x3a:error::x\n  \\x3a:error::x\na\\n::error::x\n\x1b[31merror\x1b[0m b\\x1b[0m\\n\n");
}

/// GitHub's runner removes white space of Unicode from the beginning of a line.
TEST(Lines, no_white_space_hides_the_beginning_of_a_command) {
  for (const char* const space : {" ", "\u00a0", "\u1680", "\u2000", "\u2003", "\u200a", "\u202f",
                                  "\u205f", "\u3000", "\u3000 \u00a0"})
    EXPECT_EQ(visible_line(std::string(space) + "::error::x"),
              std::string(space) + "\\x3a:error::x");
  // The other white space is shown as escapes, so that the line begins with these.
  for (const char* const space : {"\t", "\v", "\f", "\u0085", "\u2028", "\u200b", "\ufeff"})
    EXPECT_TRUE(visible_line(std::string(space) + "::error::x").starts_with('\\'));
}

}  // namespace
}  // namespace sunder::tools
