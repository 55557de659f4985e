// The extension for Godot in a host of our own, which knows no more of it than Godot does: the
// entry, the class, what is called by variants and by pointers. What it draws is compared with the
// library itself.

#include <sunder/skinning/pose.h>
#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <dlfcn.h>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "godot/mock_host.h"
#include "support/models/rigs.h"

namespace sunder::godot_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

constexpr const char* kClass = "TearableSkeleton3D";

// ---- Objects of the scene.

std::unique_ptr<Value> result(Value value) { return std::make_unique<Value>(std::move(value)); }
std::size_t index_in(const Arguments& arguments) {
  return static_cast<std::size_t>(std::get<std::int64_t>(arguments[0].data));
}

struct Material : Object {
  Material() : Object(true) {}
  std::unique_ptr<Value> call(const std::string&, const Arguments&) override { return nullptr; }
};

struct ArrayMesh : Object {
  ArrayMesh() : Object(true) {}
  struct Surface {
    Value arrays, material;
    std::int64_t flags = 0;
    std::int64_t primitive = 3;
  };
  std::vector<Surface> surfaces;
  std::int64_t blend_shapes = 0;

  std::unique_ptr<Value> call(const std::string& method, const Arguments& arguments) override {
    if (method == "get_blend_shape_count") return result(of(blend_shapes));
    if (method == "get_surface_count")
      return result(of(static_cast<std::int64_t>(surfaces.size())));
    if (method == "surface_get_arrays") return result(surfaces.at(index_in(arguments)).arrays);
    if (method == "surface_get_primitive_type")
      return result(of(surfaces.at(index_in(arguments)).primitive));
    if (method == "surface_get_material") return result(surfaces.at(index_in(arguments)).material);
    if (method == "surface_set_material") {
      surfaces.at(index_in(arguments)).material = arguments.at(1);
      return result(nil());
    }
    if (method != "add_surface_from_arrays" || arguments.size() != 5) return nullptr;
    EXPECT_EQ(index_in(arguments), 3u) << "triangles";
    surfaces.push_back({arguments[1], nil(), std::get<std::int64_t>(arguments[4].data)});
    return result(nil());
  }
};

/// Godot's order of bones need not be ours: here it is reversed.
struct Skeleton3D : Object {
  explicit Skeleton3D(const Skeleton& of) : Object(false), bones(of.bones), pose(of.bones.size()) {}
  std::vector<Bone> bones;
  std::vector<Affine3d> pose;

  [[nodiscard]] std::size_t ours(std::size_t godot) const { return bones.size() - 1 - godot; }
  static Matrix matrix(const Affine3d& from) {
    Matrix to;
    for (std::size_t row = 0; row < 3; ++row) {
      const auto r = static_cast<Eigen::Index>(row);
      for (std::size_t column = 0; column < 3; ++column)
        to.basis[3 * row + column] =
            static_cast<float>(from.matrix()(r, static_cast<Eigen::Index>(column)));
      to.origin[row] = static_cast<float>(from.matrix()(r, 3));
    }
    return to;
  }
  std::unique_ptr<Value> call(const std::string& method, const Arguments& arguments) override {
    if (method == "get_bone_count") return result(of(static_cast<std::int64_t>(bones.size())));
    if (method == "find_bone") {
      for (std::size_t i = 0; i < bones.size(); ++i)
        if (bones[ours(i)].name == std::get<std::string>(arguments[0].data))
          return result(of(static_cast<std::int64_t>(i)));
      return result(of(std::int64_t{-1}));
    }
    const std::size_t bone = ours(index_in(arguments));
    if (method == "get_bone_name") return result(of(bones[bone].name));
    if (method == "get_bone_parent")
      return result(of(bones[bone].parent == kNone
                           ? std::int64_t{-1}
                           : static_cast<std::int64_t>(ours(bones[bone].parent))));
    if (method == "get_bone_rest") {
      Affine3d rest = Affine3d::Identity();
      rest.linear() = bones[bone].rest.rotation.cast<double>().toRotationMatrix() *
                      bones[bone].rest.scale.cast<double>().asDiagonal();
      rest.translation() = bones[bone].rest.translation.cast<double>();
      return result(of(matrix(rest)));
    }
    return method == "get_bone_global_pose" ? result(of(matrix(pose[bone]))) : nullptr;
  }
};

struct SkinResource : Object {
  SkinResource(const Skin& of, const Skeleton3D& on) : Object(true), skin(of), skeleton(on) {}
  const Skin& skin;
  const Skeleton3D& skeleton;
  bool has_names = false;

  std::unique_ptr<Value> call(const std::string& method, const Arguments& arguments) override {
    if (method == "get_bind_count") return result(of(static_cast<std::int64_t>(skin.bones.size())));
    const std::size_t bone = skin.bones[index_in(arguments)];
    if (method == "get_bind_bone")
      return result(
          of(has_names ? std::int64_t{-1} : static_cast<std::int64_t>(skeleton.ours(bone))));
    if (method == "get_bind_name")
      return result(of(has_names ? skeleton.bones[bone].name : std::string()));
    if (method != "get_bind_pose") return nullptr;
    return result(of(Skeleton3D::matrix(skin.bone_from_bind[index_in(arguments)].cast<double>())));
  }
};

