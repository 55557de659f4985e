// Seeds of fuzz targets that the library accepts: a seed that is refused leads a fuzzer no further
// than to the first check.

#include <sunder/io/character_bytes.h>
#include <sunder/io/operation_log.h>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "bench/stress/torn_subject.h"
#include "fuzz/operations_of_bytes.h"
#include "fuzz/snapshot_scene.h"
#include "io/gltf/refusal.h"
#include "io/urdf/findings.h"
#include "io/urdf/read_robot.h"

namespace sunder {
namespace {

std::string seed(const std::string& name) {
  std::ifstream stream(std::filesystem::path(SUNDER_FUZZ_SEEDS) / name, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

std::vector<std::byte> bytes_of(const std::string& text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

TEST(FuzzSeeds, a_model_is_read) {
  const auto loaded = load_glb(bytes_of(seed("glb/strip.glb")));
  EXPECT_TRUE(loaded) << loaded.error().text();
}

TEST(FuzzSeeds, an_operation_log_is_read) {
  const auto operations = parse_operations(seed("operation_log/all.json"));
  EXPECT_TRUE(operations) << operations.error().text();
}

TEST(FuzzSeeds, a_robot_is_read) {
  RobotLoadOptions options;
  options.shapes = RobotShapes::none;
  urdf::Findings findings(false);
  const auto loaded = gltf::without_exceptions<LoadedRobot>([&] {
    return urdf::read_robot(seed("urdf/all_joint_types.urdf"), "/nowhere/robot.urdf", options,
                            findings);
  });
  EXPECT_TRUE(loaded) << loaded.error().text();
}

TEST(FuzzSeeds, snapshots_are_restored) {
  const fuzz::SnapshotAssets assets = fuzz::make_snapshot_assets();
  for (const char* const name :
       {"snapshot/empty.snapshot", "snapshot/torn.snapshot", "snapshot/rich.snapshot"}) {
    Scene scene = fuzz::make_scene();
    const Status status = scene.restore(bytes_of(seed(name)), assets);
    EXPECT_TRUE(status) << name << ": " << status.text()
                        << " (write_fuzz_corpus writes it in the present format)";
  }
}

TEST(FuzzSeeds, all_operations_are_done) {
  for (const char* const name : {"operations/torn_grid.trial", "operations/cut_octahedron.trial"}) {
    const std::string bytes = seed(name);
    fuzz::Trial trial =
        fuzz::trial_of({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
    const std::uint64_t faces = trial.character.meshes[0].triangle_count();
    stress::CaseReport report;
    stress::TornSubject subject(std::move(trial.character), report);
    for (const Operation& operation : trial.operations) {
      const std::uint64_t before = subject.model().digest();
      subject.operate(operation);
      EXPECT_NE(subject.model().digest(), before) << name;
    }
    stress::measure(subject.model(), report);
    EXPECT_GE(report.operations, 2u) << name;
    EXPECT_GT(report.faces, faces) << name;
  }
}

}  // namespace
}  // namespace sunder
