#include <sunder/ragdoll/ragdoll.h>
#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "core/internal/ordered.h"
#include "core/internal/out_of_memory.h"
#include "particles/internal/fitted_shape.h"
#include "pipeline/ragdoll/body_tree.h"
#include "pipeline/ragdoll/joint_frames.h"
#include "pipeline/ragdoll/rigid_parts.h"
#include "skinning/animation/internal/limit_of_bones.h"
#include "skinning/internal/rotation.h"
#include "tear/bodies/internal/posed_surface.h"

namespace sunder {
namespace {

using bodies::PosedSurface;
using ragdoll::BodyTree;

/// The least moment of inertia of a body as a fraction of its greatest: a needle still turns.
constexpr double kLeastMoment = 0.02;

Status check_options(const RagdollOptions& options) {
  if (options.maximum_bodies < 1 || options.maximum_bodies > 1024)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "at most %u bodies; it must be 1 to 1024", options.maximum_bodies);
  if (!(options.least_share >= 0 && options.least_share <= 1))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the least share of the mass is %g; it must be 0 to 1",
                           options.least_share);
  return validate(options.mass);
}

/// Per bone: the mass of the part that it moves, each part closed by itself; 0 without one.
Result<std::vector<double>> masses_of_bones(const PosedSurface& surface, std::size_t bones,
                                            const MassOptions& options) {
  std::vector<std::vector<Triangle>> parts(bones);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    if (surface.bones[t] != kNone) parts[surface.bones[t]].push_back(surface.triangles[t]);
  std::vector<double> masses(bones, 0.0);
  for (std::size_t bone = 0; bone < bones; ++bone) {
    if (parts[bone].empty()) continue;
    const Result<MassProperties> mass = compute_mass(surface.positions, parts[bone], options);
    if (!mass) return mass.error();
    masses[bone] = mass->mass;
  }
  return masses;
}

/// Per body: the triangles that move with it.
std::vector<std::vector<Triangle>> parts_of(const PosedSurface& surface, const BodyTree& tree) {
  std::vector<std::vector<Triangle>> parts(tree.bones.size());
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    if (surface.bones[t] != kNone)
      parts[tree.body_of_bone[surface.bones[t]]].push_back(surface.triangles[t]);
  return parts;
}

/// Whether the moments are those of a body, and its centre is within the box. A surface that runs
/// through itself may count parts of space twice or negatively.
bool is_of_a_body(const Vec3d& moments, const Vec3d& centre, const Vec3d& low, const Vec3d& high) {
  return moments.minCoeff() > 0 && moments.sum() > 2 * moments.maxCoeff() * (1 - 1e-9) &&
         (centre.array() >= low.array()).all() && (centre.array() <= high.array()).all();
}

/// Moments of a box of some mass about its centre.
Vec3d moments_of_box(double mass, const Vec3d& size) {
  const Vec3d squares = size.cwiseProduct(size);
  return mass / 12 * (squares.sum() * Vec3d::Ones() - squares);
}

/// Mass, moments and frame of a body: those of its part, or of the box around it.
Status fill_mass(const std::vector<Vec3d>& positions, const std::vector<Triangle>& part,
                 const MassOptions& options, RagdollBody& body) {
  const Result<MassProperties> mass = compute_mass(positions, part, options);
  if (!mass) return mass.error();
  Vec3d low = positions[part[0][0]], high = low;
  for (const Triangle& triangle : part)
    for (const std::uint32_t vertex : triangle) {
      low = low.cwiseMin(positions[vertex]);
      high = high.cwiseMax(positions[vertex]);
    }
  PrincipalAxes principal = principal_axes(mass->inertia);
  Vec3d centre = mass->centre;
  if (!is_of_a_body(principal.moments, centre, low, high)) {
    const Vec3d moments = moments_of_box(mass->mass, high - low);
    principal = principal_axes(Mat3d(moments.asDiagonal()));
    centre = 0.5 * (low + high);
  }
  body.mass = mass->mass;
  body.moments = principal.moments.cwiseMax(kLeastMoment * principal.moments.maxCoeff());
  body.model_from_body.linear() = principal.axes;
  body.model_from_body.translation() = centre;
  return {};
}

/// Mass, moments, frame and shape of a body.
Status fill_body(const std::vector<Vec3d>& positions, const std::vector<Triangle>& part,
                 const MassOptions& options, RagdollBody& body) {
  if (Status status = fill_mass(positions, part, options, body); !status) return status;
  const Affine3d body_from_model = ragdoll::inverse_of_rigid(body.model_from_body);
  std::vector<Vec3d> points;
  points.reserve(3 * part.size());
  for (const Triangle& triangle : part)
    for (const std::uint32_t vertex : triangle)
      points.push_back(transform(body_from_model, positions[vertex]));
  body.shape = particles::fitted_shape(std::move(points), 0.0);
  return {};
}