struct MeshInstance3D : Object {
  MeshInstance3D() : Object(false) {}
  Value mesh, skin, skeleton;
  /// Its place in the world: axes are exchanged, then scaled, each by a power of two. So numbers go
  /// to the world and back without a rounding but that of the origin.
  Matrix world_from_local;
  int meshes_set = 0;

  [[nodiscard]] Vector to_world(const Vec3d& local) const {
    const Matrix& m = world_from_local;
    std::array<float, 3> world = m.origin;
    for (std::size_t row = 0; row < 3; ++row)
      for (std::size_t column = 0; column < 3; ++column)
        world[row] += static_cast<float>(static_cast<double>(m.basis[3 * row + column]) *
                                         local[static_cast<Eigen::Index>(column)]);
    return {world[0], world[1], world[2]};
  }
  [[nodiscard]] Vector to_local(const Vector& world) const {
    const Matrix& m = world_from_local;
    const std::array<float, 3> from = {world.x - m.origin[0], world.y - m.origin[1],
                                       world.z - m.origin[2]};
    std::array<float, 3> local = {};
    for (std::size_t row = 0; row < 3; ++row)
      for (std::size_t column = 0; column < 3; ++column)
        if (const float scale = m.basis[3 * row + column]; scale != 0)
          local[column] = from[row] / scale;
    return {local[0], local[1], local[2]};
  }
  std::unique_ptr<Value> call(const std::string& method, const Arguments& arguments) override {
    if (method == "get_mesh") return result(mesh);
    if (method == "get_skin") return result(skin);
    if (method == "get_skeleton_path") return result(of(std::string("..")));
    if (method == "get_node_or_null") return result(skeleton);
    if (method == "get_global_transform") return result(of(world_from_local));
    if (method == "to_local") return result(of(to_local(std::get<Vector>(arguments[0].data))));
    if (method != "set_mesh") return nullptr;
    mesh = arguments[0];
    ++meshes_set;
    return result(nil());
  }
};

/// A node of the extension.
struct Node : Object {
  Node() : Object(false) {}
  struct Signal {
    std::string name;
    Arguments arguments;
  };
  std::vector<Signal> signals;
  bool processes = false;
  std::function<void()> hears;  ///< A script that is connected to all signals.

  std::unique_ptr<Value> call(const std::string& method, const Arguments& arguments) override {
    if (method == "set_process") processes = std::get<bool>(arguments[0].data);
    if (method == "get_process_delta_time") return result(of(1.0 / 60));
    if (method == "emit_signal") {
      signals.push_back({std::get<std::string>(arguments[0].data),
                         Arguments(arguments.begin() + 1, arguments.end())});
      if (hears) hears();
    }
    const bool is_known = method == "set_process" || method == "emit_signal";
    return is_known ? result(nil()) : nullptr;
  }
};

// ---- A scene with a tube on bones.

template <class Vector, class Number>
std::vector<Number> flat(const std::vector<Vector>& vectors) {
  std::vector<Number> numbers;
  for (const Vector& vector : vectors)
    numbers.insert(numbers.end(), vector.data(), vector.data() + vector.size());
  return numbers;
}

/// A submesh as Godot has it: vertices of its own, clockwise triangles.
Value arrays_of(const Mesh& mesh, std::uint32_t submesh) {
  Value arrays = list(13);
  auto& entries = *std::get<List>(arrays.data);
  std::vector<std::int32_t> indices, bones;
  std::vector<float> weights;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (mesh.triangle_submesh[t] == submesh)
      for (const std::size_t corner : {0, 2, 1})
        indices.push_back(static_cast<std::int32_t>(mesh.triangles[t][corner]));
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v)
    for (std::size_t i = 0; i < 4; ++i) {
      const auto own = mesh.weights.of(v);
      bones.push_back(i < own.size() ? static_cast<std::int32_t>(own[i].slot) : 0);
      weights.push_back(i < own.size() ? own[i].weight : 0);
    }
  entries[0] = packed(Type::packed_vector3, flat<Vec3f, float>(mesh.positions));
  entries[1] = packed(Type::packed_vector3, flat<Vec3f, float>(mesh.normals));
  entries[4] = packed(Type::packed_vector2, flat<Vec2f, float>(mesh.uv_sets[0]));
  entries[10] = packed(Type::packed_int32, bones);
  entries[11] = packed(Type::packed_float32, weights);
  entries[12] = packed(Type::packed_int32, indices);
  return arrays;
}

/// What a drawn vertex is.
struct Corner {
  Vec3f position, normal;
  Vec2f uv;
  Vec3d posed;
  bool operator==(const Corner&) const = default;
};

