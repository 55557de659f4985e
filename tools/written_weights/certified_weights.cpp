#include "tools/written_weights/certified_weights.h"

#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "tools/written_weights/coincident_vertices.h"
#include "tools/written_weights/joint_limits_file.h"

namespace sunder::tools {
namespace {

/// Bounds are compared twice, with terms in another order: this share of the maximum error is kept
/// for the rounding between.
constexpr double kForRounding = 1e-9;

/// From the fewest bytes to the most.
constexpr std::pair<WeightFormat, std::uint32_t> kFormats[] = {
    {WeightFormat::unorm8, 8}, {WeightFormat::unorm16, 16}, {WeightFormat::float32, 32}};

/// The weights of meshes that share points, all in one format.
struct Trial {
  std::vector<SkinWeights> weights;  ///< One per mesh of the list.
  std::vector<CertifiedMesh> meshes;
  std::uint64_t bytes = 0;
};

std::uint32_t sets_of(const SkinWeights& weights) {
  std::size_t most = 1;
  for (std::uint32_t v = 0; v < weights.vertex_count(); ++v)
    most = std::max(most, weights.of(v).size());
  return static_cast<std::uint32_t>((most + 3) / 4);
}

std::uint64_t bytes_of(const SkinWeights& weights, std::uint64_t bytes_per_weight) {
  const bool fits_a_byte = std::ranges::all_of(
      weights.influences, [](const Influence& influence) { return influence.slot < 256; });
  return std::uint64_t{weights.vertex_count()} * sets_of(weights) * 4 *
         ((fits_a_byte ? 1 : 2) + bytes_per_weight);
}

bool is_permutation(std::span<const Influence> a, std::span<const Influence> b) {
  return a.size() == b.size() && std::ranges::is_permutation(a, b);
}

bool is_displaced_by_a_morph(const Mesh& mesh, std::uint32_t vertex) {
  return std::ranges::any_of(mesh.morph_targets, [&](const MorphTarget& target) {
    return !target.position_deltas.empty() && !target.position_deltas[vertex].isZero(0);
  });
}

/// The meshes with joints and weights in the file.
std::vector<bool> skinned_meshes(const Character& unpruned, const LoadedCharacter& loaded) {
  std::vector<bool> are_skinned(unpruned.meshes.size(), true);
  for (std::size_t m = 0; m < loaded.stored.size(); ++m)
    are_skinned[m] = loaded.stored[m].per_vertex > 0 ||
                     unpruned.meshes[m].skin != loaded.character->meshes[m].skin;
  return are_skinned;
}

class WeightChooser {
 public:
  WeightChooser(const Character& unpruned, const LoadedCharacter& loaded, ModelPose bind,
                JointTree tree, double maximum_error)
      : unpruned_(unpruned),
        bind_(std::move(bind)),
        tree_(std::move(tree)),
        maximum_error_(maximum_error),
        coincident_(unpruned, bind_, skinned_meshes(unpruned, loaded)) {}

  [[nodiscard]] const CoincidentVertices& coincident() const { return coincident_; }

  /// The weights of joined meshes in the format of the fewest bytes.
  [[nodiscard]] Result<Trial> choose(const std::vector<std::uint32_t>& meshes) {
    std::optional<Trial> best;
    std::vector<std::uint32_t> uncertified;
    for (const auto& [format, bits] : kFormats) {
      Result<std::vector<CertifiedInfluences>> chosen = influences(meshes, bits);
      if (!chosen) return chosen.error();
      if (format == WeightFormat::unorm8) uncertified = without_bound(*chosen);
      if (format == WeightFormat::float32) keep_all_where_needed(meshes, *chosen);
      Result<std::optional<Trial>> trial = certify(meshes, *chosen, format);
      if (!trial) return trial.error();
      if (*trial && (!best || (*trial)->bytes <= best->bytes)) best = std::move(*trial);
    }
    if (!best)
      return Status::failure(StatusCode::internal_error, meshes.front(),
                             "mesh %u: even its own weights have no certificate", meshes.front());
    for (std::size_t i = 0; i < meshes.size(); ++i) best->meshes[i].uncertified = uncertified[i];
    return std::move(*best);
  }

