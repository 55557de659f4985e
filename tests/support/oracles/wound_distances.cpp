#include "support/oracles/wound_distances.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <queue>
#include <set>

namespace sunder::test {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;
using Eigen::Vector2d;

/// The faces of skin that are left, and the places on their edges.
struct SkinGraph {
  SkinGraph(const TornModel& model, std::uint32_t mesh, std::uint32_t steps) {
    const Mesh& torn = model.character().meshes[mesh];
    std::set<Edge> directed, of_source;
    const auto points_of = [&](std::uint32_t t) -> Triangle {
      return {model.point_at(mesh, t, 0), model.point_at(mesh, t, 1), model.point_at(mesh, t, 2)};
    };
    for (std::uint32_t t = 0; t < torn.triangle_count(); ++t) {
      if (is_retired(torn.triangles[t])) continue;
      if (model.source_triangle(mesh, t) >= model.source().meshes[mesh].triangle_count()) continue;
      faces.push_back(t);
      const Triangle p = points_of(t);
      for (std::uint32_t k = 0; k < 3; ++k) directed.emplace(p[k], p[(k + 1) % 3]);
    }
    std::map<Edge, std::uint32_t> first_of_edge;
    for (const std::uint32_t t : faces) {
      const Triangle p = points_of(t);
      auto& nodes = nodes_of_face.emplace_back();
      for (std::uint32_t k = 0; k < 3; ++k) {
        const Edge edge = {p[k], p[(k + 1) % 3]};
        const auto [at, is_new] = first_of_edge.try_emplace(
            std::minmax(edge.first, edge.second), static_cast<std::uint32_t>(places.size()));
        const Vec3d a = torn.positions[torn.triangles[t][k]].cast<double>(),
                    b = torn.positions[torn.triangles[t][(k + 1) % 3]].cast<double>();
        const bool is_lip = !directed.contains({edge.second, edge.first}) && !is_outer(a, b);
        if (is_lip) lips_of_face[t].push_back({a, b});
        for (std::uint32_t i = 0; i <= steps; ++i) {
          if (is_new) {
            places.push_back(a + (b - a) * i / steps);
            distances.push_back(is_lip ? 0.0 : std::numeric_limits<double>::infinity());
          }
          nodes.push_back(at->second + i);
        }
      }
    }
    find_ways();
  }

  /// Whether an edge lies in the border of make_sheet(n, 1); the other bodies are closed.
  static bool is_outer(const Vec3d& a, const Vec3d& b) {
    for (int i = 0; i < 2; ++i)
      for (const double border : {0.0, 1.0})
        if (a[i] == border && b[i] == border && a.z() == 0 && b.z() == 0) return true;
    return false;
  }

  void find_ways() {
    std::vector<std::vector<std::uint32_t>> faces_at(places.size());
    for (std::uint32_t f = 0; f < faces.size(); ++f)
      for (const std::uint32_t n : nodes_of_face[f]) faces_at[n].push_back(f);
    std::priority_queue<std::pair<double, std::uint32_t>,
                        std::vector<std::pair<double, std::uint32_t>>, std::greater<>>
        queue;
    for (std::uint32_t n = 0; n < places.size(); ++n)
      if (distances[n] == 0) queue.emplace(0.0, n);
    while (!queue.empty()) {
      const auto [distance, node] = queue.top();
      queue.pop();
      if (distance > distances[node]) continue;
      for (const std::uint32_t f : faces_at[node])
        for (const std::uint32_t other : nodes_of_face[f])
          if (const double path = distance + (places[other] - places[node]).norm();
              path < distances[other])
            queue.emplace(distances[other] = path, other);
    }
  }

  std::vector<std::uint32_t> faces;  ///< Triangles of the torn mesh.
  std::vector<std::vector<std::uint32_t>> nodes_of_face;
  std::map<std::uint32_t, std::vector<std::array<Vec3d, 2>>> lips_of_face;
  std::vector<Vec3d> places;
  std::vector<double> distances;  ///< Per place.
};

}  // namespace

