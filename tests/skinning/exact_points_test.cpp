// Vertices with a bind position per influence follow a point of a triangle exactly in every pose.

#include <sunder/skinning/deform.h>
#include <sunder/skinning/skinned_mesh.h>

#include <array>
#include <map>

#include <gtest/gtest.h>

#include "skinning/internal/reference.h"
#include "support/models/posed_arrays.h"
#include "support/models/random_skin.h"

namespace sunder {
namespace {

/// A vertex inside a triangle of other vertices.
struct Inside {
  Triangle corners;
  std::array<double, 3> parts;
};

/// Appends vertices inside random triangles, with interpolated weights and with bind positions per
/// influence by definition.
InfluencePositions append_inside(test::Random& random, Mesh& mesh, std::uint32_t count,
                                 std::vector<Inside>& inside) {
  InfluencePositions exact;
  exact.morph_targets.resize(mesh.morph_targets.size());
  const std::uint32_t old_count = mesh.vertex_count();
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t a = random.index(old_count);
    Inside at = {{a, (a + 1) % old_count, (a + 2) % old_count}, {}};
    at.parts[0] = random.uniform(0, 1);
    at.parts[1] = random.uniform(0, 1 - at.parts[0]);
    at.parts[2] = 1 - at.parts[0] - at.parts[1];
    std::map<std::uint32_t, std::array<double, 3>>
        weights;  // by slot, of each corner times its part
    for (std::size_t k = 0; k < 3; ++k)
      for (const Influence& influence : mesh.weights.of(at.corners[k]))
        weights[influence.slot][k] += at.parts[k] * influence.weight;
    const auto blend = [&](const std::array<double, 3>& of, const std::vector<Vec3f>& values) {
      Vec3d sum = Vec3d::Zero();
      for (std::size_t k = 0; k < 3; ++k) sum += of[k] * values[at.corners[k]].cast<double>();
      return Vec3f(sum.cast<float>());
    };
    std::vector<Influence> influences;
    for (const auto& [slot, of] : weights) {
      influences.push_back({slot, static_cast<float>(of[0] + of[1] + of[2])});
      exact.positions.push_back(blend(of, mesh.positions));
      exact.normals.push_back(blend(of, mesh.normals));
      for (std::size_t j = 0; j < mesh.morph_targets.size(); ++j) {
        exact.morph_targets[j].positions.push_back(
            blend(of, mesh.morph_targets[j].position_deltas));
        exact.morph_targets[j].normals.push_back(
            mesh.morph_targets[j].normal_deltas.empty()
                ? Vec3f(Vec3f::Zero())
                : blend(of, mesh.morph_targets[j].normal_deltas));
      }
    }
    exact.vertices.push_back(mesh.vertex_count());
    inside.push_back(at);
    mesh.weights.append(influences);
    mesh.positions.push_back(blend(at.parts, mesh.positions));
    mesh.normals.push_back(blend(at.parts, mesh.normals).normalized());
    for (MorphTarget& target : mesh.morph_targets) {
      target.position_deltas.push_back(blend(at.parts, target.position_deltas));
      if (!target.normal_deltas.empty())
        target.normal_deltas.push_back(blend(at.parts, target.normal_deltas));
    }
  }
  return exact;
}

TEST(ExactPoints, stay_on_their_triangle_in_every_pose) {
  for (int seed = 1; seed <= 20; ++seed) {
    test::Random random(static_cast<std::uint64_t>(seed));
    const std::uint32_t slots = 12;
    Mesh mesh = test::make_random_skin(random, {200, slots, 4, 2, false, 6});
    std::vector<Inside> inside;
    const std::uint32_t old_count = mesh.vertex_count();
    const InfluencePositions exact = append_inside(random, mesh, 60, inside);
    VertexSource source = source_of(mesh);
    source.per_influence = &exact;
    const auto made = SkinnedMesh::create(source, slots);
    ASSERT_TRUE(made) << made.error().text();
    BonePalette palette = *BonePalette::create(slots, 2);
    test::PosedArrays posed(mesh);
    PosedBuffer buffer(posed.target());
    double without = 0;
    for (int pose = 0; pose < 5; ++pose) {
      const auto matrices = test::random_palette(random, slots, pose % 2 == 0 ? 1.0 : 1.3);
      const std::vector<float> weights = {static_cast<float>(random.uniform(0, 1)),
                                          pose == 3 ? 0.0f : 0.4f};
      ASSERT_TRUE(palette.set(test::in_float(matrices), weights));
      ASSERT_TRUE(made->deform(palette, buffer));
      for (std::uint32_t i = 0; i < inside.size(); ++i) {
        Vec3d expected = Vec3d::Zero(), normal = Vec3d::Zero();
        for (std::size_t k = 0; k < 3; ++k) {
          const std::uint32_t corner = inside[i].corners[k];
          expected +=
              inside[i].parts[k] * deform_position_reference(mesh, corner, matrices, weights);
          Vec3d bind = mesh.normals[corner].cast<double>();
          bind += weights[0] * mesh.morph_targets[0].normal_deltas[corner].cast<double>();
          Mat3d blended = Mat3d::Zero();
          for (const Influence& influence : mesh.weights.of(corner))
            blended += influence.weight * compute_normal_matrix(matrices[influence.slot].linear());
          normal += inside[i].parts[k] * (blended * bind);
        }
        ASSERT_LT((posed.position(old_count + i).cast<double>() - expected).norm(), 5e-7);
        ASSERT_LT((posed.normal(old_count + i).cast<double>() - normal).norm(), 1e-6);
        without = std::max(
            without,
            (deform_position_reference(mesh, old_count + i, matrices, weights) - expected).norm());
      }
      for (std::uint32_t v = 0; v < old_count; ++v)
        ASSERT_LT((posed.position(v).cast<double>() -
                   deform_position_reference(mesh, v, matrices, weights))
                      .norm(),
                  2e-6);
    }
    EXPECT_GT(without, 0.01) << "interpolated weights alone would not have stayed";
  }
}

TEST(ExactPoints, of_another_mesh_are_refused) {
  test::Random random(1);
  Mesh mesh = test::make_random_skin(random, {20, 4, 3, 1, false, 4});
  std::vector<Inside> inside;
  const InfluencePositions good = append_inside(random, mesh, 5, inside);
  const auto code_of = [&](const InfluencePositions& exact) {
    VertexSource source = source_of(mesh);
    source.per_influence = &exact;
    return SkinnedMesh::create(source, 4).error().code();
  };
  EXPECT_EQ(code_of(good), StatusCode::ok);
  InfluencePositions bad = good;
  bad.positions.pop_back();
  EXPECT_EQ(code_of(bad), StatusCode::size_mismatch);
  bad = good;
  bad.normals.clear();
  EXPECT_EQ(code_of(bad), StatusCode::size_mismatch);
  bad = good;
  bad.morph_targets.emplace_back();
  EXPECT_EQ(code_of(bad), StatusCode::size_mismatch);
  bad = good;
  bad.vertices.back() = 1000;
  EXPECT_EQ(code_of(bad), StatusCode::index_out_of_range);
  std::swap(bad.vertices[0], bad.vertices[1]);
  EXPECT_EQ(code_of(bad), StatusCode::index_out_of_range);
}

}  // namespace
}  // namespace sunder
