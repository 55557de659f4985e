#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace sunder::test {

/// A closed body and planes that split it: normal (unit length) and offset.
struct SplitTask {
  std::vector<std::array<double, 3>> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::array<double, 4>> planes;
};

/// One cell between the planes.
struct SplitCell {
  double volume = 0;
  int parts = 0;
};
/// One character per plane: "+" on the side of its normal.
using SplitCells = std::map<std::string, SplitCell>;

/// Whether node and manifold-3d are installed.
bool has_manifold();

/// The cells that Manifold computes for each task; empty if it could not be run.
std::vector<SplitCells> split_by_manifold(const std::vector<SplitTask>& tasks);

}  // namespace sunder::test

/// Skips a test that needs Manifold if it is absent.
#define SUNDER_SKIP_WITHOUT_MANIFOLD() \
  if (!::sunder::test::has_manifold()) \
  GTEST_SKIP() << "needs node and manifold-3d: npm ci --prefix tests/npm"
