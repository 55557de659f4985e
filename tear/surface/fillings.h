#pragma once

#include <algorithm>
#include <iterator>
#include <string>

#include "tear/surface/edit_columns.h"

namespace sunder::tear {

/// The triangles of walls and caps. No triangle of the source covers them, so they are origins
/// themselves: the indices in births refer to triangles of the source and, after those, to
/// fillings.
class Fillings {
 public:
  Fillings(const Character& source, Character& character, EditColumns& columns)
      : source_(source), character_(character), columns_(columns) {}

  /// The fillings of a mesh as they were made.
  [[nodiscard]] const std::vector<Triangle>& of(Index mesh) const {
    return columns_.meshes[mesh].fillings;
  }
  /// The name of the submeshes of walls.
  static constexpr const char* kWall = "wall";
  /// Whether a triangle is a part of a wall.
  [[nodiscard]] bool is_wall(const TriangleRef& triangle) const {
    if (triangle.source_triangle < source_.meshes[triangle.mesh].triangle_count()) return false;
    const Mesh& mesh = character_.meshes[triangle.mesh];
    return mesh.submeshes[mesh.triangle_submesh[triangle.triangle]].name == kWall;
  }
  /// A triangle of the source or a filling.
  [[nodiscard]] const Triangle& origin_triangle(Index mesh, Index origin) const {
    const Index source_count = source_.meshes[mesh].triangle_count();
    return origin < source_count ? source_.meshes[mesh].triangles[origin]
                                 : columns_.meshes[mesh].fillings[origin - source_count];
  }
  /// A number that no other filling ever had. Serials ascend.
  [[nodiscard]] std::uint64_t serial(Index mesh, Index origin) const {
    return columns_.meshes[mesh].filling_serials[origin - source_.meshes[mesh].triangle_count()];
  }
  [[nodiscard]] std::uint64_t next_serial() const { return next_serial_; }

  /// The group of a filling.
  [[nodiscard]] Index group(Index mesh, Index origin) const {
    return columns_.meshes[mesh]
        .filling_groups[origin - source_.meshes[mesh].triangle_count()]
        .group;
  }
  /// The number of groups of a mesh, which is also the number of its next one.
  [[nodiscard]] Index group_count(Index mesh) const {
    const auto& groups = columns_.meshes[mesh].filling_groups;
    return groups.empty() ? 0 : groups.back().group_count;
  }
  /// The submesh that a triangle of a mesh would have if each group had one of its own. Digests are
  /// made of it, as they were when that was so.
  [[nodiscard]] Index submesh_of_group(const TriangleRef& triangle) const {
    const Mesh& source = source_.meshes[triangle.mesh];
    if (triangle.source_triangle < source.triangle_count())
      return source.triangle_submesh[triangle.source_triangle];
    return static_cast<Index>(source.submeshes.size()) +
           group(triangle.mesh, triangle.source_triangle);
  }

  /// @param group  at most group_count(), which begins a new one.
  /// @return the origin. There must be room.
  Index append(Index mesh, Index group, const Triangle& vertices) {
    std::vector<Triangle>& fillings = columns_.meshes[mesh].fillings;
    const Index origin =
        source_.meshes[mesh].triangle_count() + static_cast<Index>(fillings.size());
    const Index groups = std::max(group_count(mesh), group + 1);
    fillings.push_back(vertices);
    columns_.meshes[mesh].filling_groups.push_back({group, groups});
    columns_.additions.push_back({Addition::Kind::filling, mesh});
    complete(mesh);
    return origin;
  }
  /// The submesh of fillings with a name and a material: all of them share one, so that an engine
  /// draws them at once. It is made if there is none yet. There must be room.
  Index find_or_append_submesh(Index mesh, const std::string& name, Index material) {
    auto& submeshes = character_.meshes[mesh].submeshes;
    const Submesh wanted = {name, material};
    const auto first = submeshes.begin() + std::ssize(source_.meshes[mesh].submeshes);
    const auto known = std::find(first, submeshes.end(), wanted);
    const auto submesh = static_cast<Index>(known - submeshes.begin());
    if (known != submeshes.end()) return submesh;
    submeshes.push_back(wanted);
    columns_.additions.push_back({Addition::Kind::submesh, mesh});
    return submesh;
  }
  /// Appends the rows of the newest fillings that redo recomputes: new serials, and no parts.
  void complete(Index mesh) {
    MeshColumns& of = columns_.meshes[mesh];
    while (of.filling_serials.size() < of.fillings.size()) {
      of.filling_serials.push_back(next_serial_++);
      of.newest_part.push_back(kNone);
    }
  }

 private:
  const Character& source_;
  Character& character_;
  EditColumns& columns_;
  std::uint64_t next_serial_ = 0;
};

}  // namespace sunder::tear
