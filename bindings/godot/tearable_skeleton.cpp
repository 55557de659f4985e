#include "bindings/godot/tearable_skeleton.h"

#include <algorithm>
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

void TearableSkeleton::release() {
  if (scene_ != 0) sunder_destroy_scene(scene_);
  if (asset_ != 0) sunder_destroy_asset(asset_);
  if (character_ != 0) sunder_destroy_character(character_);
  scene_ = asset_ = character_ = 0;
  instance_ = 0;
  undos_.clear();
  mesh_instance_ = skeleton_node_ = source_mesh_ = Variant();
}

bool TearableSkeleton::attach(const Variant& mesh_instance) {
  release();
  if (mesh_instance.is_nil()) return true;
  const Variant mesh = mesh_instance.call("get_mesh");
  const Variant skeleton =
      mesh_instance.call("get_node_or_null", mesh_instance.call("get_skeleton_path"));
  skeleton_ = SkeletonReader();
  if (std::string fault = skeleton_.read(skeleton, mesh_instance.call("get_skin")); !fault.empty())
    return fail(std::move(fault));
  MeshArrays arrays;
  if (std::string fault = arrays.read(mesh, skeleton_.skin().slot_count); !fault.empty())
    return fail(std::move(fault));
  if (!create(arrays)) {
    release();
    return false;
  }
  surface_count_ = arrays.mesh().submesh_count;
  mesh_instance_ = mesh_instance;
  skeleton_node_ = skeleton;
  source_mesh_ = mesh;
  self().call("set_process", Variant(true));
  return true;
}

bool TearableSkeleton::create(const MeshArrays& arrays) {
  const sunder_mesh mesh = arrays.mesh();
  const sunder_skin skin = skeleton_.skin();
  sunder_character_data data = sunder_default_character_data();
  data.name = "character";
  data.bones = skeleton_.bones().data();
  data.bone_count = static_cast<std::uint32_t>(skeleton_.bones().size());
  data.skins = &skin;
  data.skin_count = 1;
  data.meshes = &mesh;
  data.mesh_count = 1;
  sunder_asset_options of_asset = sunder_default_asset_options();
  of_asset.poses_vertices = 0;  // Godot does
  sunder_scene_options of_scene = sunder_default_scene_options();
  of_scene.threads = 1;
  return check(sunder_check_abi(SUNDER_C_VERSION, 0)) &&
         check(sunder_create_character(&data, &character_)) &&
         check(sunder_create_asset(character_, &of_asset, &asset_)) &&
         check(sunder_create_scene(&of_scene, &scene_)) &&
         check(sunder_spawn(scene_, asset_, nullptr, &instance_)) &&
         check(sunder_prepare_to_tear(scene_, instance_));
}

Vector3 TearableSkeleton::to_local(const Vector3& place) const {
  return mesh_instance_.call("to_local", Variant(place)).vector3();
}

sunder_blade TearableSkeleton::blade(const Vector3& base, const Vector3& tip) const {
  sunder_blade blade = {};
  set(blade.base, to_local(base));
  set(blade.tip, to_local(tip));
  return blade;
}

bool TearableSkeleton::tear(const Variant& bases, const Variant& tips, double width,
                            double wall_depth) {
  if (scene_ == 0) return fail("nothing is attached");
  const std::vector<Vector3> from = places_of(bases), to = places_of(tips);
  if (from.size() != to.size())
    return fail("there are " + std::to_string(from.size()) + " bases and " +
                std::to_string(to.size()) + " tips");
  std::vector<sunder_blade> blades;
  for (std::size_t i = 0; i < from.size(); ++i) blades.push_back(blade(from[i], to[i]));
  const sunder_tear_options options = gap(width, wall_depth);
  return check(sunder_submit_tear(scene_, instance_, blades.data(),
                                  static_cast<std::uint32_t>(blades.size()), &options, 0, nullptr));
}

bool TearableSkeleton::begin_stroke(const Vector3& base, const Vector3& tip, double width,
                                    double wall_depth) {
  if (scene_ == 0) return fail("nothing is attached");
  const sunder_blade first = blade(base, tip);
  const sunder_tear_options options = gap(width, wall_depth);
  return check(sunder_submit_begin_stroke(scene_, instance_, &first, &options, nullptr, nullptr));
}

bool TearableSkeleton::extend_stroke(const Vector3& base, const Vector3& tip, double seconds) {
  if (scene_ == 0) return fail("nothing is attached");
  const sunder_blade next = blade(base, tip);
  return check(sunder_submit_extend_stroke(scene_, instance_, &next, seconds, nullptr));
}

bool TearableSkeleton::end_stroke() {
  if (scene_ == 0) return fail("nothing is attached");
  return check(sunder_submit_end_stroke(scene_, instance_, nullptr));
}

