#include "support/oracles/surface_distances.h"

#include <limits>
#include <map>
#include <queue>

#include "tear/internal/surface.h"

namespace sunder::test {
namespace {

using tear::Surface;

constexpr double kNever = std::numeric_limits<double>::infinity();

/// The nodes on the edges, and the faces between them.
struct Graph {
  std::vector<Vec3d> places;
  std::vector<std::vector<std::uint32_t>> faces;  ///< Per face the nodes on its border.
};

std::vector<double> shortest(const Graph& graph, std::uint32_t source) {
  std::vector<std::vector<std::uint32_t>> faces_of(graph.places.size());
  for (std::uint32_t f = 0; f < graph.faces.size(); ++f)
    for (const std::uint32_t node : graph.faces[f]) faces_of[node].push_back(f);
  std::vector<double> distances(graph.places.size(), kNever);
  std::priority_queue<std::pair<double, std::uint32_t>,
                      std::vector<std::pair<double, std::uint32_t>>, std::greater<>>
      queue;
  queue.emplace(distances[source] = 0.0, source);
  while (!queue.empty()) {
    const auto [distance, node] = queue.top();
    queue.pop();
    if (distance > distances[node]) continue;
    for (const std::uint32_t f : faces_of[node])
      for (const std::uint32_t other : graph.faces[f])
        if (const double path = distance + (graph.places[other] - graph.places[node]).norm();
            path < distances[other])
          queue.emplace(distances[other] = path, other);
  }
  return distances;
}

}  // namespace

std::vector<double> fine_distances(const Surface& surface, std::span<const Vec3f> positions,
                                   std::uint32_t source, std::uint32_t steps) {
  Graph graph;
  for (const Vec3f& position : positions) graph.places.emplace_back(position.cast<double>());
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> first_of_edge;
  for (std::uint32_t t = 0; t < surface.triangle_count(); ++t) {
    if (surface.has_repeated_point(t)) continue;
    auto& face = graph.faces.emplace_back();
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t a = surface.corner_point[3 * t + k],
                          b = surface.corner_point[3 * t + (k + 1) % 3];
      face.push_back(a);
      const auto [at, is_new] = first_of_edge.try_emplace(
          std::minmax(a, b), static_cast<std::uint32_t>(graph.places.size()));
      for (std::uint32_t i = 0; i < steps; ++i) {
        face.push_back(at->second + i);
        const double part = (i + 1.0) / (steps + 1.0);
        if (is_new)
          graph.places.emplace_back((1 - part) * graph.places[std::min(a, b)] +
                                    part * graph.places[std::max(a, b)]);
      }
    }
  }
  std::vector<double> distances = shortest(graph, source);
  distances.resize(positions.size());
  return distances;
}

std::vector<double> edge_distances(const Surface& surface, std::span<const Vec3f> positions,
                                   std::uint32_t source) {
  return fine_distances(surface, positions, source, 0);
}

std::vector<Vec3f> bind_positions(const Character& character, const Surface& surface) {
  std::vector<Vec3f> positions(surface.point_count(), Vec3f::Zero());
  for (std::uint32_t t = 0; t < surface.triangle_count(); ++t) {
    const tear::TriangleRef of = surface.triangle(t);
    const Mesh& mesh = character.meshes[of.mesh];
    for (std::uint32_t k = 0; k < 3; ++k)
      positions[surface.corner_point[3 * t + k]] = mesh.positions[mesh.triangles[of.triangle][k]];
  }
  return positions;
}

}  // namespace sunder::test
