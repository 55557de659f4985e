#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <sunder_c.h>
#include <vector>

#include "bindings/godot/mesh_arrays.h"
#include "bindings/godot/skeleton.h"
#include "bindings/godot/variant.h"

namespace sunder::godot {

/// The character that a node tears, made from a MeshInstance3D, in a scene of its own.
struct Torn {
  Torn() = default;
  ~Torn();
  Torn(const Torn&) = delete;
  Torn& operator=(const Torn&) = delete;

  NodeReference mesh_instance, skeleton_node;
  Variant source_mesh;
  SkeletonReader skeleton;
  std::uint32_t surface_count = 0;  ///< Of the source.
  sunder_character character = 0;
  sunder_asset asset = 0;
  sunder_scene scene = 0;
  sunder_instance instance = 0;
  std::vector<sunder_command> undos;  ///< Submitted, without a result yet.
};

/// The node TearableSkeleton3D: tears the mesh of a MeshInstance3D in the pose in which its
/// Skeleton3D stands. Godot draws and skins; after an operation it gets a new mesh. Places are in
/// world space. On the main thread.
class TearableSkeleton {
 public:
  static constexpr const char* kName = "TearableSkeleton3D";
  static constexpr const char* kParent = "Node3D";

  /// @param object  the node of the host.
  explicit TearableSkeleton(void* object) : self_(object) {}
  TearableSkeleton(const TearableSkeleton&) = delete;
  TearableSkeleton& operator=(const TearableSkeleton&) = delete;

  // What scripts call. Those that return a bool say in get_error() why it is false.

  /// Reads the mesh, the skin and the skeleton of a MeshInstance3D; null lets go of it. The
  /// instance keeps the mesh that it has. Where it fails, what was attached stays so.
  bool attach(const Variant& mesh_instance);
  /// Tears along a blade with pairs of base and tip, in the next frame.
  bool tear(const Variant& bases, const Variant& tips, double width, double wall_depth);
  /// A stroke over several frames, in the pose of each: begun, extended `seconds` later, ended.
  bool begin_stroke(const Vector3& base, const Vector3& tip, double width, double wall_depth);
  bool extend_stroke(const Vector3& base, const Vector3& tip, double seconds);
  bool end_stroke();
  /// Cuts by a plane, in the next frame.
  bool cut(const Vector3& point, const Vector3& normal, bool caps);
  /// Takes back the last operation, in the next frame.
  bool undo();
  /// Sets the material of walls and caps; null: they have that of the surface beside.
  void set_wound_material(const Variant& material) { wound_material_ = material; }
  /// The log of all operations, which `sunder tear` reads; empty if nothing is attached.
  [[nodiscard]] std::string get_log();
  [[nodiscard]] const std::string& get_error() const { return error_; }

  void notify(std::int32_t what);

 private:
  bool create(const MeshArrays& arrays, Torn& torn);
  bool fail(std::string text);
  bool check(sunder_status status);
  /// @return nil, with an error, if nothing is attached or it is gone.
  [[nodiscard]] Variant find_mesh_instance();
  void signal_failure(const std::string& error);
  void process(double seconds);
  /// @return whether the mesh changed.
  bool report_results();
  void write_mesh();
  [[nodiscard]] Variant material_of(const sunder_submesh& submesh, std::uint32_t index) const;
  [[nodiscard]] Variant self() const { return Variant::object(self_); }

  void* self_;
  Variant wound_material_;
  std::unique_ptr<Torn> torn_;
  std::vector<double> pose_;
  std::string error_;
};

}  // namespace sunder::godot
