#include "tear/filling/rim_values.h"

#include <algorithm>

#include "tear/geometry/tolerances.h"

namespace sunder::tear {

RimValues::RimValues(Index mesh, std::span<const Index> vertices, const SurfaceEditor& editor)
    : editor_(editor),
      mesh_(mesh),
      target_count_(editor.character().meshes[mesh].morph_targets.size()),
      slots_(&editor.scratch()),
      place_of_(&editor.scratch()),
      influences_(&editor.scratch()),
      displacements_(target_count_, Vec3d::Zero(), &editor.scratch()) {
  place_of_.resize(editor.character().skins[editor.character().meshes[mesh].skin].bones.size(),
                   kNone);
  for (const Index vertex : vertices)
    for (const Influence& influence : editor.births.influences(mesh, vertex))
      place_of_[influence.slot] = 0;
  slots_.reserve(place_of_.size());
  for (Index slot = 0; slot < place_of_.size(); ++slot) {
    if (place_of_[slot] == kNone) continue;
    place_of_[slot] = static_cast<Index>(slots_.size());
    slots_.push_back(slot);
  }
  influences_.reserve(slots_.size());
}

ScratchVector<double> RimValues::rows(std::span<const Index> vertices,
                                      std::size_t point_count) const {
  const Mesh& of = editor_.character().meshes[mesh_];
  const std::size_t first_morph = 3 + slots_.size(), width = channels();
  ScratchVector<double> values(point_count * width, 0.0, &editor_.scratch());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    double* const row = &values[i * width];
    const Vec3f& at = editor_.births.position(mesh_, vertices[i]);
    for (Eigen::Index k = 0; k < 3; ++k) row[k] = static_cast<double>(at[k]);
    for (const Influence& influence : editor_.births.influences(mesh_, vertices[i]))
      row[3 + place_of_[influence.slot]] = static_cast<double>(influence.weight);
    for (std::size_t t = 0; t < target_count_; ++t) {
      const auto& deltas = of.morph_targets[t].position_deltas;
      for (Eigen::Index k = 0; k < 3 && !deltas.empty(); ++k)
        row[first_morph + 3 * t + static_cast<std::size_t>(k)] =
            static_cast<double>(deltas[vertices[i]][k]);
    }
  }
  return values;
}

RimValues::Vertex RimValues::vertex_of(const double* row) {
  weigh(row + 3);
  for (std::size_t t = 0; t < target_count_; ++t)
    displacements_[t] = Eigen::Map<const Eigen::Vector3d>(row + 3 + slots_.size() + 3 * t);
  return {Eigen::Map<const Eigen::Vector3d>(row), influences_, displacements_};
}

void RimValues::weigh(const double* weights) {
  influences_.clear();
  const double largest = *std::max_element(weights, weights + slots_.size());
  const double least = std::min(kLeastCapWeight, kLeastCapWeightByLargest * largest);
  double sum = 0;
  for (std::size_t s = 0; s < slots_.size(); ++s) {
    if (!(weights[s] > 0) || weights[s] < least) continue;
    influences_.push_back({slots_[s], static_cast<float>(weights[s])});
    sum += static_cast<double>(influences_.back().weight);
  }
  for (Influence& influence : influences_)
    influence.weight = static_cast<float>(static_cast<double>(influence.weight) / sum);
  std::sort(influences_.begin(), influences_.end(), [](const Influence& a, const Influence& b) {
    return a.weight != b.weight ? a.weight > b.weight : a.slot < b.slot;
  });
}

bool RimValues::are_same(Index mesh, Index vertex, Index other, const SurfaceEditor& editor) {
  if (editor.births.position(mesh, vertex) != editor.births.position(mesh, other)) return false;
  const auto influences = editor.births.influences(mesh, vertex),
             of_other = editor.births.influences(mesh, other);
  const auto is_same = [](const Influence& a, const Influence& b) {
    return a.slot == b.slot && a.weight == b.weight;
  };
  if (!std::equal(influences.begin(), influences.end(), of_other.begin(), of_other.end(), is_same))
    return false;
  const auto& targets = editor.character().meshes[mesh].morph_targets;
  return std::all_of(targets.begin(), targets.end(), [&](const MorphTarget& target) {
    return target.position_deltas.empty() ||
           target.position_deltas[vertex] == target.position_deltas[other];
  });
}

}  // namespace sunder::tear
