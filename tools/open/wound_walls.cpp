#include "tools/open/wound_walls.h"

#include <array>
#include <map>
#include <utility>

namespace sunder::tools {
namespace {

constexpr std::size_t kAcrossInFiles = 8;  ///< Faces from lip to lip.

/// Makes the walls of all meshes.
class WallMaker {
 public:
  WallMaker(const TornModel& torn, const WoundFlesh& flesh, const WoundFlesh::Ground& ground)
      : torn_(torn), flesh_(flesh), ground_(ground) {
    walls_.meshes.resize(torn.character().meshes.size());
  }

  WoundWalls make() {
    for (const WoundFlesh::Face& face : ground_.faces) add(face);
    return std::move(walls_);
  }

 private:
  void add(const WoundFlesh::Face& face) {
    const std::uint32_t mesh = flesh_.spans()[face.span].edge.mesh;
    WoundWalls::OfMesh& walls = walls_.meshes[mesh];
    Triangle triangle;
    for (std::size_t i = 0; i < 3; ++i) triangle[i] = vertex(face, i);
    const bool is_flat =
        triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0];
    if (!is_flat) walls.triangles.push_back(triangle);  // At a tip, whose places are one.
  }

  /// A mesh, a submesh, a section, and a place in its row.
  using Key = std::array<std::uint32_t, 4>;

  std::uint32_t vertex(const WoundFlesh::Face& face, std::size_t corner) {
    const WoundFlesh::Span& span = flesh_.spans()[face.span];
    const std::uint32_t mesh = span.edge.mesh,
                        submesh =
                            torn_.character().meshes[mesh].triangle_submesh[span.edge.triangle];
    auto [section, place] = face.corners[corner];
    const bool is_joint = section >= ground_.sections;
    const std::size_t at = ground_.at(face.corners[corner]);
    // A joint has the weights and the place along the wound of the section before it.
    const std::uint32_t of_joint = is_joint ? face.corners[0][0] : section;
    const WoundFlesh::Section& of = flesh_.sections()[of_joint];
    if (!is_joint && of.is_tip()) place = 0;
    WoundWalls::OfMesh& walls = walls_.meshes[mesh];
    const auto [known, is_new] = vertices_.try_emplace(
        Key{mesh, submesh, section, place}, static_cast<std::uint32_t>(walls.vertices.size()));
    if (!is_new) return known->second;
    const std::uint32_t left = of_joint == span.a ? span.edge.a : span.edge.b;
    const bool is_right = !is_joint && 2 * place > ground_.across && of.right.mesh == mesh;
    const float unit = ground_.widest > 0 ? 1 / ground_.widest : 0.0f;
    const float share =
        is_joint ? 0.5f : static_cast<float>(place) / static_cast<float>(ground_.across);
    walls.vertices.push_back({is_right ? of.right.vertex : left,
                              ground_.closed[at],
                              ground_.open[at],
                              ground_.normals[at],
                              {unit * of.along, share},
                              submesh});
    return known->second;
  }

  const TornModel& torn_;
  const WoundFlesh& flesh_;
  const WoundFlesh::Ground& ground_;
  WoundWalls walls_;
  std::map<Key, std::uint32_t> vertices_;
};

}  // namespace

std::size_t WoundWalls::triangle_count() const {
  std::size_t count = 0;
  for (const OfMesh& of : meshes) count += of.triangles.size();
  return count;
}

WoundWalls make_wound_walls(const TornModel& torn, std::span<const Wound> wounds,
                            const std::vector<DeformedMesh>& closed,
                            const std::vector<DeformedMesh>& open) {
  const WoundFlesh flesh(torn, wounds, closed);
  const WoundFlesh::Ground ground = flesh.ground(closed, open, kAcrossInFiles);
  return WallMaker(torn, flesh, ground).make();
}

}  // namespace sunder::tools
