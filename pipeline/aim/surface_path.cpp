#include "pipeline/aim/surface_path.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <queue>
#include <unordered_map>
#include <utility>

#include "core/internal/ordered.h"

namespace sunder::aim {
namespace {

using tear::Surface;

/// Places of the search on each edge. Those near the ends let paths pass close to a vertex.
constexpr std::array<double, 4> kFractions = {0.03, 0.35, 0.65, 0.97};

Vec3d position_in(const PosedSurface& surface, const FacePlace& place) {
  const std::array<Vec3d, 3> corners = surface.corners(place.face);
  return place.barycentrics[0] * corners[0] + place.barycentrics[1] * corners[1] +
         place.barycentrics[2] * corners[2];
}

Vec3d normal_of(const PosedSurface& surface, Index face) {
  const std::array<Vec3d, 3> corners = surface.corners(face);
  return normalized(Vec3d((corners[1] - corners[0]).cross(corners[2] - corners[0])));
}

/// Finds the edges that the path crosses, by Dijkstra's algorithm.
class EdgeSearch {
 public:
  EdgeSearch(const PosedSurface& surface, const FacePlace& from, const FacePlace& to)
      : surface_(surface), to_(to), end_(position_in(surface, to)) {
    expand(from.face, position_in(surface, from), 0, kStart);
  }

  /// The half-edges through which the path leaves its faces, in order; empty if there is no path.
  std::vector<Index> run() {
    while (!open_.empty()) {
      const auto [length, node] = open_.top();
      open_.pop();
      if (node == kEnd) return half_edges();
      Reached& reached = reached_[node];
      if (reached.is_done) continue;
      reached.is_done = true;
      const Index edge = edge_of(node), twin = surface_.surface().twin[edge];
      expand(edge / 3, place_of(node), length, node);
      if (twin != kNone) expand(twin / 3, place_of(node), length, node);
    }
    return {};
  }

 private:
  using Node = std::uint64_t;  ///< The lower half-edge of an edge, and the place on it.
  static constexpr Node kStart = ~Node{0}, kEnd = kStart - 1;
  struct Reached {
    double length = 0;
    Node before = kStart;
    Index face = kNone;  ///< In which the path goes from there to here.
    bool is_done = false;
  };

  static Index edge_of(Node node) { return static_cast<Index>(node / kFractions.size()); }
  [[nodiscard]] Vec3d place_of(Node node) const {
    const Index edge = edge_of(node);
    const Vec3d from = surface_.position(surface_.point(edge)),
                to = surface_.position(surface_.point(Surface::next(edge)));
    return from + kFractions[node % kFractions.size()] * (to - from);
  }

  void reach(Node node, const Reached& reached) {
    const auto [known, is_new] = reached_.emplace(node, reached);
    if (!is_new) {
      if (known->second.is_done || known->second.length <= reached.length) return;
      known->second = reached;
    }
    open_.emplace(reached.length, node);
  }

  /// Goes from a place to all others on the border of a face.
  void expand(Index face, const Vec3d& place, double length, Node node) {
    if (!surface_.is_live(face)) return;
    if (face == to_.face) reach(kEnd, {length + norm(end_ - place), node, face, false});
    const Index own_edge = node == kStart ? kNone : edge_of(node);
    for (Index h = 3 * face; h < 3 * face + 3; ++h) {
      const Index twin = surface_.surface().twin[h];
      const Index edge = std::min(h, twin);  // kNone is the highest
      if (twin == kNone || edge == own_edge) continue;
      for (std::size_t i = 0; i < kFractions.size(); ++i) {
        const Node next = edge * kFractions.size() + i;
        reach(next, {length + norm(place_of(next) - place), node, face, false});
      }
    }
  }

  [[nodiscard]] std::vector<Index> half_edges() const {
    std::vector<Index> crossed;
    for (Node node = reached_.at(kEnd).before; node != kStart;) {
      const Reached& reached = reached_.at(node);
      const Index edge = edge_of(node);
      crossed.push_back(edge / 3 == reached.face ? edge : surface_.surface().twin[edge]);
      node = reached.before;
    }
    std::reverse(crossed.begin(), crossed.end());
    return crossed;
  }

