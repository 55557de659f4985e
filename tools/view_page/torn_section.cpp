#include "tools/view_page/torn_section.h"

#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <set>

namespace sunder::tools {
namespace {

/// Distance of an open edge from one of the source up to which it is a part of that, as a share of
/// the model's diagonal: new vertices are rounded to float.
constexpr double kOnEdge = 2e-6;

/// A mesh and a bind position, by which vertices of both files are compared.
using Place = std::array<float, 4>;

Place place_of(const Character& character, Index mesh, Index vertex) {
  const Vec3f& position = character.meshes[mesh].positions[vertex];
  return {static_cast<float>(mesh), position[0] + 0.0f, position[1] + 0.0f, position[2] + 0.0f};
}

/// A side of a triangle.
struct Side {
  Index mesh = 0;
  std::array<Index, 2> vertices = {};
};

/// The surface of one file: which sides are open, and which component a triangle belongs to.
class Surface {
 public:
  static Result<Surface> create(const Character& character) {
    // The model only borrows the character.
    auto model =
        TornModel::create(std::shared_ptr<const Character>(std::shared_ptr<void>(), &character));
    if (!model) return model.error();
    return Surface(character, *model);
  }

  [[nodiscard]] const Character& character() const { return *character_; }
  [[nodiscard]] const std::vector<Side>& open_sides() const { return open_sides_; }
  [[nodiscard]] Index component(Index mesh, Index triangle) const {
    return component_of_triangle_[mesh][triangle];
  }

 private:
  Surface(const Character& character, const TornModel& model) : character_(&character) {
    std::vector<std::array<Index, 2>> edges;
    std::vector<Index> parents(model.point_count());
    std::iota(parents.begin(), parents.end(), Index{0});
    for_each_side(model, [&](const Side&, Index a, Index b) {
      edges.push_back({a, b});
      parents[root(parents, a)] = root(parents, b);
    });
    std::sort(edges.begin(), edges.end());
    for_each_side(model, [&](const Side& side, Index a, Index b) {
      if (!std::binary_search(edges.begin(), edges.end(), std::array<Index, 2>{b, a}))
        open_sides_.push_back(side);
    });
    for (Index mesh = 0; mesh < character.meshes.size(); ++mesh) {
      auto& components = component_of_triangle_.emplace_back();
      for (Index t = 0; t < character.meshes[mesh].triangle_count(); ++t)
        components.push_back(is_retired(character.meshes[mesh].triangles[t])
                                 ? kNone
                                 : root(parents, model.point_at(mesh, t, 0)));
    }
  }

  template <class Visit>
  void for_each_side(const TornModel& model, const Visit& visit) const {
    for (Index mesh = 0; mesh < character_->meshes.size(); ++mesh) {
      const std::vector<Triangle>& triangles = character_->meshes[mesh].triangles;
      for (Index t = 0; t < triangles.size(); ++t)
        for (Index corner = 0; corner < 3 && !is_retired(triangles[t]); ++corner) {
          const Index next = (corner + 1) % 3;
          visit(Side{mesh, {triangles[t][corner], triangles[t][next]}},
                model.point_at(mesh, t, corner), model.point_at(mesh, t, next));
        }
    }
  }

  static Index root(std::vector<Index>& parents, Index point) {
    while (parents[point] != point) point = parents[point] = parents[parents[point]];
    return point;
  }

  const Character* character_;
  std::vector<Side> open_sides_;
  std::vector<std::vector<Index>> component_of_triangle_;
};

double bind_diagonal(const Character& character) {
  Vec3d least = Vec3d::Constant(1e300), most = Vec3d::Constant(-1e300);
  for (const Mesh& mesh : character.meshes)
    for (const Vec3f& position : mesh.positions) {
      least = least.cwiseMin(position.cast<double>());
      most = most.cwiseMax(position.cast<double>());
    }
  return (most - least).norm();
}

/// The open sides of the source, to find those of the torn model that are parts of them.
class SourceSides {
 public:
  explicit SourceSides(const Surface& source)
      : source_(source), tolerance_(kOnEdge * bind_diagonal(source.character())) {
    for (const Side& side : source.open_sides())
      whole_.emplace(places(source.character(), side), 0);
  }

  [[nodiscard]] bool contain(const Character& torn, const Side& side) const {
    const auto ends = places(torn, side);
    if (whole_.contains(ends) || whole_.contains({ends[1], ends[0]})) return true;
    return std::any_of(source_.open_sides().begin(), source_.open_sides().end(),
                       [&](const Side& other) {
                         const auto of_source = places(source_.character(), other);
                         return lies_on(ends[0], of_source) && lies_on(ends[1], of_source);
                       });
  }

 private:
  using Ends = std::array<Place, 2>;

  static Ends places(const Character& character, const Side& side) {
    return {place_of(character, side.mesh, side.vertices[0]),
            place_of(character, side.mesh, side.vertices[1])};
  }
  [[nodiscard]] bool lies_on(const Place& place, const Ends& ends) const {
    if (place[0] != ends[0][0]) return false;  // another mesh
    const auto position = [](const Place& of) -> Vec3d {
      return Vec3f(of[1], of[2], of[3]).cast<double>();
    };
    const Vec3d from = position(ends[0]), along = position(ends[1]) - from,
                offset = position(place) - from;
    const double squared = along.squaredNorm();
    const double share = squared > 0 ? std::clamp(offset.dot(along) / squared, 0.0, 1.0) : 0.0;
    return (offset - share * along).norm() <= tolerance_;
  }

