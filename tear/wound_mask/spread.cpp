#include "tear/wound_mask/spread.h"

#include <algorithm>
#include <numbers>
#include <utility>

#include "core/internal/elementary.h"

namespace sunder::tear {
namespace {

constexpr double kAngleRounding = 1e-9;     ///< Radians.
constexpr double kCrossingRounding = 1e-9;  ///< Relative.
constexpr double kThinnestFan = 1e-12;      ///< Radians; thinner fans hold no place of their own.

/// Where a ray from a fan's point crosses an edge: a share of it.
double where_ray_crosses(const Beam& beam, Flat direction, Flat a, Flat b) {
  const double at_a = cross(a - beam.from, direction), at_b = cross(b - beam.from, direction);
  const double change = at_a - at_b;
  return change != 0 ? std::clamp(at_a / change, 0.0, 1.0) : 0.0;
}

/// Which share of an edge of a face is at a place along a lip.
double where_strip_crosses(const Beam& beam, double along, Flat a, Flat b) {
  const double at_a = dot(a - beam.from, beam.along), at_b = dot(b - beam.from, beam.along);
  const double change = at_b - at_a;
  return change != 0 ? std::clamp((along - at_a) / change, 0.0, 1.0) : 0.0;
}

}  // namespace

std::span<const SpreadBeam> Spread::from(Index face, std::span<const LipSegment> lips) {
  beams_.clear();
  if (!faces_.has_area(face)) return beams_;
  for (const LipSegment& lip : lips) start_segment(face, lip);
  std::vector<std::array<double, 3>> ends;
  for (const LipSegment& lip : lips) ends.insert(ends.end(), lip.ends.begin(), lip.ends.end());
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  for (const std::array<double, 3>& end : ends) start_point(face, end);
  finish();
  for (const Index point : met_) nearest_[point] = Beam::kNotSeen;
  met_.clear();
  crossings_.clear();
  return beams_;
}

void Spread::start_segment(Index face, const LipSegment& lip) {
  const Flat a = faces_.place(face, lip.ends[0]), b = faces_.place(face, lip.ends[1]);
  Beam beam;
  beam.from = a;
  beam.along = unit(b - a);
  beam.high = length(b - a);
  if (!(beam.high > 0)) return;
  beams_.push_back({face, beam});
  for (Index h = 3 * face; h < 3 * face + 3; ++h) {
    see_corner(h, beam);
    Beam strip = beam;
    strip.kind = Beam::Kind::strip;
    const double s = dot(faces_.corner(h) - a, beam.along),
                 t = dot(faces_.corner(Surface::next(h)) - a, beam.along);
    send_strip(h, strip, std::max(0.0, std::min(s, t)), std::min(beam.high, std::max(s, t)));
  }
}

void Spread::start_point(Index face, const std::array<double, 3>& place) {
  shine_from_point(face, faces_.place(face, place), 0);
  const auto zeros = std::count(place.begin(), place.end(), 0.0);
  if (zeros == 1) {
    const auto opposite =
        static_cast<Index>(std::find(place.begin(), place.end(), 0.0) - place.begin());
    const Index edge = Surface::next(3 * face + opposite), twin = faces_.surface.twin[edge];
    if (twin != kNone)
      shine_from_point(twin / 3, faces_.across(edge).place(faces_.place(face, place)), 0);
  } else if (zeros == 2) {
    const auto at =
        static_cast<Index>(std::max_element(place.begin(), place.end()) - place.begin());
    faces_.surface.for_each_in_fan(3 * face + at, [&](Index corner) {
      if (corner / 3 != face) shine_from_point(corner / 3, faces_.corner(corner), 0);
    });
  }
}

void Spread::shine_from_point(Index face, Flat place, double offset) {
  if (!faces_.has_area(face)) return;
  Beam beam;
  beam.kind = Beam::Kind::point;
  beam.from = place;
  beam.offset = offset;
  beams_.push_back({face, beam});
  beam.kind = Beam::Kind::fan;
  for (Index h = 3 * face; h < 3 * face + 3; ++h) {
    const Flat corner = faces_.corner(h);
    if (!(corner == place)) see_corner(h, beam);
    send_fan(h, beam, unit(faces_.corner(Surface::next(h)) - place), unit(corner - place));
  }
}

void Spread::finish() {
  while (!entered_.empty() || !bends_.empty()) {
    if (!entered_.empty()) {
      const Entered entered = entered_.back();
      entered_.pop_back();
      pass(entered);
    } else {
      const Bend around = bends_.back();
      bends_.pop_back();
      if (around.distance <= nearest_[faces_.surface.corner_point[around.corner]]) bend(around);
    }
  }
}

void Spread::enter(Index half_edge, const Beam& beam) {
  const Index twin = faces_.surface.twin[half_edge];
  if (twin == kNone || !faces_.has_area(twin / 3)) return;
  const FlatFaces::Turn turn = faces_.across(half_edge);
  Beam turned = beam;
  turned.from = turn.place(beam.from);
  turned.along = turn.direction(beam.along);
  turned.left = turn.direction(beam.left);
  turned.right = turn.direction(beam.right);
  entered_.push_back({turned, twin});
}

void Spread::pass(const Entered& entered) {
  beams_.push_back({entered.half_edge / 3, entered.beam});
  if (entered.beam.kind == Beam::Kind::strip)
    pass_strip(entered);
  else
    pass_fan(entered);
}

void Spread::pass_strip(const Entered& entered) {
  const Beam& beam = entered.beam;
  const Index h = entered.half_edge, to_right = Surface::next(h), to_left = Surface::previous(h);
  const double apex = dot(faces_.corner(to_left) - beam.from, beam.along);
  const bool ascends = dot(faces_.corner(to_right) - faces_.corner(h), beam.along) > 0;
  const Index below = ascends ? to_left : to_right, above = ascends ? to_right : to_left;
  if (apex >= beam.low && apex <= beam.high) see_corner(to_left, beam);
  send_strip(below, beam, beam.low, std::min(beam.high, apex));
  send_strip(above, beam, std::max(beam.low, apex), beam.high);
}

void Spread::pass_fan(const Entered& entered) {
  const Beam& beam = entered.beam;
  const Index h = entered.half_edge, to_right = Surface::next(h), to_left = Surface::previous(h);
  const Flat apex = unit(faces_.corner(to_left) - beam.from);
  if (cross(beam.left, apex) > 0) return send_fan(to_right, beam, beam.left, beam.right);
  if (cross(beam.right, apex) < 0) return send_fan(to_left, beam, beam.left, beam.right);
  see_corner(to_left, beam);
  send_fan(to_left, beam, beam.left, apex);
  send_fan(to_right, beam, apex, beam.right);
}

void Spread::send_strip(Index half_edge, Beam beam, double low, double high) {
  if (!(low < high)) return;
  const Flat a = faces_.corner(half_edge), b = faces_.corner(Surface::next(half_edge));
  const double at_low = where_strip_crosses(beam, low, a, b),
               at_high = where_strip_crosses(beam, high, a, b);
  const auto height = [&](double share) {
    return std::abs(cross(beam.along, a + share * (b - a) - beam.from));
  };
  const auto [least, most] = std::minmax({height(at_low), height(at_high)});
  if (least >= reach_) return;
  const auto [begin, end] = std::minmax({at_low, at_high});
  if (is_covered(half_edge, {begin, end, least, most})) return;
  beam.low = low;
  beam.high = high;
  enter(half_edge, beam);
}

void Spread::send_fan(Index half_edge, Beam beam, Flat left, Flat right) {
  if (!(cross(right, left) > kThinnestFan)) return;
  const Flat a = faces_.corner(half_edge), b = faces_.corner(Surface::next(half_edge));
  const double at_right = where_ray_crosses(beam, right, a, b),
               at_left = where_ray_crosses(beam, left, a, b);
  const Flat from = a + at_right * (b - a), to = a + at_left * (b - a);
  const double least = beam.offset + length(nearest_on_segment(beam.from, from, to) - beam.from);
  if (least >= reach_) return;
  const double most = beam.offset + std::max(length(from - beam.from), length(to - beam.from));
  const auto [begin, end] = std::minmax({at_right, at_left});
  if (is_covered(half_edge, {begin, end, least, most})) return;
  beam.left = left;
  beam.right = right;
  enter(half_edge, beam);
}

bool Spread::is_covered(Index half_edge, Crossing crossing) {
  const Index twin = faces_.surface.twin[half_edge];
  if (twin < half_edge) crossing.begin = 1 - std::exchange(crossing.end, 1 - crossing.begin);
  const auto [found, is_first] = crossings_.try_emplace(std::min(half_edge, twin), crossing);
  if (is_first) return false;
  Crossing& widest = found->second;
  if (crossing.least > widest.most * (1 + kCrossingRounding) &&
      crossing.begin >= widest.begin - kCrossingRounding &&
      crossing.end <= widest.end + kCrossingRounding)
    return true;
  if (crossing.end - crossing.begin > widest.end - widest.begin) widest = crossing;
  return false;
}

void Spread::see_corner(Index corner, const Beam& beam) {
  const Index point = faces_.surface.corner_point[corner];
  if (!faces_.bends_paths[point]) return;
  const Flat place = faces_.corner(corner), back = beam.source_of(place) - place;
  const double distance = beam.offset + length(back);
  if (!(distance > 0) || distance >= reach_ || distance >= nearest_[point]) return;
  if (nearest_[point] == Beam::kNotSeen) met_.push_back(point);
  nearest_[point] = distance;
  bends_.push_back({corner, back, distance});
}

void Spread::bend(const Bend& around) {
  const Surface& surface = faces_.surface;
  const Index first = around.corner;
  const Flat out = faces_.corner(Surface::next(first)) - faces_.corner(first);
  const Flat turned = {dot(out, around.back), cross(out, around.back)};
  const double before =
      std::clamp(std::abs(elementary::atan2(turned.y, turned.x)), 0.0, faces_.angles[first]);
  double total = 0;
  bool is_closed = true;
  surface.for_each_in_fan(first, [&](Index corner) {
    total += faces_.angles[corner];
    is_closed = is_closed && surface.twin[corner] != kNone &&
                surface.twin[Surface::previous(corner)] != kNone;
  });
  const auto shine = [&](Index corner) {
    shine_from_point(corner / 3, faces_.corner(corner), around.distance);
  };
  const double last = is_closed ? total - std::numbers::pi + kAngleRounding : Beam::kNotSeen;
  double angle = faces_.angles[first] - before;
  for (Index c = surface.rotate_ccw(first); c != kNone && c != first && angle < last;
       c = surface.rotate_ccw(c)) {
    angle += faces_.angles[c];
    if (angle > std::numbers::pi - kAngleRounding) shine(c);
  }
  if (is_closed) return;
  angle = before;
  for (Index c = surface.rotate_cw(first); c != kNone && c != first; c = surface.rotate_cw(c)) {
    angle += faces_.angles[c];
    if (angle > std::numbers::pi - kAngleRounding) shine(c);
  }
}

}  // namespace sunder::tear