  const PosedSurface& surface_;
  FacePlace to_;
  Vec3d end_;
  std::unordered_map<Node, Reached> reached_;
  std::priority_queue<std::pair<double, Node>, std::vector<std::pair<double, Node>>, std::greater<>>
      open_;
};

double cross(const Vec2d& a, const Vec2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// A crossed edge in the strip, unfolded into the plane; seen along the path.
struct Gate {
  Vec2d left, right;
};

/// The strip of faces, unfolded.
struct UnfoldedStrip {
  Vec2d start, end;
  std::vector<Gate> gates;
};

/// The third corner of a triangle on the right of the line from `a` to `b`.
Vec2d third_corner(const Vec2d& a, const Vec2d& b, double from_a, double from_b) {
  const Vec2d way = b - a;
  const double length = norm(way);
  if (!(length > 0)) return a;
  const double along = (length * length + from_a * from_a - from_b * from_b) / (2 * length);
  const double beside = std::sqrt(std::max(0.0, from_a * from_a - along * along));
  const Vec2d x = way / length;
  return a + along * x + beside * Vec2d(x.y(), -x.x());
}

UnfoldedStrip unfold(const PosedSurface& surface, const FacePlace& from, const FacePlace& to,
                     const std::vector<Index>& crossed) {
  const Surface& topology = surface.surface();
  const auto distance = [&](Index corner_a, Index corner_b) {
    return norm(surface.position(surface.point(corner_a)) -
                surface.position(surface.point(corner_b)));
  };
  // The corners of the present face, the first face counter-clockwise.
  const Index first = 3 * from.face;
  std::array<Vec2d, 3> corners = {Vec2d(0, 0), Vec2d(distance(first, first + 1), 0), Vec2d(0, 0)};
  corners[2] = third_corner(corners[1], corners[0], distance(first + 1, first + 2),
                            distance(first, first + 2));
  const auto place_in = [&](const FacePlace& place) {
    return Vec2d(place.barycentrics[0] * corners[0] + place.barycentrics[1] * corners[1] +
                 place.barycentrics[2] * corners[2]);
  };
  UnfoldedStrip strip;
  strip.start = place_in(from);
  for (const Index h : crossed) {
    const Vec2d a = corners[h % 3], b = corners[Surface::next(h) % 3];
    strip.gates.push_back({b, a});
    const Index twin = topology.twin[h], last = Surface::previous(twin);
    std::array<Vec2d, 3> next;
    next[twin % 3] = b;
    next[Surface::next(twin) % 3] = a;
    next[last % 3] = third_corner(a, b, distance(Surface::next(twin), last), distance(twin, last));
    corners = next;
  }
  strip.end = place_in(to);
  return strip;
}

/// The corners of the shortest path through the gates, and the gate of each; the start is not
/// named, the end has the number of gates. The funnel of Lee and Preparata, 1984.
std::vector<std::pair<Vec2d, std::size_t>> pull_taut(const UnfoldedStrip& strip) {
  std::vector<Gate> gates = strip.gates;
  gates.push_back({strip.end, strip.end});
  std::vector<std::pair<Vec2d, std::size_t>> corners;
  Vec2d apex = strip.start, left = apex, right = apex;
  std::size_t left_gate = 0, right_gate = 0;
  std::size_t i = 0;
  const auto restart = [&](const Vec2d& corner, std::size_t gate) {
    corners.emplace_back(corner, gate);
    apex = left = right = corner;
    left_gate = right_gate = gate;
    i = gate + 1;
  };
  while (i < gates.size()) {
    const Vec2d new_right = gates[i].right, new_left = gates[i].left;
    if (cross(right - apex, new_right - apex) >= 0) {
      if (right == apex || cross(left - apex, new_right - apex) < 0) {
        right = new_right;
        right_gate = i;
      } else {
        restart(left, left_gate);
        continue;
      }
    }
    if (cross(left - apex, new_left - apex) <= 0) {
      if (left == apex || cross(right - apex, new_left - apex) > 0) {
        left = new_left;
        left_gate = i;
      } else {
        restart(right, right_gate);
        continue;
      }
    }
    ++i;
  }
  corners.emplace_back(strip.end, strip.gates.size());
  return corners;
}

/// Where the line between two corners of the path crosses a gate, or where it touches it: a corner
/// lies on an end of its gate.
double share_of_gate(const Gate& gate, const Vec2d& from, const Vec2d& to) {
  if (to == gate.left) return 1;
  if (to == gate.right) return 0;
  const Vec2d across = gate.left - gate.right, way = to - from;
  const double turn = cross(way, across);
  if (turn != 0) return std::clamp(cross(way, from - gate.right) / turn, 0.0, 1.0);
  const double squared = squared_norm(across);
  return squared > 0 ? std::clamp(dot(from - gate.right, across) / squared, 0.0, 1.0) : 0.0;
}

/// Where the taut path crosses each gate: the share of the way from its right to its left end.
std::vector<double> shares_of_gates(const UnfoldedStrip& strip) {
  std::vector<double> shares;
  Vec2d from = strip.start;
  std::size_t gate = 0;
  for (const auto& [corner, last] : pull_taut(strip)) {
    for (; gate < strip.gates.size() && gate <= last; ++gate) {
      shares.push_back(share_of_gate(strip.gates[gate], from, corner));
    }
    from = corner;
  }
  return shares;
}

}  // namespace

PathPlace path_place(const PosedSurface& surface, const FacePlace& place) {
  return {position_in(surface, place), normal_of(surface, place.face)};
}

bool append_path(const PosedSurface& surface, const FacePlace& from, const FacePlace& to,
                 std::vector<PathPlace>& path) {
  std::vector<Index> crossed;
  if (from.face != to.face) {
    crossed = EdgeSearch(surface, from, to).run();
    if (crossed.empty()) return false;
  }
  const std::vector<double> shares = shares_of_gates(unfold(surface, from, to, crossed));
  for (std::size_t i = 0; i < crossed.size(); ++i) {
    const Index h = crossed[i];
    const Vec3d right = surface.position(surface.point(h)),
                left = surface.position(surface.point(Surface::next(h)));
    path.push_back({right + shares[i] * (left - right),
                    normalized(Vec3d(normal_of(surface, h / 3) +
                                     normal_of(surface, surface.surface().twin[h] / 3)))});
  }
  path.push_back(path_place(surface, to));
  return true;
}

}  // namespace sunder::aim