class GodotExtension : public testing::Test {
 protected:
  void SetUp() override {
    host = {};
    library_ = dlopen(SUNDER_GODOT_LIBRARY, RTLD_NOW | RTLD_LOCAL);
    ASSERT_NE(library_, nullptr) << dlerror();
    entry_ = reinterpret_cast<Entry>(dlsym(library_, "sunder_godot_init"));
    ASSERT_NE(entry_, nullptr);
    host.construct = [](const std::string& name) -> Object* {
      if (name == "ArrayMesh") return new ArrayMesh;
      return name == "Node3D" ? new Node : nullptr;
    };
    ASSERT_EQ(entry_(get_proc_address(), this, &initialization_), 1);
    EXPECT_EQ(initialization_.minimum_level, godot::kSceneLevel);
    for (std::int32_t level = 0; level < 4; ++level)
      initialization_.initialize(initialization_.userdata, level);
    ASSERT_TRUE(host.classes.contains(kClass));
    build_scene();
  }

  void TearDown() override {
    node_.reset();
    instance_.reset();
    skeleton_.reset();
    for (std::int32_t level = 3; level >= 0; --level)
      initialization_.deinitialize(initialization_.userdata, level);
    EXPECT_TRUE(host.classes.empty());
    EXPECT_EQ(host.living_variants, 0);
    EXPECT_EQ(host.living_strings, 0);
    EXPECT_EQ(host.living_arrays, 0);
    EXPECT_THAT(Object::living, IsEmpty());
    EXPECT_EQ(dlclose(library_), 0);
  }

  using Entry = std::uint8_t (*)(godot::GetProcAddress, void*, godot::Initialization*);

  void build_scene() {
    character_ = test::make_tube(12, 10, 5);
    character_.meshes[0].morph_targets.clear();
    character_.rest_morph_weights.clear();
    character_.clips.clear();
    skeleton_ = std::make_unique<Skeleton3D>(character_.skeleton);
    auto* const mesh = new ArrayMesh;
    for (std::uint32_t s = 0; s < character_.meshes[0].submeshes.size(); ++s)
      mesh->surfaces.push_back({arrays_of(character_.meshes[0], s), of(new Material), 0});
    instance_ = std::make_unique<MeshInstance3D>();
    instance_->mesh = of(mesh);
    instance_->skin = of(new SkinResource(character_.skins[0], *skeleton_));
    instance_->skeleton = of(skeleton_.get());
    instance_->world_from_local = {{0, 0, 0.5f, 2, 0, 0, 0, 4, 0}, {3, -1, 2}};
    node_.reset(static_cast<Node*>(create()));
    pose_ = test::random_pose(character_, random_, 0.3, 1.0);
    for (Affine3d& bone : pose_.model_from_bone)  // Godot's numbers
      bone = bone.cast<float>().cast<double>();
    skeleton_->pose = pose_.model_from_bone;
  }

  static void* create() {
    const godot::ClassInfo& info = host.classes.at(kClass).info;
    return info.create_instance(info.class_userdata);
  }
  struct FreeNode {
    void operator()(Node* node) const {
      const godot::ClassInfo& info = host.classes.at(kClass).info;
      info.free_instance(info.class_userdata, node->instance);
      delete node;
    }
  };

  Value call(const std::string& method, const Arguments& arguments) {
    return call_method(kClass, node_->instance, method, arguments);
  }
  bool succeeds(const std::string& method, const Arguments& arguments) {
    return std::get<bool>(call(method, arguments).data);
  }
  std::string error() { return std::get<std::string>(call("get_error", {}).data); }
  void frame() { host.classes.at(kClass).info.notification(node_->instance, 17, 0); }

  [[nodiscard]] Vec3f to_world(const Vec3d& place) const {
    const Vector world = instance_->to_world(place);
    return {world.x, world.y, world.z};
  }
  [[nodiscard]] Vec3d to_local(const Vec3f& place) const {
    const Vector local = instance_->to_local({place.x(), place.y(), place.z()});
    return Vec3f(local.x, local.y, local.z).cast<double>();
  }

  /// A stroke in world space, as the host passes it.
  Arguments stroke(double width) {
    std::vector<Vec3f> bases, tips;
    blades_.clear();
    for (const Blade& blade : test::random_stroke(character_, pose_, random_, 0.3)) {
      bases.push_back(to_world(blade.base));
      tips.push_back(to_world(blade.tip));
      blades_.push_back({to_local(bases.back()), to_local(tips.back())});
    }
    return {packed(Type::packed_vector3, flat<Vec3f, float>(bases)),
            packed(Type::packed_vector3, flat<Vec3f, float>(tips)), of(width), of(0.0)};
  }