 private:
  [[nodiscard]] Result<std::vector<CertifiedInfluences>> influences(
      const std::vector<std::uint32_t>& meshes, std::uint32_t bits) const {
    std::vector<CertifiedInfluences> chosen;
    const InfluenceBudget budget{maximum_error_ * (1 - kForRounding), 0, {bits}};
    for (const std::uint32_t mesh : meshes) {
      Result<CertifiedInfluences> of_mesh =
          certified_influences(unpruned_, bind_, tree_, mesh, budget);
      if (!of_mesh) return of_mesh.error();
      chosen.push_back(std::move(*of_mesh));
    }
    return chosen;
  }

  static std::vector<std::uint32_t> without_bound(const std::vector<CertifiedInfluences>& chosen) {
    std::vector<std::uint32_t> counts;
    for (const CertifiedInfluences& of_mesh : chosen)
      counts.push_back(static_cast<std::uint32_t>(std::ranges::count_if(
          of_mesh.bound, [](double bound) { return !std::isfinite(bound); })));
    return counts;
  }

  /// As floats every vertex can keep its own weights, which is no change at all.
  void keep_all_where_needed(const std::vector<std::uint32_t>& meshes,
                             std::vector<CertifiedInfluences>& chosen) const {
    for (std::size_t i = 0; i < meshes.size(); ++i) {
      const SkinWeights& own = unpruned_.meshes[meshes[i]].weights;
      SkinWeights kept;
      for (std::uint32_t v = 0; v < own.vertex_count(); ++v)
        kept.append(chosen[i].bound[v] <= maximum_error_ ? chosen[i].weights.of(v) : own.of(v));
      chosen[i].weights = std::move(kept);
    }
  }

  /// The weights that the first coincident vertex got, for the same bones. Where nothing changed,
  /// the vertex' own ones in their order, so that they differ by nothing.
  void append_weights(std::uint32_t mesh, std::uint32_t vertex, std::span<const Influence> of_first,
                      const Skin& skin_of_first, SkinWeights& weights) const {
    const auto own = unpruned_.meshes[mesh].weights.of(vertex);
    const Skin& skin = unpruned_.skins[unpruned_.meshes[mesh].skin];
    std::vector<Influence> influences;
    for (const Influence& influence : of_first)
      for (const Influence& mine : own)
        if (skin.bones[mine.slot] == skin_of_first.bones[influence.slot]) {
          influences.push_back({mine.slot, influence.weight});
          break;
        }
    weights.append(is_permutation(influences, own) ? own : std::span<const Influence>(influences));
  }

  /// Certifies the weights as they will be written. @return nothing where they are not certified to
  /// stay within the maximum error.
  [[nodiscard]] Result<std::optional<Trial>> certify(const std::vector<std::uint32_t>& meshes,
                                                     const std::vector<CertifiedInfluences>& chosen,
                                                     WeightFormat format) const {
    Trial trial;
    for (std::size_t i = 0; i < meshes.size(); ++i) {
      const Mesh& mesh = unpruned_.meshes[meshes[i]];
      SkinWeights& weights = trial.weights.emplace_back();
      for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
        const MeshVertex first = coincident_.first_like(meshes[i], v);
        const auto list = std::ranges::find(meshes, first.mesh) - meshes.begin();
        append_weights(meshes[i], v,
                       chosen[static_cast<std::size_t>(list)].weights.of(first.vertex),
                       unpruned_.skins[unpruned_.meshes[first.mesh].skin], weights);
      }
      Result<std::vector<double>> bound = bounds(mesh, weights);
      if (!bound) return bound.error();
      if (std::ranges::any_of(*bound, [&](double of) { return !(of <= maximum_error_); }))
        return std::optional<Trial>();
      trial.meshes.push_back(describe(meshes[i], weights, format, std::move(*bound)));
      trial.bytes += trial.meshes.back().bytes;
    }
    return std::optional<Trial>(std::move(trial));
  }

