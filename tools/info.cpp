#include <sunder/io/character_file.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/topology.h>

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <string>

#include "tools/model_check.h"
#include "tools/posed_model.h"
#include "tools/report.h"
#include "tools/value_of.h"
#include "tools/verbs.h"

namespace sunder::tools {
namespace {

/// The number of surface points of one mesh.
std::uint32_t point_count(const Character& character, const Mesh& mesh) {
  Character alone;
  alone.skeleton = character.skeleton;
  alone.skins = character.skins;
  alone.rest_morph_weights = character.rest_morph_weights;
  alone.meshes = {mesh};
  return value_of(count_topology(alone)).points;
}

Json mesh_json(const Character& character, const Mesh& mesh) {
  const ModelCheck check = check_mesh(mesh);
  std::vector<std::uint32_t> triangles_of(mesh.submeshes.size(), 0);
  for (const std::uint32_t submesh : mesh.triangle_submesh) ++triangles_of[submesh];
  Json submeshes = Json::array();
  for (std::size_t i = 0; i < mesh.submeshes.size(); ++i)
    submeshes.push_back({{"name", mesh.submeshes[i].name}, {"triangles", triangles_of[i]}});
  Json targets = Json::array(), attributes = Json::array();
  for (const MorphTarget& target : mesh.morph_targets) targets.push_back(target.name);
  for (const CustomAttribute& attribute : mesh.custom_attributes)
    attributes.push_back(attribute.name);
  return {{"name", mesh.name},
          {"vertices", mesh.vertex_count()},
          {"points", point_count(character, mesh)},
          {"triangles", mesh.triangle_count()},
          {"submeshes", std::move(submeshes)},
          {"skin", mesh.skin},
          {"influences_max", check.most_influences},
          {"weight_sum_min", check.least_weight_sum},
          {"weight_sum_max", check.greatest_weight_sum},
          {"normals", !mesh.normals.empty()},
          {"tangents", !mesh.tangents.empty()},
          {"uv_sets", mesh.uv_sets.size()},
          {"color_sets", mesh.color_sets.size()},
          {"morph_targets", std::move(targets)},
          {"custom_attributes", std::move(attributes)}};
}

Json info_json(const InfoRequest& request, const LoadedCharacter& loaded, const Bounds& bounds) {
  const Character& character = *loaded.character;
  Json info = {{"sunder_info", 1}, {"model", request.model.string()}};
  info.update(to_json(loaded.report));
  info["bounds"] = {{"min", vector_json(bounds.least)}, {"max", vector_json(bounds.greatest)}};
  info["meshes"] = Json::array();
  for (const Mesh& mesh : character.meshes) info["meshes"].push_back(mesh_json(character, mesh));
  info["bones"] = Json::array();
  for (const Bone& bone : character.skeleton.bones) info["bones"].push_back(bone.name);
  info["skins"] = Json::array();
  for (const Skin& skin : character.skins)
    info["skins"].push_back({{"name", skin.name}, {"bones", skin.bones.size()}});
  info["clips"] = Json::array();
  for (const Clip& clip : character.clips)
    info["clips"].push_back({{"name", clip.name},
                             {"duration", static_cast<double>(clip.duration)},
                             {"channels", clip.channels.size()}});
  const ModelCheck check = check_model(character);
  info["weight_sum_min"] = check.least_weight_sum;
  info["weight_sum_max"] = check.greatest_weight_sum;
  info["topology"] = to_json(value_of(count_topology(character)));
  return info;
}

/// Prints the same as text.
void print_info(const Json& info) {
  const auto text = [](const Json& value) { return value.get<std::string>(); };
  const auto number = [](const Json& value) { return value.get<double>(); };
  const auto count = [](const Json& value) { return value.get<std::size_t>(); };

  std::printf("%s: %s\n", text(info["model"]).c_str(), text(info["format"]).c_str());
  std::printf("space      %s\n", text(info["space"]).c_str());
  const Json &least = info["bounds"]["min"], &greatest = info["bounds"]["max"];
  std::printf("bounds     (%.5g, %.5g, %.5g) to (%.5g, %.5g, %.5g), at rest\n", number(least[0]),
              number(least[1]), number(least[2]), number(greatest[0]), number(greatest[1]),
              number(greatest[2]));
  std::printf("bones      %zu\n", info["bones"].size());
  for (std::size_t i = 0; i < info["skins"].size(); ++i)
    std::printf("skin %zu     '%s': %zu bones\n", i, text(info["skins"][i]["name"]).c_str(),
                count(info["skins"][i]["bones"]));
  for (std::size_t i = 0; i < info["meshes"].size(); ++i) {
    const Json& mesh = info["meshes"][i];
    std::printf(
        "mesh %zu     '%s': %zu vertices, %zu points, %zu triangles, %zu submeshes, skin %zu, up "
        "to %zu influences\n",
        i, text(mesh["name"]).c_str(), count(mesh["vertices"]), count(mesh["points"]),
        count(mesh["triangles"]), mesh["submeshes"].size(), count(mesh["skin"]),
        count(mesh["influences_max"]));
    std::printf("           %s, %s, %zu UV sets, %zu colour sets, %zu morph targets\n",
                mesh["normals"].get<bool>() ? "normals" : "no normals",
                mesh["tangents"].get<bool>() ? "tangents" : "no tangents", count(mesh["uv_sets"]),
                count(mesh["color_sets"]), mesh["morph_targets"].size());
  }
  for (std::size_t i = 0; i < info["clips"].size(); ++i)
    std::printf("clip %zu     '%s': %.4g s, %zu channels\n", i,
                text(info["clips"][i]["name"]).c_str(), number(info["clips"][i]["duration"]),
                count(info["clips"][i]["channels"]));
  std::printf("weights    sums from %.9g to %.9g\n", number(info["weight_sum_min"]),
              number(info["weight_sum_max"]));
  const Json& topology = info["topology"];
  std::printf("topology   %zu points, %zu edges, %zu triangles, %zu components\n",
              count(topology["points"]), count(topology["edges"]), count(topology["triangles"]),
              count(topology["components"]));
  std::printf(
      "           %zu boundary loops (%zu edges), %zu non-manifold edges, %zu degenerate "
      "triangles\n",
      count(topology["boundary_loops"]), count(topology["boundary_edges"]),
      count(topology["non_manifold_edges"]), count(topology["degenerate_triangles"]));
  for (const Json& note : info["notes"])
    std::printf("%-10s %s: %s (%zu)\n", text(note["kind"]).c_str(), text(note["place"]).c_str(),
                text(note["text"]).c_str(), count(note["count"]));
}

}  // namespace

ExitCode run_info(const InfoRequest& request) {
  const Result<LoadedCharacter> loaded = load_character(request.model);
  if (!loaded) return complain(request.model.string(), loaded.error(), ExitCode::unreadable_input);
  const Character& character = *loaded->character;
  const Result<ModelPose> rest = make_pose(character, RestPose{});
  if (!rest) return complain(request.model.string(), rest.error(), ExitCode::internal_error);
  const Result<std::vector<DeformedMesh>> posed = pose_model(character, *rest);
  if (!posed) return complain(request.model.string(), posed.error(), ExitCode::internal_error);

  const Json info = info_json(request, *loaded, bounds_of(character, *posed));
  if (request.as_json)
    std::fputs(dump(info).c_str(), stdout);
  else
    print_info(info);

  const auto& notes = loaded->report.notes;
  const bool was_changed = std::any_of(notes.begin(), notes.end(), [](const LoadNote& note) {
    return note.kind != LoadNote::Kind::information;
  });
  return was_changed ? ExitCode::findings : ExitCode::ok;
}

}  // namespace sunder::tools