  /// Surface by surface, the corners of all triangles as Godot would draw them, turned round.
  std::vector<std::vector<Corner>> drawn() const {
    std::vector<std::vector<Corner>> all;
    const auto* const mesh =
        dynamic_cast<const ArrayMesh*>(std::get<Reference>(instance_->mesh.data).get());
    for (const ArrayMesh::Surface& surface : mesh->surfaces) {
      const auto& arrays = *std::get<List>(surface.arrays.data);
      const auto positions = numbers<float>(arrays[0]), normals = numbers<float>(arrays[1]),
                 uvs = numbers<float>(arrays[4]), weights = numbers<float>(arrays[11]);
      const auto bones = numbers<std::int32_t>(arrays[10]),
                 indices = numbers<std::int32_t>(arrays[12]);
      const std::size_t width = bones.size() / (positions.size() / 3);
      EXPECT_EQ(width, surface.flags == 0 ? 4u : 8u);
      all.emplace_back();
      for (std::size_t i = 0; i < indices.size(); i += 3) {
        if (indices[i] == indices[i + 1] && indices[i] == indices[i + 2])
          continue;  // draws nothing
        for (const std::size_t corner : {i, i + 2, i + 1}) {
          const auto v = static_cast<std::size_t>(indices[corner]);
          const Vec3f position(positions[3 * v], positions[3 * v + 1], positions[3 * v + 2]);
          Vec3d posed = Vec3d::Zero();
          for (std::size_t k = v * width; k < (v + 1) * width; ++k) {
            const auto slot = static_cast<std::size_t>(bones[k]);
            const Skin& skin = character_.skins[0];
            posed += static_cast<double>(weights[k]) *
                     Vec3d(pose_.model_from_bone[skin.bones[slot]] *
                           (skin.bone_from_bind[slot].cast<double>() * position.cast<double>()));
          }
          all.back().push_back({position,
                                {normals[3 * v], normals[3 * v + 1], normals[3 * v + 2]},
                                {uvs[2 * v], uvs[2 * v + 1]},
                                posed});
        }
      }
    }
    return all;
  }

  /// Compares what is drawn with a model of the library.
  void expect_drawn(const Character& wanted) const {
    const Mesh& mesh = wanted.meshes[0];
    const std::vector<Vec3d> posed = test::posed_positions(wanted, 0, pose_);
    const double diagonal = test::posed_diagonal(wanted, pose_);
    const std::vector<std::vector<Corner>> found = drawn();
    ASSERT_GE(found.size(), mesh.submeshes.size());
    for (std::size_t s = mesh.submeshes.size(); s < found.size(); ++s)
      EXPECT_THAT(found[s], IsEmpty()) << "of a wound that was taken back";
    for (std::uint32_t s = 0; s < mesh.submeshes.size(); ++s) {
      std::vector<std::uint32_t> corners;
      for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        if (mesh.triangle_submesh[t] == s && !is_retired(mesh.triangles[t]))
          corners.insert(corners.end(), mesh.triangles[t].begin(), mesh.triangles[t].end());
      ASSERT_EQ(found[s].size(), corners.size()) << "surface " << s;
      for (std::size_t i = 0; i < corners.size(); ++i) {
        const Corner& corner = found[s][i];
        EXPECT_EQ(corner.position, mesh.positions[corners[i]]);
        EXPECT_EQ(corner.normal, mesh.normals[corners[i]]);
        EXPECT_EQ(corner.uv, mesh.uv_sets[0][corners[i]]);
        if (mesh.weights.of(corners[i]).size() <= 8) {
          EXPECT_LE((corner.posed - posed[corners[i]]).norm(), 1e-5 * diagonal);
        }
      }
    }
  }

  void* library_ = nullptr;
  Entry entry_ = nullptr;
  godot::Initialization initialization_ = {};
  test::Random random_{7};
  Character character_;
  ModelPose pose_;
  Stroke blades_;
  std::unique_ptr<MeshInstance3D> instance_;
  std::unique_ptr<Skeleton3D> skeleton_;
  std::unique_ptr<Node, FreeNode> node_;
};

/// The character that the extension reads: submeshes have vertices of their own.
Character as_attached(Character character) {
  Mesh& mesh = character.meshes[0];
  Mesh joined = mesh;
  const std::uint32_t count = mesh.vertex_count();
  for (std::uint32_t s = 1; s < mesh.submeshes.size(); ++s) {
    joined.positions.insert(joined.positions.end(), mesh.positions.begin(), mesh.positions.end());
    joined.normals.insert(joined.normals.end(), mesh.normals.begin(), mesh.normals.end());
    joined.uv_sets[0].insert(joined.uv_sets[0].end(), mesh.uv_sets[0].begin(),
                             mesh.uv_sets[0].end());
    for (std::uint32_t v = 0; v < count; ++v) joined.weights.append(mesh.weights.of(v));
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      if (mesh.triangle_submesh[t] == s)
        for (std::uint32_t& corner : joined.triangles[t]) corner += s * count;
  }
  // In the order of the surfaces.
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> submeshes;
  for (std::uint32_t s = 0; s < mesh.submeshes.size(); ++s) {
    joined.submeshes[s].material = s;
    for (std::size_t t = 0; t < joined.triangles.size(); ++t)
      if (joined.triangle_submesh[t] == s) {
        triangles.push_back(joined.triangles[t]);
        submeshes.push_back(s);
      }
  }
  joined.triangles = triangles;
  joined.triangle_submesh = submeshes;
  mesh = joined;
  return character;
}

