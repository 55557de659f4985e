// The fast parser of glTF's JSON against nlohmann's: whatever it accepts, it reads the same.

#include <array>
#include <cstring>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "io/gltf_decoders/parse_json.h"
#include "support/machine/random.h"
#include "support/machine/temporary_folder.h"
#include "support/models/shared_models.h"

namespace sunder::test {
namespace {

using gltf::Json;

constexpr gltf::JsonLimits kLimits = {256, 10'000};

/// Equal values of equal types; objects with the same order of members.
void expect_same(const std::string& text) {
  const auto fast = gltf::parse_json_fast(text, kLimits);
  if (!fast) return;
  const Json slow = Json::parse(text, nullptr, false);
  ASSERT_FALSE(slow.is_discarded()) << text.substr(0, 200);
  EXPECT_EQ(fast->dump(), slow.dump()) << text.substr(0, 200);
  EXPECT_EQ(Json::to_msgpack(*fast), Json::to_msgpack(slow)) << "types differ";
}

void expect_parsed_fast(const std::string& text) {
  EXPECT_TRUE(gltf::parse_json_fast(text, kLimits).has_value()) << text;
  expect_same(text);
}

class Documents {
 public:
  explicit Documents(std::uint64_t seed) : random_(seed) {}

  std::string value(int levels) {
    switch (random_.index(levels > 0 ? 9 : 7)) {
      case 0: return std::to_string(random_.index(1000));
      case 1: return "-" + std::to_string(random_.index(1000));
      case 2: return number();
      case 3: return string();
      case 4: return "true";
      case 5: return "false";
      case 6: return "null";
      case 7: return list('[', ']', levels, [&] { return value(levels - 1); });
      default:
        return list('{', '}', levels,
                    [&] { return string() + space() + ":" + space() + value(levels - 1); });
    }
  }

  /// With a few characters replaced, inserted or removed.
  std::string mutated(std::string text) {
    constexpr std::string_view kCharacters =
        "{}[]\",:\\/u0123456789eE+-. \ntrfalsn\x01\x80\xC3\xBC";
    for (std::uint32_t i = 0; i <= random_.index(3) && !text.empty(); ++i) {
      const std::uint32_t at = random_.index(static_cast<std::uint32_t>(text.size()));
      const char c = kCharacters[random_.index(kCharacters.size())];
      if (const std::uint32_t kind = random_.index(3); kind == 0)
        text[at] = c;
      else if (kind == 1)
        text.insert(at, 1, c);
      else
        text.erase(at, 1 + random_.index(4));
    }
    return text;
  }

 private:
  template <class Entry>
  std::string list(char open, char close, int, const Entry& entry) {
    std::string text(1, open);
    const std::uint32_t count = random_.index(20);
    for (std::uint32_t i = 0; i < count; ++i)
      text += (i == 0 ? "" : ",") + space() + entry() + space();
    return text + space() + close;
  }

  std::string number() {
    constexpr std::array<const char*, 14> kNumbers = {"0",
                                                      "-0",
                                                      "1.5",
                                                      "-0.0",
                                                      "1e5",
                                                      "1E-7",
                                                      "18446744073709551615",
                                                      "1e308",
                                                      "5e-324",
                                                      "1e-400",
                                                      "0.1",
                                                      "-9223372036854775808",
                                                      "3.4028234663852886e38",
                                                      "123456789012345678"};
    return kNumbers[random_.index(kNumbers.size())];
  }

  std::string string() {
    constexpr std::array<const char*, 8> kParts = {
        "name", "\\n", "\\u00e4", "\xC3\xA4", " _0 \\\"", "\\ud83d\\ude00", "/", "POSITION"};
    std::string text = "\"";
    for (std::uint32_t i = random_.index(6); i > 0; --i)
      text += kParts[random_.index(kParts.size())];
    return text + "\"";
  }

  std::string space() {
    constexpr std::array<const char*, 4> kSpaces = {"", "", " ", "\r\n\t"};
    return kSpaces[random_.index(kSpaces.size())];
  }

  Random random_;
};

TEST(GltfJson, common_documents_take_the_fast_way) {
  expect_parsed_fast(R"({"asset": {"version": "2.0"}, "nodes": [{"matrix": [1, 0.5, -2e-3]}]})");
  expect_parsed_fast(R"({"name": "K\u00f6rper \"1\"", "extras": {"ä": "日本", "n": null}})");
  expect_parsed_fast("[18446744073709551615, -9223372036854775808, 1e-400, -0, -0.0, true]");
  expect_parsed_fast(" [ ] \r\n\t");
}

TEST(GltfJson, limits_and_rare_documents_are_left_to_the_other_parser) {
  EXPECT_FALSE(gltf::parse_json_fast(R"({"a": 1, "a": 2})", kLimits));
  EXPECT_FALSE(gltf::parse_json_fast("[[[]]]", {2, 10}));
  EXPECT_TRUE(gltf::parse_json_fast("[[]]", {2, 10}));
  EXPECT_TRUE(gltf::parse_json_fast("[[1]]", {2, 10}));
  EXPECT_FALSE(gltf::parse_json_fast("[[[1]]]", {2, 10}));
  EXPECT_FALSE(gltf::parse_json_fast(R"({"a": 1, "b": 2})", {2, 1}));
  EXPECT_FALSE(gltf::parse_json_fast("[1, 2, 3]", {2, 10, 9 + 80 + 2 * 32 - 1}));
  EXPECT_TRUE(gltf::parse_json_fast("[1, 2, 3]", {2, 10, 9 + 80 + 2 * 32}));
  EXPECT_FALSE(gltf::parse_json_fast(std::string(100'000, '['), kLimits));
}

TEST(GltfJson, malformed_documents_are_not_accepted) {
  for (const char* text : {"",          " ",        "{",        "}",           "[1,]",  "{\"a\":}",
                           "{\"a\" 1}", "{,}",      "01",       "1.",          ".5",    "1e",
                           "1e+",       "-",        "+1",       "1e999",       "tru",   "truefalse",
                           "\"",        "\"\\\"",   "\"\\x\"",  "\"\\ud800\"", "[1] 2", "nan",
                           "\"\x01\"",  "\"\xFF\"", "\"\xC3\"", "{1: 2}",      "[1 2]", "'a'",
                           "/**/1"})
    EXPECT_FALSE(gltf::parse_json_fast(text, kLimits)) << text;
}

TEST(GltfJson, random_and_mutated_documents_are_read_as_by_the_other_parser) {
  Documents documents(21);
  int fast = 0;
  for (int i = 0; i < 3000; ++i) {
    const std::string text = documents.value(4);
    fast += gltf::parse_json_fast(text, kLimits) ? 1 : 0;
    expect_same(text);
    for (int k = 0; k < 4; ++k) expect_same(documents.mutated(text));
  }
  EXPECT_GT(fast, 1500);
}

TEST(GltfJson, pointers_name_the_way_through_a_document_of_any_depth) {
  Json document = "end";
  std::string expected;
  for (int level = 0; level < 40; ++level) {
    if (level % 3 == 0)
      document = Json::array({0, std::move(document)});
    else
      document = {{"other", 1}, {"member", std::move(document)}};
    expected = (level % 3 == 0 ? "/1" : "/member") + expected;
  }
  gltf::Cursor at(document, "");
  while (!at.json().is_string()) at = at.json().is_array() ? at.element(1) : at.member("member");
  EXPECT_EQ(at.pointer(), expected);
  EXPECT_EQ(gltf::Cursor(document, "/start").element(1).pointer(), "/start/1");
}

TEST(GltfJson, models_take_the_fast_way) {
  for (const std::filesystem::path& file : rigged_gltf_models()) {
    const auto bytes = read_bytes(file);
    std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (text.starts_with("glTF")) {
      std::uint32_t length = 0;
      std::memcpy(&length, text.data() + 12, sizeof length);
      text = text.substr(20, length);
    }
    SCOPED_TRACE(file.string());
    EXPECT_TRUE(gltf::parse_json_fast(text, kLimits));
    expect_same(text);
  }
}

}  // namespace
}  // namespace sunder::test
