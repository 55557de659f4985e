#include "tear/surface/tear_sides.h"

#include <algorithm>

namespace sunder::tear {

TearSides::TearSides(Character& character, EditColumns& columns)
    : character_(character), columns_(columns) {
  for (const Index side : columns.surface.source_side) next_ = std::max(next_, side + 1);
  for (std::size_t m = 0; m < character.meshes.size(); ++m) {
    const auto& attributes = character.meshes[m].custom_attributes;
    const auto found = std::find_if(
        attributes.begin(), attributes.end(),
        [](const CustomAttribute& a) { return a.name == kTearSideAttribute && a.components == 1; });
    if (found != attributes.end())
      columns.meshes[m].tear_side = static_cast<Index>(found - attributes.begin());
  }
}

void TearSides::add_to(Index mesh) {
  Mesh& of = character_.meshes[mesh];
  MeshColumns& columns = columns_.meshes[mesh];
  columns.spare_sides.resize(of.vertex_count(), 0.0f);
  of.custom_attributes.push_back({kTearSideAttribute, 1, false, std::move(columns.spare_sides)});
  columns.tear_side = static_cast<Index>(of.custom_attributes.size() - 1);
}

void TearSides::remove_from(Index mesh) {
  auto& attributes = character_.meshes[mesh].custom_attributes;
  columns_.meshes[mesh].spare_sides = std::move(attributes.back().values);
  attributes.pop_back();
  columns_.meshes[mesh].tear_side = kNone;
}

void TearSides::reserve() {
  for (Mesh& mesh : character_.meshes)
    mesh.custom_attributes.reserve(mesh.custom_attributes.size() + 1);
}

void TearSides::add_for_operation(Index mesh) {
  // Memory first: a roll back removes the attribute if, and only if, this addition is listed.
  auto& additions = columns_.additions;
  if (additions.size() == additions.capacity()) additions.reserve(2 * additions.size() + 8);
  add_to(mesh);
  additions.push_back({Addition::Kind::tear_sides, mesh});
}

void TearSides::write(Index mesh, Index vertex, Index side) {
  if (columns_.meshes[mesh].tear_side == kNone) {
    if (side == 0) return;
    add_for_operation(mesh);
  }
  float& value = at(mesh, vertex);
  if (value == static_cast<float>(side)) return;
  columns_.side_changes.push_back({mesh, vertex, value});
  value = static_cast<float>(side);
}

void TearSides::write_to_new(Index mesh, Index vertex, Index side) {
  if (columns_.meshes[mesh].tear_side == kNone) add_for_operation(mesh);
  at(mesh, vertex) = static_cast<float>(side);
}

}  // namespace sunder::tear
