#pragma once

#include <sunder/core/mesh.h>

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

namespace sunder::test {

/// A closed surface.
struct Solid {
  std::vector<Vec3d> positions;
  std::vector<Triangle> triangles;
};

inline void append(const Solid& more, Solid& to) {
  const auto first = static_cast<std::uint32_t>(to.positions.size());
  to.positions.insert(to.positions.end(), more.positions.begin(), more.positions.end());
  for (const auto& [a, b, c] : more.triangles)
    to.triangles.push_back({a + first, b + first, c + first});
}

/// A box around the origin; two triangles per side.
inline Solid make_box(const Vec3d& size) {
  Solid box;
  for (std::uint32_t corner = 0; corner < 8; ++corner)
    box.positions.emplace_back(((corner & 1) != 0 ? 0.5 : -0.5) * size[0],
                               ((corner & 2) != 0 ? 0.5 : -0.5) * size[1],
                               ((corner & 4) != 0 ? 0.5 : -0.5) * size[2]);
  constexpr std::array<std::array<std::uint32_t, 4>, 6> kSides = {
      {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
  for (const auto& [a, b, c, d] : kSides) {
    box.triangles.push_back({a, b, c});
    box.triangles.push_back({a, c, d});
  }
  return box;
}

/// A unit ball: an octahedron whose triangles are divided `levels` times.
inline Solid make_ball(int levels) {
  Solid ball;
  ball.positions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  ball.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                    {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [known, is_new] = middles.try_emplace(
          {std::min(a, b), std::max(a, b)}, static_cast<std::uint32_t>(ball.positions.size()));
      if (is_new)
        ball.positions.push_back(Vec3d(ball.positions[a] + ball.positions[b]).normalized());
      return known->second;
    };
    std::vector<Triangle> finer;
    for (const auto& [a, b, c] : ball.triangles) {
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      for (const Triangle& part : {Triangle{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}})
        finer.push_back(part);
    }
    ball.triangles = std::move(finer);
  }
  return ball;
}

/// Around the z axis.
inline Solid make_torus(double ring, double tube, std::uint32_t around, std::uint32_t across) {
  Solid torus;
  for (std::uint32_t i = 0; i < around; ++i)
    for (std::uint32_t j = 0; j < across; ++j) {
      const double u = 2 * std::numbers::pi * i / around, v = 2 * std::numbers::pi * j / across;
      const double radius = ring + tube * std::cos(v);
      torus.positions.emplace_back(radius * std::cos(u), radius * std::sin(u), tube * std::sin(v));
      const std::uint32_t i1 = (i + 1) % around, j1 = (j + 1) % across;
      const std::uint32_t a = i * across + j, b = i1 * across + j, c = i1 * across + j1,
                          d = i * across + j1;
      torus.triangles.push_back({a, b, c});
      torus.triangles.push_back({a, c, d});
    }
  return torus;
}

}  // namespace sunder::test
