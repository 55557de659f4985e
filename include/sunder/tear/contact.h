#pragma once

#include <sunder/operation/operation.h>
#include <sunder/skinning/vertex_arrays.h>
#include <sunder/tear/torn_model.h>

#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace sunder {

/// A ray in model space.
struct Ray {
  Vec3d origin = Vec3d::Zero();
  Vec3d direction = Vec3d(0.0, 0.0, -1.0);                  ///< Any length except zero.
  double length = std::numeric_limits<double>::infinity();  ///< Metres; >= 0.
};

/// A segment with a radius, in model space. With base == tip it is a sphere.
struct Capsule {
  Vec3d base = Vec3d::Zero();
  Vec3d tip = Vec3d::Zero();
  double radius = 0.0;  ///< Metres; >= 0.
};

/// A place that keeps its meaning while the model is torn: a place in a triangle of the source, or,
/// from the source's triangle count on, in a triangle of a wall or cap.
struct SurfaceAnchor {
  std::uint32_t mesh = 0;
  Birth birth;
};

/// A place on the posed surface that a query found. Indices are those of TornModel::character().
struct SurfaceContact {
  Vec3d place = Vec3d::Zero();  ///< On the surface; model space, metres.
  /// Unit normal of the triangle, counter-clockwise from outside. Zero if it has no area.
  Vec3d normal = Vec3d::Zero();
  /// The normals of the vertices, posed and interpolated; unit length. Equal to `normal` without
  /// ContactOptions::interpolates_normals, and for a mesh without normals.
  Vec3d interpolated_normal = Vec3d::Zero();
  /// Metres from the origin of the ray, the base of the blade, the axis of the capsule or the given
  /// point.
  double distance = 0.0;
  /// Metres that the query reaches below the surface. A blade: its tip below the plane of the
  /// triangle. A capsule: its radius minus the distance, or plus it where the axis is below.
  double depth = 0.0;
  bool enters = true;  ///< From outside to inside along the ray or blade. Others: from outside.
  std::uint32_t mesh = 0;
  std::uint32_t triangle = 0;
  std::array<double, 3> barycentric = {1.0, 0, 0};  ///< >= 0, sum 1.
  std::uint32_t submesh = 0;
  std::uint32_t material = kNone;  ///< That of the submesh.
  std::uint32_t bone = 0;          ///< Index in the skeleton: the bone with most weight there.
  SurfaceAnchor anchor;            ///< The same place, for decals; see SurfaceQuery::locate().
};

/// Where a capsule touches the surface.
struct CapsuleContact {
  SurfaceContact nearest;  ///< The place nearest to the axis; one of them if the axis crosses.
  /// The place nearest to the end of the axis that is farthest below the surface; equal to
  /// `nearest` if the axis is above the surface.
  SurfaceContact deepest;
};

/// The surface that is queried, where weights other than `barycentric` make a difference.
enum class ContactSurface : std::uint8_t {
  drawn,  ///< The vertices as their weights pose them.
  torn,   ///< The surface on which operations find their way, see docs/tear.md.
};

struct ContactOptions {
  ContactSurface surface = ContactSurface::drawn;
  bool interpolates_normals = false;
  /// One per mesh, as for SkinnedMesh::deform(), in model space; or empty: nothing is displaced.
  /// The arrays must stay as they are until the next set_pose().
  std::span<const VertexDisplacements> displacements;
};

/// Answers where rays, blades, capsules and points meet the posed, torn and displaced surface of a
/// model, without tearing it. Skinning is linear. Make one, keep it, call set_pose() in each frame,
/// then any number of queries: each O(log faces + faces near it), in any pose. No allocation once
/// warm, unless the model grows. See docs/contact.md.
///
/// One thread at a time per object; several objects may query one model at the same time, while
/// nothing changes it. The model must outlive the object, in the same place.
class SUNDER_API SurfaceQuery {
 public:
  /// @return limit_exceeded: out of memory. O(faces): builds the tree.
  static Result<SurfaceQuery> create(const TornModel& model);

  /// Sets the pose of the next queries. Call it again when the pose, the displacements or the model
  /// changed. O(bones + particles), and O(vertices appended) if they have weights other than
  /// `barycentric`.
  /// @return size_mismatch or non_finite_value (nothing is changed); limit_exceeded, out of memory:
  ///         queries fail until a later call succeeds.
  Status set_pose(const ModelPose& pose, const ContactOptions& options = {});

  /// The first place where a ray meets the surface, from either side.
  /// @return empty if it meets nothing; non_finite_value or invalid_argument for the ray. All
  ///         queries: invalid_argument before set_pose(), and after the model changed.
  Result<std::optional<SurfaceContact>> cast_ray(const Ray& ray);

  /// All places where a blade crosses the surface, from base to tip: every layer. A crossing on an
  /// edge is listed once.
  /// @param contacts  written. Empty: the blade meets nothing.
  /// @return non_finite_value or invalid_argument for the blade; `contacts` is unchanged then.
  Status find_blade_contacts(const Blade& blade, std::vector<SurfaceContact>& contacts);

  /// Where a capsule touches the surface.
  /// @return empty if the surface is farther from the axis than the radius; non_finite_value or
  ///         invalid_argument for the capsule.
  Result<std::optional<CapsuleContact>> find_capsule_contact(const Capsule& capsule);

  /// The place on the surface nearest to a point. `depth` is positive if the point is below it.
  /// @param most_distance  metres, >= 0; the smaller, the faster.
  /// @return empty if nothing is that near; non_finite_value or invalid_argument.
  Result<std::optional<SurfaceContact>> find_nearest(
      const Vec3d& point, double most_distance = std::numeric_limits<double>::infinity());

  /// Where a place is now. O(parts of the triangle).
  /// @return empty if an operation removed it; index_out_of_range, non_finite_value or
  ///         invalid_argument for the anchor.
  Result<std::optional<SurfaceContact>> locate(const SurfaceAnchor& anchor);

  [[nodiscard]] std::size_t memory_bytes() const;

  ~SurfaceQuery();
  SurfaceQuery(SurfaceQuery&&) noexcept;
  SurfaceQuery& operator=(SurfaceQuery&&) noexcept;

 private:
  struct State;
  explicit SurfaceQuery(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace sunder
