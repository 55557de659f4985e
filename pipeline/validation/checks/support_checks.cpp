#include "pipeline/validation/checks/support_checks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

#include "core/internal/ordered.h"
#include "pipeline/validation/checks/inherited.h"

namespace sunder::validation {
namespace {

constexpr float kSupported = 0.01f;  ///< Weights below do not count as support.
constexpr double kNear = 0.1;        ///< Of the diagonal.

/// The influences of a point: those of its first vertex.
struct PointWeights {
  explicit PointWeights(const Skinned& of) : skin(of) {
    for (Index mesh = 0; mesh < of.character.meshes.size(); ++mesh)
      mesh_of_vertex.insert(mesh_of_vertex.end(), of.character.meshes[mesh].vertex_count(), mesh);
  }
  [[nodiscard]] std::span<const Influence> of(Index point) const {
    const Index vertex = skin.graph.vertex_of_point[point], mesh = mesh_of_vertex[vertex];
    return skin.influences(mesh, vertex - skin.surface.first_vertex[mesh]);
  }
  [[nodiscard]] Index mesh(Index point) const {
    return mesh_of_vertex[skin.graph.vertex_of_point[point]];
  }

  const Skinned& skin;
  std::vector<Index> mesh_of_vertex;
};

/// L1 between the influences of two points, by bone.
double difference(const PointWeights& weights, Index a, Index b) {
  const auto of_a = weights.of(a), of_b = weights.of(b);
  const Index mesh_a = weights.mesh(a), mesh_b = weights.mesh(b);
  double common = 0.0, total = 0.0;
  for (const Influence& in_a : of_a) {
    total += static_cast<double>(in_a.weight);
    for (const Influence& in_b : of_b)
      if (weights.skin.bone(mesh_a, in_a.slot) == weights.skin.bone(mesh_b, in_b.slot))
        common += static_cast<double>(std::min(in_a.weight, in_b.weight));
  }
  for (const Influence& in_b : of_b) total += static_cast<double>(in_b.weight);
  return total - 2.0 * common;
}

/// The points that each bone moves, back to back.
struct Supports {
  struct Entry {
    Index point = 0;
    float weight = 0.0f;
    bool governs = false;  ///< No other bone has more weight.
  };
  std::vector<Index> first;
  std::vector<Entry> entries;

  [[nodiscard]] std::span<const Entry> of(Index bone) const {
    return {entries.data() + first[bone], first[bone + 1] - first[bone]};
  }
};

Supports collect_supports(const PointWeights& weights) {
  const Skinned& skin = weights.skin;
  Supports supports;
  supports.first.assign(skin.character.skeleton.bones.size() + 1, 0);
  const auto visit = [&](const auto& take) {
    for (Index point = 0; point < skin.graph.point_count(); ++point) {
      if (skin.graph.around(point).empty()) continue;
      const auto of = weights.of(point);
      float most = 0.0f;
      for (const Influence& influence : of) most = std::max(most, influence.weight);
      for (const Influence& influence : of)
        if (influence.weight >= kSupported)
          take(skin.bone(weights.mesh(point), influence.slot),
               Supports::Entry{point, influence.weight, influence.weight >= most});
    }
  };
  visit([&](Index bone, const Supports::Entry&) { ++supports.first[bone + 1]; });
  for (std::size_t i = 1; i < supports.first.size(); ++i)
    supports.first[i] += supports.first[i - 1];
  supports.entries.resize(supports.first.back());
  std::vector<Index> next(supports.first.begin(), supports.first.end() - 1);
  visit([&](Index bone, const Supports::Entry& entry) { supports.entries[next[bone]++] = entry; });
  return supports;
}

/// Distances along edges from some points, up to a limit. Reused between bones: only what was
/// reached is reset.
class Front {
 public:
  explicit Front(const PointGraph& graph) : graph_(graph), distance_(graph.point_count(), kFar) {}

