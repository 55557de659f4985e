// The reply of the helper process, read as if a model had taken that process over.

#include <random>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "io/import_messages/reply.h"

namespace sunder {
namespace {

using import_messages::decode_head;
using import_messages::encode_head;
using nlohmann::json;

LoadReport some_report() {
  LoadReport report;
  report.format = "FBX by assimp 5.2.5";
  report.space = "metres, y up";
  report.notes = {{LoadNote::Kind::information, "scene", "cameras", 3},
                  {LoadNote::Kind::repaired, "mesh 0 'é'", "weights", 4'000'000'000u},
                  {LoadNote::Kind::dropped, "", "", 1}};
  return report;
}

TEST(ImportReply, KeepsTheReport) {
  const LoadReport report = some_report();
  const auto decoded = decode_head(encode_head({}, report), "a.fbx");
  ASSERT_TRUE(decoded) << decoded.error().text();
  EXPECT_EQ(decoded->format, report.format);
  EXPECT_EQ(decoded->space, report.space);
  ASSERT_EQ(decoded->notes.size(), report.notes.size());
  for (std::size_t i = 0; i < report.notes.size(); ++i) {
    EXPECT_EQ(decoded->notes[i].kind, report.notes[i].kind);
    EXPECT_EQ(decoded->notes[i].place, report.notes[i].place);
    EXPECT_EQ(decoded->notes[i].text, report.notes[i].text);
    EXPECT_EQ(decoded->notes[i].count, report.notes[i].count);
  }
}

TEST(ImportReply, KeepsAFailure) {
  const Status failure = Status::failure(StatusCode::empty_input, 7, "no triangles: 100%%");
  const auto decoded = decode_head(encode_head(failure, {}), "a.fbx");
  ASSERT_FALSE(decoded);
  EXPECT_EQ(decoded.error().code(), failure.code());
  EXPECT_EQ(decoded.error().index(), failure.index());
  EXPECT_EQ(decoded.error().text(), failure.text());
}

TEST(ImportReply, RefusesWrongTypesAndRanges) {
  const json good = json::parse(encode_head({}, some_report()));
  const auto expect_refused = [&](const json& bad) {
    const auto decoded = decode_head(bad.dump(), "a.fbx");
    ASSERT_FALSE(decoded) << bad;
    EXPECT_EQ(decoded.error().code(), StatusCode::malformed_file);
    EXPECT_NE(decoded.error().text().find("a.fbx"), std::string_view::npos);
  };
  for (const auto& [key, unused] : good.items()) {
    json without = good;
    without.erase(key);
    expect_refused(without);
    for (const json& value : {json(), json(-1), json(1e300), json::object(), json(1ull << 40)}) {
      json changed = good;
      changed[key] = value;
      expect_refused(changed);
    }
  }
  for (const json& note : {json::array(), json({1, 2, 3, 4}), json({3, "", "", 1}),
                           json({0, "", "", -1}), json({0, std::string(5000, 'x'), "", 1})}) {
    json changed = good;
    changed["notes"].push_back(note);
    expect_refused(changed);
  }
}

TEST(ImportReply, ControlCharactersBecomeSpaces) {
  LoadReport report = some_report();
  report.notes[0].text = "a\x1B[2Jb\n";
  EXPECT_EQ(decode_head(encode_head({}, report), "")->notes[0].text, "a [2Jb ");
}

TEST(ImportReply, MutationsEndInAReportOrAStatus) {
  const std::string good = encode_head({}, some_report());
  for (std::size_t length = 0; length < good.size(); ++length)
    EXPECT_FALSE(decode_head(std::string_view(good).substr(0, length), "a.fbx")) << length;
  std::mt19937_64 random(1);
  for (int i = 0; i < 20'000; ++i) {
    std::string bad = good;
    for (auto changes = random() % 4 + 1; changes > 0; --changes)
      bad[random() % bad.size()] = static_cast<char>(random());
    const auto decoded = decode_head(bad, "a.fbx");
    if (!decoded) {
      EXPECT_NE(decoded.error().code(), StatusCode::ok);
    } else {
      EXPECT_LE(decoded->notes.size(), 3u);
    }
  }
  // Deep nesting does not overflow the stack.
  EXPECT_FALSE(decode_head(std::string(1'000'000, '['), "a.fbx"));
}

}  // namespace
}  // namespace sunder