  /// The bounds between the unpruned vertices and copies of them with other weights.
  [[nodiscard]] Result<std::vector<double>> bounds(const Mesh& mesh,
                                                   const SkinWeights& weights) const {
    const std::uint32_t count = mesh.vertex_count();
    Character both;
    both.skeleton = unpruned_.skeleton;
    both.skins = unpruned_.skins;
    Mesh& copies = both.meshes.emplace_back();
    copies.skin = mesh.skin;
    copies.positions = mesh.positions;
    copies.positions.insert(copies.positions.end(), mesh.positions.begin(), mesh.positions.end());
    copies.weights = mesh.weights;
    for (std::uint32_t v = 0; v < count; ++v) copies.weights.append(weights.of(v));
    SkinDifferences rows;
    for (std::uint32_t v = 0; v < count; ++v) {
      const VertexShare shares[] = {{count + v, 1.0}, {v, -1.0}};
      if (const Status status = append_difference(both, bind_, 0, shares, rows); !status)
        return status;
    }
    Result<DeviationCertificate> certificate = certify_deviation(tree_, rows);
    if (!certificate) return certificate.error();
    return std::move(certificate->bound);
  }

  [[nodiscard]] CertifiedMesh describe(std::uint32_t index, const SkinWeights& weights,
                                       WeightFormat format, std::vector<double> bound) const {
    const Mesh& mesh = unpruned_.meshes[index];
    const std::uint64_t bytes_per_weight = format == WeightFormat::unorm8    ? 1
                                           : format == WeightFormat::unorm16 ? 2
                                                                             : 4;
    CertifiedMesh described{index,
                            format,
                            sets_of(weights),
                            bytes_of(mesh.weights, 4),
                            bytes_of(weights, bytes_per_weight),
                            std::move(bound)};
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
      if (is_permutation(weights.of(v), mesh.weights.of(v))) continue;
      ++described.changed;
      described.morphed += is_displaced_by_a_morph(mesh, v);
    }
    return described;
  }

  const Character& unpruned_;
  ModelPose bind_;
  JointTree tree_;
  double maximum_error_;
  CoincidentVertices coincident_;
};

}  // namespace

Result<CertifiedWeights> certify_weights(const Character& unpruned, const LoadedCharacter& loaded,
                                         const MaximumError& wanted) {
  Result<ModelPose> bind = bind_pose(unpruned);
  if (!bind) return bind.error();
  const Result<JointLimits> limits = joint_limits_named(wanted.limits, unpruned, *bind);
  if (!limits) return limits.error();
  Result<JointTree> tree = JointTree::create(unpruned.skeleton, *bind, *limits);
  if (!tree) return tree.error();
  CertifiedWeights result{
      unpruned, std::vector<WeightFormat>(unpruned.meshes.size(), WeightFormat::float32), {}, 0};
  WeightChooser chooser(unpruned, loaded, std::move(*bind), std::move(*tree), wanted.metres);
  for (const std::vector<std::uint32_t>& meshes : chooser.coincident().joined_meshes()) {
    if (std::ranges::all_of(meshes, [&](std::uint32_t mesh) {
          return unpruned.meshes[mesh] == loaded.character->meshes[mesh];
        }))
      continue;
    Result<Trial> trial = chooser.choose(meshes);
    if (!trial) return trial.error();
    for (std::size_t i = 0; i < meshes.size(); ++i) {
      result.character.meshes[meshes[i]].weights = std::move(trial->weights[i]);
      result.formats[meshes[i]] = trial->meshes[i].format;
      for (const double bound : trial->meshes[i].bound)
        result.maximum = std::max(result.maximum, bound);
      result.meshes.push_back(std::move(trial->meshes[i]));
    }
  }
  std::ranges::sort(result.meshes, {}, &CertifiedMesh::mesh);
  return result;
}

}  // namespace sunder::tools
