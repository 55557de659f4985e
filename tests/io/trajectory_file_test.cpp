// Trajectories as files: what is read, and what is refused, with its place.

#include <sunder/io/trajectory_file.h>

#include <cmath>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/machine/random.h"
#include "support/machine/temporary_folder.h"

namespace sunder {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string csv_error(const std::string& text) {
  const auto read = parse_trajectory_csv(text);
  EXPECT_FALSE(read) << text;
  return read ? std::string() : std::string(read.error().text());
}

std::string json_error(const std::string& text) {
  const auto read = parse_trajectory_json(text);
  EXPECT_FALSE(read) << text;
  return read ? std::string() : std::string(read.error().text());
}

TEST(TrajectoryFile, csv_and_json_say_the_same) {
  const auto csv = parse_trajectory_csv(
      "\xEF\xBB\xBF# a comment\r\n time , shoulder,\"elbow\"\r\n\r\n0,0.5,-1e-3\r\n0.25, 1 ,2\r\n");
  ASSERT_TRUE(csv) << csv.error().text();
  const auto json = parse_trajectory_json(
      R"({"names": ["shoulder", "elbow"], "samples": [{"time": 0, "values": [0.5, -0.001]},
          {"time": 0.25, "values": [1, 2]}]})");
  ASSERT_TRUE(json) << json.error().text();
  for (const RobotTrajectory& read : {*csv, *json}) {
    EXPECT_THAT(read.names, ElementsAre("shoulder", "elbow"));
    EXPECT_THAT(read.times, ElementsAre(0, 0.25));
    EXPECT_THAT(read.values, ElementsAre(0.5, -0.001, 1, 2));
  }
}

TEST(TrajectoryFile, written_csv_is_read_back_bit_for_bit) {
  RobotTrajectory trajectory{{"shoulder", "elbow.x"}, {-0.1, 1.0 / 3, 1e6}, {}};
  for (int i = 0; i < 6; ++i) trajectory.values.push_back(std::sin(i) * std::pow(10, 40 * i - 99));
  const auto text = trajectory_csv(trajectory);
  ASSERT_TRUE(text) << text.error().text();
  const auto read = parse_trajectory_csv(*text);
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read->names, trajectory.names);
  EXPECT_EQ(read->times, trajectory.times);
  EXPECT_EQ(read->values, trajectory.values);
  trajectory.values.pop_back();
  EXPECT_EQ(trajectory_csv(trajectory).error().code(), StatusCode::size_mismatch);
  trajectory = {{"a,b"}, {0}, {0}};
  EXPECT_EQ(trajectory_csv(trajectory).error().code(), StatusCode::invalid_argument);
}

TEST(TrajectoryFile, faults_of_csv_have_line_and_column) {
  EXPECT_THAT(csv_error(""), HasSubstr("expected a line of names"));
  EXPECT_THAT(csv_error("time,a\n"), HasSubstr("expected a line of names"));
  EXPECT_THAT(csv_error("t,a\n0,0\n"), HasSubstr("line 1, column 1: 't'"));
  EXPECT_THAT(csv_error("time,a,\n0,0,0\n"), HasSubstr("line 1, column 3 has no name"));
  EXPECT_THAT(csv_error("time,a,b,a\n0,0,0,0\n"), HasSubstr("columns 2 and 4 are both named 'a'"));
  EXPECT_THAT(csv_error("time,a\n0,0\n1,x\n"), HasSubstr("line 3, column 2 ('a'): 'x'"));
  EXPECT_THAT(csv_error("time,a\n0,0\n1,2z\n"), HasSubstr("'2z' is not a number"));
  EXPECT_THAT(csv_error("time,a\n0,0\n1,\n"), HasSubstr("'' is not a number"));
  EXPECT_THAT(csv_error("time,a\n0,nan\n"), HasSubstr("line 2, column 2 ('a'): 'nan' is not fin"));
  EXPECT_THAT(csv_error("time,a\n\n0,0\n1,inf\n"), HasSubstr("line 4"));
  EXPECT_THAT(csv_error("time,a\n0,1e999\n"), HasSubstr("line 2, column 2"));
  EXPECT_THAT(csv_error("time,a\n0,0\n0,0\n"), HasSubstr("line 3, column 1 ('time'): 0 s"));
  EXPECT_THAT(csv_error("time,a\n0,0,0\n"), HasSubstr("line 2 has 3 columns, the names have 2"));
  EXPECT_THAT(csv_error("time,a\n0\n"), HasSubstr("line 2 has 1 columns"));
  const auto read = parse_trajectory_csv("time,a\n0,0\n1,x\n");
  EXPECT_EQ(read.error().index(), 3u);
  EXPECT_EQ(read.error().code(), StatusCode::malformed_file);
}

