#include "tear/wound_mask/rivulets.h"

#include <numbers>
#include <utility>

#include "core/internal/elementary.h"

namespace sunder::tear {
namespace {

constexpr double kFlattest = 0.12;    ///< Sine of the incline at which blood stops.
constexpr double kStepOfWidth = 1.5;  ///< Length of a part, in widths.
constexpr double kWander = 0.5;       ///< Radians to either side.
constexpr double kWaves = 2.5;        ///< Of the wandering, along the longest rivulet.
constexpr double kNarrowing = 0.6;    ///< By the end of a rivulet, of its radius.
constexpr int kMostParts = 4096;      ///< Of a rivulet.

/// A number of [0, 1) for each triple.
double hashed(std::uint64_t seed, std::uint64_t a, std::uint64_t b) {
  std::uint64_t h = seed ^ a * 0x9e3779b97f4a7c15u ^ b * 0xc2b2ae3d27d4eb4fu;
  h = (h ^ h >> 30) * 0xbf58476d1ce4e5b9u;
  h = (h ^ h >> 27) * 0x94d049bb133111ebu;
  return static_cast<double>((h ^ h >> 31) >> 11) / 9007199254740992.0;
}

std::array<double, 3> between(const std::array<double, 3>& a, const std::array<double, 3>& b,
                              double part) {
  return {a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1]), a[2] + part * (b[2] - a[2])};
}

}  // namespace

Rivulets::Rivulets(const Character& source, const FlatFaces& faces,
                   std::span<const std::vector<Vec3f>> posed, const BloodFlowOptions& options,
                   IsRemoved is_removed)
    : source_(source),
      faces_(faces),
      posed_(posed),
      options_(options),
      is_removed_(std::move(is_removed)) {
  options_.down.normalize();
}

Vec3d Rivulets::corner(Index half_edge) const {
  const TriangleRef of = faces_.surface.triangle(half_edge / 3);
  return posed_[of.mesh][source_.meshes[of.mesh].triangles[of.triangle][half_edge % 3]]
      .cast<double>();
}

void Rivulets::run_from(Index face, std::span<const LipSegment> lips) {
  for (std::size_t i = 0; i < lips.size(); ++i) {
    const auto& [a, b] = lips[i].ends;
    const double long_is = length(faces_.place(face, b) - faces_.place(face, a));
    const std::uint64_t seed =
        options_.seed + (std::uint64_t{face} << 24 | static_cast<std::uint64_t>(i));
    const double wanted = std::min(long_is / options_.spacing, 1e4) + hashed(seed, 0, 0);
    for (std::uint64_t k = 1; static_cast<double>(k) <= wanted; ++k) {
      const double size = hashed(seed, k, 2);
      Run run;
      run.face = face;
      run.at = between(a, b, hashed(seed, k, 1));
      run.length = options_.length * (0.15 + 0.85 * size * size);
      run.radius = 0.5 * options_.width * (0.55 + 0.45 * size);
      run.phase = 2 * std::numbers::pi * hashed(seed, k, 3);
      follow(run);
    }
  }
}

bool Rivulets::descend(const Run& run, Place& rate) const {
  const Vec3d origin = corner(3 * run.face), b = corner(3 * run.face + 1) - origin,
              c = corner(3 * run.face + 2) - origin;
  const Vec3d across = b.cross(c);
  const double square = across.squaredNorm();
  if (!(square > 0) || !std::isfinite(square) || !faces_.has_area(run.face)) return false;
  const Vec3d normal = across / std::sqrt(square);
  const Vec3d down = options_.down - options_.down.dot(normal) * normal;
  if (down.norm() < kFlattest) return false;
  const double angle = kWander * elementary::sin(run.phase + 2 * std::numbers::pi * kWaves *
                                                                 run.gone / options_.length);
  const Vec3d way = elementary::cos(angle) * down + elementary::sin(angle) * normal.cross(down);
  const double at_b = way.cross(c).dot(across) / square, at_c = b.cross(way).dot(across) / square;
  rate = {-at_b - at_c, at_b, at_c};
  // Per metre in bind space.
  const double speed = length(faces_.place(run.face, {0, at_b, at_c}));
  if (!(speed > 0)) return false;
  for (double& r : rate) r /= speed;
  return true;
}

