#include "tools/written_weights/place_bound.h"

#include <sunder/certificate/certificate.h>
#include <sunder/skinning/pose.h>
#include <sunder/weights/influences.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

namespace sunder::tools {
namespace {

template <class Integer>
void round_to(std::vector<Influence>& influences) {
  std::vector<Integer> units(influences.size());
  if (!quantise_weights(influences, units)) return;  // Cannot fail: the model is valid.
  for (std::size_t i = 0; i < units.size(); ++i)
    influences[i].weight =
        static_cast<float>(units[i]) / static_cast<float>(std::numeric_limits<Integer>::max());
}

void append_stored(std::span<const Influence> all, std::uint32_t maximum, WeightFormat format,
                   SkinWeights& stored) {
  std::vector<Influence> influences(all.begin(), all.end());
  influences.resize(prune_influences(influences, all.size() > maximum ? maximum : 0));
  if (format == WeightFormat::unorm8) round_to<std::uint8_t>(influences);
  if (format == WeightFormat::unorm16) round_to<std::uint16_t>(influences);
  stored.append(influences);
}

/// Appends how the vertices of a mesh differ from their places.
Status append_rows(const Character& torn, std::uint32_t mesh, const ModelPose& bind,
                   const MeshOrigins& origins, const SkinWeights& stored, SkinDifferences& rows) {
  const Mesh& of = torn.meshes[mesh];
  Character both;  // the unpruned vertices, then the appended ones as they are stored
  both.skeleton = torn.skeleton;
  both.skins = torn.skins;
  Mesh& vertices = both.meshes.emplace_back();
  vertices.skin = of.skin;
  vertices.positions = of.positions;
  vertices.weights = of.weights;
  for (std::uint32_t i = 0; i < origins.vertices.size(); ++i) {
    vertices.positions.push_back(of.positions[origins.first_vertex + i]);
    vertices.weights.append(stored.of(i));
  }
  for (std::uint32_t i = 0; i < origins.vertices.size(); ++i) {
    const VertexOrigin& origin = origins.vertices[i];
    if (origin.values == VertexOrigin::Values::none) continue;
    std::array<VertexShare, 4> shares;
    std::size_t count = 0;
    shares[count++] = {of.vertex_count() + i, 1.0};
    for (std::size_t k = 0; k < 3; ++k)
      if (origin.parts[k] > 0) shares[count++] = {origin.parents[k], -origin.parts[k]};
    if (const Status status =
            append_difference(both, bind, 0, std::span(shares).first(count), rows);
        !status)
      return status;
  }
  return {};
}

/// As bound_places(), but with the failures of the certificate.
Result<std::optional<double>> certify_places(const Character& torn,
                                             const std::vector<MeshOrigins>& origins,
                                             const std::vector<SkinWeights>& stored) {
  const Result<ModelPose> bind = bind_pose(torn);
  if (!bind) return bind.error();
  const Result<JointLimits> limits = free_joint_limits(torn, *bind);
  if (!limits) return limits.error();
  const Result<JointTree> tree = JointTree::create(torn.skeleton, *bind, *limits);
  if (!tree) return tree.error();
  double maximum = 0;
  for (std::uint32_t mesh = 0; mesh < origins.size(); ++mesh) {
    SkinDifferences rows;
    if (const Status status = append_rows(torn, mesh, *bind, origins[mesh], stored[mesh], rows);
        !status)
      return status;
    const Result<DeviationCertificate> certificate = certify_deviation(*tree, rows);
    if (!certificate) return certificate.error();
    for (const double bound : certificate->bound) {
      if (!std::isfinite(bound)) return std::optional<double>();  // a gap, or numbers that overflow
      maximum = std::max(maximum, bound);
    }
  }
  return std::optional<double>(maximum);
}

}  // namespace

Result<std::vector<SkinWeights>> stored_weights(const Character& torn,
                                                const LoadedCharacter& loaded,
                                                const std::vector<MeshOrigins>& origins,
                                                const SaveOptions& options) {
  const auto written = written_influences(torn, loaded, options);
  if (!written) return written.error();
  std::vector<SkinWeights> stored(torn.meshes.size());
  for (std::uint32_t mesh = 0; mesh < torn.meshes.size(); ++mesh) {
    const auto of = std::ranges::find(*written, mesh, &WrittenInfluences::mesh);
    const std::uint32_t maximum = of == written->end() ? 0 : of->maximum;
    const WeightFormat format =
        options.weights_of_mesh.empty() ? options.weights : options.weights_of_mesh[mesh];
    for (std::uint32_t i = 0; i < origins[mesh].vertices.size(); ++i)
      append_stored(torn.meshes[mesh].weights.of(origins[mesh].first_vertex + i), maximum, format,
                    stored[mesh]);
  }
  return stored;
}

Result<std::optional<double>> bound_places(const Character& torn,
                                           const std::vector<MeshOrigins>& origins,
                                           const std::vector<SkinWeights>& stored) {
  Result<std::optional<double>> bound = certify_places(torn, origins, stored);
  if (!bound && bound.error().code() != StatusCode::limit_exceeded) return std::optional<double>();
  return bound;
}

}  // namespace sunder::tools
