#include "io/faulty_documents.h"

#include <cmath>
#include <limits>
#include <utility>

namespace sunder::test {
namespace {

class Faults {
 public:
  void add(const char* name, GltfBuilder builder) { all.push_back({name, std::move(builder)}); }
  /// The strip with one value of its document changed.
  void add(const char* name, const char* pointer, Json value) {
    GltfBuilder builder = skinned_strip();
    builder.json[Json::json_pointer(pointer)] = std::move(value);
    add(name, std::move(builder));
  }

  std::vector<FaultyDocument> all;
};

/// Each skin has joints in two trees, so all become one, which must not be too deep to be read.
GltfBuilder skins_across_trees() {
  GltfBuilder builder = skinned_strip();
  const std::size_t first = builder.json["nodes"].size();
  for (std::size_t i = 0; i <= 1100; ++i) {
    builder.json["nodes"].push_back(Json::object());
    if (i > 0) builder.json["skins"].push_back({{"joints", {first + i - 1, first + i}}});
  }
  // Two trees that were put together meet.
  builder.json["nodes"].insert(builder.json["nodes"].end(), 4, Json::object());
  const std::size_t apart = builder.json["nodes"].size() - 4;
  for (const auto& joints :
       {std::pair{apart, apart + 1}, {apart + 2, apart + 3}, {apart, apart + 3}})
    builder.json["skins"].push_back({{"joints", {joints.first, joints.second}}});
  return builder;
}

void add_faults_of_properties(Faults& faults) {
  faults.add("skins_across_trees", skins_across_trees());
  faults.add("name_is_a_number", "/nodes/0/name", 7);
  faults.add("empty_children", "/nodes/2/children", Json::array());
  faults.add("empty_cameras", "/cameras", Json::array());
  faults.add("whole_number_with_fraction", "/nodes/0/mesh", 0.0);
  faults.add("extension_is_no_object", "/nodes/0/extensions", 3);
  faults.add("undeclared_extension", "/nodes/0/extensions", {{"EXT_unknown", Json::object()}});
  faults.add("required_but_not_used", "/extensionsRequired", {"KHR_materials_unlit"});
  faults.add("extension_elsewhere", "/nodes/0/extensions",
             {{"KHR_materials_unlit", Json::object()}});
  faults.add("version", "/asset/version", "2.9x");
  faults.add("material_out_of_range", "/materials",
             {{{"pbrMetallicRoughness", {{"metallicFactor", 3}, {"baseColorFactor", {1, 1}}}},
               {"alphaCutoff", -1},
               {"doubleSided", "yes"},
               {"emissiveFactor", {0, 0, 7}},
               {"normalTexture", {{"index", 9}}}}});
  faults.add("camera", "/cameras", {{{"type", "perspective"}}});
  faults.add("sampler", "/samplers", {{{"wrapS", 5}}});
  faults.add("texture", "/textures", {{{"source", 4}}});
  faults.add("light", "/extensions", {{"KHR_lights_punctual", {{"lights", {{{"type", 3}}}}}}});
  faults.add("target_of_view", "/bufferViews/0/target", 34963);
  faults.add("unused_accessor", "/accessors/20", nullptr);
}

void add_faults_of_nodes(Faults& faults) {
  faults.add("rotation_too_long", "/nodes/2/rotation", {0, 0, 0, 2});
  faults.add("rotation_slightly_too_long", "/nodes/2/rotation", {0, 0, 0, 1.001});
  faults.add("rotation_zero", "/nodes/2/rotation", {0, 0, 0, 0});
  faults.add("matrix_and_translation", "/nodes/2/matrix",
             {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 1, 0, 1});
  faults.add("sheared_matrix", "/nodes/2/matrix",
             {1, 0.5, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 1, 0, 1});
  faults.add("singular_matrix", "/nodes/2/matrix",
             {1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 1});
  faults.add("scene_lists_a_child", "/scenes/0/nodes", {0, 2, 1});
  faults.add("joints_outside_the_scene", "/scenes/0/nodes", {0});
  faults.add("wrong_skeleton", "/skins/0/skeleton", 0);
  faults.add("skin_without_mesh", "/nodes/1/skin", 0);
  faults.add("weights_without_morphs", "/nodes/0/weights", {1, 2});
  faults.add("joint_twice", "/skins/0/joints", {1, 1});
  GltfBuilder roots = skinned_strip();
  roots.json["nodes"][1].erase("children");
  roots.json["scenes"][0]["nodes"] = {0, 1, 2};
  faults.add("joints_without_common_root", std::move(roots));
  GltfBuilder mixed = skinned_strip();
  Json& primitives = mixed.json["meshes"][0]["primitives"];
  primitives.push_back(primitives[0]);
  for (const char* const key : {"JOINTS_0", "WEIGHTS_0"}) primitives[1]["attributes"].erase(key);
  faults.add("rigid_primitive_on_a_skin", mixed);
  primitives.erase(0);
  faults.add("skin_without_joints", std::move(mixed));
}

void add_faults_of_vertices(Faults& faults) {
  const auto with = [&](const char* name, const char* attribute, std::vector<float> values,
                        const char* type) {
    GltfBuilder builder = skinned_strip();
    strip_attributes(builder)[attribute] = builder.add(values, type);
    faults.add(name, std::move(builder));
  };
  const float not_a_number = std::numeric_limits<float>::quiet_NaN();
  with("normals_too_long", "NORMAL", std::vector<float>(3 * kStripVertices, 2.0f), "VEC3");
  with("normals_not_finite", "NORMAL", std::vector<float>(3 * kStripVertices, not_a_number),
       "VEC3");
  with("coordinates_not_finite", "TEXCOORD_0", std::vector<float>(2 * kStripVertices, not_a_number),
       "VEC2");
  with("colours_out_of_range", "COLOR_0", std::vector<float>(4 * kStripVertices, 3.0f), "VEC4");
  with("tangents_without_sign", "TANGENT", std::vector<float>(4 * kStripVertices, 0.5f), "VEC4");
  with("custom_not_finite", "_HEAT", std::vector<float>(kStripVertices, not_a_number), "SCALAR");
  with("unknown_attribute", "HEAT", std::vector<float>(kStripVertices, 1.0f), "SCALAR");
  with("gap_in_sets", "TEXCOORD_1", std::vector<float>(2 * kStripVertices, 0.5f), "VEC2");
  with("weights_zero", "WEIGHTS_0", std::vector<float>(4 * kStripVertices, 0.0f), "VEC4");
  with("weights_too_large", "WEIGHTS_0", std::vector<float>(4 * kStripVertices, 0.9f), "VEC4");
  with("weights_negative", "WEIGHTS_0", std::vector<float>(4 * kStripVertices, -0.25f), "VEC4");
  with("weights_not_finite", "WEIGHTS_0", std::vector<float>(4 * kStripVertices, not_a_number),
       "VEC4");
  GltfBuilder joints = skinned_strip();
  strip_attributes(joints)["JOINTS_0"] =
      joints.add(std::vector<std::uint8_t>(4 * kStripVertices, 9), "VEC4");
  faults.add("joints_out_of_range", std::move(joints));
  GltfBuilder indices = skinned_strip();
  indices.json["meshes"][0]["primitives"][0]["indices"] =
      indices.add(std::vector<std::uint16_t>{0, 1, 2, 1, 2, 99, 2, 1, 3, 4}, "SCALAR");
  faults.add("indices_out_of_range", std::move(indices));
  faults.add("bounds", "/accessors/0/min", {5, 5, 5});
  GltfBuilder bounds = skinned_strip();
  bounds.json["accessors"][0].erase("min");
  bounds.json["accessors"][0].erase("max");
  faults.add("no_bounds", std::move(bounds));
  GltfBuilder material = skinned_strip();
  material.json["images"] = {{{"uri", "data:image/png;base64,iVBORw0KGgo="}}};
  material.json["textures"] = {{{"source", 0}}};
  material.json["materials"] = {
      {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}, {"texCoord", 1}}}}}}};
  material.json["meshes"][0]["primitives"][0]["material"] = 0;
  faults.add("broken_image_and_no_coordinates", std::move(material));
}

