#include "tear/filling/lip_places.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tear/filling/blade_direction.h"
#include "tear/filling/room_below.h"

namespace sunder::tear {
namespace {

/// The share of the lean in the first row below the lip, see the profile in lip_walls.cpp.
constexpr double kFirstRow = 1.0 / 9;

/// Fills in the places of one rim, step by step.
class RimPlaces {
 public:
  RimPlaces(Rim& rim, const Stroke& stroke, const LipWallOptions& options, const LipWalls& walls,
            WallBuilder& builder)
      : rim_(rim),
        stroke_(stroke),
        options_(options),
        walls_(walls),
        builder_(builder),
        places_(&builder.scratch()),
        to_wall_(&builder.scratch()) {}

  ScratchVector<LipPlace> make() {
    locate();
    if (rim_.is_closed && rotate_to_first()) locate();
    measure();
    if (!find_walls()) return std::move(places_);
    BladeDirections directions(stroke_, builder_.scratch());
    for (std::size_t i = 0; i <= count(); ++i)
      if (is_near_wall(i)) direct(i, directions);
    find_lean();
    find_room();
    return std::move(places_);
  }

 private:
  [[nodiscard]] std::size_t count() const { return rim_.half_edges.size(); }
  [[nodiscard]] Vec3d edge(std::size_t i) const { return places_[i + 1].at - places_[i].at; }
  /// The edge before a place, or count() if there is none.
  [[nodiscard]] std::size_t before(std::size_t i) const {
    return i > 0 ? i - 1 : rim_.is_closed ? count() - 1 : count();
  }
  [[nodiscard]] std::size_t after(std::size_t i) const {
    return i < count() ? i : rim_.is_closed ? 0 : count();
  }

  /// Whether the rim turns back, as where the two lips of a tear without width meet.
  [[nodiscard]] bool turns_back(std::size_t i) const {
    const std::size_t in = before(i), out = after(i);
    if (in == count() || out == count()) return false;
    return dot(unit_or(edge(in), Vec3d::Zero()), unit_or(edge(out), Vec3d::Zero())) <
           kTurnsBackCosine;
  }

  void locate() {
    places_.assign(count() + 1, {});
    const Surface& surface = builder_.surface();
    for (std::size_t i = 0; i <= count(); ++i) {
      LipPlace& place = places_[i];
      place.point = i < count() ? surface.corner_point[rim_.half_edges[i]]
                                : surface.corner_point[Surface::next(rim_.half_edges.back())];
      place.at = builder_.position(place.point);
      place.is_ready = !(options_.hold > 0) ||
                       squared_distance(options_.front, place.at) >= options_.hold * options_.hold;
      const auto known =
          std::find_if(walls_.ends.begin(), walls_.ends.end(),
                       [&](const LipWalls::End& end) { return end.point == place.point; });
      if (known != walls_.ends.end() && is_still_there(*known))
        place.end = static_cast<Index>(known - walls_.ends.begin());
    }
    for (std::size_t i = 0; i <= count(); ++i) places_[i].taper = turns_back(i) ? 0 : 1;
  }

  /// Whether the border at the end of a wall was not changed since.
  [[nodiscard]] bool is_still_there(const LipWalls::End& end) const {
    Index above = end.point;
    for (Index r = 0; r < end.row_count; ++r) {
      if (find_border(builder_.surface(), above, end.rows[r]) == kNone) return false;
      above = end.rows[r];
    }
    return true;
  }

  /// @return whether the rim was rotated.
  bool rotate_to_first() {
    std::size_t first = 0;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < count(); ++i) {
      if (!places_[i].is_tip()) continue;
      const double squared = squared_distance(stroke_.front(), places_[i].at);
      if (squared < nearest) nearest = squared, first = i;
    }
    if (!(nearest < std::numeric_limits<double>::infinity()))
      while (first < count() && places_[first].is_ready) ++first;
    if (first == 0 || first == count()) return false;
    std::rotate(rim_.half_edges.begin(), rim_.half_edges.begin() + first, rim_.half_edges.end());
    return true;
  }

