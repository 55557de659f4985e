#include "tear/contact/posed_surface.h"

#include <algorithm>

#include "core/internal/ordered.h"
#include "tear/internal/surface.h"

namespace sunder::tear {
namespace {

/// The farthest that particles move a point: weights are >= 0 and sum to one.
Result<double> farthest_displacement(std::span<const VertexDisplacements> displacements) {
  double farthest = 0;
  const Vec4f* last = nullptr;
  for (const VertexDisplacements& of_mesh : displacements) {
    const bool is_known = of_mesh.displacements.data() == last;
    if (of_mesh.moved.empty() || is_known) continue;
    last = of_mesh.displacements.data();
    for (std::size_t i = 0; i < of_mesh.displacements.size(); ++i) {
      const Vec3d displacement = of_mesh.displacements[i].head<3>().cast<double>();
      if (!displacement.allFinite())
        return Status::failure(StatusCode::non_finite_value, static_cast<Index>(i),
                               "the displacement of particle %zu is not finite", i);
      farthest = std::max(farthest, norm(displacement));
    }
  }
  return (1 + 1e-6) * farthest;  // weights sum to one but for their rounding
}

Status check_sizes(const Character& character, std::span<const VertexDisplacements> displacements) {
  if (displacements.empty()) return {};
  if (displacements.size() != character.meshes.size())
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "there are displacements of %zu meshes, the character has %zu",
                           displacements.size(), character.meshes.size());
  for (Index m = 0; m < displacements.size(); ++m)
    if (!displacements[m].moved.empty() &&
        displacements[m].vertex_rows.size() != character.meshes[m].vertex_count())
      return Status::failure(StatusCode::size_mismatch, m,
                             "mesh %u: there are %zu rows of displacements for %u vertices", m,
                             displacements[m].vertex_rows.size(),
                             character.meshes[m].vertex_count());
  return {};
}

}  // namespace

Result<double> PosedSurface::reach_of(const ContactOptions& options, const Character& character) {
  if (Status status = check_sizes(character, options.displacements); !status) return status;
  return farthest_displacement(options.displacements);
}

void PosedSurface::set_options(const ContactOptions& options, double reach) {
  displacements_ = options.displacements;
  are_drawn_ = false;
  reach_ = reach;
  if (options.surface == ContactSurface::drawn) reach_ += farthest_drawn();
}

Corners PosedSurface::corners(Index face) {
  const Index* points = &editor_.surface().corner_point[3 * face];
  return {position(points[0]), position(points[1]), position(points[2])};
}

Vec3d PosedSurface::position(Index point) {
  if (!are_drawn_ && displacements_.empty()) return posed_.position(editor_, point);
  const Index corner = editor_.surface().point_corner[point];
  const Index mesh = editor_.surface().triangle(corner / 3).mesh,
              vertex = editor_.vertex_at(corner);
  Vec3d place = are_drawn_ && is_drawn_elsewhere(mesh, vertex) ? drawn_position(mesh, vertex)
                                                               : posed_.position(editor_, point);
  if (!displacements_.empty()) place += displacement(mesh, vertex);
  return place;
}

/// Whether the weights of a vertex are not those of its birth.
bool PosedSurface::is_drawn_elsewhere(Index mesh, Index vertex) const {
  return editor_.births.kept_birth(mesh, vertex) != kNone ||
         editor_.births.policy(mesh, vertex) == WeightPolicy::exact;
}

/// The position of a vertex where its weights pose it, also of one with a bind position per
/// influence.
Vec3d PosedSurface::drawn_position(Index mesh, Index vertex) const {
  const Mesh& of = editor_.character().meshes[mesh];
  const InfluencePositions& exact = editor_.exact.of(mesh);
  if (!std::binary_search(exact.vertices.begin(), exact.vertices.end(), vertex))
    return pose().position(of, vertex);
  std::size_t place = editor_.exact.place(mesh, vertex);
  Vec3d sum = Vec3d::Zero();
  for (const Influence& influence : of.weights.of(vertex)) {
    Vec3d bind = exact.positions[place].cast<double>();
    for (std::size_t j = 0; j < exact.morph_targets.size(); ++j)
      if (!exact.morph_targets[j].positions.empty())
        bind += static_cast<double>(pose().morph_weights()[of.first_morph_weight + j]) *
                exact.morph_targets[j].positions[place].cast<double>();
    const Affine3d& bone = pose().palette(of.skin)[influence.slot];
    sum +=
        multiply(bone.linear(), bind) + static_cast<double>(influence.weight) * bone.translation();
    ++place;
  }
  return sum;
}

Vec3d PosedSurface::displacement(Index mesh, Index vertex) const {
  const VertexDisplacements& of = displacements_[mesh];
  const auto after =
      std::upper_bound(of.moved.begin(), of.moved.end(), vertex,
                       [](Index wanted, const IndexRange& range) { return wanted < range.first; });
  if (after == of.moved.begin() || vertex - (after - 1)->first >= (after - 1)->count)
    return Vec3d::Zero();
  const Index row = of.vertex_rows[vertex];
  if (row >= of.influences.size()) return Vec3d::Zero();
  const ParticleInfluences& influences = of.influences[row];
  Vec3d sum = Vec3d::Zero();
  for (std::size_t k = 0; k < influences.weights.size(); ++k)
    if (influences.weights[k] > 0)
      sum += static_cast<double>(influences.weights[k]) *
             of.displacements[influences.particles[k]].head<3>().cast<double>();
  return sum;
}

/// The farthest that weights draw a vertex from where it is torn.
double PosedSurface::farthest_drawn() {
  double farthest = 0;
  const auto& meshes = editor_.character().meshes;
  for (Index m = 0; m < meshes.size(); ++m) {
    const Index source_count = editor_.source().meshes[m].vertex_count();
    for (Index vertex = source_count; vertex < meshes[m].vertex_count(); ++vertex) {
      if (!is_drawn_elsewhere(m, vertex)) continue;
      are_drawn_ = true;
      const Vec3d torn = pose().position(meshes[m], vertex, editor_.births.position(m, vertex),
                                         editor_.births.influences(m, vertex));
      farthest = std::max(farthest, norm(Vec3d(drawn_position(m, vertex) - torn)));
    }
  }
  return (1 + 1e-9) * farthest;
}

}  // namespace sunder::tear
