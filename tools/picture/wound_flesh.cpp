#include "tools/picture/wound_flesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <queue>
#include <utility>

#include "tools/render/triangle_tree.h"

namespace sunder::tools {
namespace {

constexpr std::size_t kAcrossInPictures = 14;  ///< Faces from lip to lip in pictures.
using Section = WoundFlesh::Section;
using Vertex = WoundFlesh::Vertex;
constexpr float kDepthOfGap = 0.8f, kDepthOfThickness = 0.4f;
constexpr float kBloodOfLength = 0.06f;
constexpr int kSmoothing = 6;

Vec3f place(const std::vector<DeformedMesh>& posed, std::uint32_t mesh, std::uint32_t vertex) {
  return posed[mesh].positions[vertex];
}

/// Finds the sections of wounds: the rims of torn surfaces that face each other.
class SectionFinder {
 public:
  SectionFinder(const TornModel& torn, std::span<const Wound> wounds) : torn_(torn) {
    std::vector<bool> is_lip;
    for (const Wound& wound : wounds)
      for (const LipPair& pair : wound.lips) {
        right_of_.emplace(pair.left, pair.right);
        is_right_.insert(pair.right);
        is_lip.resize(
            std::max({is_lip.size(), pair.left + std::size_t{1}, pair.right + std::size_t{1}}));
        is_lip[pair.left] = is_lip[pair.right] = true;
      }
    if (is_lip.empty()) return;
    rims_ = find_borders_at(torn, is_lip);
    points_.resize(torn.character().meshes.size());
    for (std::uint32_t m = 0; m < points_.size(); ++m) {
      const Mesh& mesh = torn.character().meshes[m];
      points_[m].assign(mesh.vertex_count(), kNone);
      for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t)
        for (std::uint32_t c = 0; c < 3 && !is_retired(mesh.triangles[t]); ++c) {
          const std::uint32_t vertex = mesh.triangles[t][c], point = torn.point_at(m, t, c);
          points_[m][vertex] = point;
          vertex_of_.try_emplace(point, Vertex{m, vertex});
        }
    }
    for (std::uint32_t i = 0; i < rims_.size(); ++i) rims_at_[ends_of(rims_[i])].push_back(i);
  }

  void find(std::vector<Section>& sections, std::vector<WoundFlesh::Span>& spans) {
    std::vector<bool> is_done(rims_.size(), false);
    for (std::uint32_t i = 0; i < rims_.size(); ++i) {
      if (is_done[i]) continue;
      const std::uint32_t opposite = opposite_of(i, is_done);
      if (opposite == kNone && !is_whole_left(rims_[i])) continue;
      std::uint32_t left = i, right = opposite;
      if (opposite != kNone && !is_left(rims_[i]) && is_left(rims_[opposite]))
        std::swap(left, right);
      const RimEdge& edge = rims_[left];
      std::array<std::uint32_t, 2> ends = {right_of(point(edge.mesh, edge.a)),
                                           right_of(point(edge.mesh, edge.b))};
      if (right != kNone)
        ends = {point(rims_[right].mesh, rims_[right].b), point(rims_[right].mesh, rims_[right].a)};
      spans.push_back({section(point(edge.mesh, edge.a), ends[0], sections),
                       section(point(edge.mesh, edge.b), ends[1], sections), edge});
      is_done[i] = true;
      if (opposite != kNone) is_done[opposite] = true;
    }
  }

  /// All vertices of the lips.
  [[nodiscard]] std::set<std::array<std::uint32_t, 2>> lip_vertices() const {
    std::set<std::array<std::uint32_t, 2>> vertices;
    for (std::uint32_t m = 0; m < points_.size(); ++m)
      for (std::uint32_t v = 0; v < points_[m].size(); ++v)
        if (is_lip(points_[m][v])) vertices.insert({m, v});
    return vertices;
  }

 private:
  /// Places in bind space, where lips coincide bit for bit.
  using Ends = std::array<std::array<float, 3>, 2>;