  /// Distances along the rim, to the tips, and the taper that follows from them.
  void measure() {
    constexpr double kFar = std::numeric_limits<double>::infinity();
    double tip = kFar;
    const auto pass = [&](std::size_t i, double step) {
      LipPlace& place = places_[i];
      tip = place.is_tip() ? 0 : tip + step;
      if (place.end != kNone) tip = std::min(tip, walls_.ends[place.end].to_tip);
      place.to_tip = std::min(place.to_tip, tip);
    };
    for (LipPlace& place : places_) place.to_tip = kFar;
    for (int round = 0; round < (rim_.is_closed ? 2 : 1); ++round) {
      for (std::size_t i = 0; i <= count(); ++i) {
        const double step = i > 0 ? norm(edge(i - 1)) : 0;
        places_[i].along = i > 0 ? places_[i - 1].along + step : 0;
        pass(i, step);
      }
      if (!rim_.is_closed) tip = kFar;
    }
    tip = kFar;
    for (int round = 0; round < (rim_.is_closed ? 2 : 1); ++round)
      for (std::size_t i = count() + 1; i-- > 0;) pass(i, i < count() ? norm(edge(i)) : 0);
    for (LipPlace& place : places_) {
      const double part = std::min(1.0, place.to_tip / options_.depth);
      if (!place.is_tip()) place.taper = std::sqrt(part * (2 - part));
    }
  }

  /// The direction in which the surface would go on across an edge.
  [[nodiscard]] Vec3d outward(std::size_t i) const {
    const Vec3d along = unit_or(edge(i), Vec3d::Zero());
    return unit_or(Vec3d(along.cross(face_normal(i))), Vec3d::Zero());
  }
  [[nodiscard]] Vec3d face_normal(std::size_t i) const {
    const Index face = rim_.half_edges[i] / 3;
    const Index* points = &builder_.surface().corner_point[3 * face];
    const Vec3d a = builder_.position(points[0]);
    return Vec3d(builder_.position(points[1]) - a).cross(Vec3d(builder_.position(points[2]) - a));
  }

  /// Finds the edges that get walls now. @return whether there are any.
  bool find_walls() {
    to_wall_.assign(count() + 1, std::numeric_limits<double>::infinity());
    bool is_any = false;
    for (std::size_t i = 0; i < count(); ++i) {
      LipPlace &a = places_[i], &b = places_[i + 1];
      a.begins_wall =
          a.is_ready && b.is_ready && !(a.is_tip() && b.is_tip()) &&
          !std::binary_search(walls_.refused.begin(), walls_.refused.end(), rim_.half_edges[i]);
      if (!a.begins_wall) continue;
      is_any = true;
      to_wall_[i] = to_wall_[i + 1] = 0;
    }
    if (!is_any) return false;
    for_each_pair([&](std::size_t i, std::size_t by) {
      const double step = norm(Vec3d(places_[i].at - places_[by].at));
      to_wall_[i] = std::min(to_wall_[i], to_wall_[by] + step);
    });
    return true;
  }
  /// Whether the lean at a place may limit that of a wall, as find_lean() smooths it.
  [[nodiscard]] bool is_near_wall(std::size_t i) const {
    return to_wall_[i] <= 2 * lean_of(options_);
  }

  /// Calls pass(place, neighbour) along the rim and back, twice round a closed one.
  template <class Pass>
  void for_each_pair(Pass pass) {
    for (int round = 0; round < (rim_.is_closed ? 2 : 1); ++round) {
      for (std::size_t i = 1; i <= count(); ++i) pass(i, i - 1);
      if (rim_.is_closed) pass(0, count());
      for (std::size_t i = count(); i-- > 0;) pass(i, i + 1);
      if (rim_.is_closed) pass(count(), 0);
    }
  }

  void direct(std::size_t i, BladeDirections& directions) {
    LipPlace& place = places_[i];
    const std::size_t in = before(i), out = after(i);
    Vec3d across = Vec3d::Zero(), normal = Vec3d::Zero();
    for (const std::size_t of : {in, out}) {
      if (of == count()) continue;
      across += outward(of);
      normal += face_normal(of);
    }
    place.down = directions.at(place.at);
    if (options_.all_layers && dot(normal, place.down) > 0) place.down = -place.down;
    across -= dot(across, place.down) * place.down;
    if (norm(across) > kLeastUnder) place.under = across / norm(across);
  }

