// Damaged URDF files: cut short, bits flipped, pieces copied and removed. Each either loads to a
// valid robot or is refused with a cause.

#include <sunder/io/robot_file.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/machine/random.h"
#include "support/machine/stress.h"
#include "support/machine/temporary_folder.h"
#include "support/models/random_robot.h"
#include "support/models/shared_models.h"

namespace sunder::test {
namespace {

class MutatedUrdf : public testing::Test {
 protected:
  /// No mesh is read: its importers have tests of their own.
  void expect_an_answer(const std::string& text) {
    RobotLoadOptions options;
    options.shapes = RobotShapes::none;
    std::vector<RobotFinding> findings;
    const auto loaded = load_robot(folder_.write("robot.urdf", text), options, &findings);
    const bool has_error = std::any_of(
        findings.begin(), findings.end(),
        [](const RobotFinding& finding) { return finding.severity == RobotSeverity::error; });
    EXPECT_EQ(loaded.has_value(), !has_error) << loaded.error().text();
    if (loaded) {
      EXPECT_TRUE(validate_robot(loaded->robot)) << validate_robot(loaded->robot).text();
    } else {
      EXPECT_FALSE(loaded.error().text().empty());
      EXPECT_NE(loaded.error().code(), StatusCode::internal_error) << loaded.error().text();
    }
  }

  TemporaryFolder folder_;
};

std::vector<std::string> originals() {
  Random random(7);
  std::vector<std::string> texts = {random_urdf(random, 6, 0.5), random_urdf(random, 12, 1.0)};
  if (!shared_models().empty())
    for (const auto& file : files_below(shared_models() / "urdf", {".urdf"})) {
      std::ifstream stream(file);
      texts.emplace_back(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
    }
  return texts;
}

TEST_F(MutatedUrdf, cut_short_at_every_64th_byte) {
  for (const std::string& text : originals())
    for (std::size_t length = 0; length < text.size(); length += 64)
      expect_an_answer(text.substr(0, length));
}

TEST_F(MutatedUrdf, bits_flipped) {
  Random random(8);
  for (const std::string& text : originals())
    for (int i = 0; i < 150; ++i) {
      std::string mutant = text;
      for (std::uint32_t flips = 1 + random.index(8); flips > 0; --flips) {
        char& byte = mutant[random.index(static_cast<std::uint32_t>(mutant.size()))];
        byte = static_cast<char>(byte ^ (1 << random.index(8)));
      }
      expect_an_answer(mutant);
    }
}

TEST_F(MutatedUrdf, pieces_moved) {
  Random random(9);
  for (const std::string& text : originals())
    for (int i = 0; i < 150; ++i) {
      std::string mutant = text;
      const auto size = static_cast<std::uint32_t>(mutant.size());
      const std::uint32_t from = random.index(size), length = 1 + random.index(200);
      const std::string piece = mutant.substr(from, length);
      if (i % 2 == 0) mutant.erase(from, length);
      mutant.insert(random.index(static_cast<std::uint32_t>(mutant.size())), piece);
      expect_an_answer(mutant);
    }
}

TEST_F(MutatedUrdf, long_chains_load_without_recursion) {
  Random random(10);
  for (const char* const type : {"fixed", "continuous"}) {
    std::string text = "<robot name=\"r\"><link name=\"l0\"/>";
    for (int i = 1; i < 20'000; ++i)
      text += "<link name=\"l" + std::to_string(i) + "\"/><joint name=\"j" + std::to_string(i) +
              "\" type=\"" + type + "\"><parent link=\"l" + std::to_string(i - 1) +
              "\"/><child link=\"l" + std::to_string(i) + "\"/></joint>";
    expect_an_answer(text + "</robot>");
  }
}

TEST_F(MutatedUrdf, large_files_are_answered_quickly) {
  const auto start = std::chrono::steady_clock::now();
  expect_an_answer("<robot name=\"" + std::string(8 << 20, 'x') + "\"><link name=\"a\"/></robot>");
  expect_an_answer("<robot name=\"r\"><!--" + std::string(8 << 20, '-') + "></robot>");
  expect_an_answer("<robot name=\"r\">" + std::string(8 << 20, '<'));
  std::string attributes = "<robot name=\"r\"><link";
  for (int i = 0; i < 200'000; ++i) attributes += " a" + std::to_string(i) + "=\"\"";
  expect_an_answer(attributes + " name=\"a\"/></robot>");
  std::string numbers = "<robot name=\"r\"><link name=\"a\"/><material name=\"m\"><color rgba=\"";
  for (int i = 0; i < 1'000'000; ++i) numbers += "1 ";
  expect_an_answer(numbers + "\"/></material></robot>");
  // Far above what it takes; quadratic time would be minutes.
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(60));
}

}  // namespace
}  // namespace sunder::test
