#include "tools/tear/blood_of_run.h"

#include <utility>

#include "tools/model/posed_model.h"
#include "tools/render/png_file.h"
#include "tools/tear/pose_of_run.h"
#include "tools/value_of.h"

namespace sunder::tools {
namespace {

void multiply_colors(std::span<const Vec3f> tints, std::span<const std::uint32_t> vertices,
                     Mesh& mesh) {
  if (mesh.color_sets.empty())
    mesh.color_sets.emplace_back(mesh.vertex_count(), Vec4f(Vec4f::Ones()));
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    Vec4f& color = mesh.color_sets[0][i];
    color.head<3>() = color.head<3>().cwiseProduct(tints[vertices[i]]);
  }
}

}  // namespace

ExitCode lay_blood_of_run(TearRun& run) {
  if (!run.request.blood) return ExitCode::ok;
  const std::string place = run.request.model.string() + ": --blood";
  const Result<ModelLooks> looks = ModelLooks::create(run.loaded.source.get());
  if (!looks) return complain(place, looks.error(), ExitCode::internal_error);
  const Result<ModelPose> pose = pose_of_run(run);
  if (!pose) return complain(place, pose.error(), ExitCode::internal_error);
  const auto posed = pose_positions(run.model.source(), *pose);
  if (!posed) return complain(place, posed.error(), ExitCode::internal_error);
  BloodOptions options;
  options.flow_pose = &*pose;
  options.reach = *run.request.blood;
  if (options.reach == 0)
    options.reach = blood_reach(bounds_of(run.model.source(), *posed).size().norm());
  Result<BloodLayers> layers = lay_blood(run.model, *posed, *looks, options);
  if (!layers) return complain(place, layers.error(), ExitCode::internal_error);
  run.blood = {options.reach, {}, std::move(*layers)};
  for (BloodTexture& texture : run.blood->layers.textures) {
    run.blood->images.push_back(encode_png(texture.image));
    texture.image.rgba.clear();
    texture.image.rgba.shrink_to_fit();
  }
  for (const std::string& note : run.blood->layers.notes) run.messages.say("--blood: " + note);
  if (run.blood->layers.textures.empty() && run.blood->layers.tints.empty()) {
    run.messages.warn("--blood: no operation left a wound");
    run.has_findings = true;
  }
  return ExitCode::ok;
}

std::vector<PaintedMaterial> painted_materials(const TearRun& run) {
  std::vector<PaintedMaterial> painted;
  if (!run.blood) return painted;
  for (std::size_t i = 0; i < run.blood->images.size(); ++i) {
    const BloodTexture& texture = run.blood->layers.textures[i];
    PaintedMaterial material{texture.material, run.blood->images[i], texture.uv_set, {}};
    const auto& at = texture.image_from_uv;
    if (texture.is_placed_anew) material.placement = {at.col(2), Vec2f(at(0, 0), at(1, 1))};
    painted.push_back(std::move(material));
  }
  return painted;
}

void give_blood(const TearRun& run, std::uint32_t first_material, Character& character) {
  if (!run.blood) return;
  const BloodLayers& layers = run.blood->layers;
  for (std::uint32_t i = 0; i < layers.textures.size(); ++i)
    character.meshes[layers.textures[i].mesh].submeshes[layers.textures[i].submesh].material =
        first_material + i;
  for (const BloodTints& of : layers.tints) {
    std::vector<std::uint32_t> vertices(of.tints.size());
    for (std::uint32_t v = 0; v < vertices.size(); ++v) vertices[v] = v;
    multiply_colors(of.tints, vertices, character.meshes[of.mesh]);
  }
}

std::shared_ptr<const Character> with_blood(const TearRun& run, std::uint32_t first_material,
                                            const DetachedPiece& piece,
                                            std::shared_ptr<const Character> character) {
  if (!run.blood) return character;
  auto changed = std::make_shared<Character>(*character);
  const BloodLayers& layers = run.blood->layers;
  for (std::size_t m = 0; m < piece.meshes.size(); ++m) {
    Mesh& mesh = changed->meshes[m];
    const auto& torn = run.model.character().meshes[piece.meshes[m].mesh];
    for (std::uint32_t i = 0; i < layers.textures.size(); ++i) {
      if (layers.textures[i].mesh != piece.meshes[m].mesh) continue;
      for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t)
        if (torn.triangle_submesh[piece.meshes[m].triangle_old_from_new[t]] ==
            layers.textures[i].submesh)
          mesh.submeshes[mesh.triangle_submesh[t]].material = first_material + i;
    }
    for (const BloodTints& of : layers.tints)
      if (of.mesh == piece.meshes[m].mesh)
        multiply_colors(of.tints, piece.meshes[m].vertex_old_from_new, mesh);
  }
  return changed;
}

Json blood_json(const TearRun& run) {
  std::size_t tinted = run.blood->layers.tints.size();
  Json textures = Json::array();
  for (const BloodTexture& texture : run.blood->layers.textures)
    textures.push_back({{"mesh", texture.mesh},
                        {"submesh", texture.submesh},
                        {"size", {texture.image.width, texture.image.height}}});
  return {{"reach", run.blood->reach},
          {"textures", std::move(textures)},
          {"meshes_with_vertex_colours", tinted},
          {"notes", run.blood->layers.notes}};
}

}  // namespace sunder::tools
