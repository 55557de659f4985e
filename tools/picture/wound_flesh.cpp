#include "tools/picture/wound_flesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "tools/render/triangle_tree.h"

namespace sunder::tools {
namespace {

constexpr std::size_t kAcross = 14;  ///< Faces from lip to lip.
using Row = std::array<Vec3f, kAcross + 1>;
constexpr float kDepthOfGap = 0.8f, kDepthOfThickness = 0.4f;
constexpr float kRednessOfLength = 0.055f;
constexpr int kSmoothing = 6, kDepthPasses = 60;

Vec3f place(const std::vector<DeformedMesh>& posed, std::uint32_t mesh, std::uint32_t vertex) {
  return posed[mesh].positions[vertex];
}

}  // namespace

WoundFlesh::WoundFlesh(const TornModel& torn, std::span<const Wound> wounds,
                       const std::vector<DeformedMesh>& closed) {
  find_sections(torn, wounds);
  measure(torn, closed);
}

void WoundFlesh::find_sections(const TornModel& torn, std::span<const Wound> wounds) {
  std::map<std::uint32_t, std::uint32_t> right_of;
  for (const Wound& wound : wounds)
    for (const LipPair& pair : wound.lips) right_of.emplace(pair.left, pair.right);
  std::map<std::uint32_t, Vertex> vertex_of;  // The first vertex of a point.
  std::vector<std::vector<std::uint32_t>> points(torn.character().meshes.size());
  for (std::uint32_t m = 0; m < points.size(); ++m) {
    const Mesh& mesh = torn.character().meshes[m];
    points[m].assign(mesh.vertex_count(), kNone);
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t)
      for (std::uint32_t c = 0; c < 3 && !is_retired(mesh.triangles[t]); ++c) {
        const std::uint32_t vertex = mesh.triangles[t][c], point = torn.point_at(m, t, c);
        points[m][vertex] = point;
        vertex_of.try_emplace(point, Vertex{m, vertex});
      }
  }
  std::map<std::uint32_t, std::uint32_t> section_of;
  const auto section = [&](std::uint32_t left) {
    const auto [entry, is_new] =
        section_of.try_emplace(left, static_cast<std::uint32_t>(sections_.size()));
    if (is_new) {
      const auto pair = right_of.find(left);
      const auto right = vertex_of.find(pair == right_of.end() ? left : pair->second);
      sections_.push_back({vertex_of.at(left),
                           right == vertex_of.end() ? vertex_of.at(left) : right->second, 0, 0});
    }
    return entry->second;
  };
  std::map<std::uint32_t, bool> is_right;
  for (const auto& [left, right] : right_of) is_right[right] = true;
  for (std::uint32_t m = 0; m < points.size(); ++m)
    for (std::uint32_t v = 0; v < points[m].size(); ++v)
      if (right_of.contains(points[m][v]) || is_right.contains(points[m][v]))
        lip_vertices_.insert({m, v});
  for (const RimEdge& edge : find_rims(torn)) {
    const std::uint32_t a = points[edge.mesh][edge.a], b = points[edge.mesh][edge.b];
    const bool is_left = (right_of.contains(a) || right_of.contains(b)) && !is_right.contains(a) &&
                         !is_right.contains(b);
    if (is_left) spans_.push_back({section(a), section(b)});
  }
}

void WoundFlesh::measure(const TornModel& torn, const std::vector<DeformedMesh>& closed) {
  std::vector<TriangleTree::Corners> corners;
  Vec3f least = Vec3f::Constant(std::numeric_limits<float>::max()), greatest = -least;
  for (std::size_t m = 0; m < closed.size(); ++m)
    for (const Triangle& triangle : torn.character().meshes[m].triangles) {
      if (is_retired(triangle)) continue;
      TriangleTree::Corners& added = corners.emplace_back();
      for (std::size_t i = 0; i < 3; ++i) {
        added[i] = closed[m].positions[triangle[i]];
        least = least.cwiseMin(added[i]);
        greatest = greatest.cwiseMax(added[i]);
      }
    }
  const TriangleTree tree(corners);
  const float size = (greatest - least).norm(), begin = 2e-3f * size;
  for (Section& section : sections_) {
    const Vec3f inwards = -closed[section.left.mesh].normals[section.left.vertex];
    const Vec3f from = place(closed, section.left.mesh, section.left.vertex) + begin * inwards;
    const TriangleTree::Hit hit = tree.first_hit(from, inwards, size);
    section.thickness = hit.triangle == kNone ? size : begin + hit.distance;
  }
  for (int i = 0; i < kSmoothing; ++i)
    for (const auto& [a, b] : spans_) {
      float &x = sections_[a].thickness, &y = sections_[b].thickness;
      const float lesser = std::min(x, y);
      x = (x + lesser) / 2;
      y = (y + lesser) / 2;
    }
  std::vector<bool> is_placed(sections_.size(), false);
  // Spans come in any order: each pass places those that touch what is placed.
  for (bool goes_on = true; goes_on;) {
    goes_on = false;
    for (const auto& [a, b] : spans_) {
      if (is_placed[a] && is_placed[b]) continue;
      const float step = (place(closed, sections_[a].left.mesh, sections_[a].left.vertex) -
                          place(closed, sections_[b].left.mesh, sections_[b].left.vertex))
                             .norm();
      if (is_placed[a])
        sections_[b].along = sections_[a].along + step;
      else if (is_placed[b])
        sections_[a].along = sections_[b].along - step;
      else if (!goes_on)
        sections_[b].along = sections_[a].along + step;
      else
        continue;
      is_placed[a] = is_placed[b] = goes_on = true;
      length_ += step;
    }
  }
}