  const Surface& source_;
  double tolerance_;
  std::map<Ends, char> whole_;
};

/// Visits all corners of a surface: visit(component of its triangle, place).
template <class Visit>
void for_each_corner(const Surface& surface, const Visit& visit) {
  const Character& character = surface.character();
  for (Index mesh = 0; mesh < character.meshes.size(); ++mesh) {
    const std::vector<Triangle>& triangles = character.meshes[mesh].triangles;
    for (Index t = 0; t < triangles.size(); ++t) {
      const Index component = surface.component(mesh, t);
      for (Index corner = 0; corner < 3 && component != kNone; ++corner)
        visit(component, place_of(character, mesh, triangles[t][corner]));
    }
  }
}

/// A component of the torn model.
struct Part {
  std::size_t corners = 0;
  Index origin = kNone;  ///< The component of the source that it was a part of; kNone: a new one.
};

/// The components of the source at each place, and how many corners each has.
struct SourceComponents {
  std::map<Place, std::set<Index>> at;
  std::map<Index, std::size_t> corners;

  explicit SourceComponents(const Surface& source) {
    for_each_corner(source, [&](Index component, const Place& place) {
      at[place].insert(component);
      ++corners[component];
    });
  }
};

/// Components of the source may touch in places. A part was of the one with which it shares most
/// corners and, if it shares as many with several, of the smallest of these.
std::map<Index, Part> find_parts(const Surface& source, const Surface& torn) {
  const SourceComponents components(source);
  std::map<Index, Part> parts;
  std::map<Index, std::map<Index, std::size_t>> shared;  // by part and component of the source
  for_each_corner(torn, [&](Index component, const Place& place) {
    ++parts[component].corners;
    const auto known = components.at.find(place);
    if (known == components.at.end()) return;
    for (const Index of_source : known->second) ++shared[component][of_source];
  });
  for (const auto& [part, of_sources] : shared) {
    const auto is_likelier = [&](const auto& a, const auto& b) {
      return a.second != b.second ? a.second > b.second
                                  : components.corners.at(a.first) < components.corners.at(b.first);
    };
    parts[part].origin = std::ranges::min_element(of_sources, is_likelier)->first;
  }
  return parts;
}

/// Number of the piece of each component of the torn model; absent: it is no piece.
std::map<Index, std::uint16_t> number_pieces(const Surface& source, const Surface& torn) {
  const std::map<Index, Part> parts = find_parts(source, torn);
  std::map<Index, Index> body;  // the largest part of each component of the source
  for (const auto& [component, part] : parts) {
    const Index origin = part.origin;
    if (origin == kNone) continue;
    Index& largest = body.try_emplace(origin, component).first->second;
    if (part.corners > parts.at(largest).corners) largest = component;
  }
  std::map<Index, std::uint16_t> numbers;
  for (const auto& [component, part] : parts) {
    const Index origin = part.origin;
    if (origin != kNone && body[origin] == component) continue;
    if (numbers.size() < std::numeric_limits<std::uint16_t>::max())
      numbers.emplace(component, static_cast<std::uint16_t>(numbers.size() + 1));
  }
  return numbers;
}

}  // namespace

Result<TornParts> find_torn_parts(const Character& source, const Character& torn) {
  const auto before = Surface::create(source);
  if (!before) return before.error();
  const auto after = Surface::create(torn);
  if (!after) return after.error();
  TornParts parts;
  std::vector<Index> first_vertex;
  Index count = 0;
  for (const Mesh& mesh : torn.meshes) {
    first_vertex.push_back(count);
    count += mesh.vertex_count();
  }
  const SourceSides source_sides(*before);
  for (const Side& side : after->open_sides())
    if (!source_sides.contain(torn, side))
      parts.lips.push_back(
          {first_vertex[side.mesh] + side.vertices[0], first_vertex[side.mesh] + side.vertices[1]});
  const auto numbers = number_pieces(*before, *after);
  parts.pieces = static_cast<std::uint32_t>(numbers.size());
  parts.piece_of_vertex.resize(count, 0);
  for (Index mesh = 0; mesh < torn.meshes.size(); ++mesh)
    for (Index t = 0; t < torn.meshes[mesh].triangle_count(); ++t)
      if (const auto number = numbers.find(after->component(mesh, t)); number != numbers.end())
        for (const Index vertex : torn.meshes[mesh].triangles[t])
          parts.piece_of_vertex[first_vertex[mesh] + vertex] = number->second;
  return parts;
}

void add_torn_parts(const TornParts& parts, DataArrays& arrays, Json& section) {
  std::vector<std::uint32_t> ends;
  for (const auto& lip : parts.lips) ends.insert(ends.end(), lip.begin(), lip.end());
  section["lips"] = arrays.add(ends);
  section["piece_of_vertex"] = arrays.add(parts.piece_of_vertex);
  section["pieces"] = parts.pieces;
}

}  // namespace sunder::tools