  void start(Index point) {
    if (distance_[point] == kFar) touched_.push_back(point);
    distance_[point] = 0.0;
    starts_.push_back(point);
  }
  /// @param may_enter  of a point.
  template <class MayEnter>
  void run(double limit, const MayEnter& may_enter) {
    const auto pass = [&](Index point, double distance) {
      const auto around = graph_.around(point);
      const auto lengths = graph_.lengths_around(point);
      for (std::size_t i = 0; i < around.size(); ++i) {
        const double next = distance + static_cast<double>(lengths[i]);
        if (next <= limit && next < distance_[around[i]] && may_enter(around[i]))
          push(around[i], next);
      }
    };
    for (const Index point : starts_) pass(point, 0.0);  // the nearest ones: no queue is needed
    starts_.clear();
    while (!open_.empty()) {
      const auto [distance, point] = open_.top();
      open_.pop();
      if (distance <= distance_[point]) pass(point, distance);
    }
  }
  [[nodiscard]] bool has_reached(Index point) const { return distance_[point] < kFar; }
  void reset() {
    for (const Index point : touched_) distance_[point] = kFar;
    touched_.clear();
  }

 private:
  static constexpr double kFar = std::numeric_limits<double>::infinity();

  void push(Index point, double distance) {
    if (distance_[point] == kFar) touched_.push_back(point);
    distance_[point] = distance;
    open_.push({distance, point});
  }

  const PointGraph& graph_;
  std::vector<double> distance_;
  std::vector<Index> touched_, starts_;
  std::priority_queue<std::pair<double, Index>, std::vector<std::pair<double, Index>>,
                      std::greater<>>
      open_;
};

/// Finds the far points of one bone after another.
class BleedSearch {
 public:
  explicit BleedSearch(const Skinned& skin)
      : skin_(skin),
        near_(kNear * skin.surface.diagonal),
        front_(skin.graph),
        in_support_(skin.graph.point_count(), false),
        governed_shell_(skin.graph.shell_count, false) {}

  void add_far_points(Index bone, std::span<const Supports::Entry> support, Places& places) {
    std::vector<Index> far = beyond_support(support);
    if (!far.empty()) far = beyond_surface(support, far);
    for (const Index point : far)
      places.push_back(
          skin_.place(skin_.graph.vertex_of_point[point], bone,
                      static_cast<double>(far.size()) / static_cast<double>(support.size())));
  }

 private:
  /// Points that no path of at most `near_` within the support joins to where the bone governs. A
  /// quick test: such paths are no shorter than those along the whole surface.
  std::vector<Index> beyond_support(std::span<const Supports::Entry> support) {
    for (const auto& entry : support) {
      in_support_[entry.point] = true;
      if (entry.governs) front_.start(entry.point);
    }
    front_.run(near_, [&](Index point) { return in_support_[point]; });
    std::vector<Index> far;
    for (const auto& entry : support) {
      in_support_[entry.point] = false;
      if (!front_.has_reached(entry.point)) far.push_back(entry.point);
    }
    front_.reset();
    return far;
  }

  std::vector<Index> beyond_surface(std::span<const Supports::Entry> support,
                                    const std::vector<Index>& candidates) {
    const std::vector<Index> core = core_of(support);
    Eigen::AlignedBox3d box;
    for (const Index point : core) {
      front_.start(point);
      governed_shell_[skin_.graph.shell_of_point[point]] = true;
      box.extend(Eigen::Vector3d(place(point)));
    }
    front_.run(near_, [](Index) { return true; });
    std::vector<Index> far;
    for (const Index point : candidates) {
      const bool is_governed = governed_shell_[skin_.graph.shell_of_point[point]];
      const bool is_far = is_governed ? !front_.has_reached(point)
                                      : box.exteriorDistance(Eigen::Vector3d(place(point))) > near_;
      if (is_far) far.push_back(point);
    }
    front_.reset();
    for (const Index point : core) governed_shell_[skin_.graph.shell_of_point[point]] = false;
    return far;
  }