bool TearableSkeleton::cut(const Vector3& point, const Vector3& normal, bool caps) {
  if (scene_ == 0) return fail("nothing is attached");
  sunder_cut plane = sunder_default_cut();
  const Vector3 at = to_local(point);
  const Vector3 end = to_local({point.x + normal.x, point.y + normal.y, point.z + normal.z});
  set(plane.point, at);
  set(plane.normal, {end.x - at.x, end.y - at.y, end.z - at.z});
  plane.has_caps = caps ? 1 : 0;
  return check(sunder_submit_cut(scene_, instance_, &plane, 0, nullptr));
}

bool TearableSkeleton::undo() {
  if (scene_ == 0) return fail("nothing is attached");
  sunder_command command = 0;
  if (!check(sunder_submit_undo(scene_, instance_, &command))) return false;
  undos_.push_back(command);
  return true;
}

std::string TearableSkeleton::get_log() {
  sunder_bytes bytes = 0;
  const std::uint8_t* data = nullptr;
  std::uint64_t size = 0;
  if (scene_ == 0 || !check(sunder_get_log(scene_, instance_, &bytes)) ||
      !check(sunder_get_bytes(bytes, &data, &size)))
    return {};
  std::string text(reinterpret_cast<const char*>(data), static_cast<std::size_t>(size));
  sunder_destroy_bytes(bytes);
  return text;
}

void TearableSkeleton::notify(std::int32_t what) {
  if (what == kNotificationProcess && scene_ != 0)
    process(self().call("get_process_delta_time").real());
}

void TearableSkeleton::process(double seconds) {
  const std::int64_t bones = skeleton_node_.call("get_bone_count").integer();  // 0: it is gone
  if (bones != static_cast<std::int64_t>(skeleton_.bones().size())) {
    release();
    fail("the skeleton is gone, or has other bones");
    self().call("emit_signal", Variant("failed"), Variant(error_.c_str()));
    return;
  }
  skeleton_.read_pose(skeleton_node_, pose_);
  if (!check(sunder_set_matrices(scene_, instance_, pose_.data(),
                                 static_cast<std::uint32_t>(pose_.size() / 12), nullptr)) ||
      !check(sunder_update(scene_, std::max(seconds, 0.0)))) {
    self().call("emit_signal", Variant("failed"), Variant(error_.c_str()));
    return;
  }
  if (report_results()) write_mesh();
}

bool TearableSkeleton::report_results() {
  const sunder_result* results = nullptr;
  std::uint32_t count = 0;
  bool has_changed = false;
  if (!check(sunder_get_results(scene_, &results, &count))) return false;
  // A script that hears a signal may submit what makes the view of results stale.
  const std::vector<sunder_result> kept(results, results + count);
  std::vector<std::string> errors;
  for (const sunder_result& result : kept) errors.emplace_back(result.error);
  for (std::size_t i = 0; i < kept.size(); ++i) {
    if (kept[i].status != SUNDER_OK) {
      error_ = errors[i];
      self().call("emit_signal", Variant("failed"), Variant(errors[i].c_str()));
      continue;
    }
    const bool is_undo = std::erase(undos_, kept[i].command) > 0;
    has_changed |= is_undo || kept[i].vertices_added + kept[i].triangles_added > 0 ||
                   kept[i].triangles_retired > 0;
    self().call("emit_signal", Variant("torn"), Variant(std::int64_t{kept[i].faces_crossed}),
                Variant(kept[i].length));
  }
  return has_changed && scene_ != 0;
}

Variant TearableSkeleton::material_of(const sunder_submesh& submesh, std::uint32_t index) const {
  if (index >= surface_count_ && !wound_material_.is_nil()) return wound_material_;
  const std::uint32_t surface = index < surface_count_ ? index : submesh.material;
  if (surface >= surface_count_) return {};
  return source_mesh_.call("surface_get_material", Variant(std::int64_t{surface}));
}

void TearableSkeleton::write_mesh() {
  sunder_mesh mesh = {};
  if (!check(sunder_get_instance_mesh(scene_, instance_, 0, &mesh))) return;
  const Name array_mesh("ArrayMesh");
  const Variant drawn = Variant::object(host.classdb_construct_object(array_mesh.get()));
  const Variant no_shapes = Variant::empty(Type::array),
                no_levels = Variant::empty(Type::dictionary);
  const std::uint32_t influences = most_influences(mesh) > 4 ? 8 : 4;
  const Variant flags(influences > 4 ? kEightInfluences : std::int64_t{0});
  std::int64_t surface = 0;
  for (std::uint32_t s = 0; s < mesh.submesh_count; ++s) {
    const Variant arrays = surface_arrays(mesh, s, influences);
    if (arrays.is_nil()) continue;
    drawn.call("add_surface_from_arrays", Variant(kTriangles), arrays, no_shapes, no_levels, flags);
    if (const Variant material = material_of(mesh.submeshes[s], s); !material.is_nil())
      drawn.call("surface_set_material", Variant(surface), material);
    ++surface;
  }
  mesh_instance_.call("set_mesh", drawn);
}

}  // namespace sunder::godot