TEST_F(GodotExtension, registers_one_node_with_methods_and_signals) {
  const RegisteredClass& of = host.classes.at(kClass);
  EXPECT_EQ(of.parent, "Node3D");
  EXPECT_EQ(of.methods.size(), 10u);
  EXPECT_THAT(
      of.argument_types.at("tear"),
      testing::ElementsAre(Type::packed_vector3, Type::packed_vector3, Type::real, Type::real));
  EXPECT_EQ(of.signals.at("torn"), 2u);
  EXPECT_EQ(of.signals.at("failed"), 1u);
}

/// Lines "platform = …res://addons/sunder/FILE…" of a section, by platform.
std::map<std::string, std::string> files_of(const std::string& section) {
  std::ifstream file(SUNDER_GODOT_ADDON "/sunder.gdextension");
  std::map<std::string, std::string> files;
  const std::string folder = "res://addons/sunder/";
  bool is_inside = false;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("[")) is_inside = line == "[" + section + "]";
    const std::size_t begin = line.find(folder);
    if (!is_inside || begin == std::string::npos) continue;
    const std::size_t name = begin + folder.size();
    files[line.substr(0, line.find(' '))] = line.substr(name, line.find('"', name) - name);
  }
  return files;
}

TEST(GodotAddon, names_for_each_platform_the_files_that_are_built) {
  const std::map<std::string, std::string> libraries = files_of("libraries"),
                                           dependencies = files_of("dependencies");
  ASSERT_EQ(libraries.size(), 4u);
  for (const auto& [platform, file] : libraries)
    EXPECT_TRUE(dependencies.contains(platform)) << "an exported game would lack the C library";
  const std::filesystem::path addon = SUNDER_GODOT_ADDON;
  EXPECT_TRUE(
      std::filesystem::equivalent(addon / libraries.at("linux.x86_64"), SUNDER_GODOT_LIBRARY));
  EXPECT_TRUE(std::filesystem::exists(addon / dependencies.at("linux.x86_64")));
  EXPECT_EQ(dependencies.at("linux.arm64"), dependencies.at("linux.x86_64"));
}

TEST_F(GodotExtension, an_older_host_is_told_what_it_lacks) {
  godot::Initialization none = {};
  EXPECT_EQ(entry_(get_proc_address("classdb_register_extension_class2"), this, &none), 0);
  ASSERT_EQ(host.errors.size(), 1u);
  EXPECT_THAT(host.errors[0], HasSubstr("classdb_register_extension_class2"));
  ASSERT_EQ(entry_(get_proc_address(), this, &none), 1);
}

TEST_F(GodotExtension, tears_in_the_pose_as_the_library_does) {
  ASSERT_TRUE(succeeds("attach", {of(instance_.get())})) << error();
  EXPECT_TRUE(node_->processes);
  frame();
  EXPECT_EQ(instance_->meshes_set, 0) << "nothing has changed";
  auto model = TornModel::create(std::make_shared<const Character>(as_attached(character_)));
  ASSERT_TRUE(model) << model.error().text();
  for (const double width : {0.0, 0.02}) {
    ASSERT_TRUE(succeeds("tear", stroke(width))) << error();
    frame();
    const auto report = model->tear(pose_, blades_, {width, Layers::nearest, 0.0});
    ASSERT_TRUE(report) << report.error().text();
    ASSERT_GT(report->faces_crossed, 0u);
    ASSERT_EQ(node_->signals.back().name, "torn");
    EXPECT_EQ(std::get<std::int64_t>(node_->signals.back().arguments[0].data),
              report->faces_crossed);
    expect_drawn(model->character());
  }
  EXPECT_EQ(instance_->meshes_set, 2);
  ASSERT_TRUE(succeeds("undo", {}));
  ASSERT_TRUE(succeeds("undo", {}));
  frame();
  expect_drawn(as_attached(character_));
  EXPECT_EQ(instance_->meshes_set, 3);
  Arguments far = stroke(0);
  far[0] = far[1] = packed(Type::packed_vector3, std::vector<float>{90, 90, 90, 91, 90, 90});
  ASSERT_TRUE(succeeds("tear", far));
  frame();
  EXPECT_EQ(instance_->meshes_set, 3) << "it met nothing";
  EXPECT_THAT(host.errors, IsEmpty());
}