Status fill_bodies(const PosedSurface& surface, const BodyTree& tree, const MassOptions& options,
                   double least_share, std::vector<RagdollBody>& bodies) {
  const Result<MassProperties> whole = compute_mass(surface.positions, surface.triangles, options);
  if (!whole) return whole.error();
  const std::vector<std::vector<Triangle>> parts = parts_of(surface, tree);
  double sum = 0;
  for (std::uint32_t i = 0; i < parts.size(); ++i) {
    RagdollBody& body = bodies.emplace_back();
    body.bone = tree.bones[i];
    body.parent = tree.parents[i];
    if (Status status = fill_body(surface.positions, parts[i], options, body); !status)
      return status;
    sum += body.mass;
  }
  // A part that is thinner than those it was joined of is not lighter than bodies may be.
  double raised_sum = 0;
  for (RagdollBody& body : bodies) {
    const double raise = std::max(1.0, least_share * sum / body.mass);
    body.mass *= raise;
    body.moments *= raise;
    raised_sum += body.mass;
  }
  for (RagdollBody& body : bodies) {
    body.mass *= whole->mass / raised_sum;
    body.moments *= whole->mass / raised_sum;
  }
  return {};
}

/// The places that the parts of each pair of bodies share, row by row.
std::vector<std::uint32_t> borders_of(const PosedSurface& surface, const BodyTree& tree) {
  const auto before = [](const Vec3d& a, const Vec3d& b) {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
  };
  using PlaceOfBody = std::pair<Vec3d, std::uint32_t>;
  std::vector<PlaceOfBody> places;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    if (surface.bones[t] != kNone)
      for (const std::uint32_t vertex : surface.triangles[t])
        places.emplace_back(surface.positions[vertex], tree.body_of_bone[surface.bones[t]]);
  std::ranges::sort(places, [&](const PlaceOfBody& a, const PlaceOfBody& b) {
    if (before(a.first, b.first) || before(b.first, a.first)) return before(a.first, b.first);
    return a.second < b.second;
  });
  places.erase(std::unique(places.begin(), places.end()), places.end());
  const std::size_t count = tree.bones.size();
  std::vector<std::uint32_t> borders(count * count, 0);
  for (std::size_t i = 0; i < places.size(); ++i)
    for (std::size_t j = i + 1; j < places.size() && places[j].first == places[i].first; ++j) {
      ++borders[places[i].second * count + places[j].second];
      ++borders[places[j].second * count + places[i].second];
    }
  return borders;
}

/// Per body: the turns of its joint from rest, in poses of all clips.
Result<std::vector<std::vector<Quatd>>> turns_in_clips(const Character& character,
                                                       const std::vector<RagdollBody>& bodies,
                                                       const std::vector<Quatd>& rests) {
  std::vector<std::vector<Quatd>> turns(bodies.size());
  if (character.clips.empty()) return turns;
  // The set does not outlive this call, so it need not own the character.
  const std::shared_ptr<const Character> borrowed(std::shared_ptr<void>(), &character);
  const Result<PoseSet> poses = PoseSet::create(borrowed, {});
  if (!poses) return poses.error();
  ModelPose pose;
  for (const PoseSet::Role role : {PoseSet::Role::fit, PoseSet::Role::held_out})
    for (std::size_t i = 0; i < poses->size(role); ++i) {
      if (Status status = poses->compute(role, i, pose); !status) return status;
      for (std::size_t body = 0; body < bodies.size(); ++body)
        if (bodies[body].parent != kNone)
          turns[body].push_back(unit(multiply(
              conjugate(rests[body]),
              ragdoll::turn_between(pose, bodies[bodies[body].parent].bone, bodies[body].bone))));
    }
  return turns;
}

/// From the joint of a body to the middle of its part, along its bone's frame.
Vec3d direction_of(const RagdollBody& body, const ModelPose& pose, const Vec3d& origin) {
  const Vec3d away = body.model_from_body.translation() - origin;
  const Affine3d frame =
      ragdoll::rigid_frame(pose.model_from_bone[body.bone]).value_or(Affine3d::Identity());
  const Vec3d local = multiply(Mat3d(frame.linear().transpose()), away);
  return norm(local) > 0 ? normalized(local) : Vec3d(Vec3d::UnitX());
}