void add_faults_of_unused_parts(Faults& faults) {
  GltfBuilder lines = skinned_strip();
  Json& primitives = lines.json["meshes"][0]["primitives"];
  Json line = primitives[0];
  line["mode"] = 1;
  line["indices"] = lines.add(std::vector<std::uint16_t>{0, 77}, "SCALAR");
  primitives.push_back(line);
  faults.add("lines_out_of_range", std::move(lines));
  GltfBuilder empty = skinned_strip();
  Json second = empty.json["meshes"][0];
  second["primitives"][0]["indices"] = empty.add(std::vector<std::uint16_t>{50, 51, 52}, "SCALAR");
  empty.json["meshes"].push_back(second);
  empty.json["nodes"].push_back({{"mesh", 1}, {"skin", 0}});
  empty.json["scenes"][0]["nodes"].push_back(empty.json["nodes"].size() - 1);
  faults.add("a_mesh_of_bad_triangles_only", std::move(empty));
  faults.add("a_mesh_that_nothing_uses", "/meshes/1",
             {{"primitives", {{{"attributes", {{"X", 0}}}}}}});
}

GltfBuilder animated(const std::vector<float>& times, const std::vector<float>& values,
                     const char* path, const char* type) {
  GltfBuilder builder = skinned_strip();
  const std::size_t input = builder.add(times, "SCALAR"), output = builder.add(values, type);
  builder.json["animations"] = {
      {{"channels", {{{"sampler", 0}, {"target", {{"node", 2}, {"path", path}}}}}},
       {"samplers", {{{"input", input}, {"output", output}}}}}};
  return builder;
}

