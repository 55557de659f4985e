#include "tools/model/model_check.h"

#include <algorithm>
#include <cmath>

namespace sunder::tools {
namespace {

template <class Vector>
std::uint64_t count_non_finite(const std::vector<Vector>& values) {
  std::uint64_t count = 0;
  for (const Vector& value : values)
    for (int i = 0; i < Vector::RowsAtCompileTime; ++i) count += std::isfinite(value[i]) ? 0 : 1;
  return count;
}

void check_weights(const Mesh& mesh, ModelCheck& check) {
  for (std::uint32_t v = 0; v < mesh.weights.vertex_count(); ++v) {
    const auto influences = mesh.weights.of(v);
    double sum = 0;
    for (const Influence& influence : influences) {
      if (!std::isfinite(influence.weight)) ++check.non_finite_values;
      sum += static_cast<double>(influence.weight);
      check.least_weight = std::min(check.least_weight, static_cast<double>(influence.weight));
    }
    check.least_weight_sum = std::min(check.least_weight_sum, sum);
    check.greatest_weight_sum = std::max(check.greatest_weight_sum, sum);
    check.most_influences =
        std::max(check.most_influences, static_cast<std::uint32_t>(influences.size()));
  }
  check.greatest_weight_sum_error =
      std::max(check.greatest_weight_sum - 1, 1 - check.least_weight_sum);
}

}  // namespace

ModelCheck check_mesh(const Mesh& mesh) {
  ModelCheck check;
  check.non_finite_values = count_non_finite(mesh.positions) + count_non_finite(mesh.normals) +
                            count_non_finite(mesh.tangents);
  for (const auto& uv : mesh.uv_sets) check.non_finite_values += count_non_finite(uv);
  for (const auto& colors : mesh.color_sets) check.non_finite_values += count_non_finite(colors);
  for (const MorphTarget& target : mesh.morph_targets)
    check.non_finite_values += count_non_finite(target.position_deltas) +
                               count_non_finite(target.normal_deltas) +
                               count_non_finite(target.tangent_deltas);
  check_weights(mesh, check);
  return check;
}

ModelCheck check_model(const Character& character) {
  ModelCheck all;
  for (const Mesh& mesh : character.meshes) {
    const ModelCheck one = check_mesh(mesh);
    all.least_weight_sum = std::min(all.least_weight_sum, one.least_weight_sum);
    all.greatest_weight_sum = std::max(all.greatest_weight_sum, one.greatest_weight_sum);
    all.greatest_weight_sum_error =
        std::max(all.greatest_weight_sum_error, one.greatest_weight_sum_error);
    all.least_weight = std::min(all.least_weight, one.least_weight);
    all.most_influences = std::max(all.most_influences, one.most_influences);
    all.non_finite_values += one.non_finite_values;
  }
  return all;
}

bool is_static(const Character& character) {
  return character.clips.empty() && std::ranges::all_of(character.skins, [](const Skin& skin) {
           return skin.bones.size() <= 1;
         });
}

}  // namespace sunder::tools