  [[nodiscard]] Ends ends_of(const RimEdge& edge) const {
    Ends ends;
    for (std::size_t i = 0; i < 2; ++i) {
      const Vec3f& at = torn_.character().meshes[edge.mesh].positions[i == 0 ? edge.a : edge.b];
      ends[i] = {at.x(), at.y(), at.z()};
    }
    return ends;
  }
  [[nodiscard]] std::uint32_t point(std::uint32_t mesh, std::uint32_t vertex) const {
    return points_[mesh][vertex];
  }
  [[nodiscard]] bool is_lip(std::uint32_t point) const {
    return right_of_.contains(point) || is_right_.contains(point);
  }
  [[nodiscard]] bool is_left(const RimEdge& edge) const {
    const std::uint32_t a = point(edge.mesh, edge.a), b = point(edge.mesh, edge.b);
    return (right_of_.contains(a) || right_of_.contains(b)) && !is_right_.contains(a) &&
           !is_right_.contains(b);
  }
  /// Whether both ends have a place on the right lip.
  [[nodiscard]] bool is_whole_left(const RimEdge& edge) const {
    return is_left(edge) && right_of_.contains(point(edge.mesh, edge.a)) &&
           right_of_.contains(point(edge.mesh, edge.b));
  }
  /// The rim edge between the same places, the other way round. Lips that were torn again have
  /// points that no pair names.
  [[nodiscard]] std::uint32_t opposite_of(std::uint32_t edge,
                                          const std::vector<bool>& is_done) const {
    const Ends ends = ends_of(rims_[edge]);
    const auto found = rims_at_.find({ends[1], ends[0]});
    if (found == rims_at_.end()) return kNone;
    for (const std::uint32_t other : found->second)
      if (other != edge && !is_done[other]) return other;
    return kNone;
  }
  [[nodiscard]] std::uint32_t right_of(std::uint32_t left) const {
    const auto found = right_of_.find(left);
    return found == right_of_.end() || !vertex_of_.contains(found->second) ? left : found->second;
  }
  std::uint32_t section(std::uint32_t left, std::uint32_t right, std::vector<Section>& sections) {
    const auto [entry, is_new] =
        section_of_.try_emplace({left, right}, static_cast<std::uint32_t>(sections.size()));
    if (is_new) sections.push_back({vertex_of_.at(left), vertex_of_.at(right), 0, 0});
    return entry->second;
  }

  const TornModel& torn_;
  std::vector<RimEdge> rims_;
  std::map<Ends, std::vector<std::uint32_t>> rims_at_;
  std::map<std::uint32_t, std::uint32_t> right_of_;  ///< Points, by the pairs of the wounds.
  std::set<std::uint32_t> is_right_;
  std::vector<std::vector<std::uint32_t>> points_;  ///< Per mesh and vertex.
  std::map<std::uint32_t, Vertex> vertex_of_;       ///< The first vertex of a point.
  std::map<std::array<std::uint32_t, 2>, std::uint32_t> section_of_;
};

}  // namespace

WoundFlesh::WoundFlesh(const TornModel& torn, std::span<const Wound> wounds,
                       const std::vector<DeformedMesh>& closed)
    : is_sewn_(!threads_of(torn).empty()) {
  SectionFinder finder(torn, wounds);
  finder.find(sections_, spans_);
  lip_vertices_ = finder.lip_vertices();
  find_joints(torn);
  if (!sections_.empty()) measure(torn, closed);
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
    for (const auto& [a, b, edge] : spans_) {
      float &x = sections_[a].thickness, &y = sections_[b].thickness;
      const float lesser = std::min(x, y);
      x = (x + lesser) / 2;
      y = (y + lesser) / 2;
    }
  place_along(closed);
}

/// The shortest way along the lips from an end of the wound, so that neighbours are never farther
/// apart than the edge between them, also where a wound is a ring or forks.
void WoundFlesh::place_along(const std::vector<DeformedMesh>& closed) {
  struct Step {
    std::uint32_t to;
    float length;
  };
  std::vector<std::vector<Step>> steps(sections_.size());
  for (const auto& [a, b, length] : edges_along(closed)) {
    steps[a].push_back({b, length});
    steps[b].push_back({a, length});
    length_ += length;
  }
  std::vector<bool> is_placed(sections_.size(), false);
  const auto place_from = [&](std::uint32_t start) {
    using Reached = std::pair<float, std::uint32_t>;  // The way, and the section.
    std::priority_queue<Reached, std::vector<Reached>, std::greater<>> next;
    next.push({0.0f, start});
    while (!next.empty()) {
      const auto [along, section] = next.top();
      next.pop();
      if (is_placed[section]) continue;
      is_placed[section] = true;
      sections_[section].along = along;
      for (const Step& step : steps[section]) next.push({along + step.length, step.to});
    }
  };
  for (const bool from_ends : {true, false})  // Rings have no end.
    for (std::uint32_t s = 0; s < sections_.size(); ++s)
      if (!is_placed[s] && (!from_ends || steps[s].size() == 1)) place_from(s);
}

