// Where memory runs out, reading and writing say so, and files are as they were.

#include <sunder/io/character_file.h>
#include <sunder/io/operation_log.h>
#include <sunder/skinning/pose.h>

#include <gtest/gtest.h>

#include "support/rigs.h"
#include "support/starve.h"
#include "support/temporary_folder.h"

namespace sunder {
namespace {

using test::starve;
using test::TemporaryFolder;

constexpr auto nothing = [](const auto&, const Status&) {};

std::vector<Operation> operations() {
  TearOperation tear;
  tear.pose = *bind_pose(test::make_sheet(2));
  tear.stroke = {test::down_at(0.1, 0.2), test::down_at(0.7, 0.6)};
  tear.options.weights = WeightOptions{};
  return {tear, CutOperation{}, DrillOperation{}, WeightsOperation{}, UndoOperation{}};
}

std::unique_ptr<TemporaryFolder> folder() { return std::make_unique<TemporaryFolder>(); }

TEST(AllocationFailure, operation_logs_are_refused) {
  const std::vector<Operation> log = operations();
  const std::string text = *format_operations(log);
  starve(
      folder, [&](TemporaryFolder&) { return format_operations(log); }, nothing);
  starve(
      folder, [&](TemporaryFolder&) { return parse_operations(text); }, nothing);
  starve(
      [] {
        auto made = folder();
        (void)made->write("log.json", "before");
        return made;
      },
      [&](TemporaryFolder& in) { return save_operations(in.path() / "log.json", log); },
      [&](TemporaryFolder& in, const Status& status) {
        EXPECT_EQ(test::read_bytes(in.path() / "log.json").size(), status ? text.size() : 6u);
        if (status) EXPECT_TRUE(load_operations(in.path() / "log.json"));
      });
}

TEST(AllocationFailure, models_are_refused) {
  const Character tube = test::make_tube(3, 5, 2);
  starve(
      folder, [&](TemporaryFolder& in) { return save_glb(in.path() / "tube.glb", tube); },
      [](TemporaryFolder& in, const Status& status) {
        std::error_code error;
        EXPECT_EQ(std::filesystem::is_empty(in.path(), error), !status);
      });
  const TemporaryFolder in;
  const auto file = in.path() / "tube.glb";
  ASSERT_TRUE(save_glb(file, tube));
  starve(
      folder, [&](TemporaryFolder&) { return load_character(file); }, nothing);
  const auto loaded = load_character(file);
  ASSERT_TRUE(loaded);
  Character moved = *loaded->character;
  moved.meshes[0].positions[0].x() += 1;
  starve(
      folder,
      [&](TemporaryFolder& to) { return save_glb(to.path() / "moved.glb", moved, *loaded); },
      [](TemporaryFolder& to, const Status& status) {
        std::error_code error;
        EXPECT_EQ(std::filesystem::is_empty(to.path(), error), !status);
      });
}

}  // namespace
}  // namespace sunder
