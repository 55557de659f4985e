#include "bindings/godot/tearable_skeleton.h"

#include <algorithm>
#include <array>
#include <utility>

namespace sunder::godot {
namespace {

constexpr std::int64_t kTriangles = 3;                            // Mesh.PRIMITIVE_TRIANGLES
constexpr std::int64_t kEightInfluences = std::int64_t{1} << 27;  // ARRAY_FLAG_USE_8_BONE_WEIGHTS

std::vector<Vector3> places_of(const Variant& array) {
  const std::vector<float> numbers = array.numbers<float>(Type::packed_vector3, 3);
  std::vector<Vector3> places;
  for (std::size_t i = 0; i < numbers.size(); i += 3)
    places.push_back({numbers[i], numbers[i + 1], numbers[i + 2]});
  return places;
}

void set(double (&to)[3], const Vector3& from) {
  to[0] = static_cast<double>(from.x);
  to[1] = static_cast<double>(from.y);
  to[2] = static_cast<double>(from.z);
}

Vector3 to_local(const Variant& node, const Vector3& place) {
  return node.call("to_local", Variant(place)).vector3();
}

sunder_blade blade(const Variant& mesh_instance, const Vector3& base, const Vector3& tip) {
  sunder_blade blade = {};
  set(blade.base, to_local(mesh_instance, base));
  set(blade.tip, to_local(mesh_instance, tip));
  return blade;
}

/// A plane's normal goes to a node's space by the transposed basis: n . (M x) = (M^T n) . x.
void set_local_normal(double (&to)[3], const Vector3& normal, const Transform& world_from_local) {
  const std::array<float, 3> world = {normal.x, normal.y, normal.z};
  for (std::size_t column = 0; column < 3; ++column) {
    to[column] = 0;
    for (std::size_t row = 0; row < 3; ++row)
      to[column] += static_cast<double>(world_from_local.basis[3 * row + column]) *
                    static_cast<double>(world[row]);
  }
}

sunder_tear_options gap(double width, double wall_depth) {
  sunder_tear_options options = sunder_default_tear_options();
  options.width = width;
  options.wall_depth = wall_depth;
  return options;
}

}  // namespace

bool TearableSkeleton::fail(std::string text) {
  error_ = std::move(text);
  return false;
}

bool TearableSkeleton::check(sunder_status status) {
  if (status == SUNDER_OK) return true;
  return fail(sunder_last_error());
}

Torn::~Torn() {
  if (scene != 0) sunder_destroy_scene(scene);
  if (asset != 0) sunder_destroy_asset(asset);
  if (character != 0) sunder_destroy_character(character);
}

bool TearableSkeleton::attach(const Variant& mesh_instance) {
  if (mesh_instance.is_nil()) {
    torn_.reset();
    return true;
  }
  const Variant mesh = mesh_instance.call("get_mesh");
  const Variant skeleton =
      mesh_instance.call("get_node_or_null", mesh_instance.call("get_skeleton_path"));
  auto torn = std::make_unique<Torn>();
  if (std::string fault = torn->skeleton.read(skeleton, mesh_instance.call("get_skin"));
      !fault.empty())
    return fail(std::move(fault));
  MeshArrays arrays;
  if (std::string fault = arrays.read(mesh, torn->skeleton.skin().slot_count); !fault.empty())
    return fail(std::move(fault));
  if (!create(arrays, *torn)) return false;
  torn->surface_count = arrays.mesh().submesh_count;
  torn->mesh_instance = NodeReference(mesh_instance);
  torn->skeleton_node = NodeReference(skeleton);
  torn->source_mesh = mesh;
  torn_ = std::move(torn);
  self().call("set_process", Variant(true));
  return true;
}

bool TearableSkeleton::create(const MeshArrays& arrays, Torn& torn) {
  const sunder_mesh mesh = arrays.mesh();
  const sunder_skin skin = torn.skeleton.skin();
  sunder_character_data data = sunder_default_character_data();
  data.name = "character";
  data.bones = torn.skeleton.bones().data();
  data.bone_count = static_cast<std::uint32_t>(torn.skeleton.bones().size());
  data.skins = &skin;
  data.skin_count = 1;
  data.meshes = &mesh;
  data.mesh_count = 1;
  sunder_asset_options of_asset = sunder_default_asset_options();
  of_asset.poses_vertices = 0;  // Godot does
  sunder_scene_options of_scene = sunder_default_scene_options();
  of_scene.threads = 1;
  return check(sunder_check_abi(SUNDER_C_VERSION, 0)) &&
         check(sunder_create_character(&data, &torn.character)) &&
         check(sunder_create_asset(torn.character, &of_asset, &torn.asset)) &&
         check(sunder_create_scene(&of_scene, &torn.scene)) &&
         check(sunder_spawn(torn.scene, torn.asset, nullptr, &torn.instance)) &&
         check(sunder_prepare_to_tear(torn.scene, torn.instance));
}

Variant TearableSkeleton::find_mesh_instance() {
  if (torn_ == nullptr) {
    fail("nothing is attached");
    return {};
  }
  Variant found = torn_->mesh_instance.find();
  if (found.is_nil()) fail("the mesh instance is gone");
  return found;
}

bool TearableSkeleton::tear(const Variant& bases, const Variant& tips, double width,
                            double wall_depth) {
  const Variant mesh_instance = find_mesh_instance();
  if (mesh_instance.is_nil()) return false;
  const std::vector<Vector3> from = places_of(bases), to = places_of(tips);
  if (from.size() != to.size())
    return fail("there are " + std::to_string(from.size()) + " bases and " +
                std::to_string(to.size()) + " tips");
  std::vector<sunder_blade> blades;
  for (std::size_t i = 0; i < from.size(); ++i)
    blades.push_back(blade(mesh_instance, from[i], to[i]));
  const sunder_tear_options options = gap(width, wall_depth);
  return check(sunder_submit_tear(torn_->scene, torn_->instance, blades.data(),
                                  static_cast<std::uint32_t>(blades.size()), &options, 0, nullptr));
}

bool TearableSkeleton::begin_stroke(const Vector3& base, const Vector3& tip, double width,
                                    double wall_depth) {
  const Variant mesh_instance = find_mesh_instance();
  if (mesh_instance.is_nil()) return false;
  const sunder_blade first = blade(mesh_instance, base, tip);
  const sunder_tear_options options = gap(width, wall_depth);
  return check(sunder_submit_begin_stroke(torn_->scene, torn_->instance, &first, &options, nullptr,
                                          nullptr));
}

bool TearableSkeleton::extend_stroke(const Vector3& base, const Vector3& tip, double seconds) {
  const Variant mesh_instance = find_mesh_instance();
  if (mesh_instance.is_nil()) return false;
  const sunder_blade next = blade(mesh_instance, base, tip);
  return check(sunder_submit_extend_stroke(torn_->scene, torn_->instance, &next, seconds, nullptr));
}

bool TearableSkeleton::end_stroke() {
  if (torn_ == nullptr) return fail("nothing is attached");
  return check(sunder_submit_end_stroke(torn_->scene, torn_->instance, nullptr));
}

bool TearableSkeleton::cut(const Vector3& point, const Vector3& normal, bool caps) {
  const Variant mesh_instance = find_mesh_instance();
  if (mesh_instance.is_nil()) return false;
  sunder_cut plane = sunder_default_cut();
  set(plane.point, to_local(mesh_instance, point));
  set_local_normal(plane.normal, normal, mesh_instance.call("get_global_transform").transform());
  plane.has_caps = caps ? 1 : 0;
  return check(sunder_submit_cut(torn_->scene, torn_->instance, &plane, 0, nullptr));
}

bool TearableSkeleton::undo() {
  if (torn_ == nullptr) return fail("nothing is attached");
  sunder_command command = 0;
  if (!check(sunder_submit_undo(torn_->scene, torn_->instance, &command))) return false;
  torn_->undos.push_back(command);
  return true;
}

std::string TearableSkeleton::get_log() {
  sunder_bytes bytes = 0;
  const std::uint8_t* data = nullptr;
  std::uint64_t size = 0;
  if (torn_ == nullptr || !check(sunder_get_log(torn_->scene, torn_->instance, &bytes)) ||
      !check(sunder_get_bytes(bytes, &data, &size)))
    return {};
  std::string text(reinterpret_cast<const char*>(data), static_cast<std::size_t>(size));
  sunder_destroy_bytes(bytes);
  return text;
}

void TearableSkeleton::notify(std::int32_t what) {
  if (what == kNotificationProcess && torn_ != nullptr)
    process(self().call("get_process_delta_time").real());
}

void TearableSkeleton::signal_failure(const std::string& error) {
  error_ = error;
  self().call("emit_signal", Variant("failed"), Variant(error.c_str()));
}

void TearableSkeleton::process(double seconds) {
  const Variant skeleton = torn_->skeleton_node.find();
  if (skeleton.is_nil() || skeleton.call("get_bone_count").integer() !=
                               static_cast<std::int64_t>(torn_->skeleton.bones().size())) {
    torn_.reset();
    signal_failure("the skeleton is gone, or has other bones");
    return;
  }
  if (find_mesh_instance().is_nil()) {
    torn_.reset();
    signal_failure(std::string(error_));
    return;
  }
  torn_->skeleton.read_pose(skeleton, pose_);
  if (!check(sunder_set_matrices(torn_->scene, torn_->instance, pose_.data(),
                                 static_cast<std::uint32_t>(pose_.size() / 12), nullptr)) ||
      !check(sunder_update(torn_->scene, std::max(seconds, 0.0)))) {
    signal_failure(std::string(error_));
    return;
  }
  if (report_results()) write_mesh();
}

bool TearableSkeleton::report_results() {
  const sunder_result* results = nullptr;
  std::uint32_t count = 0;
  bool has_changed = false;
  if (!check(sunder_get_results(torn_->scene, &results, &count))) return false;
  // A script that hears a signal may submit what makes the view of results stale, or attach
  // another mesh.
  const sunder_scene scene = torn_->scene;
  const std::vector<sunder_result> kept(results, results + count);
  std::vector<std::string> errors;
  for (const sunder_result& result : kept) {
    errors.emplace_back(result.error);
    if (result.status != SUNDER_OK) continue;
    const bool is_undo = std::erase(torn_->undos, result.command) > 0;
    has_changed |= is_undo || result.vertices_added + result.triangles_added > 0 ||
                   result.triangles_retired > 0;
  }
  for (std::size_t i = 0; i < kept.size(); ++i) {
    if (kept[i].status != SUNDER_OK)
      signal_failure(errors[i]);
    else
      self().call("emit_signal", Variant("torn"), Variant(std::int64_t{kept[i].faces_crossed}),
                  Variant(kept[i].length));
  }
  return has_changed && torn_ != nullptr && torn_->scene == scene;
}

Variant TearableSkeleton::material_of(const sunder_submesh& submesh, std::uint32_t index) const {
  const std::uint32_t count = torn_->surface_count;
  if (index >= count && !wound_material_.is_nil()) return wound_material_;
  const std::uint32_t surface = index < count ? index : submesh.material;
  if (surface >= count) return {};
  return torn_->source_mesh.call("surface_get_material", Variant(std::int64_t{surface}));
}

void TearableSkeleton::write_mesh() {
  sunder_mesh mesh = {};
  const Variant mesh_instance = find_mesh_instance();
  if (mesh_instance.is_nil() ||
      !check(sunder_get_instance_mesh(torn_->scene, torn_->instance, 0, &mesh)))
    return;
  const Name array_mesh("ArrayMesh");
  const Variant drawn = Variant::object(host.classdb_construct_object(array_mesh.get()));
  const Variant no_shapes = Variant::empty(Type::array),
                no_levels = Variant::empty(Type::dictionary);
  const std::uint32_t influences = most_influences(mesh) > 4 ? 8 : 4;
  const Variant flags(influences > 4 ? kEightInfluences : std::int64_t{0});
  for (std::uint32_t s = 0; s < mesh.submesh_count; ++s) {
    drawn.call("add_surface_from_arrays", Variant(kTriangles), surface_arrays(mesh, s, influences),
               no_shapes, no_levels, flags);
    if (const Variant material = material_of(mesh.submeshes[s], s); !material.is_nil())
      drawn.call("surface_set_material", Variant(std::int64_t{s}), material);
  }
  mesh_instance.call("set_mesh", drawn);
}

}  // namespace sunder::godot
