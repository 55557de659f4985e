#include "pipeline/plan/read_lips.h"

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <queue>
#include <utility>

namespace sunder::plan {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// Numbers vertices such that those with equal keys have equal numbers.
template <typename Key>
std::vector<std::uint32_t> numbered(const std::vector<Key>& keys) {
  std::map<Key, std::uint32_t> known;
  std::vector<std::uint32_t> numbers;
  for (std::uint32_t v = 0; v < keys.size(); ++v)
    numbers.push_back(known.emplace(keys[v], v).first->second);
  return numbers;
}

/// How many triangles have each edge.
std::map<Edge, int> edges_of(const Mesh& mesh, const std::vector<std::uint32_t>& number_of) {
  std::map<Edge, int> count;
  for (const Triangle& corners : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = number_of[corners[i]], b = number_of[corners[(i + 1) % 3]];
      if (a != b) ++count[std::minmax(a, b)];
    }
  return count;
}

/// Edges of lips between places, each place numbered by its first vertex.
std::vector<Edge> lip_edges(const Mesh& mesh) {
  const auto side = std::find_if(
      mesh.custom_attributes.begin(), mesh.custom_attributes.end(),
      [](const CustomAttribute& attribute) { return attribute.name == kTearSideAttribute; });
  if (side == mesh.custom_attributes.end() || side->components != 1) return {};
  std::vector<std::array<float, 3>> places;
  std::vector<std::array<float, 4>> sides;
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    const Vec3f& place = mesh.positions[v];
    places.push_back({place.x(), place.y(), place.z()});
    sides.push_back({place.x(), place.y(), place.z(), side->values[v]});
  }
  const std::vector<std::uint32_t> place_of = numbered(places);
  const std::map<Edge, int> by_place = edges_of(mesh, place_of);
  std::map<Edge, int> lips;
  for (const auto& [edge, count] : edges_of(mesh, numbered(sides))) {
    const Edge placed = std::minmax(place_of[edge.first], place_of[edge.second]);
    if (count == 1 && by_place.at(placed) == 2) ++lips[placed];
  }
  std::vector<Edge> found;
  for (const auto& [edge, count] : lips)
    if (count == 2) found.push_back(edge);
  return found;
}

/// Places joined by edges.
class LipGraph {
 public:
  LipGraph(const Mesh& mesh, const std::vector<Edge>& edges) {
    for (const auto& [a, b] : edges) {
      const double length = (mesh.positions[a] - mesh.positions[b]).cast<double>().norm();
      next_[a].emplace_back(b, length);
      next_[b].emplace_back(a, length);
    }
  }

  struct Way {
    std::vector<std::uint32_t> places;
    bool is_closed = false;
    double length = 0;
  };

  /// The longest way of all parts.
  [[nodiscard]] Way longest() const {
    Way best;
    std::map<std::uint32_t, bool> is_seen;
    for (const auto& [place, joined] : next_) {
      if (is_seen[place]) continue;
      for (const auto& [of_part, distance] : distances(place).first) is_seen[of_part] = true;
      Way way = longest_from(place);
      if (way.length > best.length) best = std::move(way);
    }
    return best;
  }

 private:
  using Distances = std::map<std::uint32_t, double>;
  using Before = std::map<std::uint32_t, std::uint32_t>;

  /// By Dijkstra.
  [[nodiscard]] std::pair<Distances, Before> distances(std::uint32_t from) const {
    Distances found = {{from, 0}};
    Before before;
    using Entry = std::pair<double, std::uint32_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    open.emplace(0, from);
    while (!open.empty()) {
      const auto [distance, at] = open.top();
      open.pop();
      if (distance > found.at(at)) continue;
      for (const auto& [to, length] : next_.at(at)) {
        const auto known = found.find(to);
        if (known != found.end() && known->second <= distance + length) continue;
        found[to] = distance + length;
        before[to] = at;
        open.emplace(distance + length, to);
      }
    }
    return {std::move(found), std::move(before)};
  }

  static std::uint32_t farthest(const Distances& of) {
    return std::max_element(of.begin(), of.end(),
                            [](const auto& a, const auto& b) { return a.second < b.second; })
        ->first;
  }

  /// Around a ring from a place; otherwise between the two places that are farthest apart.
  [[nodiscard]] Way longest_from(std::uint32_t place) const {
    Distances found = distances(place).first;
    const bool is_ring = std::all_of(
        found.begin(), found.end(), [&](const auto& of) { return next_.at(of.first).size() == 2; });
    if (is_ring) return around(place);
    const std::uint32_t end = farthest(found);
    auto [from_end, before] = distances(end);
    Way way;
    std::uint32_t at = farthest(from_end);
    way.length = from_end.at(at);
    for (way.places = {at}; at != end; way.places.push_back(at)) at = before.at(at);
    return way;
  }

  [[nodiscard]] Way around(std::uint32_t first) const {
    Way way{{first}, true, 0};
    std::uint32_t before = kNone, at = first;
    do {
      const auto& joined = next_.at(at);
      const auto& [to, length] = joined[0].first == before ? joined[1] : joined[0];
      before = at;
      at = to;
      way.length += length;
      if (at != first) way.places.push_back(at);
    } while (at != first);
    return way;
  }

  std::map<std::uint32_t, std::vector<std::pair<std::uint32_t, double>>> next_;
};

}  // namespace

std::optional<LipCurve> read_lips(const Character& torn) {
  LipCurve longest;
  double length = 0;
  for (std::uint32_t mesh = 0; mesh < torn.meshes.size(); ++mesh) {
    LipGraph::Way way = LipGraph(torn.meshes[mesh], lip_edges(torn.meshes[mesh])).longest();
    if (way.length <= length) continue;
    length = way.length;
    longest = {mesh, std::move(way.places), way.is_closed};
  }
  if (length == 0) return {};
  return longest;
}

}  // namespace sunder::plan
