// Texts of strangers as large as they may be are read in a time in proportion to their size, and
// in memory in proportion to it. The texts here took minutes in quadratic time; the watchdog
// counts the time of the processor.
#include <sunder/io/operation_log.h>
#include <sunder/io/trajectory_file.h>

#include <cstdint>
#include <string>
#include <variant>

#include <gtest/gtest.h>

#include "support/machine/peak_memory.h"
#include "support/machine/watchdog.h"

namespace sunder {
namespace {

/// Enough for the sanitizers.
constexpr double kSeconds = 20;

std::string log_of(const std::string& operations) {
  return R"({"sunder_operations": 1, "operations": [)" + operations + "]}";
}

template <class Item>
std::string list_of(int count, Item item) {
  std::string text;
  for (int i = 0; i < count; ++i) {
    if (i > 0) text += ',';
    text += item(i);
  }
  return text;
}

TEST(LongTexts, a_log_of_many_operations) {
  const std::string log = log_of(list_of(400000, [](int) { return R"({"op":"undo"})"; }));
  const test::Watchdog watchdog(kSeconds, "many operations");
  const auto operations = parse_operations(log);
  ASSERT_TRUE(operations) << operations.error().text();
  EXPECT_EQ(operations->size(), 400000u);
}

TEST(LongTexts, a_stroke_of_many_blades) {
  const std::string log =
      log_of(R"({"op":"tear","stroke":[)" +
             list_of(300000,
                     [](int i) {
                       return R"({"base":[)" + std::to_string(i) + R"(,0,1],"tip":[0,0,0]})";
                     }) +
             "]}");
  const test::Watchdog watchdog(kSeconds, "many blades");
  const auto operations = parse_operations(log);
  ASSERT_TRUE(operations) << operations.error().text();
}

TEST(LongTexts, a_pose_of_many_bones) {
  const std::string log = log_of(
      R"({"op":"cut","plane":{"point":[0,0,0],"normal":[0,0,1]},"pose":{"bones":{)" +
      list_of(300000, [](int i) { return "\"bone " + std::to_string(i) + "\":{}"; }) + "}}}");
  const test::Watchdog watchdog(kSeconds, "many bones");
  const auto operations = parse_operations(log);
  ASSERT_TRUE(operations) << operations.error().text();
  EXPECT_EQ(std::get<BonesPose>(std::get<CutOperation>(operations->at(0)).pose).bones.size(),
            300000u);
}

TEST(LongTexts, a_log_of_many_unknown_fields) {
  const std::string log =
      log_of("{" + list_of(400000, [](int i) { return "\"f" + std::to_string(i) + "\":0"; }) + "}");
  const test::Watchdog watchdog(kSeconds, "many fields");
  EXPECT_EQ(parse_operations(log).error().code(), StatusCode::malformed_file);
}

TEST(LongTexts, a_trajectory_of_many_samples) {
  const std::string json =
      R"({"names":["elbow"],"samples":[)" +
      list_of(400000,
              [](int i) { return R"({"time":)" + std::to_string(i) + R"(,"values":[0.5]})"; }) +
      "]}";
  const std::string csv = "time,elbow\n" + list_of(400000, [](int i) {
                            return std::to_string(i) + ".5\n" + std::to_string(i) + ".75";
                          });
  const test::Watchdog watchdog(kSeconds, "many samples");
  const auto of_json = parse_trajectory_json(json);
  ASSERT_TRUE(of_json) << of_json.error().text();
  EXPECT_EQ(of_json->times.size(), 400000u);
  EXPECT_FALSE(parse_trajectory_csv(csv));  // rows of one column
}

TEST(LongTexts, a_line_of_many_columns_takes_no_memory) {
  for (const std::string begin : {"time", "time,elbow\n0"}) {
    const std::string csv = begin + std::string(std::size_t{16} << 20, ',');
    const test::PeakMemory peak;
    EXPECT_FALSE(parse_trajectory_csv(csv));
    if (test::PeakMemory::is_measured()) {
      EXPECT_LT(peak.bytes(), std::uint64_t{1} << 20);
    }
  }
}

}  // namespace
}  // namespace sunder
