// The fast parser of glTF's JSON against nlohmann's: the same values and types, or nothing.

#include "io/gltf/parse_json.h"

#include <random>
#include <string>

#include <gtest/gtest.h>

namespace sunder::gltf {
namespace {

constexpr JsonLimits kLimits{.levels = 32, .members = 40};

class RandomJson {
 public:
  explicit RandomJson(unsigned seed) : random_(seed) {}

  std::string value(int depth) {
    switch (below(depth > 0 ? 9 : 7)) {
      case 0: return "null";
      case 1: return below(2) ? "true" : "false";
      case 2: return std::to_string(below(2000) - 1000);
      case 3: return integer();
      case 4: return number();
      case 5:
      case 6: return text();
      case 7: return array(depth);
      default: return object(depth);
    }
  }

  int below(int limit) { return std::uniform_int_distribution<int>(0, limit - 1)(random_); }

 private:
  std::string integer() {
    std::string digits = below(2) ? "-" : "";
    digits += static_cast<char>('1' + below(9));
    for (int i = below(21); i > 0; --i) digits += static_cast<char>('0' + below(10));
    return digits;
  }

  std::string number() {
    static const char* const kSome[] = {"0",
                                        "-0",
                                        "-0.0",
                                        "0.1",
                                        "1e5",
                                        "1E-3",
                                        "2.5e+10",
                                        "4.9e-324",
                                        "1.7976931348623157e308",
                                        "123456.789",
                                        "9007199254740993.0",
                                        "18446744073709551615"};
    return kSome[below(12)];
  }

  std::string text() {
    static const char* const kSome[] = {"\"\"",
                                        "\"a\"",
                                        "\"POSITION\"",
                                        "\"\\u00e9\\n\"",
                                        "\"é\"",
                                        "\"\\\"quoted\\\"\"",
                                        "\"\\ud83d\\ude00\"",
                                        "\"a longer string with spaces\""};
    return kSome[below(8)];
  }

  std::string space() { return below(4) ? "" : " \n"; }

  std::string array(int depth) {
    std::string list = "[";
    for (int i = 0, count = below(5); i < count; ++i)
      list += (i ? "," : "") + space() + value(depth - 1);
    return list + space() + "]";
  }

  std::string object(int depth) {
    std::string list = "{";
    for (int i = 0, count = below(5); i < count; ++i)
      list += (i ? ",\"" : "\"") + std::string(1, static_cast<char>('a' + below(26))) +
              "\":" + space() + value(depth - 1);
    return list + space() + "}";
  }

  std::mt19937 random_;
};

/// Equal, also in the types of numbers and in the order of members. nlohmann's parser calls -0 a
/// signed number; the sign of an integer is not looked at.
void expect_identical(const Json& one, const Json& other) {
  EXPECT_EQ(one.dump(), other.dump());
  ASSERT_TRUE(one.type() == other.type() || (one.is_number_integer() && other.is_number_integer()));
  if (!one.is_structured()) return;
  ASSERT_EQ(one.size(), other.size());
  for (auto a = one.begin(), b = other.begin(); a != one.end(); ++a, ++b) expect_identical(*a, *b);
}

TEST(ParseJson, equals_nlohmanns_parser_or_leaves_the_text_to_it) {
  RandomJson random(1);
  int parsed = 0;
  for (int i = 0; i < 20'000; ++i) {
    const std::string text = random.value(5);
    const Json expected = Json::parse(text, nullptr, false);
    const auto found = parse_json_fast(text, kLimits);
    if (!found) continue;
    ++parsed;
    ASSERT_FALSE(expected.is_discarded()) << text;
    expect_identical(*found, expected);
    ASSERT_FALSE(HasFailure()) << text;
  }
  EXPECT_GT(parsed, 15'000);
}

TEST(ParseJson, accepts_no_text_that_nlohmanns_parser_refuses) {
  RandomJson random(2);
  int refused = 0;
  for (int i = 0; i < 20'000; ++i) {
    std::string text = "{\"a\":" + random.value(4) + "}";
    for (int changes = 1 + random.below(3); changes > 0; --changes) {
      const auto at = static_cast<std::size_t>(random.below(static_cast<int>(text.size())));
      if (random.below(3) == 0)
        text.resize(at + 1);
      else
        text[at] = static_cast<char>(random.below(256));
    }
    const auto found = parse_json_fast(text, kLimits);
    const Json expected = Json::parse(text, nullptr, false);
    if (expected.is_discarded()) {
      EXPECT_FALSE(found) << text;
      ++refused;
    } else if (found) {
      expect_identical(*found, expected);
    }
  }
  EXPECT_GT(refused, 5'000);
}

TEST(ParseJson, leaves_objects_that_name_a_member_twice) {
  EXPECT_FALSE(parse_json_fast(R"({"a": 1, "b": 2, "a": 3})", kLimits));
  EXPECT_FALSE(parse_json_fast(R"([{"a": [{"b": 1, "b": 1}]}])", kLimits));
}

TEST(ParseJson, leaves_objects_and_nesting_beyond_the_limits) {
  const auto nested = [](std::size_t levels) {
    return std::string(levels, '[') + "1" + std::string(levels, ']');
  };
  EXPECT_TRUE(parse_json_fast(nested(kLimits.levels), kLimits));
  EXPECT_FALSE(parse_json_fast(nested(kLimits.levels + 1), kLimits));
  EXPECT_FALSE(parse_json_fast(nested(1'000'000), kLimits));

  const auto members = [](std::size_t count) {
    std::string text = "{";
    for (std::size_t i = 0; i < count; ++i)
      text += (i ? ",\"m" : "\"m") + std::to_string(i) + "\":0";
    return text + "}";
  };
  EXPECT_TRUE(parse_json_fast(members(kLimits.members), kLimits));
  EXPECT_FALSE(parse_json_fast(members(kLimits.members + 1), kLimits));
}

}  // namespace
}  // namespace sunder::gltf