  void find_lean() {
    for (std::size_t i = 0; i < count(); ++i)
      if (is_near_wall(i) && is_near_wall(i + 1)) limit_lean(i);
    const auto smooth = [&](std::size_t i, std::size_t by) {
      const double step = norm(Vec3d(places_[i].at - places_[by].at)) / lean_of(options_);
      places_[i].lean = std::min(places_[i].lean, places_[by].lean + 0.5 * step);
    };
    for_each_pair(smooth);
  }

  /// Where the rim bends around the gap, walls that lean below the other lip come together. They
  /// lean less where even the rows nearest to the lip would change places; lower ones may, because
  /// they are out of sight there, below the wall of a nearer lip.
  void limit_lean(std::size_t i) {
    LipPlace &a = places_[i], &b = places_[i + 1];
    const double length = norm(edge(i));
    const double nearer = kFirstRow * lean_of(options_) *
                          dot(Vec3d(a.under - b.under), unit_or(edge(i), Vec3d::Zero()));
    if (!(nearer > 0)) return;
    const double most = kMostShorterEdges * length / nearer;
    a.lean = std::min(a.lean, most);
    b.lean = std::min(b.lean, most);
  }

  /// The ways on which a place looks for room.
  struct Ways {
    Vec3d straight, leaning;
  };
  [[nodiscard]] Ways ways_of(const LipPlace& place) const {
    const Vec3d straight = 2 * options_.depth * place.down;
    return {straight, straight + 2 * lean_of(options_) * place.under};
  }

  /// Walls get half of the room below, and nowhere much more than next to it.
  void find_room() {
    ScratchVector<std::size_t> wanted(&builder_.scratch());
    for (std::size_t i = 0; i <= count(); ++i)
      if (!(to_wall_[i] > 0) && places_[i].end == kNone && !places_[i].is_tip())
        wanted.push_back(i);
    RoomBelow room(walls_.submeshes, builder_.work());
    constexpr std::size_t kAtOnce = 64;  // their surroundings are small, and have few faces each
    for (std::size_t first = 0; first < wanted.size(); first += kAtOnce)
      find_room(std::span(wanted).subspan(first, std::min(kAtOnce, wanted.size() - first)), room);
    for (std::size_t i = 1; i <= count(); ++i) limit(i, i - 1);
    for (std::size_t i = count(); i-- > 0;) limit(i, i + 1);
  }
  void find_room(std::span<const std::size_t> wanted, RoomBelow& room) {
    room.clear();
    for (const std::size_t i : wanted) {
      const Ways ways = ways_of(places_[i]);
      room.expect(places_[i].at, ways.straight);
      room.expect(places_[i].at, ways.leaning);
    }
    room.look_around();
    for (const std::size_t i : wanted) {
      LipPlace& place = places_[i];
      const Ways ways = ways_of(place);
      room.stand_at(place.at, ways.straight, ways.leaning);
      place.room = room.along(place.at, ways.straight);
      if (lean_of(options_) > 0 && place.room > 0)
        place.room = std::min(place.room, room.along(place.at, ways.leaning));
      place.room = std::max(place.room, kLeastRoom);
    }
  }
  void limit(std::size_t i, std::size_t by) {
    if (places_[i].end != kNone || places_[by].is_tip()) return;
    const double most =
        places_[by].room + norm(Vec3d(places_[i].at - places_[by].at)) / options_.depth;
    places_[i].room = std::min(places_[i].room, most);
  }

  Rim& rim_;
  const Stroke& stroke_;
  const LipWallOptions& options_;
  const LipWalls& walls_;
  WallBuilder& builder_;
  ScratchVector<LipPlace> places_;
  ScratchVector<double> to_wall_;  ///< Per place: along the rim to the next edge with a wall.
};

}  // namespace

Index find_border(const Surface& surface, Index a, Index b) {
  if (surface.point_corner[a] == kNone || surface.point_corner[b] == kNone) return kNone;
  for (const Index h : {surface.find_half_edge(a, b), surface.find_half_edge(b, a)})
    if (h != kNone && surface.twin[h] == kNone) return h;
  return kNone;
}

double lean_of(const LipWallOptions& options) {
  return 0.5 * options.width + kLeanDepths * options.depth;
}

ScratchVector<LipPlace> lip_places(Rim& rim, const Stroke& stroke, const LipWallOptions& options,
                                   const LipWalls& walls, WallBuilder& builder) {
  return RimPlaces(rim, stroke, options, walls, builder).make();
}

}  // namespace sunder::tear
