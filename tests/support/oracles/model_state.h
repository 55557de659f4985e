#pragma once

#include <sunder/tear/torn_model.h>

#include <string>
#include <vector>

namespace sunder::test {

/// All observable state of a model.
struct ModelState {
  Character character;
  std::uint64_t digest = 0;
  std::uint32_t point_count = 0;
  struct OfMesh {
    std::vector<std::uint32_t> points;  ///< Three a triangle.
    std::vector<Birth> births;          ///< One per vertex beyond the source's.
    std::vector<std::uint32_t> source_triangles;
    std::vector<Triangle> fillings;
  };
  std::vector<OfMesh> meshes;
};

ModelState state_of(const TornModel& model);

/// Describes the difference between two states; empty if they are equal.
std::string difference(const ModelState& a, const ModelState& b);

bool are_same(const Birth& a, const Birth& b);

}  // namespace sunder::test
