// The interpolation error of docs/weights.md, in double.

#include <map>

#include <gtest/gtest.h>

#include "support/models/random_skin.h"
#include "weights/internal/animation_point.h"

namespace sunder {
namespace {

constexpr std::uint32_t kSlots = 10;

using Weights = std::map<std::uint32_t, double>;

Weights weights_of(const Mesh& mesh, std::uint32_t vertex, double part = 1, Weights weights = {}) {
  for (const Influence& influence : mesh.weights.of(vertex))
    weights[influence.slot] += part * static_cast<double>(influence.weight);
  return weights;
}

Eigen::Vector3d posed(const std::vector<Affine3d>& palette, const Weights& weights,
                      const Eigen::Vector3d& position) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& [slot, weight] : weights) sum += weight * (palette[slot] * position);
  return sum;
}

/// sum_i (w_a,i - w_b,i) R_i v
Eigen::Vector3d turned_apart(const std::vector<Affine3d>& palette, const Weights& a,
                             const Weights& b, const Eigen::Vector3d& v) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& [slot, weight] : a) sum += weight * (palette[slot].linear() * v);
  for (const auto& [slot, weight] : b) sum -= weight * (palette[slot].linear() * v);
  return sum;
}

class InterpolationError : public testing::Test {
 protected:
  /// Calls with three vertices and their barycentric coordinates, and a palette with scale and
  /// shear.
  template <class Check>
  void in_many_triangles(Check check) {
    test::Random random(7);
    for (int i = 0; i < 20; ++i) {
      const Mesh mesh = test::make_random_skin(
          random, {.vertices = 100, .slots = kSlots, .influences = 6, .spread = kSlots});
      const auto palette = test::random_palette(random, kSlots, 2);
      for (int k = 0; k < 100; ++k) {
        const double u = random.uniform(0, 1), v = random.uniform(0, 1 - u);
        const Triangle corners = {random.index(100), random.index(100), random.index(100)};
        check(mesh, palette, corners, std::array<double, 3>{1 - u - v, u, v});
      }
    }
  }
};

TEST_F(InterpolationError, on_an_edge_is_the_closed_form) {
  in_many_triangles([](const Mesh& mesh, const std::vector<Affine3d>& palette,
                       const Triangle& corners, const auto& barycentric) {
    const double t = barycentric[1];
    const Eigen::Vector3d a = mesh.positions[corners[0]].cast<double>(),
                          b = mesh.positions[corners[1]].cast<double>();
    const Weights of_a = weights_of(mesh, corners[0]), of_b = weights_of(mesh, corners[1]);
    const Weights of_new = weights_of(mesh, corners[1], t, weights_of(mesh, corners[0], 1 - t));
    const Eigen::Vector3d error = posed(palette, of_new, (1 - t) * a + t * b) -
                                  ((1 - t) * posed(palette, of_a, a) + t * posed(palette, of_b, b));
    EXPECT_LT((error + t * (1 - t) * turned_apart(palette, of_a, of_b, a - b)).norm(), 1e-12);
  });
}

TEST_F(InterpolationError, in_a_triangle_is_the_closed_form) {
  in_many_triangles([](const Mesh& mesh, const std::vector<Affine3d>& palette,
                       const Triangle& corners, const auto& barycentric) {
    Eigen::Vector3d position = Eigen::Vector3d::Zero(), expected = Eigen::Vector3d::Zero();
    Weights of_new;
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d corner = mesh.positions[corners[k]].cast<double>();
      position += barycentric[k] * corner;
      of_new = weights_of(mesh, corners[k], barycentric[k], of_new);
      expected += barycentric[k] * posed(palette, weights_of(mesh, corners[k]), corner);
      for (std::size_t l = k + 1; l < 3; ++l)
        expected -=
            barycentric[k] * barycentric[l] *
            turned_apart(palette, weights_of(mesh, corners[k]), weights_of(mesh, corners[l]),
                         corner - mesh.positions[corners[l]].cast<double>());
    }
    EXPECT_LT((posed(palette, of_new, position) - expected).norm(), 1e-12);
  });
}

TEST_F(InterpolationError, an_animation_point_has_none) {
  in_many_triangles([](const Mesh& mesh, const std::vector<Affine3d>& palette,
                       const Triangle& corners, const auto& barycentric) {
    AnimationPoint point, of_points;
    Eigen::Vector3d expected = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d corner = mesh.positions[corners[k]].cast<double>();
      point.add(barycentric[k], corner, mesh.weights.of(corners[k]));
      AnimationPoint of_corner;
      of_corner.add(1, corner, mesh.weights.of(corners[k]));
      of_points.add(barycentric[k], of_corner);
      expected += barycentric[k] * posed(palette, weights_of(mesh, corners[k]), corner);
    }
    EXPECT_LT((point.posed(palette) - expected).norm(), 1e-12 * (1 + expected.norm()));
    EXPECT_LT((of_points.posed(palette) - expected).norm(), 1e-12 * (1 + expected.norm()));
  });
}

}  // namespace
}  // namespace sunder