void WoundFlesh::add(const std::vector<DeformedMesh>& closed, const std::vector<DeformedMesh>& open,
                     std::uint32_t flesh, RenderScene& scene) const {
  float widest = 0;
  const std::vector<Bed> beds = make_beds(closed, open, widest);
  std::vector<Row> places(sections_.size()), normals(sections_.size());
  for (std::size_t s = 0; s < sections_.size(); ++s)
    for (std::size_t i = 0; i < places[s].size(); ++i) {
      const float angle =
          std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(kAcross);
      const Bed& bed = beds[s];
      places[s][i] = bed.left + (1 - std::cos(angle)) / 2 * (bed.right - bed.left) -
                     bed.depth * std::sin(angle) * bed.outwards;
      normals[s][i].setZero();
    }
  using Corner = std::array<std::size_t, 2>;
  const auto for_each_face = [&](const auto& visit) {
    for (const auto& [a, b] : spans_)
      for (std::size_t i = 0; i < kAcross; ++i) {
        visit(std::array<Corner, 3>{{{a, i}, {b, i}, {a, i + 1}}});
        visit(std::array<Corner, 3>{{{b, i}, {b, i + 1}, {a, i + 1}}});
      }
  };
  const auto at = [](auto& rows, const Corner& corner) -> auto& {
    return rows[corner[0]][corner[1]];
  };
  for_each_face([&](const auto& face) {
    const Vec3f a = at(places, face[0]);
    const Vec3f normal = (at(places, face[1]) - a).cross(at(places, face[2]) - a);
    for (const Corner& corner : face) at(normals, corner) += normal;
  });
  const float unit = widest > 0 ? 1 / widest : 0.0f;
  for_each_face([&](const auto& face) {
    RenderTriangle drawn;
    drawn.material = flesh;
    for (std::size_t i = 0; i < 3; ++i) {
      drawn.corners[i] = at(places, face[i]);
      const Vec3f& normal = at(normals, face[i]);
      drawn.normals[i] = normal.norm() > 0 ? Vec3f(normal.normalized()) : Vec3f(Vec3f::UnitY());
      drawn.uvs[i] = Vec2f(unit * sections_[face[i][0]].along,
                           static_cast<float>(face[i][1]) / static_cast<float>(kAcross));
      drawn.tints[i].setOnes();
    }
    scene.triangles.push_back(drawn);
  });
  for (const auto& [a, b] : spans_) {
    scene.lips.push_back({beds[a].left, beds[b].left});
    scene.lips.push_back({beds[a].right, beds[b].right});
  }
  // Fresh lips are pale: the skin reddens as they open.
  scene.redness = std::min(kRednessOfLength * length_, 0.5f * widest);
}

std::vector<WoundFlesh::Bed> WoundFlesh::make_beds(const std::vector<DeformedMesh>& closed,
                                                   const std::vector<DeformedMesh>& open,
                                                   float& widest) const {
  std::vector<Bed> beds;
  std::vector<float> limits;
  for (const Section& section : sections_) {
    Bed bed;
    bed.left = place(open, section.left.mesh, section.left.vertex);
    bed.right = place(open, section.right.mesh, section.right.vertex);
    bed.outwards = (closed[section.left.mesh].normals[section.left.vertex] +
                    closed[section.right.mesh].normals[section.right.vertex])
                       .normalized();
    const float gap = (bed.right - bed.left).norm();
    widest = std::max(widest, gap);
    bed.depth = std::min(kDepthOfGap * gap, kDepthOfThickness * section.thickness);
    limits.push_back(bed.depth);
    beds.push_back(bed);
  }
  // Gaps are uneven; the ground between the lips is not. It ends where the lips meet.
  std::vector<float> sums(beds.size());
  std::vector<int> counts(beds.size());
  std::vector<Vec3f> directions(beds.size());
  for (int pass = 0; pass < kDepthPasses; ++pass) {
    sums.assign(beds.size(), 0);
    counts.assign(beds.size(), 0);
    for (std::size_t s = 0; s < beds.size(); ++s) directions[s] = beds[s].outwards;
    for (const auto& [a, b] : spans_) {
      sums[a] += beds[b].depth;
      sums[b] += beds[a].depth;
      ++counts[a];
      ++counts[b];
      directions[a] += beds[b].outwards;
      directions[b] += beds[a].outwards;
    }
    for (std::size_t s = 0; s < beds.size(); ++s)
      if (directions[s].norm() > 0) beds[s].outwards = directions[s].normalized();
    for (std::size_t s = 0; s < beds.size(); ++s)
      if (counts[s] > 0 && limits[s] > 0)
        beds[s].depth = 0.5f * beds[s].depth + 0.5f * sums[s] / static_cast<float>(counts[s]);
  }
  return beds;
}

bool WoundFlesh::has_lip(const RimEdge& edge) const {
  return lip_vertices_.contains({edge.mesh, edge.a}) || lip_vertices_.contains({edge.mesh, edge.b});
}

std::vector<Vec3d> WoundFlesh::places(const std::vector<DeformedMesh>& posed) const {
  std::vector<Vec3d> places;
  for (const Section& section : sections_)
    for (const Vertex& vertex : {section.left, section.right})
      places.push_back(place(posed, vertex.mesh, vertex.vertex).cast<double>());
  return places;
}

}  // namespace sunder::tools
