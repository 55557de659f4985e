#include "tools/tear/flesh_materials.h"

#include <memory>
#include <utility>

#include "core/internal/wall_material.h"
#include "tools/model/history.h"
#include "tools/model/named_material.h"
#include "tools/model/robot_joints.h"
#include "tools/value_of.h"

namespace sunder::tools {
namespace {

/// Flesh has a colour of its own. Fillings share no vertex with other submeshes.
void make_white(std::uint32_t submesh, Mesh& mesh) {
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t)
    if (mesh.triangle_submesh[t] == submesh)
      for (const std::uint32_t vertex : mesh.triangles[t])
        for (auto& colors : mesh.color_sets) colors[vertex].setOnes();
}

}  // namespace

bool has_fillings(const TornModel& model) {
  for (std::uint32_t m = 0; m < model.source().meshes.size(); ++m)
    if (model.character().meshes[m].submeshes.size() > model.source().meshes[m].submeshes.size())
      return true;
  return false;
}

Result<FleshMaterials> FleshMaterials::create(const TearRun& run) {
  Result<SurfaceKinds> kinds = SurfaceKinds::create(run.model.source(), run.loaded.source.get());
  if (!kinds) return kinds.error();
  return FleshMaterials(run, std::move(*kinds));
}

FleshMaterials::FleshMaterials(const TearRun& run, SurfaceKinds kinds)
    : run_(run), kinds_(std::move(kinds)) {
  for (const Operation& operation : value_of(run.model.history()))
    named_.insert(material_field(operation).material);
  for (const Mesh& mesh : run.model.source().meshes)
    if (const CustomAttribute* const authored = find_wall_materials(mesh))
      for (const float value : authored->values) named_.insert(wall_material_of(value));
}

std::vector<AppendedMaterial> FleshMaterials::appended() const {
  return {run_.request.flesh.material};
}

std::uint32_t FleshMaterials::beside(std::uint32_t mesh, std::uint32_t material) const {
  const bool is_flesh = run_.request.flesh.use == FleshOption::Use::flesh &&
                        !is_urdf(run_.request.model) &&
                        kinds_.of(mesh, material) != SurfaceKind::dead;
  return is_flesh ? kinds_.material_count() : material;
}

void FleshMaterials::give_to(std::uint32_t source_mesh, std::uint32_t submesh, Mesh& mesh) const {
  std::uint32_t& material = mesh.submeshes[submesh].material;
  if (material != kNone && named_.contains(material)) return;
  const std::uint32_t given = beside(source_mesh, material);
  if (given == material) return;
  material = given;
  if (!mesh.color_sets.empty()) make_white(submesh, mesh);
}

void FleshMaterials::give_to_fillings(Character& torn) const {
  for (std::uint32_t m = 0; m < torn.meshes.size(); ++m)
    for (std::size_t s = run_.model.source().meshes[m].submeshes.size();
         s < torn.meshes[m].submeshes.size(); ++s)
      give_to(m, static_cast<std::uint32_t>(s), torn.meshes[m]);
}

std::shared_ptr<const Character> FleshMaterials::with_flesh(const DetachedPiece& piece) const {
  if (!has_fillings(run_.model)) return piece.character;
  auto changed = std::make_shared<Character>(*piece.character);
  for (std::size_t m = 0; m < piece.meshes.size(); ++m) {
    Mesh& mesh = changed->meshes[m];
    const std::uint32_t source_mesh = piece.meshes[m].mesh;
    const auto& torn_submesh = run_.model.character().meshes[source_mesh].triangle_submesh;
    std::set<std::uint32_t> fillings;
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t)
      if (torn_submesh[piece.meshes[m].triangle_old_from_new[t]] >=
          run_.model.source().meshes[source_mesh].submeshes.size())
        fillings.insert(mesh.triangle_submesh[t]);
    for (const std::uint32_t submesh : fillings) give_to(source_mesh, submesh, mesh);
  }
  return changed;
}

}  // namespace sunder::tools