void WoundFlesh::find_joints(const TornModel& torn) {
  std::vector<std::uint32_t> span_count(sections_.size(), 0);
  for (const Span& span : spans_)
    for (const std::uint32_t section : {span.a, span.b}) ++span_count[section];
  std::map<std::array<float, 3>, std::vector<std::array<std::uint32_t, 2>>> ends;
  for (std::uint32_t s = 0; s < spans_.size(); ++s)
    for (const std::uint32_t end : {0u, 1u}) {
      const std::uint32_t section = end == 0 ? spans_[s].a : spans_[s].b;
      if (span_count[section] != 1 || sections_[section].is_tip()) continue;
      const Vertex& left = sections_[section].left;
      const Vec3f& at = torn.character().meshes[left.mesh].positions[left.vertex];
      ends[{at.x(), at.y(), at.z()}].push_back({s, end});
    }
  for (auto& [place, of_place] : ends)
    if (of_place.size() > 1) joints_.push_back(std::move(of_place));
}

/// Fills the hole between the rows that meet at a joint, from its middle.
void WoundFlesh::add_joints(Ground& ground) const {
  for (std::uint32_t j = 0; j < joints_.size(); ++j) {
    const auto joint = static_cast<std::uint32_t>(sections_.size()) + j;
    Vec3f closed = Vec3f::Zero(), open = Vec3f::Zero();
    for (const auto& [s, end] : joints_[j]) {
      const std::uint32_t section = end == 0 ? spans_[s].a : spans_[s].b;
      const std::size_t middle =
          ground.at({section, static_cast<std::uint32_t>(ground.across / 2)});
      closed += ground.closed[middle];
      open += ground.open[middle];
      for (std::uint32_t i = 0; i < ground.across; ++i)
        if (end == 0)
          ground.faces.push_back({s, {{{section, i + 1}, {section, i}, {joint, 0}}}});
        else
          ground.faces.push_back({s, {{{section, i}, {section, i + 1}, {joint, 0}}}});
    }
    ground.closed.emplace_back(closed / static_cast<float>(joints_[j].size()));
    ground.open.emplace_back(open / static_cast<float>(joints_[j].size()));
  }
}

WoundFlesh::Ground WoundFlesh::ground(const std::vector<DeformedMesh>& closed,
                                      const std::vector<DeformedMesh>& open,
                                      std::size_t across) const {
  Ground ground;
  ground.across = across;
  ground.sections = sections_.size();
  const std::vector<Bed> beds = make_beds(closed, open, ground.widest);
  for (std::size_t s = 0; s < sections_.size(); ++s) {
    const Bed& bed = beds[s];
    const Vec3f left = place(closed, sections_[s].left.mesh, sections_[s].left.vertex),
                right = place(closed, sections_[s].right.mesh, sections_[s].right.vertex);
    for (std::size_t i = 0; i <= across; ++i) {
      const float angle =
          std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(across);
      // Exactly the lips at both ends, so that no crack is seen between.
      const float share = i == across ? 1.0f : (1 - std::cos(angle)) / 2;
      const Vec3f down =
          i == across ? Vec3f(Vec3f::Zero()) : Vec3f(bed.depth * std::sin(angle) * bed.outwards);
      ground.open.push_back(i == across ? bed.right
                                        : Vec3f(bed.left + share * (bed.right - bed.left) - down));
      ground.closed.push_back(i == across ? right : Vec3f(left + share * (right - left) - down));
    }
  }
  for (std::uint32_t s = 0; s < spans_.size(); ++s)
    for (std::uint32_t i = 0; i < across; ++i) {
      const auto [a, b, edge] = spans_[s];
      ground.faces.push_back({s, {{{b, i}, {a, i}, {a, i + 1}}}});
      ground.faces.push_back({s, {{{b, i}, {a, i + 1}, {b, i + 1}}}});
    }
  add_joints(ground);
  ground.normals.assign(ground.open.size(), Vec3f::Zero());
  for (const Face& face : ground.faces) {
    std::array<std::size_t, 3> at;
    for (std::size_t i = 0; i < 3; ++i) at[i] = ground.at(face.corners[i]);
    const Vec3f& a = ground.open[at[0]];
    const Vec3f normal = (ground.open[at[1]] - a).cross(ground.open[at[2]] - a);
    for (const std::size_t corner : at) ground.normals[corner] += normal;
  }
  smooth_normals(closed, beds, ground);
  return ground;
}

