#include <sunder/bodies/mass_properties.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/internal/ordered.h"
#include "core/internal/out_of_memory.h"
#include "tear/bodies/open_edges.h"

namespace sunder {
namespace {

/// A body flatter than this, relative to the area to the power of 1.5, encloses no volume. (A ball
/// encloses 0.09.)
constexpr double kFlat = 1e-9;
/// Thickness of a shell without a given one, in square roots of its area.
constexpr double kThickness = 0.01;

/// The part of the integrals over an element that its size does not change: the triangle of three
/// corners, or the tetrahedron whose fourth corner is the origin.
struct ElementSums {
  Vec3d total;
  std::array<double, 6> products;  ///< xx, xy, xz, yy, yz, zz: rows of the upper triangle.

  ElementSums(const Vec3d& a, const Vec3d& b, const Vec3d& c) : total(a + b + c) {
    std::size_t k = 0;
    for (int i = 0; i < 3; ++i)
      for (int j = i; j < 3; ++j)
        products[k++] = total[i] * total[j] + a[i] * a[j] + b[i] * b[j] + c[i] * c[j];
  }
};

/// Integrals of 1, of p and of p p^T over tetrahedra or triangles.
struct Integrals {
  double sum = 0;
  Vec3d first = Vec3d::Zero();
  std::array<double, 6> second{};  ///< As ElementSums::products.

  /// Adds an element with equal weight everywhere. Exact for polynomials of the second degree.
  /// @param size   its area or volume. @param corners  3 or 4, the origin included.
  void add(double size, const ElementSums& of, double corners) {
    sum += size;
    first += size / corners * of.total;
    const double part = size / (corners * (corners + 1));
    for (std::size_t k = 0; k < 6; ++k) second[k] += part * of.products[k];
  }
  void add_tetrahedron(const Vec3d& a, const Vec3d& b, const Vec3d& c, const ElementSums& of) {
    add(dot(a, Vec3d(b.cross(c))) / 6, of, 4);
  }
  double add_triangle(const Vec3d& a, const Vec3d& b, const Vec3d& c, const ElementSums& of) {
    const double area = 0.5 * norm(Vec3d((b - a).cross(c - a)));
    add(area, of, 3);
    return area;
  }
};

/// Coordinates relative to the middle of the surface's box, in units of its size: far, tiny and
/// huge bodies lose nothing.
struct LocalFrame {
  Vec3d origin = Vec3d::Zero();
  double unit = 1;

  [[nodiscard]] Vec3d local(const Vec3d& position) const { return (position - origin) / unit; }
};

/// @param used  whether a triangle uses each position; those are finite.
LocalFrame frame_of(std::span<const Vec3d> positions, const std::vector<std::uint8_t>& used) {
  Vec3d least = Vec3d::Constant(HUGE_VAL), most = Vec3d::Constant(-HUGE_VAL);
  for (std::size_t v = 0; v < positions.size(); ++v) {
    if (!used[v]) continue;
    least = least.cwiseMin(positions[v]);
    most = most.cwiseMax(positions[v]);
  }
  const double size = (0.5 * most - 0.5 * least).maxCoeff();
  return {0.5 * least + 0.5 * most, size > 0 ? size : 1.0};
}

/// Marks the positions that triangles use. @return whether all of them exist and are finite.
bool mark_used(std::span<const Vec3d> positions, std::span<const Triangle> triangles,
               std::vector<std::uint8_t>& used) {
  for (const Triangle& triangle : triangles) {
    if (is_retired(triangle)) continue;
    for (const std::uint32_t vertex : triangle) {
      if (vertex >= positions.size()) return false;
      used[vertex] = 1;
    }
  }
  for (std::size_t v = 0; v < positions.size(); ++v)
    if (used[v] && !positions[v].allFinite()) return false;
  return true;
}

/// Names the first fault of a surface.
Status describe_fault(std::span<const Vec3d> positions, std::span<const Triangle> triangles) {
  bool has_any = false;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    if (is_retired(triangles[t])) continue;
    has_any = true;
    for (const std::uint32_t vertex : triangles[t]) {
      if (vertex >= positions.size())
        return Status::failure(StatusCode::index_out_of_range, t,
                               "triangle %u has vertex %u; there are %zu", t, vertex,
                               positions.size());
      if (!positions[vertex].allFinite())
        return Status::failure(StatusCode::non_finite_value, vertex,
                               "the position of vertex %u is not finite", vertex);
    }
  }
  return has_any ? Status()
                 : Status::failure(StatusCode::empty_input, kNone,
                                   "a body needs a surface; there is no triangle");
}

/// Mass and inertia in the units of the positions.
/// @param of       in the local frame. @param thickness  of a shell, otherwise 1.
void write(const Integrals& of, const LocalFrame& frame, double thickness, double density,
           MassProperties& mass) {
  const double unit = frame.unit;
  const double powers = mass.rule == SolidRule::shell ? unit * unit : unit * unit * unit;
  mass.volume = of.sum * powers * thickness;
  mass.mass = density * mass.volume;
  const Vec3d centre = of.sum != 0 ? Vec3d(of.first / of.sum) : Vec3d(Vec3d::Zero());
  mass.centre = frame.origin + unit * centre;
  Mat3d covariance;
  std::size_t k = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j)
      covariance(i, j) = covariance(j, i) = of.second[k++] - of.sum * centre[i] * centre[j];
  const double scale = density * thickness * powers * unit * unit;
  mass.inertia = scale * (trace(covariance) * Mat3d::Identity() - covariance);
}

}  // namespace

