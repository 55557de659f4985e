#include <sunder/tear/torn_model.h>

#include <algorithm>

#include "tear/model/model_access.h"

namespace sunder {

std::span<const std::array<std::uint32_t, 2>> scars_of(const TornModel& model) {
  if (model.undo_count() == 0) return {};
  return tear::ModelAccess::state_of(model).editor.connectivity.scars();
}

void mark_scars(const TornModel& model, Character& character) {
  if (scars_of(model).empty()) return;
  std::vector<bool> is_scar(model.point_count(), false);
  for (const auto& scar : scars_of(model))
    for (const std::uint32_t point : scar) is_scar[point] = true;
  for (std::uint32_t m = 0; m < character.meshes.size(); ++m) {
    Mesh& mesh = character.meshes[m];
    std::vector<float> marks(mesh.vertex_count(), 0.0f);
    bool has_any = false;
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
      if (is_retired(mesh.triangles[t])) continue;
      for (std::uint32_t k = 0; k < 3; ++k) {
        const std::uint32_t point = model.point_at(m, t, k);
        if (point == kNone || !is_scar[point]) continue;
        marks[mesh.triangles[t][k]] = 1.0f;
        has_any = true;
      }
    }
    if (!has_any) continue;
    const auto of_source = std::find_if(
        mesh.custom_attributes.begin(), mesh.custom_attributes.end(),
        [](const CustomAttribute& of) { return of.name == kScarAttribute && of.components == 1; });
    if (of_source == mesh.custom_attributes.end()) {
      mesh.custom_attributes.push_back({kScarAttribute, 1, true, std::move(marks)});
      continue;
    }
    for (std::size_t v = 0; v < marks.size(); ++v)
      of_source->values[v] = std::max(of_source->values[v], marks[v]);
  }
}

}  // namespace sunder