bool Rivulets::go_to(Run& run, const Place& place) {
  const double way = length(faces_.place(run.face, place) - faces_.place(run.face, run.at));
  const double part = way > 0 ? std::min(1.0, (run.length - run.gone) / way) : 1.0;
  const Place end = between(run.at, place, part);
  if (is_removed_(run.face, between(run.at, end, 0.5)) || is_removed_(run.face, end)) return false;
  const double share = run.gone / run.length;
  if (way > 0) parts_.push_back({run.face, {{run.at, end}}, run.radius * (1 - kNarrowing * share)});
  run.at = place;
  run.gone += part * way;
  return part == 1 && run.gone < run.length;
}

void Rivulets::follow(Run run) {
  for (int i = 0; i < kMostParts; ++i) {
    Place rate;
    if (!descend(run, rate)) return;
    double way = kStepOfWidth * options_.width;
    Index leaves_at = kNone;
    for (Index k = 0; k < 3; ++k) {
      if (!(rate[k] < 0)) continue;
      const double to_edge = std::max(0.0, run.at[k]) / -rate[k];
      if (to_edge > way) continue;
      way = to_edge;
      leaves_at = k;
    }
    Place end = run.at;
    for (std::size_t k = 0; k < 3; ++k) end[k] += way * rate[k];
    if (leaves_at != kNone) end[leaves_at] = 0;
    if (!go_to(run, end)) return;
    if (leaves_at != kNone && !cross(run, 3 * run.face + (leaves_at + 1) % 3)) return;
  }
}

bool Rivulets::cross(Run& run, Index half_edge) {
  const Index twin = faces_.surface.twin[half_edge];
  if (twin == kNone) return false;
  Run beyond = run;
  beyond.face = twin / 3;
  beyond.at = {};
  beyond.at[twin % 3] = run.at[Surface::next(half_edge) % 3];
  beyond.at[Surface::next(twin) % 3] = run.at[half_edge % 3];
  Place rate;
  if (!descend(beyond, rate)) return false;
  if (rate[Surface::previous(twin) % 3] > 0) {
    run = beyond;
    return true;
  }
  // The edge is the bottom of a valley: down along it.
  const Index other = Surface::next(half_edge);
  const bool is_other_lower = options_.down.dot(corner(other) - corner(half_edge)) > 0;
  const Index lower = is_other_lower ? other : half_edge;
  Place end = {};
  end[lower % 3] = 1;
  return go_to(run, end) && leave_corner(run, lower);
}

bool Rivulets::leave_corner(Run& run, Index from) {
  for (int i = 0; i < kMostParts; ++i) {
    const WayDown way = way_from(run, from);
    if (way.half_edge == kNone) return false;
    run.face = way.half_edge / 3;
    run.at = {};
    run.at[way.half_edge % 3] = 1;
    if (way.is_inside) return true;
    from = Surface::next(way.half_edge);
    Place end = {};
    end[from % 3] = 1;
    if (!go_to(run, end)) return false;
  }
  return false;
}

Rivulets::WayDown Rivulets::way_from(const Run& run, Index from) const {
  const Vec3d here = corner(from);
  double steepest = kFlattest;
  WayDown best;
  faces_.surface.for_each_in_fan(from, [&](Index c) {
    Run in_face = run;
    in_face.face = c / 3;
    Place rate;
    const Vec3d a = corner(Surface::next(c)) - here, b = corner(Surface::previous(c)) - here;
    if (descend(in_face, rate) && rate[Surface::next(c) % 3] > 0 &&
        rate[Surface::previous(c) % 3] > 0) {
      const Vec3d normal = a.cross(b).normalized();
      const double slope = (options_.down - options_.down.dot(normal) * normal).norm();
      if (slope > steepest) {
        steepest = slope;
        best = {c, true};
      }
    }
    const double slope = a.norm() > 0 ? options_.down.dot(a) / a.norm() : 0.0;
    if (!(slope > steepest)) return;
    steepest = slope;
    best = {c, false};
  });
  return best;
}

}  // namespace sunder::tear