/// The joints of all bodies that have a parent.
Status fill_joints(const Character& character, const ModelPose& pose, const BodyTree& tree,
                   std::span<const BoneLimit> given, std::vector<RagdollBody>& bodies) {
  const Result<std::vector<const BoneLimit*>> limit_of =
      animation::limit_of_bones(given, character.skeleton.bones.size());
  if (!limit_of) return limit_of.error();
  const Result<ModelPose> rest = rest_pose(character);
  if (!rest) return rest.error();
  std::vector<Quatd> rests(bodies.size(), Quatd::Identity());
  for (std::size_t i = 0; i < bodies.size(); ++i)
    if (bodies[i].parent != kNone)
      rests[i] = ragdoll::turn_between(*rest, bodies[bodies[i].parent].bone, bodies[i].bone);
  const auto given_for = [&](std::size_t i) {
    const BoneLimit* const at_joint = (*limit_of)[tree.joint_bones[i]];
    return at_joint != nullptr ? at_joint : (*limit_of)[bodies[i].bone];
  };
  bool needs_clips = false;
  for (std::size_t i = 0; i < bodies.size(); ++i)
    needs_clips |= bodies[i].parent != kNone && given_for(i) == nullptr;
  Result<std::vector<std::vector<Quatd>>> turns =
      needs_clips ? turns_in_clips(character, bodies, rests)
                  : std::vector<std::vector<Quatd>>(bodies.size());
  if (!turns) return turns.error();
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    RagdollBody& body = bodies[i];
    if (body.parent == kNone) continue;
    const RagdollBody& parent = bodies[body.parent];
    const Vec3d origin = pose.model_from_bone[tree.joint_bones[i]].translation();
    const BoneLimit* const limit = given_for(i);
    const ragdoll::Joint joint =
        limit != nullptr
            ? ragdoll::given_joint(character.skeleton, *rest, *limit, parent.bone, body.bone)
            : ragdoll::shown_joint(rests[i], std::move((*turns)[i]),
                                   direction_of(body, pose, origin));
    ragdoll::set_joint(joint, pose, origin, parent, body);
  }
  return {};
}

}  // namespace

Result<Ragdoll> make_ragdoll(const Character& character, const ModelPose& pose,
                             const RagdollOptions& options) {
  if (Status status = check_options(options); !status) return status;
  return or_out_of_memory([&]() -> Result<Ragdoll> {
    Result<PosedSurface> surface = bodies::pose_surface(character, pose);
    if (!surface) return surface.error();
    const std::vector<std::uint32_t> owners = ragdoll::owners_of_parts(character, surface->bones);
    for (std::uint32_t& bone : surface->bones)
      if (bone != kNone) bone = owners[bone];
    const Result<std::vector<double>> masses =
        masses_of_bones(*surface, character.skeleton.bones.size(), options.mass);
    if (!masses) return masses.error();
    if (std::ranges::none_of(*masses, [](double mass) { return mass > 0; }))
      return Status::failure(StatusCode::empty_input, kNone,
                             "a ragdoll needs a surface; no triangle has an area");
    BodyTree tree = ragdoll::make_body_tree(character.skeleton, *masses, options.maximum_bodies,
                                            options.least_share);
    ragdoll::follow_borders(borders_of(*surface, tree), tree);
    Ragdoll made;
    if (Status status = fill_bodies(*surface, tree, options.mass, options.least_share, made.bodies);
        !status)
      return status;
    if (Status status = fill_joints(character, pose, tree, options.limits, made.bodies); !status)
      return status;
    made.body_of_bone = std::move(tree.body_of_bone);
    for (std::size_t bone = 0; bone < owners.size(); ++bone)
      made.body_of_bone[bone] = made.body_of_bone[owners[bone]];
    for (std::size_t bone = 0; bone < made.body_of_bone.size(); ++bone)
      made.body_from_bone.push_back(
          multiply(ragdoll::inverse_of_rigid(made.bodies[made.body_of_bone[bone]].model_from_body),
                   pose.model_from_bone[bone]));
    return made;
  });
}

Result<std::vector<ConvexHull>> hulls_of_ragdoll(const Ragdoll& ragdoll, const Character& character,
                                                 const ModelPose& pose,
                                                 std::uint32_t maximum_points) {
  if (ragdoll.body_of_bone.size() != character.skeleton.bones.size())
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "the ragdoll is of %zu bones, the character has %zu",
                           ragdoll.body_of_bone.size(), character.skeleton.bones.size());
  return or_out_of_memory([&]() -> Result<std::vector<ConvexHull>> {
    Result<PosedSurface> surface = bodies::pose_surface(character, pose);
    if (!surface) return surface.error();
    for (std::uint32_t& bone : surface->bones)
      if (bone != kNone) bone = ragdoll.body_of_bone[bone];
    const auto most = static_cast<std::uint32_t>(ragdoll.bodies.size());
    Result<std::vector<ConvexHull>> hulls = convex_hulls(surface->positions, surface->triangles,
                                                         surface->bones, {most, maximum_points});
    if (!hulls) return hulls;
    if (hulls->size() != ragdoll.bodies.size())
      return Status::failure(StatusCode::size_mismatch, kNone,
                             "%zu bodies have a surface; the ragdoll has %zu", hulls->size(),
                             ragdoll.bodies.size());
    for (ConvexHull& hull : *hulls) {
      const Affine3d body_from_model =
          ragdoll::inverse_of_rigid(ragdoll.bodies[hull.part].model_from_body);
      for (Vec3d& point : hull.points) point = transform(body_from_model, point);
    }
    return hulls;
  });
}

}  // namespace sunder
