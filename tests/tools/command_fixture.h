#pragma once

#include <sunder/io/character_file.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "support/machine/temporary_folder.h"
#include "tools/demo/demo_rig.h"
#include "tools/run_command.h"

/// Tests of the built command from the outside.
namespace sunder::command_test {

using nlohmann::json;
using test::CommandResult;
using test::run_sunder;
using testing::HasSubstr;
using testing::IsEmpty;

/// From the front across the trunk, mid-clip.
inline constexpr const char* kOneTear = R"({"sunder_operations": 1, "operations": [
  {"op": "tear", "pose": {"clip": "Sway", "time": 0.8},
   "stroke": [{"base": [-0.1, 1.15, 2], "tip": [-0.1, 1.15, 0]}, {"base": [-0.12, 1.25, 2], "tip": [-0.12, 1.25, 0]},
              {"base": [-0.1, 1.4, 2], "tip": [-0.1, 1.4, 0]}]}]})";

/// Every operation: a tear that opens, one with a gap, one while the cactus sways, a cut through
/// its trunk, a bore, undone ones, and misses.
inline constexpr const char* kAll = R"({"sunder_operations": 1, "operations": [
  {"op": "tear", "pose": {"clip": "Sway", "time": 0.8},
   "stroke": [{"base": [-0.1, 1.15, 2], "tip": [-0.1, 1.15, 0]}, {"base": [-0.12, 1.25, 2], "tip": [-0.12, 1.25, 0]}]},
  {"op": "tear", "width": 0.02, "stroke": [{"base": [0, 0.55, 2], "tip": [0, 0.55, 0]}, {"base": [0.05, 0.65, 2], "tip": [0.05, 0.65, 0]},
   {"base": [-0.03, 0.7, 2], "tip": [-0.03, 0.7, 0]}]},
  {"op": "tear", "layers": "all", "stroke": [{"base": [-0.03, 1.4, 2], "tip": [-0.03, 1.4, -2]},
   {"base": [0.04, 1.42, 2], "tip": [0.04, 1.42, -2], "pose": {"clip": "Sway", "time": 0.2}}]},
  {"op": "cut", "plane": {"point": [0, 0.5, 0], "normal": [0, 1, 0.1]}, "pose": {"clip": 0, "time": 1.3}},
  {"op": "undo"},
  {"op": "redo"},
  {"op": "drill", "axis": {"origin": [0, 0.4, 2], "direction": [0, 0, -1]}, "radius": 0.03, "depth": 4},
  {"op": "undo", "count": 2},
  {"op": "drill", "axis": {"origin": [0, 0.4, 2], "direction": [0, 0, -1]}, "radius": 0.02, "depth": 4},
  {"op": "cut", "plane": {"point": [0, 9, 0], "normal": [0, 1, 0]}},
  {"op": "drill", "axis": {"origin": [9, 9, 9], "direction": [1, 0, 0]}, "radius": 0.02, "depth": 4}]})";

/// One tear and bores with weights of their own in the log, the last of which waits for a fit; then
/// weights for the first.
inline constexpr const char* kWeighed = R"({"sunder_operations": 1, "operations": [
  {"op": "tear", "pose": {"clip": "Sway", "time": 0.8}, "weights": {"policy": "refit"},
   "stroke": [{"base": [-0.1, 1.15, 2], "tip": [-0.1, 1.15, 0]}, {"base": [-0.12, 1.25, 2], "tip": [-0.12, 1.25, 0]}]},
  {"op": "drill", "axis": {"origin": [0, 0.4, 2], "direction": [0, 0, -1]}, "radius": 0.02, "depth": 4, "weights": {"policy": "exact"}},
  {"op": "drill", "axis": {"origin": [0, 0.7, 2], "direction": [0, 0, -1]}, "radius": 0.02, "depth": 4,
   "weights": {"policy": "pose_exact", "influences": 4}},
  {"op": "weights", "count": 1, "weights": {"policy": "pose_exact"}, "pose": {"clip": "Sway", "time": 0.4}},
  {"op": "drill", "axis": {"origin": [0, 0.9, 2], "direction": [0, 0, -1]}, "radius": 0.02, "depth": 4}]})";

/// A folder that all tests of a suite share.
class CommandSuite : public testing::Test {
 protected:
  static void SetUpTestSuite() { folder_ = std::make_unique<test::TemporaryFolder>(); }
  static void TearDownTestSuite() { folder_.reset(); }

  static std::string path(const std::string& name) { return (folder_->path() / name).string(); }
  static std::string write(const std::string& name, const std::string& text) {
    std::ofstream(path(name)) << text;
    return path(name);
  }
  static bool exists(const std::string& name) { return std::filesystem::exists(path(name)); }
  static std::vector<std::byte> bytes(const std::string& name) {
    return test::read_bytes(path(name));
  }
  static json read_json(const std::string& name) {
    std::ifstream stream(path(name));
    return json::parse(stream);
  }

 private:
  inline static std::unique_ptr<test::TemporaryFolder> folder_;
};

/// With the cactus of the demo as a file.
class CactusSuite : public CommandSuite {
 protected:
  static void SetUpTestSuite() {
    CommandSuite::SetUpTestSuite();
    ASSERT_TRUE(save_glb(model(), tools::make_cactus()));
  }
  static std::string model() { return path("cactus.glb"); }
};

}  // namespace sunder::command_test
