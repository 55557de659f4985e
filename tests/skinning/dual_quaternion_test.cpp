#include <sunder/skinning/skinned_mesh.h>

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "skinning/internal/reference.h"
#include "support/models/posed_arrays.h"
#include "support/models/random_skin.h"

namespace sunder {
namespace {

/// The definition for rigid bones, in double: blended unit dual quaternions, each with the sign
/// that agrees with the sum before it.
Vec3d pose_by_definition(const Mesh& mesh, std::uint32_t v, const std::vector<Affine3d>& matrices) {
  std::vector<Influence> influences(mesh.weights.of(v).begin(), mesh.weights.of(v).end());
  std::sort(influences.begin(), influences.end(),
            [](const Influence& a, const Influence& b) { return a.slot < b.slot; });
  Eigen::Vector4d real = Eigen::Vector4d::Zero(), dual = real;
  for (const Influence& influence : influences) {
    const Eigen::Quaterniond turn(Eigen::Matrix3d(matrices[influence.slot].linear()));
    const Vec3d t = matrices[influence.slot].translation();
    const Eigen::Quaterniond moved = Eigen::Quaterniond(0, t.x(), t.y(), t.z()) * turn;
    const double weight = real.dot(turn.coeffs()) < 0 ? -influence.weight : influence.weight;
    real += weight * turn.coeffs();
    dual += weight * 0.5 * moved.coeffs();
  }
  dual /= real.norm();
  real /= real.norm();
  const Eigen::Quaterniond turn(real[3], real[0], real[1], real[2]);
  const Eigen::Quaterniond translation =
      Eigen::Quaterniond(2 * dual[3], 2 * dual[0], 2 * dual[1], 2 * dual[2]) * turn.conjugate();
  return Vec3d(turn * Eigen::Vector3d(mesh.positions[v].cast<double>())) + Vec3d(translation.vec());
}

void pose(const Mesh& mesh, const std::vector<Affine3f>& matrices, const VertexTarget& target,
          SkinningMethod method = SkinningMethod::dual_quaternion) {
  const auto made = SkinnedMesh::create(source_of(mesh), matrices.size());
  ASSERT_TRUE(made) << made.error().text();
  BonePalette palette = *BonePalette::create(matrices.size(), 0, method);
  ASSERT_TRUE(palette.set(matrices, {}));
  PosedBuffer buffer(target);
  ASSERT_TRUE(made->deform(palette, buffer));
}

TEST(DualQuaternion, agrees_with_the_definition_in_double) {
  test::Random random(1);
  for (const test::RandomSkin& kind :
       {test::RandomSkin{500, 12, 4, 0, false, 6}, test::RandomSkin{300, 200, 3, 0, false, 200}}) {
    const Mesh mesh = test::make_random_skin(random, kind);
    auto matrices = test::random_palette(random, kind.slots);
    for (Affine3d& matrix :
         matrices) {  // close to each other, because opposite rotations have no mean
      const Eigen::AngleAxisd turn(Eigen::Matrix3d(matrix.linear()));
      matrix.linear() = Eigen::AngleAxisd(turn.angle() / 3, turn.axis()).toRotationMatrix();
    }
    test::PosedArrays posed(mesh);
    pose(mesh, test::in_float(matrices), posed.target());
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v)
      ASSERT_LT((posed.position(v).cast<double>() - pose_by_definition(mesh, v, matrices)).norm(),
                1e-6)
          << "vertex " << v;
  }
}

TEST(DualQuaternion, with_one_influence_equals_its_matrix) {
  test::Random random(2);
  const Mesh mesh = test::make_random_skin(random, {300, 10, 1, 0, true, 10});
  const auto matrices =
      test::in_float(test::random_palette(random, 10, 1.5));  // stretched, sheared, some mirrored
  test::PosedArrays by_motions(mesh, 0, true), by_matrices(mesh, 0, true);
  pose(mesh, matrices, by_motions.target());
  pose(mesh, matrices, by_matrices.target(), SkinningMethod::linear);
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    EXPECT_LT((by_motions.position(v) - by_matrices.position(v)).norm(), 2e-6f);
    EXPECT_LT((by_motions.normal(v) - by_matrices.normal(v)).norm(), 5e-6f);
    EXPECT_LT((by_motions.tangent(v) - by_matrices.tangent(v)).norm(), 5e-6f);
  }
}

TEST(DualQuaternion, a_twist_keeps_the_distance_from_its_axis) {
  Mesh mesh;
  for (int i = 0; i < 100; ++i) {
    const double angle = 0.1 * i, upper = i / 100.0;
    mesh.positions.push_back(Vec3d(std::cos(angle), 0, std::sin(angle)).cast<float>());
    const Influence both[] = {{0, static_cast<float>(1 - upper)}, {1, static_cast<float>(upper)}};
    mesh.weights.append(both);
  }
  std::vector<Affine3f> matrices(2, Affine3f::Identity());
  matrices[1].linear() =
      Eigen::AngleAxisf(0.9f * std::numbers::pi_v<float>, Eigen::Vector3f::UnitY())
          .toRotationMatrix();
  test::PosedArrays posed(mesh), collapsed(mesh);
  pose(mesh, matrices, posed.target());
  pose(mesh, matrices, collapsed.target(), SkinningMethod::linear);
  float least = 1;
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    EXPECT_NEAR(posed.position(v).norm(), 1.0f, 1e-6f);
    least = std::min(least, collapsed.position(v).norm());
  }
  EXPECT_LT(least, 0.2f) << "blended matrices make a candy wrapper of it";
}

}  // namespace
}  // namespace sunder
