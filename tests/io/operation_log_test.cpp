#include <sunder/io/operation_log.h>

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "support/temporary_folder.h"

namespace sunder {
namespace {

constexpr const char* kBlades = R"([{"base": [0,0,1], "tip": [0,0,0]}, {"base": [0.1,0,1], "tip": [0.1,0,0]}])";

std::string log_of(const std::string& operations) { return R"({"sunder_operations": 1, "operations": [)" + operations + "]}"; }

/// A tear with other fields than the stroke in front of it.
std::string tear_with(const std::string& fields) {
  return log_of(R"({"op": "tear", )" + fields + R"(, "stroke": )" + kBlades + "}");
}

TearOperation parsed(const std::string& json) {
  auto operations = parse_operations(json);
  EXPECT_TRUE(operations) << operations.error().text();
  if (!operations || operations->empty()) return {};
  return std::get<TearOperation>(operations->front());
}

TEST(OperationLog, ReadsEveryField) {
  const TearOperation tear = parsed(tear_with(R"("pose": {"clip": "Walk", "time": 0.4}, "width": 0.0, "layers": "nearest")"));
  const ClipPose pose = std::get<ClipPose>(tear.pose);
  EXPECT_EQ(std::get<std::string>(pose.clip), "Walk");
  EXPECT_EQ(pose.time, 0.4);
  const Stroke expected = {{{0, 0, 1}, {0, 0, 0}}, {{0.1, 0, 1}, {0.1, 0, 0}}};
  EXPECT_EQ(tear.stroke, expected);
}

TEST(OperationLog, RestIsTheDefaultPose) {
  EXPECT_TRUE(std::holds_alternative<RestPose>(parsed(tear_with(R"("width": 0)")).pose));
  EXPECT_TRUE(std::holds_alternative<RestPose>(parsed(tear_with(R"("pose": "rest")")).pose));
  EXPECT_TRUE(std::holds_alternative<BindPose>(parsed(tear_with(R"("pose": "bind")")).pose));
}

TEST(OperationLog, ClipByIndex) {
  const ClipPose pose = std::get<ClipPose>(parsed(tear_with(R"("pose": {"clip": 2, "time": 0})")).pose);
  EXPECT_EQ(std::get<std::uint32_t>(pose.clip), 2u);
}

TEST(OperationLog, BonesKeepTheirOrderAndWhatIsNotGivenStaysOpen) {
  const BonesPose pose = std::get<BonesPose>(
      parsed(
          tear_with(
              R"("pose": {"bones": {"Spine": {"rotation": [0, 0, 0, 2]}, "Arm": {"translation": [1, 2, 3], "scale": [1, 1, 2]}}})"))
          .pose);
  ASSERT_EQ(pose.bones.size(), 2u);
  EXPECT_EQ(pose.bones[0].name, "Spine");
  EXPECT_FALSE(pose.bones[0].translation);
  EXPECT_EQ(pose.bones[0].rotation->coeffs(), Quatf::Identity().coeffs());  // Normalised.
  EXPECT_EQ(pose.bones[1].name, "Arm");
  EXPECT_EQ(*pose.bones[1].translation, Vec3f(1, 2, 3));
  EXPECT_EQ(*pose.bones[1].scale, Vec3f(1, 1, 2));
  EXPECT_FALSE(pose.bones[1].rotation);
}

TEST(OperationLog, MayBeEmpty) {
  const auto operations = parse_operations(log_of(""));
  ASSERT_TRUE(operations);
  EXPECT_TRUE(operations->empty());
}

struct Refusal {
  const char* what;
  std::string json;
  StatusCode code;
  const char* text;  ///< Must occur in the message.
};

std::ostream& operator<<(std::ostream& stream, const Refusal& refusal) { return stream << refusal.what; }

class OperationLogRefuses : public testing::TestWithParam<Refusal> {};

TEST_P(OperationLogRefuses, NamingThePlace) {
  const auto operations = parse_operations(GetParam().json);
  ASSERT_FALSE(operations);
  EXPECT_EQ(operations.error().code(), GetParam().code) << operations.error().text();
  EXPECT_NE(operations.error().text().find(GetParam().text), std::string_view::npos) << operations.error().text();
}

constexpr auto kMalformed = StatusCode::malformed_file;
constexpr auto kUnsupported = StatusCode::unsupported_feature;

INSTANTIATE_TEST_SUITE_P(
    Logs, OperationLogRefuses,
    testing::Values(
        Refusal{"no text", "", kMalformed, "line 1"},
        Refusal{"syntax", "{\n\"sunder_operations\": 1,\n oops}", kMalformed, "line 3, byte 27"},
        Refusal{"trailing text", log_of("") + " x", kMalformed, "line 1"},
        Refusal{"bad UTF-8", "{\"\xFF\": 1}", kMalformed, "not JSON"},
        Refusal{"not an object", "[]", kMalformed, "expected an object, found array"},
        Refusal{"no version", R"({"operations": []})", kMalformed, "'sunder_operations' is missing"},
        Refusal{"version as text", R"({"sunder_operations": "1", "operations": []})", kMalformed, "/sunder_operations"},
        Refusal{"another version", R"({"sunder_operations": 2, "anything": 0})", kUnsupported, "version 2"},
        Refusal{"no operations", R"({"sunder_operations": 1})", kMalformed, "'operations' is missing"},
        Refusal{"operations no array", R"({"sunder_operations": 1, "operations": {}})", kMalformed,
                "/operations: expected an array"},
        Refusal{"unknown field at the top", R"({"sunder_operations": 1, "operations": [], "author": ""})", kMalformed, "'author'"},
        Refusal{"a field twice", R"({"sunder_operations": 1, "operations": [], "operations": []})", kMalformed,
                "'operations' occurs twice"},
        Refusal{"operation no object", log_of("7"), kMalformed, "/operations/0: expected an object, found number"},
        Refusal{"operation without op", log_of("{}"), kMalformed, "/operations/0: field 'op' is missing"},
        Refusal{"unknown operation", log_of(R"({"op": "drill"})"), kUnsupported, "/operations/0/op"},
        Refusal{"unknown field", tear_with(R"("depth": 1)"), kMalformed, "unknown field 'depth'"},
        Refusal{"no stroke", log_of(R"({"op": "tear"})"), kMalformed, "'stroke' is missing"},
        Refusal{"one blade", log_of(R"({"op": "tear", "stroke": [{"base": [0,0,1], "tip": [0,0,0]}]})"), kMalformed,
                "/operations/0/stroke"},
        Refusal{"blade without tip", log_of(R"({"op": "tear", "stroke": [{"base": [0,0,1]}, {}]})"), kMalformed,
                "/stroke/0: field 'tip'"},
        Refusal{"blade without length", log_of(R"({"op": "tear", "stroke": [{"base": [0,0,1], "tip": [0,0,1]}, {}]})"), kMalformed,
                "/operations/0/stroke/0: blade without length"},
        Refusal{"two coordinates", log_of(R"({"op": "tear", "stroke": [{"base": [0,0], "tip": [0,0,1]}, {}]})"), kMalformed,
                "/stroke/0/base"},
        Refusal{"coordinate as text", log_of(R"({"op": "tear", "stroke": [{"base": [0,0,"1"], "tip": [0,0,1]}, {}]})"), kMalformed,
                "/stroke/0/base/2: expected a number, found string"},
        Refusal{"NaN", log_of(R"({"op": "tear", "stroke": [{"base": [0,0,NaN], "tip": [0,0,1]}, {}]})"), kMalformed, "not JSON"},
        Refusal{"overflow", log_of(R"({"op": "tear", "stroke": [{"base": [0,0,1e999], "tip": [0,0,1]}, {}]})"), kMalformed,
                "1e999"},
        Refusal{"too large", log_of(R"({"op": "tear", "stroke": [{"base": [0,0,1e10], "tip": [0,0,1]}, {}]})"), kMalformed,
                "/stroke/0/base/2"},
        Refusal{"a gap", tear_with(R"("width": 0.01)"), kUnsupported, "/operations/0/width"},
        Refusal{"width as text", tear_with(R"("width": "0")"), kMalformed, "/operations/0/width"},
        Refusal{"all layers", tear_with(R"("layers": "all")"), kUnsupported, "/operations/0/layers"},
        Refusal{"unknown pose", tear_with(R"("pose": "t-pose")"), kMalformed, "/operations/0/pose"},
        Refusal{"pose as number", tear_with(R"("pose": 3)"), kMalformed, "/operations/0/pose"},
        Refusal{"clip without time", tear_with(R"("pose": {"clip": "Walk"})"), kMalformed, "'time' is missing"},
        Refusal{"negative time", tear_with(R"("pose": {"clip": "Walk", "time": -1})"), kMalformed, "/pose/time"},
        Refusal{"negative clip", tear_with(R"("pose": {"clip": -1, "time": 0})"), kMalformed, "/pose/clip"},
        Refusal{"clip index beyond 32 bits", tear_with(R"("pose": {"clip": 4294967295, "time": 0})"), kMalformed, "/pose/clip"},
        Refusal{"clip and bones", tear_with(R"("pose": {"clip": 0, "time": 0, "bones": {}})"), kMalformed, "unknown field"},
        Refusal{"unknown part of a bone", tear_with(R"("pose": {"bones": {"A/B": {"shear": 1}}})"), kMalformed, "/pose/bones/A~1B"},
        Refusal{"bone without name", tear_with(R"("pose": {"bones": {"": {}}})"), kMalformed, "without name"},
        Refusal{"rotation of zero length", tear_with(R"("pose": {"bones": {"A": {"rotation": [0,0,0,0]}}})"), kMalformed,
                "/A/rotation"},
        Refusal{"the same bone twice", tear_with(R"("pose": {"bones": {"A": {}, "A": {}}})"), kMalformed, "'A' occurs twice"}));

TEST(OperationLog, IndexIsTheOperation) {
  const std::string good = std::string(R"({"op": "tear", "stroke": )") + kBlades + "}";
  const auto operations = parse_operations(log_of(good + "," + R"({"op": "tear"})"));
  ASSERT_FALSE(operations);
  EXPECT_EQ(operations.error().index(), 1u);
}

TEST(OperationLog, DeepNestingIsALimit) {
  const auto operations = parse_operations(std::string(100'000, '['));
  ASSERT_FALSE(operations);
  EXPECT_EQ(operations.error().code(), StatusCode::limit_exceeded);
}

TEST(OperationLog, SizeIsALimit) {
  const auto operations = parse_operations(std::string((std::size_t{64} << 20) + 1, ' '));
  ASSERT_FALSE(operations);
  EXPECT_EQ(operations.error().code(), StatusCode::limit_exceeded);
}

TEST(OperationLog, FromAFile) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("log.json", std::string_view(tear_with(R"("width": 0)")));
  const auto operations = load_operations(file);
  ASSERT_TRUE(operations) << operations.error().text();
  EXPECT_EQ(operations->size(), 1u);

  EXPECT_EQ(load_operations(folder.path() / "absent.json").error().code(), StatusCode::file_not_found);
  EXPECT_EQ(load_operations(folder.path()).error().code(), StatusCode::file_unreadable);
}

/// The page and the schema are for people and other programs; what they show must be what the code takes.
TEST(OperationLog, DocumentedExampleIsRead) {
  const std::filesystem::path docs = std::filesystem::path(__FILE__).parent_path().parent_path().parent_path() / "docs";
  std::ifstream page(docs / "operation_log.md");
  if (!page) GTEST_SKIP() << "needs the source folder docs/";
  const std::string text{std::istreambuf_iterator<char>(page), {}};
  const std::size_t start = text.find("```json\n") + 8;
  const auto operations = parse_operations(std::string_view(text).substr(start, text.find("```", start) - start));
  ASSERT_TRUE(operations) << operations.error().text();

  std::ifstream schema(docs / "operation_log.schema.json");
  const nlohmann::json parsed_schema = nlohmann::json::parse(schema);
  EXPECT_EQ(parsed_schema["properties"]["sunder_operations"]["const"], 1);
}

}  // namespace
}  // namespace sunder
