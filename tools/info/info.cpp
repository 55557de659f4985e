#include <sunder/io/character_file.h>
#include <sunder/io/robot_file.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/topology.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tools/info/bone_table.h"
#include "tools/info/robot_info.h"
#include "tools/messages/lines.h"
#include "tools/messages/messages.h"
#include "tools/messages/overwriting.h"
#include "tools/messages/printed.h"
#include "tools/messages/text_file.h"
#include "tools/model/bone_extents.h"
#include "tools/model/load_notes.h"
#include "tools/model/model_check.h"
#include "tools/model/model_json.h"
#include "tools/model/pose_argument.h"
#include "tools/model/posed_model.h"
#include "tools/model/robot_joints.h"
#include "tools/value_of.h"
#include "tools/verbs.h"

namespace sunder::tools {
namespace {

std::vector<std::uint32_t> triangles_of_submeshes(const Mesh& mesh) {
  std::vector<std::uint32_t> counts(mesh.submeshes.size(), 0);
  for (const std::uint32_t submesh : mesh.triangle_submesh) ++counts[submesh];
  return counts;
}

Json mesh_json(const Mesh& mesh, const ModelCheck& check, std::uint32_t points) {
  const std::vector<std::uint32_t> triangles_of = triangles_of_submeshes(mesh);
  Json submeshes = Json::array();
  for (std::size_t i = 0; i < mesh.submeshes.size(); ++i)
    submeshes.push_back({{"name", mesh.submeshes[i].name}, {"triangles", triangles_of[i]}});
  Json targets = Json::array(), attributes = Json::array();
  for (const MorphTarget& target : mesh.morph_targets) targets.push_back(target.name);
  for (const CustomAttribute& attribute : mesh.custom_attributes)
    attributes.push_back(attribute.name);
  return {{"name", mesh.name},
          {"vertices", mesh.vertex_count()},
          {"points", points},
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

/// The materials that submeshes name, in the order of first use.
Json materials_json(const Character& character) {
  Json materials = Json::array();
  std::map<std::pair<std::uint32_t, std::string>, std::size_t> known;
  for (const Mesh& mesh : character.meshes) {
    const std::vector<std::uint32_t> triangles_of = triangles_of_submeshes(mesh);
    std::vector<bool> is_counted(mesh.submeshes.size(), false);
    for (const std::uint32_t submesh : mesh.triangle_submesh) {
      if (is_counted[submesh]) continue;
      is_counted[submesh] = true;
      const Submesh& of = mesh.submeshes[submesh];
      // Submeshes of one material may have names of their own.
      const auto [entry, is_new] = known.try_emplace(
          {of.material, of.material == kNone ? of.name : std::string()}, materials.size());
      if (is_new)
        materials.push_back(
            {{"name", of.name}, {"index", index_json(of.material)}, {"triangles", 0}});
      Json& triangles = materials[entry->second]["triangles"];
      triangles = triangles.get<std::size_t>() + triangles_of[submesh];
    }
  }
  return materials;
}

struct PosedInfo {
  PoseArgument pose;
  ModelPose model_pose;
  std::vector<DeformedMesh> meshes;
};

Json info_json(const InfoRequest& request, const LoadedCharacter& loaded, const PosedInfo& posed) {
  const Character& character = *loaded.character;
  const Bounds bounds = bounds_of(character, posed.meshes);
  Json info = {{"sunder_info", 1}, {"model", request.model.string()}};
  info.update(to_json(loaded.report));
  info["pose"] = posed.pose.name;
  info["bounds"] = {{"min", vector_json(bounds.least)}, {"max", vector_json(bounds.greatest)}};
  info["meshes"] = Json::array();
  std::vector<std::uint32_t> points_of_mesh;
  const TopologyCounts topology = value_of(count_topology(character, &points_of_mesh));
  ModelCheck check;
  for (std::size_t m = 0; m < character.meshes.size(); ++m) {
    const ModelCheck of_mesh = check_mesh(character.meshes[m]);
    check.least_weight_sum = std::min(check.least_weight_sum, of_mesh.least_weight_sum);
    check.greatest_weight_sum = std::max(check.greatest_weight_sum, of_mesh.greatest_weight_sum);
    info["meshes"].push_back(mesh_json(character.meshes[m], of_mesh, points_of_mesh[m]));
  }
  info["materials"] = materials_json(character);
  info["bones"] = Json::array();
  for (const Bone& bone : character.skeleton.bones) info["bones"].push_back(bone.name);
  if (request.with_bones)
    info["bone_tree"] = bone_tree_json(character.skeleton,
                                       measure_bones(character, posed.model_pose, posed.meshes));
  info["skins"] = Json::array();
  for (const Skin& skin : character.skins)
    info["skins"].push_back({{"name", skin.name}, {"bones", skin.bones.size()}});
  info["clips"] = Json::array();
  for (const Clip& clip : character.clips)
    info["clips"].push_back({{"name", clip.name},
                             {"duration", static_cast<double>(clip.duration)},
                             {"channels", clip.channels.size()}});
  info["static"] = is_static(character);
  info["weight_sum_min"] = check.least_weight_sum;
  info["weight_sum_max"] = check.greatest_weight_sum;
  info["topology"] = to_json(topology);
  return info;
}

std::string text(const Json& value) { return value.get<std::string>(); }
double number(const Json& value) { return value.get<double>(); }
std::size_t count(const Json& value) { return value.get<std::size_t>(); }

void add_meshes(const Json& meshes, Lines& lines) {
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const Json& mesh = meshes[i];
    lines.add(printed(
        "mesh %zu     '%s': %zu vertices, %zu points, %zu triangles, %zu submeshes, skin %zu, up "
        "to %zu influences",
        i, text(mesh["name"]).c_str(), count(mesh["vertices"]), count(mesh["points"]),
        count(mesh["triangles"]), mesh["submeshes"].size(), count(mesh["skin"]),
        count(mesh["influences_max"])));
    lines.add(printed("           %s, %s, %zu UV sets, %zu colour sets, %zu morph targets",
                      mesh["normals"].get<bool>() ? "normals" : "no normals",
                      mesh["tangents"].get<bool>() ? "tangents" : "no tangents",
                      count(mesh["uv_sets"]), count(mesh["color_sets"]),
                      mesh["morph_targets"].size()));
    std::string names;
    for (const Json& target : mesh["morph_targets"])
      names += (names.empty() ? "'" : ", '") + text(target) + "'";
    if (!names.empty()) lines.add(printed("  morphs   %s", names.c_str()));
  }
}

void add_materials_and_clips(const Json& info, Lines& lines) {
  // The indices are those that operations take: `cap_material`, `wall_material`.
  for (const Json& material : info["materials"])
    lines.add(printed("material %s '%s': %zu triangles",
                      material["index"].is_null() ? "-" : material["index"].dump().c_str(),
                      text(material["name"]).c_str(), count(material["triangles"])));
  for (std::size_t i = 0; i < info["clips"].size(); ++i)
    lines.add(printed("clip %zu     '%s': %.4g s, %zu channels", i,
                      text(info["clips"][i]["name"]).c_str(), number(info["clips"][i]["duration"]),
                      count(info["clips"][i]["channels"])));
  if (info["static"].get<bool>())
    lines.add("static     no clips, and no skin of several bones: nothing bends it");
}

/// The same as text.
Lines info_text(const Json& info) {
  Lines lines;
  lines.add(printed("%s: %s", text(info["model"]).c_str(), text(info["format"]).c_str()));
  lines.add(printed("space      %s", text(info["space"]).c_str()));
  const Json &least = info["bounds"]["min"], &greatest = info["bounds"]["max"];
  lines.add(printed("bounds     (%.5g, %.5g, %.5g) to (%.5g, %.5g, %.5g), in pose %s",
                    number(least[0]), number(least[1]), number(least[2]), number(greatest[0]),
                    number(greatest[1]), number(greatest[2]), text(info["pose"]).c_str()));
  lines.add(printed(
      "bones      %zu%s", info["bones"].size(),
      info.contains("bone_tree") ? "" : "; --bones lists them with their places and surfaces"));
  for (std::size_t i = 0; i < info["skins"].size(); ++i)
    lines.add(printed("skin %zu     '%s': %zu bones", i, text(info["skins"][i]["name"]).c_str(),
                      count(info["skins"][i]["bones"])));
  add_meshes(info["meshes"], lines);
  add_materials_and_clips(info, lines);
  lines.add(printed("weights    sums from %.9g to %.9g", number(info["weight_sum_min"]),
                    number(info["weight_sum_max"])));
  const Json& topology = info["topology"];
  lines.add(printed("topology   %zu points, %zu edges, %zu triangles, %zu components",
                    count(topology["points"]), count(topology["edges"]),
                    count(topology["triangles"]), count(topology["components"])));
  lines.add(
      printed("           %zu boundary loops (%zu edges), %zu non-manifold edges, %zu degenerate "
              "triangles",
              count(topology["boundary_loops"]), count(topology["boundary_edges"]),
              count(topology["non_manifold_edges"]), count(topology["degenerate_triangles"])));
  for (const Json& note : info["notes"])
    lines.add(printed("%-10s %s: %s (%zu)", text(note["kind"]).c_str(), text(note["place"]).c_str(),
                      text(note["text"]).c_str(), count(note["count"])));
  if (info.contains("bone_tree")) lines.add(bone_tree_text(info));
  return lines;
}

/// Prints or writes what was asked for.
ExitCode put_out(const InfoRequest& request, const Json& info, const Lines& robot) {
  if (request.report)
    if (const Status status = write_text(*request.report, dump(info)); !status)
      return complain(request.report->string(), status, ExitCode::unreadable_input);
  if (request.as_json) {
    print(info);
    return ExitCode::ok;
  }
  if (info.contains("bounds")) print(info_text(info));
  print(robot);
  return ExitCode::ok;
}

ExitCode describe(const InfoRequest& request, const LoadedCharacter& loaded, Json& info) {
  const Character& character = *loaded.character;
  Result<PoseArgument> argument = parse_pose(request.pose, character);
  if (!argument)
    return complain(request.model.string() + ": --pose", argument.error(), ExitCode::usage,
                    advice_on_pose(request.pose, character));
  if (!argument->remark.empty()) Messages(Verbosity::normal).warn("--pose: " + argument->remark);
  Result<ModelPose> pose = make_pose(character, argument->spec);
  if (!pose) return complain(request.model.string(), pose.error(), ExitCode::internal_error);
  Result<std::vector<DeformedMesh>> posed = pose_positions(character, *pose);
  if (!posed) return complain(request.model.string(), posed.error(), ExitCode::internal_error);
  info = info_json(request, loaded, {std::move(*argument), std::move(*pose), std::move(*posed)});
  return ExitCode::ok;
}

/// A robot is described also where it has no meshes, and what is wrong where it is refused.
ExitCode describe_robot(const InfoRequest& request, Budget& budget) {
  std::vector<RobotFinding> findings;
  Result<LoadedRobot> loaded =
      load_robot(request.model, robot_load_options(request.reading), &findings);
  Json info = {{"sunder_info", 1}, {"model", request.model.string()}};
  if (!loaded) {
    budget.end();
    info["robot"] = nullptr;
    info["findings"] = findings_json(findings);
    if (const ExitCode code = put_out(request, info, findings_text(findings)); code != ExitCode::ok)
      return code;
    return complain(request.model.string(), loaded.error(), ExitCode::unreadable_input);
  }
  const Messages messages(Verbosity::normal);
  warn_of_protection(request.model.string(), loaded->model.report, messages);
  loaded->model.report.notes.clear();  // they repeat the findings
  if (!loaded->model.character->meshes.empty())
    if (const ExitCode code = describe(request, loaded->model, info); code != ExitCode::ok)
      return code;
  info["robot"] = robot_json(loaded->robot);
  info["findings"] = findings_json(findings);
  Lines text = robot_text(loaded->robot);
  text.add(findings_text(findings));
  budget.end();
  if (const ExitCode code = put_out(request, info, text); code != ExitCode::ok) return code;
  const bool has_warnings = std::any_of(
      findings.begin(), findings.end(),
      [](const RobotFinding& finding) { return finding.severity == RobotSeverity::warning; });
  return has_warnings ? ExitCode::findings : ExitCode::ok;
}

}  // namespace

ExitCode run_info(const InfoRequest& request) {
  if (request.report)
    if (const std::string fault =
            overwriting({{"MODEL", request.model}}, {{"--report", *request.report}});
        !fault.empty()) {
      print_error("sunder: " + fault);
      return ExitCode::usage;
    }
  Budget budget(request.budget, request.model.string());
  if (is_urdf(request.model)) return describe_robot(request, budget);
  const Result<LoadedCharacter> loaded =
      load_character(request.model, load_options(request.reading));
  if (!loaded) return complain(request.model.string(), loaded.error(), ExitCode::unreadable_input);
  warn_of_protection(request.model.string(), loaded->report, Messages(Verbosity::normal));
  Json info;
  if (const ExitCode code = describe(request, *loaded, info); code != ExitCode::ok) return code;
  budget.end();
  if (const ExitCode code = put_out(request, info, {}); code != ExitCode::ok) return code;

  const auto& notes = loaded->report.notes;
  const bool was_changed = std::any_of(notes.begin(), notes.end(), is_change);
  return was_changed ? ExitCode::findings : ExitCode::ok;
}

}  // namespace sunder::tools
