#include "support/oracles/contact_oracle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/LU>

namespace sunder::test {
namespace {

double point_to_segment(const Vec3d& point, const Vec3d& a, const Vec3d& b) {
  const Vec3d way = b - a;
  const double square = way.squaredNorm();
  const double t = square > 0 ? std::clamp((point - a).dot(way) / square, 0.0, 1.0) : 0.0;
  return (a + t * way - point).norm();
}

/// The least value of a convex function on [0, 1].
template <class Function>
double least_of_convex(Function function) {
  constexpr double kGolden = 0.6180339887498949;
  double low = 0, high = 1;
  double a = high - kGolden * (high - low), b = low + kGolden * (high - low);
  double at_a = function(a), at_b = function(b);
  for (int i = 0; i < 80; ++i) {
    if (at_a < at_b) {
      high = b;
      b = a;
      at_b = at_a;
      a = high - kGolden * (high - low);
      at_a = function(a);
    } else {
      low = a;
      a = b;
      at_a = at_b;
      b = low + kGolden * (high - low);
      at_b = function(b);
    }
  }
  return std::min({at_a, at_b, function(0), function(1)});
}

}  // namespace

double point_distance(const Vec3d& point, const std::array<Vec3d, 3>& corners) {
  double least = std::min({point_to_segment(point, corners[0], corners[1]),
                           point_to_segment(point, corners[1], corners[2]),
                           point_to_segment(point, corners[2], corners[0])});
  // The foot in the plane, from a linear system of edges and normal.
  Eigen::Matrix3d basis;
  basis.col(0) = corners[1] - corners[0];
  basis.col(1) = corners[2] - corners[0];
  basis.col(2) = basis.col(0).cross(basis.col(1));
  const double area = basis.col(2).norm();
  const double longest = std::max(basis.col(0).norm(), basis.col(1).norm());
  if (!(area > 1e-12 * longest * longest)) return least;  // a line
  basis.col(2) /= area;
  const Eigen::Vector3d at = basis.fullPivLu().solve(Eigen::Vector3d(point - corners[0]));
  if (at.x() >= 0 && at.y() >= 0 && at.x() + at.y() <= 1) least = std::min(least, std::abs(at.z()));
  return least;
}

ContactOracle::ContactOracle(const Character& character,
                             const std::vector<std::vector<Vec3d>>& positions) {
  for (std::uint32_t m = 0; m < character.meshes.size(); ++m)
    for (std::uint32_t t = 0; t < character.meshes[m].triangle_count(); ++t) {
      const Triangle& of = character.meshes[m].triangles[t];
      if (is_retired(of)) continue;
      const Face face{m, t, {positions[m][of[0]], positions[m][of[1]], positions[m][of[2]]}};
      const auto& [a, b, c] = face.corners;
      if (a == b || b == c || c == a) continue;  // a line is no part of the surface
      faces_.push_back(face);
    }
}

std::vector<ContactOracle::Crossing> ContactOracle::crossings(const Vec3d& base, const Vec3d& way,
                                                              double margin) const {
  std::vector<Crossing> found;
  for (const Face& face : faces_) {
    // base + t way = a + u (b - a) + v (c - a), as a linear system.
    Eigen::Matrix3d system;
    system.col(0) = face.corners[1] - face.corners[0];
    system.col(1) = face.corners[2] - face.corners[0];
    system.col(2) = -way;
    const double size = system.col(0).norm() * system.col(1).norm() * system.col(2).norm();
    if (!(std::abs(system.determinant()) > 1e-12 * size)) continue;
    const Eigen::Vector3d at = system.fullPivLu().solve(Eigen::Vector3d(base - face.corners[0]));
    const double least = std::min({at.x(), at.y(), 1 - at.x() - at.y()});
    if (least < -margin || at.z() < 0) continue;
    const Eigen::Vector3d normal = system.col(0).cross(system.col(1));
    found.push_back({&face, at.z(), normal.dot(way) < 0, least});
  }
  std::sort(found.begin(), found.end(),
            [](const Crossing& a, const Crossing& b) { return a.along < b.along; });
  return found;
}

double ContactOracle::distance(const Vec3d& base, const Vec3d& tip) const {
  double least = std::numeric_limits<double>::infinity();
  for (const Face& face : faces_) {
    // A convex function of the place on the segment.
    const auto at = [&](double t) { return point_distance(base + t * (tip - base), face.corners); };
    const double ends = std::min(at(0), at(1));
    if (ends - (tip - base).norm() > least) continue;
    least = std::min(least, base == tip ? ends : least_of_convex(at));
  }
  return least;
}

double ContactOracle::winding(const Vec3d& point) const {
  // van Oosterom and Strackee 1983
  double sum = 0;
  for (const Face& face : faces_) {
    const Vec3d a = face.corners[0] - point, b = face.corners[1] - point,
                c = face.corners[2] - point;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    sum += 2 * std::atan2(a.dot(b.cross(c)),
                          la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (4 * std::numbers::pi);
}

}  // namespace sunder::test
