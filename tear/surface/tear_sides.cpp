#include "tear/surface/tear_sides.h"

#include <algorithm>

namespace sunder::tear {

TearSides::TearSides(Character& character, EditColumns& columns)
    : character_(character), columns_(columns), spare_(character.meshes.size()) {
  for (const Index side : columns.surface.source_side) next_ = std::max(next_, side + 1);
  for (const Mesh& mesh : character.meshes) {
    const auto& attributes = mesh.custom_attributes;
    const auto found = std::find_if(
        attributes.begin(), attributes.end(),
        [](const CustomAttribute& a) { return a.name == kTearSideAttribute && a.components == 1; });
    attribute_.push_back(
        found == attributes.end() ? kNone : static_cast<Index>(found - attributes.begin()));
  }
}

void TearSides::add_to(Index mesh) {
  Mesh& of = character_.meshes[mesh];
  attribute_[mesh] = static_cast<Index>(of.custom_attributes.size());
  of.custom_attributes.push_back({kTearSideAttribute, 1, false, std::move(spare_[mesh])});
  of.custom_attributes.back().values.resize(of.vertex_count(), 0.0f);
}

void TearSides::remove_from(Index mesh) {
  auto& attributes = character_.meshes[mesh].custom_attributes;
  spare_[mesh] = std::move(attributes.back().values);
  attributes.pop_back();
  attribute_[mesh] = kNone;
}

void TearSides::reserve(std::size_t vertices) {
  for (std::size_t m = 0; m < spare_.size(); ++m) {
    Mesh& mesh = character_.meshes[m];
    mesh.custom_attributes.reserve(mesh.custom_attributes.size() + 1);
    if (vertices > 0) spare_[m].reserve(mesh.vertex_count() + vertices);
  }
}

void TearSides::add_for_operation(Index mesh) {
  add_to(mesh);
  columns_.additions.push_back({Addition::Kind::tear_sides, mesh});
}

void TearSides::write(Index mesh, Index vertex, Index side) {
  if (attribute_[mesh] == kNone) {
    if (side == 0) return;
    add_for_operation(mesh);
  }
  float& value = at(mesh, vertex);
  if (value == static_cast<float>(side)) return;
  columns_.side_changes.push_back({mesh, vertex, value});
  value = static_cast<float>(side);
}

void TearSides::write_to_new(Index mesh, Index vertex, Index side) {
  if (attribute_[mesh] == kNone) add_for_operation(mesh);
  at(mesh, vertex) = static_cast<float>(side);
}

}  // namespace sunder::tear