Status validate(const MassOptions& options) {
  if (!(options.density > 0) || !std::isfinite(options.density))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the density is %g; it must be finite and above 0", options.density);
  if (!(options.shell_thickness >= 0) || !std::isfinite(options.shell_thickness))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the thickness of shells is %g; it must be finite and not below 0",
                           options.shell_thickness);
  if (options.open_surfaces != SolidRule::fans && options.open_surfaces != SolidRule::shell)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "open surfaces are closed by fans, or shells");
  return {};
}

Result<MassProperties> compute_mass(std::span<const Vec3d> positions,
                                    std::span<const Triangle> triangles,
                                    const MassOptions& options) {
  if (Status status = validate(options); !status) return status;
  return or_out_of_memory([&]() -> Result<MassProperties> {
    std::vector<std::uint8_t> used(positions.size(), 0);
    if (!mark_used(positions, triangles, used) || std::ranges::count(used, 1) == 0)
      return describe_fault(positions, triangles);
    const LocalFrame frame = frame_of(positions, used);
    std::vector<Vec3d> local;
    local.reserve(positions.size());
    for (const Vec3d& position : positions) local.push_back(frame.local(position));
    Integrals body, shell;
    MassProperties mass;
    for (const Triangle& triangle : triangles) {
      if (is_retired(triangle)) continue;
      const Vec3d &a = local[triangle[0]], &b = local[triangle[1]], &c = local[triangle[2]];
      const ElementSums sums(a, b, c);
      body.add_tetrahedron(a, b, c, sums);
      mass.area += shell.add_triangle(a, b, c, sums);
    }
    const bodies::OpenEdges open = bodies::find_open_edges(positions, triangles);
    mass.holes = static_cast<std::uint32_t>(open.groups.size());
    for (const auto& edges : open.groups) {
      Vec3d moment = Vec3d::Zero(), middle = Vec3d::Zero();
      double length = 0;
      for (const auto& [from, to] : edges) {
        const Vec3d &a = local[from], &b = local[to];
        const double of_edge = norm(Vec3d(b - a));
        moment += of_edge * 0.5 * (a + b);
        length += of_edge;
      }
      if (length > 0) middle = moment / length;
      for (const auto& [from, to] : edges)
        body.add_tetrahedron(local[to], local[from], middle, {local[to], local[from], middle});
    }
    if (body.sum < 0) {  // inside out
      body.sum = -body.sum;
      body.first = -body.first;
      for (double& product : body.second) product = -product;
    }
    mass.rule = mass.holes == 0 ? SolidRule::closed : options.open_surfaces;
    if (!(body.sum > kFlat * mass.area * std::sqrt(mass.area))) mass.rule = SolidRule::shell;
    const double area = mass.area;
    mass.area = area * frame.unit * frame.unit;
    if (mass.rule == SolidRule::shell) {
      const double thickness = options.shell_thickness > 0
                                   ? options.shell_thickness
                                   : kThickness * std::sqrt(area) * frame.unit;
      write(shell, frame, thickness, options.density, mass);
    } else {
      write(body, frame, 1, options.density, mass);
    }
    return mass;
  });
}

PrincipalAxes principal_axes(const Mat3d& inertia) {
  constexpr int kSweeps = 32;  // four suffice; each squares what is left off the diagonal
  Mat3d a = inertia, axes = Mat3d::Identity();
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    if (a(0, 1) == 0 && a(0, 2) == 0 && a(1, 2) == 0) break;
    for (int p = 0; p < 2; ++p)
      for (int q = p + 1; q < 3; ++q) {
        if (a(p, q) == 0) continue;
        const double half = 0.5 * (a(q, q) - a(p, p)) / a(p, q);
        const double tangent = (half < 0 ? -1 : 1) / (std::abs(half) + std::sqrt(half * half + 1));
        const double cosine = 1 / std::sqrt(tangent * tangent + 1), sine = tangent * cosine;
        const double moved = tangent * a(p, q);
        const int r = 3 - p - q;
        const double rp = a(r, p), rq = a(r, q);
        a(p, p) -= moved;
        a(q, q) += moved;
        a(p, q) = a(q, p) = 0;
        a(r, p) = a(p, r) = cosine * rp - sine * rq;
        a(r, q) = a(q, r) = sine * rp + cosine * rq;
        for (int k = 0; k < 3; ++k) {
          const double kp = axes(k, p), kq = axes(k, q);
          axes(k, p) = cosine * kp - sine * kq;
          axes(k, q) = sine * kp + cosine * kq;
        }
      }
  }
  std::array<int, 3> order = {0, 1, 2};
  std::stable_sort(order.begin(), order.end(), [&](int i, int j) { return a(i, i) < a(j, j); });
  PrincipalAxes result;
  for (int i = 0; i < 3; ++i) {
    result.moments[i] = a(order[static_cast<std::size_t>(i)], order[static_cast<std::size_t>(i)]);
    result.axes.col(i) = axes.col(order[static_cast<std::size_t>(i)]);
  }
  if (determinant(result.axes) < 0) result.axes.col(2) = -result.axes.col(2);
  return result;
}

}  // namespace sunder
