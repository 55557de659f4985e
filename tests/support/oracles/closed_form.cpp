#include <sunder/skinning/deform.h>

#include <algorithm>

#include "skinning/internal/reference.h"
#include "support/machine/say.h"
#include "support/models/rigs.h"
#include "support/oracles/torn_invariants.h"

namespace sunder::test {
namespace {

/// A mesh in a pose.
struct Posed {
  const Mesh& source;
  const ModelPose& pose;
  std::vector<Affine3d> palette;
  double largest = 0;  ///< Norm of the palette's matrices.

  [[nodiscard]] Vec3d position(const Mesh& mesh, std::uint32_t vertex) const {
    return deform_position_reference(mesh, vertex, palette, pose.morph_weights);
  }

  [[nodiscard]] Vec3d morphed(std::uint32_t vertex) const {
    Vec3d p = source.positions[vertex].cast<double>();
    for (std::size_t j = 0; j < source.morph_targets.size(); ++j)
      if (!source.morph_targets[j].position_deltas.empty())
        p += static_cast<double>(pose.morph_weights[source.first_morph_weight + j]) *
             source.morph_targets[j].position_deltas[vertex].cast<double>();
    return p;
  }

  /// sum_i w_i R_i edge, over the influences of a vertex.
  [[nodiscard]] Vec3d turned(std::uint32_t vertex, const Vec3d& edge) const {
    Vec3d sum = Vec3d::Zero();
    for (const Influence& influence : source.weights.of(vertex))
      sum += static_cast<double>(influence.weight) * (palette[influence.slot].linear() * edge);
    return sum;
  }

  /// The longest of the vectors whose rounding errors affect a new vertex.
  [[nodiscard]] double reach(const Triangle& parents) const {
    double reach = 0;
    for (const std::uint32_t parent : parents) {
      reach = std::max(reach, morphed(parent).norm());
      for (const Influence& influence : source.weights.of(parent))
        reach = std::max(
            reach, (palette[influence.slot] * morphed(parent)).norm() / std::max(largest, 1e-30));
    }
    return reach;
  }
};

Vec3d closed_form(const Posed& posed, const Birth& birth) {
  const Triangle parents = posed.source.triangles[birth.triangle];
  Vec3d expected = Vec3d::Zero();
  for (std::size_t k = 0; k < 3; ++k)
    expected += birth.barycentric[k] * posed.position(posed.source, parents[k]);
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t l = k + 1; l < 3; ++l) {
      const Vec3d edge = posed.morphed(parents[k]) - posed.morphed(parents[l]);
      expected -= birth.barycentric[k] * birth.barycentric[l] *
                  (posed.turned(parents[k], edge) - posed.turned(parents[l], edge));
    }
  return expected;
}

}  // namespace

std::vector<std::string> broken_closed_form(const TornModel& model, const ModelPose& pose) {
  std::vector<std::string> faults;
  const double diagonal = posed_diagonal(model.source(), pose);
  for (std::uint32_t m = 0; m < model.character().meshes.size(); ++m) {
    const Mesh& torn = model.character().meshes[m];
    const Mesh& source = model.source().meshes[m];
    if (torn.triangles == source.triangles) continue;
    const Skin& skin = model.source().skins[source.skin];
    Posed posed{source, pose, std::vector<Affine3d>(skin.bones.size())};
    if (!compute_palette(skin, pose, posed.palette)) return {"no palette"};
    for (const Affine3d& matrix : posed.palette)
      posed.largest = std::max(posed.largest, matrix.linear().norm());
    for (std::uint32_t v = source.vertex_count(); v < torn.vertex_count(); ++v) {
      const Birth birth = model.birth(m, v);
      if (birth.triangle >= source.triangle_count()) continue;  // of a wall or cap
      const double error = (posed.position(torn, v) - closed_form(posed, birth)).norm();
      // Rounding of the stored floats, amplified by the largest matrix: positions and weights have
      // a relative error of 2^-24 each.
      const double rounding =
          2e-6 * std::max(diagonal, posed.largest * posed.reach(source.triangles[birth.triangle]));
      if (!(error <= rounding))
        faults.push_back(say("mesh ", m, " vertex ", v, ": ", error,
                             " from the closed form, rounding explains ", rounding));
    }
  }
  return faults;
}

}  // namespace sunder::test
