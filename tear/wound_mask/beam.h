#pragma once

#include <limits>

#include "tear/wound_mask/flat_faces.h"

namespace sunder::tear {

/// Straight paths that cross a face on their way from a lip, or from a corner around which paths
/// from a lip bend, unfolded into the plane of the face.
struct Beam {
  enum class Kind : std::uint8_t {
    segment,  ///< A lip in the face itself: all of the face sees it.
    strip,    ///< Paths at right angles to a lip.
    fan,      ///< Paths from a point, between two directions.
    point,    ///< A point of the face itself: all of the face sees it.
  };

  Kind kind = Kind::segment;
  Flat from;          ///< The point, or an end of the lip.
  Flat along;         ///< Of a segment or strip: the unit direction of the lip.
  double low = 0;     ///< The part of the lip that is seen: metres from the end.
  double high = 0;    ///< As `low`.
  Flat left, right;   ///< Of a fan: unit directions, clockwise from left to right.
  double offset = 0;  ///< Of a fan or point: the distance of the point itself.

  static constexpr double kNotSeen = std::numeric_limits<double>::infinity();
  static constexpr double kSlack = 1e-9;  ///< Neighbouring beams overlap; relative.

  /// The distance of a place in the face; kNotSeen if no path of the beam leads there.
  [[nodiscard]] double distance(Flat place) const {
    const Flat way = place - from;
    switch (kind) {
      case Kind::segment: {
        const double s = dot(way, along), t = cross(along, way);
        const double beyond = s - std::clamp(s, low, high);
        return beyond == 0 ? std::abs(t) : std::sqrt(beyond * beyond + t * t);
      }
      case Kind::strip: {
        const double s = dot(way, along), slack = kSlack * (high - low);
        return s < low - slack || s > high + slack ? kNotSeen : std::abs(cross(along, way));
      }
      case Kind::fan: {
        const double slack = -kSlack * (std::abs(way.x) + std::abs(way.y));
        if (cross(right, way) < slack || cross(way, left) < slack) return kNotSeen;
        [[fallthrough]];
      }
      default: return offset + length(way);
    }
  }

  /// The place from which the path to a place comes.
  [[nodiscard]] Flat source_of(Flat place) const {
    if (kind == Kind::fan || kind == Kind::point) return from;
    return from + std::clamp(dot(place - from, along), low, high) * along;
  }
};

}  // namespace sunder::tear
