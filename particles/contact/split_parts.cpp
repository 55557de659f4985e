#include "particles/contact/split_parts.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>
#include <variant>

#include "core/internal/ordered.h"
#include "particles/internal/fitted_shape.h"

namespace sunder::particles {
namespace {

constexpr double kThinnest = 1e-4;         ///< Metres; flat parts get a thickness.
constexpr double kLeastGain = 0.05;        ///< Of the volume of all.
constexpr int kCuts = 9;                   ///< Places along an axis that are tried.
constexpr std::size_t kMostTried = 1'500;  ///< Items by which cuts are compared.

double volume_of(const Collider& collider) {
  if (const auto* const ball = std::get_if<Collider::Sphere>(&collider.shape))
    return 4.0 / 3 * std::numbers::pi * ball->radius * ball->radius * ball->radius;
  if (const auto* const capsule = std::get_if<Collider::Capsule>(&collider.shape))
    return std::numbers::pi * capsule->radius * capsule->radius *
           (2 * capsule->half_length + 4.0 / 3 * capsule->radius);
  return 8 * std::get<Collider::Box>(collider.shape).half_size.prod();
}

/// Indices of a triangle's corners, or of a point three times.
using Item = std::array<std::uint32_t, 3>;
using Points = std::vector<Vec3d>;

Vec3d middle_of(const Points& points, const Item& item) {
  return (points[item[0]] + points[item[1]] + points[item[2]]) / 3;
}

std::vector<Item> items_of(const PartOfBone& part) {
  std::vector<Item> items = part.triangles;
  std::vector<bool> is_in_triangle(part.points.size());
  for (const Item& corners : items)
    for (const std::uint32_t corner : corners) is_in_triangle[corner] = true;
  for (std::uint32_t i = 0; i < part.points.size(); ++i)
    if (!is_in_triangle[i]) items.push_back({i, i, i});
  return items;
}

/// The box along the axes of the frame.
Collider straight_box(const Points& points, double friction) {
  Vec3d low = points[0], high = points[0];
  for (const Vec3d& point : points) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  return {Collider::Box{Vec3d((high - low) / 2).cwiseMax(kThinnest)}, (low + high) / 2,
          Quatd::Identity(), friction};
}

/// The shape of least volume around all points of some items.
Collider shape_of(const Points& points, const std::vector<Item>& items, double friction) {
  std::vector<std::uint32_t> corners;
  for (const Item& item : items) corners.insert(corners.end(), item.begin(), item.end());
  std::ranges::sort(corners);
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  Points held;
  for (const std::uint32_t corner : corners) held.push_back(points[corner]);
  const Collider straight = straight_box(held, friction);
  const Collider fitted = fitted_shape(std::move(held), friction);
  return volume_of(straight) <= volume_of(fitted) ? straight : fitted;
}

struct Cut {
  Vec3d axis = Vec3d::UnitX();
  double at = 0;
  double volume = std::numeric_limits<double>::infinity();  ///< Of both halves.
};

std::array<std::vector<Item>, 2> halves_of(const Points& points, const std::vector<Item>& items,
                                           const Cut& cut) {
  std::array<std::vector<Item>, 2> halves;
  for (const Item& item : items)
    halves[dot(middle_of(points, item), cut.axis) < cut.at ? 0 : 1].push_back(item);
  return halves;
}

/// A shape, and the best cut through it.
struct Piece {
  std::vector<Item> items;
  Collider shape;
  double volume = 0;
  Cut cut;

  Piece(const Points& points, std::vector<Item> of, double friction)
      : items(std::move(of)), shape(shape_of(points, items, friction)), volume(volume_of(shape)) {
    std::vector<Item> some;
    const std::size_t stride = items.size() / kMostTried + 1;
    for (std::size_t i = 0; i < items.size(); i += stride) some.push_back(items[i]);
    const Mat3d axes(shape.turn);
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      try_axis(points, some, axes.col(axis));
      try_axis(points, some, Vec3d::Unit(axis));
    }
  }

 private:
  void try_axis(const Points& points, const std::vector<Item>& some, const Vec3d& axis) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Item& item : some) {
      low = std::min(low, dot(middle_of(points, item), axis));
      high = std::max(high, dot(middle_of(points, item), axis));
    }
    for (int i = 1; i <= kCuts; ++i) {
      Cut tried{axis, low + (high - low) * i / (kCuts + 1)};
      const auto halves = halves_of(points, some, tried);
      if (halves[0].empty() || halves[1].empty()) continue;
      tried.volume =
          volume_of(shape_of(points, halves[0], 0)) + volume_of(shape_of(points, halves[1], 0));
      if (tried.volume < cut.volume) cut = tried;
    }
  }
};

}  // namespace

std::vector<Collider> split_shapes(const PartOfBone& part, double friction, std::uint32_t most) {
  std::vector<Piece> pieces;
  pieces.emplace_back(part.points, items_of(part), friction);
  while (pieces.size() < most) {
    double all = 0;
    for (const Piece& piece : pieces) all += piece.volume;
    const auto best = std::ranges::max_element(
        pieces, {}, [](const Piece& piece) { return piece.volume - piece.cut.volume; });
    if (best->volume - best->cut.volume < kLeastGain * all) break;
    auto halves = halves_of(part.points, best->items, best->cut);
    Piece first(part.points, std::move(halves[0]), friction);
    Piece second(part.points, std::move(halves[1]), friction);
    // Cuts are compared by some of the items: all of them may say otherwise.
    if (first.volume + second.volume > best->volume) {
      best->cut.volume = best->volume;
      continue;
    }
    *best = std::move(first);
    pieces.push_back(std::move(second));
  }
  std::vector<Collider> shapes;
  for (const Piece& piece : pieces) shapes.push_back(piece.shape);
  return shapes;
}

}  // namespace sunder::particles
