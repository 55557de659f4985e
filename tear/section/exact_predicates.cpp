#include "tear/section/exact_predicates.h"

#include <array>
#include <cmath>

namespace sunder::tear {
namespace {

// Expansions: Shewchuk, "Adaptive precision floating-point arithmetic and fast robust geometric
// predicates", 1997.

struct Pair {
  double value;  ///< The rounded result.
  double error;  ///< The rounding error: the exact result is value + error.
};

Pair two_sum(double a, double b) {
  const double sum = a + b;
  const double b_part = sum - a;
  return {sum, (a - (sum - b_part)) + (b - b_part)};
}

Pair split(double a) {
  const double c = 134217729.0 * a;  // 2^27 + 1
  const double high = c - (c - a);
  return {high, a - high};
}

Pair two_product(double a, double b) {
  const double product = a * b;
  const Pair x = split(a), y = split(b);
  return {product, x.error * y.error -
                       (((product - x.value * y.value) - x.error * y.value) - x.value * y.error)};
}

/// A number as an exact sum of at most N non-zero doubles that do not overlap, the smallest first.
template <int N>
struct Expansion {
  std::array<double, N> component{};
  int count = 0;

  void append(double value) {
    if (value != 0) component[static_cast<std::size_t>(count++)] = value;
  }
  void add(double value) {
    const int before = count;
    count = 0;
    for (int i = 0; i < before; ++i) {
      const Pair sum = two_sum(value, component[static_cast<std::size_t>(i)]);
      append(sum.error);
      value = sum.value;
    }
    append(value);
  }
  template <int M>
  void add(const Expansion<M>& other, double sign = 1) {
    for (int i = 0; i < other.count; ++i) add(sign * other.component[static_cast<std::size_t>(i)]);
  }
  [[nodiscard]] int sign() const {
    if (count == 0) return 0;
    return component[static_cast<std::size_t>(count - 1)] > 0 ? 1 : -1;
  }
};

Expansion<2> exact_difference(double a, double b) {
  const Pair pair = two_sum(a, -b);
  Expansion<2> result;
  result.append(pair.error);
  result.append(pair.value);
  return result;
}

template <int N, int M>
Expansion<2 * N * M> exact_product(const Expansion<N>& a, const Expansion<M>& b) {
  Expansion<2 * N * M> result;
  for (int i = 0; i < a.count; ++i)
    for (int j = 0; j < b.count; ++j) {
      const Pair pair = two_product(a.component[static_cast<std::size_t>(i)],
                                    b.component[static_cast<std::size_t>(j)]);
      if (pair.error != 0) result.add(pair.error);
      result.add(pair.value);
    }
  return result;
}

/// ax * by - ay * bx.
Expansion<16> exact_cross(const Expansion<2>& ax, const Expansion<2>& ay, const Expansion<2>& bx,
                          const Expansion<2>& by) {
  Expansion<16> result;
  result.add(exact_product(ax, by));
  result.add(exact_product(ay, bx), -1);
  return result;
}

Expansion<16> exact_squared_norm(const Expansion<2>& x, const Expansion<2>& y) {
  Expansion<16> result;
  result.add(exact_product(x, x));
  result.add(exact_product(y, y));
  return result;
}

}  // namespace

namespace predicates {

int exact_orientation(const Vec2d& a, const Vec2d& b, const Vec2d& c) {
  return exact_cross(exact_difference(a.x(), c.x()), exact_difference(a.y(), c.y()),
                     exact_difference(b.x(), c.x()), exact_difference(b.y(), c.y()))
      .sign();
}

int exact_in_circle(const Vec2d& a, const Vec2d& b, const Vec2d& c, const Vec2d& d) {
  const auto ax = exact_difference(a.x(), d.x()), ay = exact_difference(a.y(), d.y());
  const auto bx = exact_difference(b.x(), d.x()), by = exact_difference(b.y(), d.y());
  const auto cx = exact_difference(c.x(), d.x()), cy = exact_difference(c.y(), d.y());
  Expansion<3 * 512> result;
  result.add(exact_product(exact_squared_norm(ax, ay), exact_cross(bx, by, cx, cy)));
  result.add(exact_product(exact_squared_norm(bx, by), exact_cross(cx, cy, ax, ay)));
  result.add(exact_product(exact_squared_norm(cx, cy), exact_cross(ax, ay, bx, by)));
  return result.sign();
}

}  // namespace predicates

std::optional<Vec2d> exact_range(const Vec2d& point) {
  Vec2d result = point;
  for (int axis = 0; axis < 2; ++axis) {
    if (!(std::abs(result[axis]) <= 0x1p200)) return std::nullopt;
    if (std::abs(result[axis]) < 0x1p-200) result[axis] = 0;
  }
  return result;
}

int area_sign(std::span<const Vec2d> loop) {
  if (loop.size() < 3) return 0;
  double area = 0, magnitude = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vec2d a = loop[i] - loop[0], b = loop[(i + 1) % loop.size()] - loop[0];
    area += a.x() * b.y() - a.y() * b.x();
    magnitude += std::abs(a.x() * b.y()) + std::abs(a.y() * b.x());
  }
  if (std::abs(area) >
      2 * static_cast<double>(loop.size() + 8) * predicates::kUnitRoundoff * magnitude)
    return predicates::sign_of(area);
  Expansion<1024>
      exact;  // more bits than lie between the smallest and the largest product in range
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vec2d &a = loop[i], &b = loop[(i + 1) % loop.size()];
    const Pair positive = two_product(a.x(), b.y()), negative = two_product(a.y(), b.x());
    for (const double part : {positive.error, positive.value, -negative.error, -negative.value})
      exact.add(part);
  }
  return exact.sign();
}

}  // namespace sunder::tear