void WoundFlesh::smooth_normals(const std::vector<DeformedMesh>& closed,
                                const std::vector<Bed>& beds, Ground& ground) const {
  const auto unit_or = [](const Vec3f& normal, const Vec3f& other) {
    return normal.norm() > 0 ? Vec3f(normal.normalized()) : other;
  };
  const std::size_t row = ground.across + 1;
  Eigen::MatrixXd normals(beds.size(), 3 * row);
  for (std::size_t i = 0; i < ground.normals.size(); ++i) {
    Vec3f& normal = ground.normals[i];
    const std::size_t section = std::min(i / row, beds.size() - 1);
    normal = unit_or(normal, beds[section].outwards);
    if (i < row * beds.size())
      normals.block<1, 3>(static_cast<Eigen::Index>(section),
                          static_cast<Eigen::Index>(3 * (i % row))) =
          normal.cast<double>().transpose();
  }
  const std::vector<bool> is_fixed(beds.size());
  normals = SmoothAlong(edges_along(closed), is_fixed, ground.widest / 2).smoothed(normals);
  for (std::size_t i = 0; i < row * beds.size(); ++i)
    ground.normals[i] = unit_or(normals
                                    .block<1, 3>(static_cast<Eigen::Index>(i / row),
                                                 static_cast<Eigen::Index>(3 * (i % row)))
                                    .transpose()
                                    .cast<float>(),
                                ground.normals[i]);
}

std::vector<SmoothAlong::Edge> WoundFlesh::edges_along(
    const std::vector<DeformedMesh>& closed) const {
  std::vector<SmoothAlong::Edge> edges;
  for (const auto& [a, b, edge] : spans_)
    edges.push_back({a, b,
                     (place(closed, sections_[a].left.mesh, sections_[a].left.vertex) -
                      place(closed, sections_[b].left.mesh, sections_[b].left.vertex))
                         .norm()});
  return edges;
}

void WoundFlesh::add(const std::vector<DeformedMesh>& closed, const std::vector<DeformedMesh>& open,
                     std::uint32_t flesh, RenderScene& scene) const {
  const Ground ground = this->ground(closed, open, kAcrossInPictures);
  const float unit = ground.widest > 0 ? 1 / ground.widest : 0.0f;
  for (const Face& face : ground.faces) {
    RenderTriangle drawn;
    drawn.material = flesh;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& [section, place] = face.corners[i];
      const std::size_t at = ground.at(face.corners[i]);
      const bool is_joint = section >= sections_.size();
      drawn.corners[i] = ground.open[at];
      drawn.normals[i] = ground.normals[at];
      drawn.uvs[i] = Vec2f(
          unit * sections_[is_joint ? spans_[face.span].a : section].along,
          is_joint ? 0.5f : static_cast<float>(place) / static_cast<float>(kAcrossInPictures));
      drawn.tints[i].setOnes();
    }
    scene.triangles.push_back(drawn);
  }
  for (const Span& span : spans_)
    for (const std::uint32_t i : {0u, static_cast<std::uint32_t>(kAcrossInPictures)})
      scene.lips.push_back(
          {ground.open[ground.at({span.a, i})], ground.open[ground.at({span.b, i})]});
  // Fresh lips are pale: blood comes as they open. Those that threads hold shut were open.
  scene.blood_reach = kBloodOfLength * length_;
  if (!is_sewn_) scene.blood_reach = std::min(scene.blood_reach, 2 * ground.widest);
}

std::vector<WoundFlesh::Bed> WoundFlesh::make_beds(const std::vector<DeformedMesh>& closed,
                                                   const std::vector<DeformedMesh>& open,
                                                   float& widest) const {
  std::vector<Bed> beds;
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
    beds.push_back(bed);
  }
  // Gaps are uneven; the ground between the lips is not. It ends where the lips meet.
  std::vector<bool> is_shut;
  Eigen::MatrixXd depths(sections_.size(), 1), directions(sections_.size(), 3);
  for (Eigen::Index s = 0; s < depths.rows(); ++s) {
    const Bed& bed = beds[static_cast<std::size_t>(s)];
    is_shut.push_back(!(bed.depth > 0));
    depths(s, 0) = static_cast<double>(bed.depth);
    directions.row(s) = bed.outwards.cast<double>().transpose();
  }
  const std::vector<SmoothAlong::Edge> edges = edges_along(closed);
  depths = SmoothAlong(edges, is_shut, widest).smoothed(depths);
  directions = SmoothAlong(edges, std::vector<bool>(beds.size()), widest).smoothed(directions);
  for (Eigen::Index s = 0; s < depths.rows(); ++s) {
    Bed& bed = beds[static_cast<std::size_t>(s)];
    bed.depth = static_cast<float>(depths(s, 0));
    const Vec3f direction = directions.row(s).transpose().cast<float>();
    if (direction.norm() > 0) bed.outwards = direction.normalized();
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