std::vector<BruteForceLip> brute_force_lips(const TornModel& model, std::uint32_t mesh) {
  std::vector<BruteForceLip> lips;
  for (const auto& [face, of_face] : SkinGraph(model, mesh, 1).lips_of_face)
    lips.insert(lips.end(), of_face.begin(), of_face.end());
  return lips;
}

void LipHistory::record(const TornModel& model) {
  lips_.resize(model.undo_count());
  lips_.push_back(brute_force_lips(model, 0));
}

std::uint32_t LipHistory::operation_of(const BruteForceLip& lip) const {
  constexpr double kRounding = 1e-5;  // of positions, metres
  const Vec3d middle = (lip[0] + lip[1]) / 2;
  auto operations = static_cast<std::uint32_t>(lips_.size() - 1);
  const auto is_there_after = [&](std::uint32_t count) {
    return std::ranges::any_of(lips_[count], [&](const BruteForceLip& other) {
      const Vec3d along = other[1] - other[0];
      const double part =
          std::clamp((middle - other[0]).dot(along) / along.squaredNorm(), 0.0, 1.0);
      return (middle - other[0] - part * along).norm() < kRounding;
    });
  };
  while (operations > 1 && is_there_after(operations - 1)) --operations;
  return operations - 1;
}

std::vector<double> brute_force_wound(const TornModel& model, std::uint32_t mesh,
                                      std::uint32_t width, std::uint32_t height,
                                      std::uint32_t steps) {
  const SkinGraph graph(model, mesh, steps);
  const Mesh& torn = model.character().meshes[mesh];
  std::vector<double> result(std::size_t{width} * height, -1.0);
  for (std::size_t f = 0; f < graph.faces.size(); ++f) {
    const Triangle& triangle = torn.triangles[graph.faces[f]];
    std::array<Vector2d, 3> uv;
    for (std::size_t k = 0; k < 3; ++k)
      uv[k] = {double{torn.uv_sets[0][triangle[k]].x()} * width - 0.5,
               double{torn.uv_sets[0][triangle[k]].y()} * height - 0.5};
    const auto area = [](const Vector2d& a, const Vector2d& b, const Vector2d& c) {
      return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
    };
    const double whole = area(uv[0], uv[1], uv[2]);
    if (whole == 0) continue;
    const auto low = [&](int i) { return std::ceil(std::min({uv[0][i], uv[1][i], uv[2][i]})); };
    const auto high = [&](int i) { return std::floor(std::max({uv[0][i], uv[1][i], uv[2][i]})); };
    for (double y = std::max(low(1), 0.0); y <= std::min(high(1), height - 1.0); ++y)
      for (double x = std::max(low(0), 0.0); x <= std::min(high(0), width - 1.0); ++x) {
        const Vector2d at(x, y);
        const double b0 = area(at, uv[1], uv[2]) / whole, b1 = area(uv[0], at, uv[2]) / whole,
                     b2 = 1 - b0 - b1;
        if (std::min({b0, b1, b2}) < 0) continue;
        const Vec3d place = b0 * torn.positions[triangle[0]].cast<double>() +
                            b1 * torn.positions[triangle[1]].cast<double>() +
                            b2 * torn.positions[triangle[2]].cast<double>();
        double least = std::numeric_limits<double>::infinity();
        for (const std::uint32_t n : graph.nodes_of_face[f])
          least = std::min(least, graph.distances[n] + (graph.places[n] - place).norm());
        if (const auto lips = graph.lips_of_face.find(graph.faces[f]);
            lips != graph.lips_of_face.end())
          for (const auto& [a, b] : lips->second) {
            const double part =
                std::clamp((place - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
            least = std::min(least, (place - a - part * (b - a)).norm());
          }
        double& known = result[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)];
        known = known < 0 ? least : std::min(known, least);
      }
  }
  return result;
}

}  // namespace sunder::test
