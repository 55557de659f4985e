// The parser of strangers' JSON, against nlohmann's own with a callback, which takes quadratic
// time.
#include "io/internal/strict_json.h"

#include <array>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/machine/random.h"

namespace sunder {
namespace {

using Json = StrictJson;
using testing::HasSubstr;

struct Refused {};

/// @throws Refused
Json parse_by_callback(const std::string& text) {
  std::vector<std::set<std::string>> fields;
  try {
    return Json::parse(text, [&](int depth, Json::parse_event_t event, const Json& value) {
      if (depth > 32) throw Refused();
      if (event == Json::parse_event_t::object_start) fields.emplace_back();
      if (event == Json::parse_event_t::object_end) fields.pop_back();
      if (event == Json::parse_event_t::key &&
          !fields.back().insert(value.get<std::string>()).second)
        throw Refused();
      return true;
    });
  } catch (const Json::exception&) {
    throw Refused();
  }
}

/// Whether both accept the text, with the same tree, or both refuse it.
testing::AssertionResult agree(const std::string& text) {
  const Result<Json> read = parse_strict_json(text);
  try {
    const Json expected = parse_by_callback(text);
    if (!read) return testing::AssertionFailure() << "refused: " << read.error().text();
    if (*read != expected || read->dump() != expected.dump())
      return testing::AssertionFailure() << read->dump() << " is not " << expected.dump();
  } catch (const Refused&) {
    if (read) return testing::AssertionFailure() << "accepted";
  }
  return testing::AssertionSuccess();
}

std::string nested(std::size_t depth, const std::string& inside) {
  return std::string(depth, '[') + inside + std::string(depth, ']');
}

std::string text_of(const std::string& text) {
  const Result<Json> read = parse_strict_json(text);
  EXPECT_FALSE(read);
  return read ? std::string() : std::string(read.error().text());
}

TEST(StrictJson, agrees_with_the_parser_on_chosen_texts) {
  for (const char* const text : {"",
                                 " ",
                                 "null",
                                 "true",
                                 "-0",
                                 "1e308",
                                 "1e309",
                                 "18446744073709551615",
                                 "18446744073709551616",
                                 "-9223372036854775808",
                                 "-9223372036854775809",
                                 "0.1",
                                 "01",
                                 "NaN",
                                 "Infinity",
                                 "[1,]",
                                 "[,1]",
                                 "{\"a\":1,}",
                                 "{\"a\" 1}",
                                 "{a:1}",
                                 "[1] 2",
                                 "// a\n1",
                                 "/* a */ [1]",
                                 "\"\\ud800\"",
                                 "\"\\u0000\"",
                                 "\"\xff\"",
                                 "\xEF\xBB\xBF[1]",
                                 "\xEF\xBB[1]",
                                 "{\"a\":{\"a\":1},\"b\":[{\"a\":2},{\"a\":3}]}",
                                 "{\"a\":1,\"a\":2}",
                                 "{\"a\":{\"b\":1,\"b\":2}}",
                                 "{\"\":1,\"\":2}",
                                 "[[],{},[{}],\"\"]"})
    EXPECT_TRUE(agree(text)) << text;
  for (std::size_t depth = 30; depth < 37; ++depth)
    for (const char* const inside : {"", "1", "{}", "{\"a\":1}", "[]"})
      EXPECT_TRUE(agree(nested(depth, inside))) << depth << " " << inside;
}

TEST(StrictJson, agrees_with_the_parser_on_random_texts) {
  constexpr std::array<const char*, 24> kParts = {
      "{",    "}",  "[",  "]",       "{\"a\":", "\"a\"", "\"b\"", ":",
      ",",    ",",  "1",  "-2.5",    "0",       "e5",    "\"",    "null",
      "true", "{}", "[]", "\"c\":1", "\"d\":",  "[1,2]", " ",     "\n"};
  std::size_t accepted = 0;
  for (std::uint64_t seed = 0; seed < 20000; ++seed) {
    test::Random random(seed);
    std::string text;
    for (std::uint32_t left = 1 + random.index(12); left > 0; --left)
      text += kParts[random.index(static_cast<std::uint32_t>(kParts.size()))];
    ASSERT_TRUE(agree(text)) << text;
    accepted += parse_strict_json(text) ? 1 : 0;
  }
  EXPECT_GT(accepted, 200u);
}

TEST(StrictJson, a_field_is_found_again_among_few_and_among_many) {
  for (const int count : {2, 11, 12, 13, 14, 40, 1000})
    for (const int again : {0, count / 2, count - 1}) {
      std::string text = "{";
      for (int i = 0; i < count; ++i) text += "\"field " + std::to_string(i) + "\": [1],";
      EXPECT_TRUE(parse_strict_json(text + "\"last\": 1}"));
      EXPECT_EQ(text_of(text + "\"field " + std::to_string(again) + "\": oops"),
                "field 'field " + std::to_string(again) + "' occurs twice in one object");
    }
}

TEST(StrictJson, errors_name_line_and_byte) {
  EXPECT_THAT(text_of("{\n\"a\": 1,\n oops}"), HasSubstr("invalid JSON: line 3, byte 11: "));
  EXPECT_THAT(text_of("[1,\n1e999]"), HasSubstr("invalid JSON: line 2, byte "));
  EXPECT_EQ(text_of(nested(40, "")), "values are nested deeper than 32");
  EXPECT_THAT(text_of(std::string(kMaximumJsonBytes + 1, ' ')), HasSubstr("the limit is 67108864"));
}

}  // namespace
}  // namespace sunder
