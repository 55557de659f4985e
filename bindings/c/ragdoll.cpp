#include <sunder/ragdoll/ragdoll.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <variant>
#include <vector>

#include "bindings/c/character.h"
#include "bindings/c/hulls.h"
#include "bindings/c/numbers.h"
#include "bindings/c/structs.h"

namespace sunder::c {
namespace {

static_assert(static_cast<int>(BoneLimit::Kind::hinge) == SUNDER_JOINT_HINGE);
static_assert(static_cast<int>(BoneLimit::Kind::cone) == SUNDER_JOINT_CONE);

struct RagdollObject : Object {
  static constexpr Kind kKind = Kind::ragdoll;
  std::shared_ptr<const CharacterParts> parts;
  ModelPose pose;  ///< In which it starts.
  Ragdoll ragdoll;
  std::vector<sunder_ragdoll_body> bodies;
  HullViews hulls;
};

sunder_ragdoll_options ragdoll_defaults() {
  const RagdollOptions from;
  sunder_ragdoll_options to = {};
  to.struct_size = sizeof to;
  to.maximum_bodies = from.maximum_bodies;
  to.open_surfaces = static_cast<uint32_t>(from.mass.open_surfaces);
  to.least_share = from.least_share;
  to.density = from.mass.density;
  to.shell_thickness = from.mass.shell_thickness;
  return to;
}

/// @param limits  storage of `to.limits`.
sunder_status read_ragdoll_options(const sunder_ragdoll_options& from,
                                   std::vector<BoneLimit>& limits, RagdollOptions& to) {
  SUNDER_C_TRY(check_enum(from.open_surfaces, SUNDER_SOLID_SHELL, "open_surfaces"));
  if (from.limits == nullptr && from.limit_count > 0) return null_pointer("limits");
  for (std::uint32_t i = 0; i < from.limit_count; ++i) {
    const sunder_bone_limit& limit = from.limits[i];
    SUNDER_C_TRY(check_enum(limit.kind, SUNDER_JOINT_CONE, "kind"));
    limits.push_back({static_cast<BoneLimit::Kind>(limit.kind), limit.bone, vector_of(limit.axis),
                      limit.lower, limit.upper, limit.cone});
  }
  to.maximum_bodies = from.maximum_bodies;
  to.least_share = from.least_share;
  to.mass = {from.density, static_cast<SolidRule>(from.open_surfaces), from.shell_thickness};
  to.limits = limits;
  return SUNDER_OK;
}

sunder_collider collider_for_c(const Collider& from) {
  sunder_collider to = {};
  if (const auto* sphere = std::get_if<Collider::Sphere>(&from.shape)) {
    to.shape = SUNDER_COLLIDER_SPHERE;
    to.size[0] = sphere->radius;
  } else if (const auto* capsule = std::get_if<Collider::Capsule>(&from.shape)) {
    to.shape = SUNDER_COLLIDER_CAPSULE;
    to.size[0] = capsule->radius;
    to.size[1] = capsule->half_length;
  } else if (const auto* box = std::get_if<Collider::Box>(&from.shape)) {
    to.shape = SUNDER_COLLIDER_BOX;
    std::copy_n(box->half_size.data(), 3, to.size);
  }
  std::copy_n(from.place.data(), 3, to.place);
  std::copy_n(from.turn.coeffs().data(), 4, to.rotation);
  to.friction = from.friction;
  return to;
}

sunder_ragdoll_body body_for_c(const RagdollBody& from) {
  sunder_ragdoll_body to = {};
  to.bone = from.bone;
  to.parent = from.parent;
  to.mass = from.mass;
  std::copy_n(from.moments.data(), 3, to.moments);
  std::copy_n(from.model_from_body.data(), 12, to.model_from_body);
  std::copy_n(from.parent_from_joint.data(), 12, to.parent_from_joint);
  std::copy_n(from.body_from_joint.data(), 12, to.body_from_joint);
  to.shape = collider_for_c(from.shape);
  to.limit.bone = from.limit.bone;
  to.limit.kind = static_cast<uint32_t>(from.limit.kind);
  std::copy_n(from.limit.axis.data(), 3, to.limit.axis);
  to.limit.lower = from.limit.lower;
  to.limit.upper = from.limit.upper;
  to.limit.cone = from.limit.cone;
  return to;
}

std::vector<Affine3d> matrices_of(const double* numbers, std::uint32_t count) {
  std::vector<Affine3d> matrices(count);
  for (std::uint32_t i = 0; i < count; ++i)
    std::copy_n(numbers + std::size_t{12} * i, 12, matrices[i].data());
  return matrices;
}

void write_matrices(const std::vector<Affine3d>& matrices, double* numbers) {
  for (const Affine3d& matrix : matrices) numbers = std::copy_n(matrix.data(), 12, numbers);
}

/// @return size_mismatch for a number of bodies that is not the ragdoll's.
sunder_status check_bodies(const RagdollObject& object, std::uint32_t count) {
  if (count == object.bodies.size()) return SUNDER_OK;
  return fail(SUNDER_SIZE_MISMATCH, kNone, "%u bodies; the ragdoll has %zu", count,
              object.bodies.size());
}

sunder_status check_bones(std::size_t bones, std::uint32_t count) {
  if (count == bones) return SUNDER_OK;
  return fail(SUNDER_SIZE_MISMATCH, kNone, "%u bones; the character has %zu", count, bones);
}

}  // namespace
}  // namespace sunder::c