TEST_F(GodotExtension, strokes_over_frames_tear_in_the_pose_of_each) {
  ASSERT_TRUE(succeeds("attach", {of(instance_.get())})) << error();
  EXPECT_TRUE(succeeds("extend_stroke", {of(Vector{}), of(Vector{0, 0, 1}), of(0.1)}));
  frame();
  ASSERT_EQ(node_->signals.back().name, "failed") << "no stroke was begun";
  (void)stroke(0);  // chooses the blades
  const auto place = [&](const Vec3d& of_blade) {
    const Vec3f world = to_world(of_blade);
    return of(Vector{world.x(), world.y(), world.z()});
  };
  for (std::size_t i = 0; i < blades_.size(); ++i) {
    const Arguments blade = {place(blades_[i].base), place(blades_[i].tip)};
    ASSERT_TRUE(i == 0 ? succeeds("begin_stroke", {blade[0], blade[1], of(0.01), of(0.0)})
                       : succeeds("extend_stroke", {blade[0], blade[1], of(1.0 / 60)}))
        << error();
    frame();
    ASSERT_EQ(node_->signals.back().name, "torn") << error();
    for (Affine3d& bone : skeleton_->pose)  // it goes on to move
      bone = (Eigen::Translation3d(0.002, 0, 0) * bone).cast<float>().cast<double>();
  }
  ASSERT_TRUE(succeeds("end_stroke", {}));
  frame();
  std::int64_t faces = 0;
  for (const Node::Signal& signal : node_->signals)
    if (signal.name == "torn") faces += std::get<std::int64_t>(signal.arguments[0].data);
  EXPECT_GT(faces, 0);
  EXPECT_GT(instance_->meshes_set, 1);
  ASSERT_TRUE(succeeds("undo", {}));
  frame();
  ASSERT_EQ(node_->signals.back().name, "torn") << error();
  expect_drawn(as_attached(character_));
}

TEST_F(GodotExtension, cuts_get_caps_of_the_wound_material) {
  auto* const flesh = new Material;
  call("set_wound_material", {of(flesh)});
  ASSERT_TRUE(succeeds("attach", {of(instance_.get())})) << error();
  const Vec3f middle = to_world({0, 0.5, 0});
  ASSERT_TRUE(succeeds(
      "cut", {of(Vector{middle.x(), middle.y(), middle.z()}), of(Vector{0.1f, 1, 0}), of(true)}));
  frame();
  ASSERT_EQ(node_->signals.back().name, "torn");
  const auto* const mesh =
      dynamic_cast<const ArrayMesh*>(std::get<Reference>(instance_->mesh.data).get());
  ASSERT_EQ(mesh->surfaces.size(), 4u) << "a wound of each";
  for (const std::size_t wound : {2, 3})
    EXPECT_EQ(std::get<Reference>(mesh->surfaces[wound].material.data).get(), flesh);
  EXPECT_NE(std::get<Reference>(mesh->surfaces[0].material.data).get(), flesh);
  const std::string log = std::get<std::string>(call("get_log", {}).data);
  EXPECT_THAT(log, HasSubstr("sunder_operations"));
  EXPECT_THAT(log, HasSubstr("\"cut\""));
}

TEST_F(GodotExtension, pointers_do_as_variants_and_binds_may_have_names) {
  dynamic_cast<SkinResource*>(std::get<Reference>(instance_->skin.data).get())->has_names = true;
  const auto succeeds_by_pointers = [&](const std::string& method, const Arguments& arguments) {
    return std::get<bool>(
        ptrcall_method(kClass, node_->instance, method, arguments, Type::boolean).data);
  };
  ASSERT_TRUE(succeeds_by_pointers("attach", {of(instance_.get())})) << error();
  ASSERT_TRUE(succeeds_by_pointers("tear", stroke(0.01)));
  frame();
  auto model = TornModel::create(std::make_shared<const Character>(as_attached(character_)));
  ASSERT_TRUE(model->tear(pose_, blades_, {0.01, Layers::nearest, 0.0}));
  expect_drawn(model->character());
  EXPECT_THAT(std::get<std::string>(
                  ptrcall_method(kClass, node_->instance, "get_log", {}, Type::string).data),
              HasSubstr("\"tear\""));
}