TEST(TrajectoryFile, faults_of_json_have_their_pointer_or_line) {
  EXPECT_THAT(json_error("{\n\"names\": [,]}"), HasSubstr("line 2"));
  EXPECT_THAT(json_error("[]"), HasSubstr("object"));
  EXPECT_THAT(json_error("{}"), HasSubstr("'names'"));
  EXPECT_THAT(json_error(R"({"names": ["a"], "samples": [], "x": 1})"), HasSubstr("'x'"));
  EXPECT_THAT(json_error(R"({"names": ["a"], "samples": []})"), HasSubstr("/samples"));
  EXPECT_THAT(json_error(R"({"names": [1], "samples": []})"), HasSubstr("/names/0"));
  EXPECT_THAT(json_error(R"({"names": ["a", "a"], "samples": []})"), HasSubstr("/names/1"));
  const auto samples = [](const std::string& text) {
    return json_error(R"({"names": ["a"], "samples": [{"time": 0, "values": [0]}, )" + text + "]}");
  };
  EXPECT_THAT(samples(R"({"time": 1, "values": [0, 1]})"),
              HasSubstr("/samples/1/values: expected an array of 1 numbers, found array of 2"));
  EXPECT_THAT(samples(R"({"time": 1, "values": ["0"]})"), HasSubstr("/samples/1/values/0"));
  EXPECT_THAT(samples(R"({"time": 0, "values": [0]})"), HasSubstr("/samples/1/time"));
  EXPECT_THAT(samples(R"({"time": 1})"), HasSubstr("values"));
  EXPECT_THAT(samples("3"), HasSubstr("/samples/1"));
}

TEST(TrajectoryFile, files_are_read_by_their_extension) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "arm.csv";
  std::ofstream(file) << "time,a\n0,1\n";
  ASSERT_TRUE(load_trajectory(file));
  EXPECT_EQ(load_trajectory(folder.path() / "none.csv").error().code(), StatusCode::file_not_found);
  EXPECT_EQ(load_trajectory(folder.path() / "arm.txt").error().code(),
            StatusCode::unsupported_format);
  std::filesystem::create_directory(folder.path() / "folder.json");
  EXPECT_EQ(load_trajectory(folder.path() / "folder.json").error().code(),
            StatusCode::file_unreadable);
}

TEST(TrajectoryFile, damaged_files_are_read_or_refused_but_never_crash) {
  const std::string csv = "time,shoulder,elbow\n0,0.5,-1e-3\n0.25,1,2\n0.5,1,2.5\n";
  const std::string json =
      R"({"names": ["shoulder", "elbow"], "samples": [{"time": 0, "values": [0.5, -0.001]}]})";
  test::Random random(1);
  for (int i = 0; i < 2000; ++i) {
    for (std::string text : {csv, json}) {
      for (std::uint32_t flip = 0; flip <= random.index(3); ++flip)
        text[random.index(static_cast<std::uint32_t>(text.size()))] =
            static_cast<char>(random.index(256));
      text.resize(1 + random.index(static_cast<std::uint32_t>(text.size())));
      for (const auto& read : {parse_trajectory_csv(text), parse_trajectory_json(text)}) {
        const std::size_t expected = read ? read->times.size() * read->names.size() : 0;
        EXPECT_EQ(read ? read->values.size() : 0, expected);
        EXPECT_NE(read.error().code(), StatusCode::internal_error);
      }
    }
  }
}

}  // namespace
}  // namespace sunder