using namespace sunder::c;

extern "C" {

sunder_ragdoll_options sunder_default_ragdoll_options() { return ragdoll_defaults(); }

sunder_status sunder_create_ragdoll(sunder_character character, const double* model_from_bone,
                                    uint32_t bone_count, const float* morph_weights,
                                    const sunder_ragdoll_options* options,
                                    sunder_ragdoll* ragdoll) {
  return guarded([&]() -> sunder_status {
    const CharacterObject* const object = find<CharacterObject>(character);
    if (object == nullptr) return SUNDER_INVALID_HANDLE;
    if (model_from_bone == nullptr) return null_pointer("model_from_bone");
    if (ragdoll == nullptr) return null_pointer("ragdoll");
    SUNDER_C_TRY(check_options(options, "options"));
    const sunder::Character& of = *object->parts->loaded.character;
    SUNDER_C_TRY(check_bones(of.skeleton.bones.size(), bone_count));
    std::vector<sunder::BoneLimit> limits;
    sunder::RagdollOptions wanted;
    SUNDER_C_TRY(
        read_ragdoll_options(options == nullptr ? ragdoll_defaults() : *options, limits, wanted));
    auto made = std::make_unique<RagdollObject>();
    made->parts = object->parts;
    made->pose.model_from_bone = matrices_of(model_from_bone, bone_count);
    made->pose.morph_weights = of.rest_morph_weights;
    if (morph_weights != nullptr)
      std::copy_n(morph_weights, made->pose.morph_weights.size(), made->pose.morph_weights.begin());
    auto bodies = sunder::make_ragdoll(of, made->pose, wanted);
    if (!bodies) return report(bodies.error());
    made->ragdoll = *std::move(bodies);
    for (const sunder::RagdollBody& body : made->ragdoll.bodies)
      made->bodies.push_back(body_for_c(body));
    return add(std::move(made), ragdoll);
  });
}

sunder_status sunder_destroy_ragdoll(sunder_ragdoll ragdoll) {
  return destroy_object(ragdoll, Kind::ragdoll);
}

sunder_status sunder_get_ragdoll_bodies(sunder_ragdoll ragdoll, const sunder_ragdoll_body** bodies,
                                        uint32_t* count) {
  const RagdollObject* const object = find<RagdollObject>(ragdoll);
  if (object == nullptr) return SUNDER_INVALID_HANDLE;
  if (bodies == nullptr) return null_pointer("bodies");
  if (count == nullptr) return null_pointer("count");
  *bodies = object->bodies.data();
  *count = count_of(object->bodies);
  return SUNDER_OK;
}

sunder_status sunder_get_ragdoll_hulls(sunder_ragdoll ragdoll, uint32_t most_points,
                                       const sunder_hull** hulls, uint32_t* count) {
  return guarded([&]() -> sunder_status {
    RagdollObject* const object = find<RagdollObject>(ragdoll);
    if (object == nullptr) return SUNDER_INVALID_HANDLE;
    if (hulls == nullptr) return null_pointer("hulls");
    if (count == nullptr) return null_pointer("count");
    auto found = sunder::hulls_of_ragdoll(object->ragdoll, *object->parts->loaded.character,
                                          object->pose, most_points);
    if (!found) return report(found.error());
    for (sunder::ConvexHull& hull : *found) hull.part = object->ragdoll.bodies[hull.part].bone;
    object->hulls.set(*std::move(found));
    object->hulls.get(hulls, count);
    return SUNDER_OK;
  });
}

sunder_status sunder_place_bodies(sunder_ragdoll ragdoll, const double* model_from_bone,
                                  uint32_t bone_count, double* model_from_body) {
  return guarded([&]() -> sunder_status {
    const RagdollObject* const object = find<RagdollObject>(ragdoll);
    if (object == nullptr) return SUNDER_INVALID_HANDLE;
    if (model_from_bone == nullptr) return null_pointer("model_from_bone");
    if (model_from_body == nullptr) return null_pointer("model_from_body");
    SUNDER_C_TRY(check_bones(object->ragdoll.body_of_bone.size(), bone_count));
    sunder::ModelPose pose;
    pose.model_from_bone = matrices_of(model_from_bone, bone_count);
    std::vector<sunder::Affine3d> places(object->bodies.size());
    if (const auto status = sunder::place_bodies(object->ragdoll, pose, places); !status)
      return report(status);
    write_matrices(places, model_from_body);
    return SUNDER_OK;
  });
}

sunder_status sunder_get_joint_turns(sunder_ragdoll ragdoll, const double* model_from_body,
                                     uint32_t body_count, double* turns) {
  return guarded([&]() -> sunder_status {
    const RagdollObject* const object = find<RagdollObject>(ragdoll);
    if (object == nullptr) return SUNDER_INVALID_HANDLE;
    if (model_from_body == nullptr) return null_pointer("model_from_body");
    if (turns == nullptr) return null_pointer("turns");
    SUNDER_C_TRY(check_bodies(*object, body_count));
    std::vector<sunder::Quatd> found(body_count);
    if (const auto status =
            sunder::joint_turns(object->ragdoll, matrices_of(model_from_body, body_count), found);
        !status)
      return report(status);
    for (const sunder::Quatd& turn : found) turns = std::copy_n(turn.coeffs().data(), 4, turns);
    return SUNDER_OK;
  });
}

sunder_status sunder_pose_of_bodies(sunder_ragdoll ragdoll, const double* model_from_body,
                                    uint32_t body_count, double* model_from_bone) {
  return guarded([&]() -> sunder_status {
    const RagdollObject* const object = find<RagdollObject>(ragdoll);
    if (object == nullptr) return SUNDER_INVALID_HANDLE;
    if (model_from_body == nullptr) return null_pointer("model_from_body");
    if (model_from_bone == nullptr) return null_pointer("model_from_bone");
    SUNDER_C_TRY(check_bodies(*object, body_count));
    sunder::ModelPose pose = object->pose;
    if (const auto status =
            sunder::pose_of_bodies(object->ragdoll, matrices_of(model_from_body, body_count), pose);
        !status)
      return report(status);
    write_matrices(pose.model_from_bone, model_from_bone);
    return SUNDER_OK;
  });
}

}  // extern "C"