TEST_F(GodotExtension, misuse_is_said) {
  EXPECT_FALSE(succeeds("tear", stroke(0)));
  EXPECT_THAT(error(), HasSubstr("nothing is attached"));
  Material other;
  other.references = 1;
  EXPECT_FALSE(succeeds("attach", {of(&other)}));
  EXPECT_THAT(error(), HasSubstr("no skeleton"));
  godot::CallError few = {};
  call_method(kClass, node_->instance, "attach", {}, &few);
  EXPECT_EQ(few.error, 4);
  EXPECT_EQ(few.expected, 1);
  auto* const mesh = dynamic_cast<ArrayMesh*>(std::get<Reference>(instance_->mesh.data).get());
  mesh->blend_shapes = 1;
  EXPECT_FALSE(succeeds("attach", {of(instance_.get())}));
  EXPECT_THAT(error(), HasSubstr("blend shapes"));
  mesh->blend_shapes = 0;
  auto& arrays = *std::get<List>(mesh->surfaces[1].arrays.data);
  const Value bones = arrays[10];
  arrays[10] = packed(Type::packed_int32, std::vector<std::int32_t>{1, 2});
  EXPECT_FALSE(succeeds("attach", {of(instance_.get())}));
  EXPECT_THAT(error(), HasSubstr("surface 1"));
  arrays[10] = bones;
  ASSERT_TRUE(succeeds("attach", {of(instance_.get())})) << error();
  Arguments unequal = stroke(0);
  unequal[1] = packed(Type::packed_vector3, std::vector<float>{1, 2, 3});
  EXPECT_FALSE(succeeds("tear", unequal));
  EXPECT_THAT(error(), HasSubstr("1 tips"));
  ASSERT_TRUE(succeeds("tear", {unequal[0], unequal[0], of(-1.0), of(0.0)})) << "it is queued";
  frame();
  ASSERT_FALSE(node_->signals.empty());
  EXPECT_EQ(node_->signals.back().name, "failed");
  EXPECT_THAT(error(), HasSubstr("width"));
  EXPECT_EQ(instance_->meshes_set, 0);
  EXPECT_TRUE(succeeds("attach", {of(static_cast<Object*>(nullptr))}));
  EXPECT_FALSE(succeeds("tear", stroke(0)));
  EXPECT_THAT(error(), HasSubstr("nothing is attached"));
}

TEST_F(GodotExtension, other_primitives_than_triangles_are_refused) {
  auto* const mesh = dynamic_cast<ArrayMesh*>(std::get<Reference>(instance_->mesh.data).get());
  const std::vector<std::string> names = {
      "points", "lines", "a line strip", "", "a triangle strip", "unknown primitives"};
  for (const std::size_t primitive : {0, 1, 2, 4, 5}) {
    mesh->surfaces[1].primitive = static_cast<std::int64_t>(primitive);
    EXPECT_FALSE(succeeds("attach", {of(instance_.get())}));
    EXPECT_THAT(error(), testing::StartsWith("surface 1: it is made of " + names[primitive] + ","));
  }
  mesh->surfaces[1].primitive = 3;
  EXPECT_TRUE(succeeds("attach", {of(instance_.get())})) << error();
}

TEST_F(GodotExtension, a_skeleton_that_is_freed_ends_it) {
  ASSERT_TRUE(succeeds("attach", {of(instance_.get())})) << error();
  ASSERT_TRUE(succeeds("tear", stroke(0.01)));
  skeleton_.reset();
  frame();
  ASSERT_EQ(node_->signals.size(), 1u);
  EXPECT_EQ(node_->signals.back().name, "failed");
  EXPECT_THAT(error(), HasSubstr("skeleton is gone"));
  frame();
  EXPECT_EQ(node_->signals.size(), 1u);
  EXPECT_THAT(host.errors, IsEmpty());
}

TEST_F(GodotExtension, a_mesh_instance_that_is_freed_ends_it) {
  ASSERT_TRUE(succeeds("attach", {of(instance_.get())})) << error();
  const Arguments blades = stroke(0.01);
  ASSERT_TRUE(succeeds("tear", blades));
  instance_.reset();
  const Value place = of(Vector{0, 1, 0});
  EXPECT_FALSE(succeeds("tear", blades));
  EXPECT_FALSE(succeeds("cut", {place, place, of(true)}));
  EXPECT_FALSE(succeeds("begin_stroke", {place, place, of(0.0), of(0.0)}));
  EXPECT_FALSE(succeeds("extend_stroke", {place, place, of(0.1)}));
  EXPECT_THAT(error(), HasSubstr("mesh instance is gone"));
  frame();
  ASSERT_EQ(node_->signals.size(), 1u);
  EXPECT_EQ(node_->signals.back().name, "failed");
  EXPECT_THAT(error(), HasSubstr("mesh instance is gone"));
  EXPECT_FALSE(succeeds("undo", {}));
  EXPECT_THAT(error(), HasSubstr("nothing is attached"));
  EXPECT_THAT(host.errors, IsEmpty());
}

TEST_F(GodotExtension, a_script_that_hears_a_signal_may_free_the_mesh_instance) {
  ASSERT_TRUE(succeeds("attach", {of(instance_.get())})) << error();
  ASSERT_TRUE(succeeds("tear", stroke(0.01)));
  node_->hears = [&] { instance_.reset(); };
  frame();
  ASSERT_EQ(node_->signals.size(), 1u);
  EXPECT_EQ(node_->signals.back().name, "torn");
  EXPECT_THAT(host.errors, IsEmpty());
}

TEST_F(GodotExtension, a_script_that_hears_a_signal_may_let_go) {
  ASSERT_TRUE(succeeds("attach", {of(instance_.get())})) << error();
  ASSERT_TRUE(succeeds("tear", stroke(0.01)));
  ASSERT_TRUE(succeeds("undo", {}));
  node_->hears = [&] { EXPECT_TRUE(succeeds("attach", {of(static_cast<Object*>(nullptr))})); };
  frame();
  EXPECT_EQ(node_->signals.size(), 2u) << "both operations have been applied";
  EXPECT_EQ(instance_->meshes_set, 0);
  EXPECT_THAT(host.errors, IsEmpty());
}

