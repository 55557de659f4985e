#pragma once

#include <sunder/core/character.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "tear/internal/surface.h"

namespace sunder::tear {

/// A place or direction in the plane of a face.
struct Flat {
  double x = 0, y = 0;

  friend Flat operator+(Flat a, Flat b) { return {a.x + b.x, a.y + b.y}; }
  friend Flat operator-(Flat a, Flat b) { return {a.x - b.x, a.y - b.y}; }
  friend Flat operator*(double s, Flat a) { return {s * a.x, s * a.y}; }
  friend bool operator==(const Flat&, const Flat&) = default;
  friend double dot(Flat a, Flat b) { return a.x * b.x + a.y * b.y; }
  /// Positive if b is counter-clockwise from a.
  friend double cross(Flat a, Flat b) { return a.x * b.y - a.y * b.x; }
  friend double length(Flat a) { return std::sqrt(dot(a, a)); }
  /// Zero stays zero.
  friend Flat unit(Flat a) {
    const double of = length(a);
    return of > 0 ? (1 / of) * a : a;
  }
};

/// The place of a segment that is nearest to a place.
inline Flat nearest_on_segment(Flat place, Flat a, Flat b) {
  const Flat along = b - a;
  const double square = dot(along, along);
  const double part = square > 0 ? std::clamp(dot(place - a, along) / square, 0.0, 1.0) : 0.0;
  return a + part * along;
}

/// The triangles of a source in bind space, each in a plane of its own: corner 0 at the origin,
/// corner 1 on the positive x axis, corner 2 above.
struct FlatFaces {
  /// A rotation and shift from one plane to the next one.
  struct Turn {
    Flat cosine_sine, from, to;

    [[nodiscard]] Flat direction(Flat d) const {
      const Flat& r = cosine_sine;
      return {r.x * d.x - r.y * d.y, r.y * d.x + r.x * d.y};
    }
    [[nodiscard]] Flat place(Flat p) const { return to + direction(p - from); }
  };

  explicit FlatFaces(const Character& source);

  [[nodiscard]] Flat corner(Index half_edge) const {
    const std::array<double, 3>& s = shapes[half_edge / 3];
    switch (half_edge % 3) {
      case 0: return {0, 0};
      case 1: return {s[0], 0};
      default: return {s[1], s[2]};
    }
  }
  [[nodiscard]] Flat place(Index face, const std::array<double, 3>& barycentric) const {
    const std::array<double, 3>& s = shapes[face];
    return {barycentric[1] * s[0] + barycentric[2] * s[1], barycentric[2] * s[2]};
  }
  [[nodiscard]] bool has_area(Index face) const { return shapes[face][2] > 0; }
  /// From the plane of a half-edge into that of its twin.
  [[nodiscard]] Turn across(Index half_edge) const;

  Surface surface;
  std::vector<std::array<double, 3>> shapes;  ///< x of corner 1, x and y of corner 2. Metres.
  std::vector<double> angles;                 ///< Per corner, radians.
  /// Per point: whether shortest paths bend around it, at borders and saddles.
  std::vector<bool> bends_paths;
};

}  // namespace sunder::tear