void add_faults_of_animations(Faults& faults) {
  const std::vector<float> identity = {0, 0, 0, 1, 0, 0, 0, 1};
  faults.add("no_bounds_of_times", animated({0, 1}, identity, "rotation", "VEC4"));
  faults.add("rotations_too_long", animated({0, 1}, {0, 0, 0, 3, 0, 0, 0, 3}, "rotation", "VEC4"));
  faults.add("equal_times", animated({1, 1}, identity, "rotation", "VEC4"));
  faults.add("decreasing_times", animated({1, 0}, identity, "rotation", "VEC4"));
  faults.add("too_few_values", animated({0, 1}, {0, 0, 0, 1}, "rotation", "VEC4"));
  faults.add("weights_of_no_morphs", animated({0, 1}, {0, 1}, "weights", "SCALAR"));
  GltfBuilder twice = animated({0, 1}, identity, "rotation", "VEC4");
  Json& channels = twice.json["animations"][0]["channels"];
  channels.push_back(channels[0]);
  faults.add("target_twice", std::move(twice));
  GltfBuilder spline = animated({0}, {0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0}, "rotation", "VEC4");
  spline.json["animations"][0]["samplers"][0]["interpolation"] = "CUBICSPLINE";
  faults.add("spline_of_one_key", std::move(spline));
  GltfBuilder unknown = animated({0, 1}, identity, "rotation", "VEC4");
  unknown.json["animations"][0]["channels"][0]["target"]["path"] = "colour";
  faults.add("unknown_path", std::move(unknown));
}

}  // namespace

std::vector<FaultyDocument> faulty_documents() {
  Faults faults;
  add_faults_of_properties(faults);
  add_faults_of_nodes(faults);
  add_faults_of_vertices(faults);
  add_faults_of_unused_parts(faults);
  add_faults_of_animations(faults);
  return std::move(faults.all);
}

}  // namespace sunder::test