TEST_F(GodotExtension, a_failing_attach_changes_nothing) {
  ASSERT_TRUE(succeeds("attach", {of(instance_.get())})) << error();
  Material other;
  other.references = 1;
  EXPECT_FALSE(succeeds("attach", {of(&other)}));
  auto* const mesh = dynamic_cast<ArrayMesh*>(std::get<Reference>(instance_->mesh.data).get());
  mesh->blend_shapes = 1;
  EXPECT_FALSE(succeeds("attach", {of(instance_.get())}));
  mesh->blend_shapes = 0;
  ASSERT_TRUE(succeeds("tear", stroke(0.01))) << error();
  frame();
  auto model = TornModel::create(std::make_shared<const Character>(as_attached(character_)));
  ASSERT_TRUE(model->tear(pose_, blades_, {0.01, Layers::nearest, 0.0}));
  expect_drawn(model->character());
}

/// A triangle that a wide gap takes away is a surface of its own, before the others.
TEST_F(GodotExtension, a_surface_of_which_nothing_is_left_keeps_its_number) {
  constexpr double kWidth = 0.5;
  const Arguments blades = stroke(kWidth);
  std::vector<std::uint32_t>& submeshes = character_.meshes[0].triangle_submesh;
  const auto is_left = [](const Character& character) {
    const Mesh& mesh = character.meshes[0];
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      if (mesh.triangle_submesh[t] == 0 && !is_retired(mesh.triangles[t])) return true;
    return false;
  };
  std::shared_ptr<const Character> wanted;
  for (std::size_t alone = 0; alone < submeshes.size() && wanted == nullptr; ++alone) {
    submeshes.assign(submeshes.size(), 1);
    submeshes[alone] = 0;
    auto model = TornModel::create(std::make_shared<const Character>(as_attached(character_)));
    ASSERT_TRUE(model->tear(pose_, blades_, {kWidth, Layers::nearest, 0.0}));
    if (!is_left(model->character())) wanted = std::make_shared<Character>(model->character());
  }
  ASSERT_NE(wanted, nullptr);
  auto* const mesh = new ArrayMesh;
  for (std::uint32_t s = 0; s < 2; ++s)
    mesh->surfaces.push_back({arrays_of(character_.meshes[0], s), of(new Material), 0, 3});
  const Object* const material = std::get<Reference>(mesh->surfaces[1].material.data).get();
  instance_->mesh = of(mesh);
  ASSERT_TRUE(succeeds("attach", {of(instance_.get())})) << error();
  ASSERT_TRUE(succeeds("tear", blades));
  frame();
  expect_drawn(*wanted);
  const auto* const now =
      dynamic_cast<const ArrayMesh*>(std::get<Reference>(instance_->mesh.data).get());
  EXPECT_TRUE(drawn()[0].empty());
  EXPECT_EQ(std::get<Reference>(now->surfaces[1].material.data).get(), material);
  EXPECT_FALSE(numbers<std::int32_t>((*std::get<List>(now->surfaces[0].arrays.data))[12]).empty())
      << "Godot takes no surface without triangles";
}

/// At rest, where interpolated vertices stand exactly on the plane.
TEST_F(GodotExtension, a_cut_is_a_plane_of_the_world_where_the_instance_is_scaled) {
  pose_ = *rest_pose(character_);
  skeleton_->pose = pose_.model_from_bone;
  for (const Vector& normal : {Vector{0.5f, 1, 3}, Vector{-0.2f, -0.5f, 2}, Vector{0, 0, -1}}) {
    ASSERT_TRUE(succeeds("attach", {of(instance_.get())})) << error();
    const Vec3f middle = to_world({0, 0.5, 0});
    ASSERT_TRUE(
        succeeds("cut", {of(Vector{middle.x(), middle.y(), middle.z()}), of(normal), of(true)}));
    frame();
    ASSERT_EQ(node_->signals.back().name, "torn") << error();
    const Vec3d upwards = Vec3f(normal.x, normal.y, normal.z).cast<double>().normalized();
    const std::vector<std::vector<Corner>> surfaces = drawn();
    std::size_t of_caps = 0;
    for (std::size_t s = 2; s < surfaces.size(); ++s)
      for (const Corner& corner : surfaces[s]) {
        const Vec3d world = to_world(corner.posed).cast<double>();
        EXPECT_NEAR(upwards.dot(world - middle.cast<double>()), 0, 1e-5);
        ++of_caps;
      }
    EXPECT_GT(of_caps, 0u);
    ASSERT_TRUE(succeeds("undo", {}));
    frame();
  }
}

}  // namespace
}  // namespace sunder::godot_test