  /// Where the bone governs; nowhere: the points of its largest weight.
  [[nodiscard]] static std::vector<Index> core_of(std::span<const Supports::Entry> support) {
    std::vector<Index> core;
    float most = 0.0f;
    for (const auto& entry : support) {
      if (entry.governs) core.push_back(entry.point);
      most = std::max(most, entry.weight);
    }
    if (core.empty())
      for (const auto& entry : support)
        if (entry.weight >= most) core.push_back(entry.point);
    return core;
  }

  [[nodiscard]] const Vec3d& place(Index point) const {
    return skin_.surface.positions[skin_.graph.vertex_of_point[point]];
  }

  const Skinned& skin_;
  double near_;
  Front front_;
  std::vector<bool> in_support_, governed_shell_;
};

/// The connected parts of one bone's support.
class IslandSearch {
 public:
  explicit IslandSearch(const PointGraph& graph)
      : graph_(graph), part_(graph.point_count(), kNone) {}

  struct Part {
    Index shell = 0;
    double mass = 0.0;
    std::vector<Index> points;
  };
  std::vector<Part> parts_of(std::span<const Supports::Entry> support) {
    constexpr Index kOpen = kNone - 1;
    std::vector<float> weight;
    for (const auto& entry : support) part_[entry.point] = kOpen;
    std::vector<Part> parts;
    std::vector<Index> open;
    for (const auto& entry : support) {
      if (part_[entry.point] != kOpen) continue;
      Part& part = parts.emplace_back();
      part.shell = graph_.shell_of_point[entry.point];
      open.assign(1, entry.point);
      part_[entry.point] = static_cast<Index>(parts.size() - 1);
      while (!open.empty()) {
        const Index point = open.back();
        open.pop_back();
        part.points.push_back(point);
        for (const Index next : graph_.around(point)) {
          if (part_[next] != kOpen) continue;
          part_[next] = part_[entry.point];
          open.push_back(next);
        }
      }
    }
    for (const auto& entry : support) {
      parts[part_[entry.point]].mass += static_cast<double>(entry.weight);
      part_[entry.point] = kNone;
    }
    return parts;
  }

 private:
  const PointGraph& graph_;
  std::vector<Index> part_;
};

}  // namespace

Places find_outliers(const Skinned& skin) {
  const PointWeights weights(skin);
  const double threshold = kind_of(Code::rough).threshold;
  Places places;
  for (Index point = 0; point < skin.graph.point_count(); ++point) {
    const auto around = skin.graph.around(point);
    double least = around.empty() ? 0.0 : 2.0;
    for (std::size_t i = 0; i < around.size() && least > threshold; ++i)
      least = std::min(least, difference(weights, point, around[i]));
    if (least > threshold)
      places.push_back(skin.place(skin.graph.vertex_of_point[point], kNone, least));
  }
  return places;
}

Places find_islands(const Skinned& skin) {
  const Supports supports = collect_supports(PointWeights(skin));
  IslandSearch search(skin.graph);
  Places places;
  for (Index bone = 0; bone < skin.character.skeleton.bones.size(); ++bone) {
    const auto parts = search.parts_of(supports.of(bone));
    double total = 0.0;
    for (const auto& part : parts) total += part.mass;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const bool is_largest = std::ranges::none_of(parts, [&](const auto& other) {
        return other.shell == parts[i].shell && other.mass > parts[i].mass;
      });
      if (is_largest) continue;
      for (const Index point : parts[i].points)
        places.push_back(
            skin.place(skin.graph.vertex_of_point[point], bone, parts[i].mass / total));
    }
  }
  return places;
}

Places find_bleeding(const Skinned& skin) {
  const Supports supports = collect_supports(PointWeights(skin));
  BleedSearch search(skin);
  Places places;
  for (Index bone = 0; bone < skin.character.skeleton.bones.size(); ++bone)
    if (!supports.of(bone).empty()) search.add_far_points(bone, supports.of(bone), places);
  return places;
}

void check_supports(const RowReader& reader, FindingList& findings) {
  add_new_weights(reader, Code::rough, find_outliers(reader.target()), findings);
  add_new_weights(reader, Code::island, find_islands(reader.target()), findings);
  add_new_weights(reader, Code::bleed, find_bleeding(reader.target()), findings);
}

}  // namespace sunder::validation
