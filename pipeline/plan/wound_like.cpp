#include <sunder/plan/plan.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <string>
#include <utility>

#include <Eigen/Geometry>

#include "core/internal/out_of_memory.h"
#include "pipeline/plan/plan_setup.h"
#include "pipeline/plan/posed_places.h"
#include "pipeline/plan/read_lips.h"

namespace sunder {
namespace plan {
namespace {

constexpr std::size_t kPlacesOfCurve = 48;  ///< Of the curve that results.
constexpr double kShortestLimb = 1e-6;      ///< Of the diagonal.

/// A name without namespace, case and separators.
std::string plain_name(const std::string& name) {
  std::string plain;
  for (const char letter : name.substr(name.find_last_of(':') + 1))
    if (std::isalnum(static_cast<unsigned char>(letter)) != 0)
      plain += static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  return plain;
}

/// Where joints are at rest, and which bone of another skeleton each one corresponds to.
class MatchedBones {
 public:
  MatchedBones(const Character& from, const Character& to, const ModelPose& from_rest,
               const ModelPose& to_rest, double size_ratio)
      : from_(from), from_rest_(from_rest), to_rest_(to_rest), size_ratio_(size_ratio) {
    std::map<std::string, std::vector<std::uint32_t>> exact, plain;
    for (std::uint32_t bone = 0; bone < to.skeleton.bones.size(); ++bone) {
      exact[to.skeleton.bones[bone].name].push_back(bone);
      plain[plain_name(to.skeleton.bones[bone].name)].push_back(bone);
    }
    for (const Bone& bone : from.skeleton.bones) {
      const auto same = exact.find(bone.name);
      const auto similar = plain.find(plain_name(bone.name));
      if (same != exact.end() && same->second.size() == 1)
        matches_.push_back(same->second[0]);
      else if (similar != plain.end() && similar->second.size() == 1)
        matches_.push_back(similar->second[0]);
      else
        matches_.push_back(kNone);
    }
  }

  /// The nearest bone upwards that has a counterpart; kNone if there is none.
  [[nodiscard]] std::uint32_t matched(std::uint32_t bone) const {
    while (bone != kNone && matches_[bone] == kNone) bone = from_.skeleton.bones[bone].parent;
    return bone;
  }

  /// A place beside a matched bone, at the same share of the limb beside the counterpart.
  [[nodiscard]] Vec3d carried(std::uint32_t bone, const Vec3d& place) const {
    const Vec3d from = from_rest_.model_from_bone[bone].translation();
    const Vec3d to = to_rest_.model_from_bone[matches_[bone]].translation();
    const auto [limb, counterpart] = limbs(bone);
    const double shortest = kShortestLimb * limb.norm() + 1e-12;
    if (limb.norm() <= shortest || counterpart.norm() <= shortest)
      return to + size_ratio_ * (place - from);
    const Eigen::Quaterniond turn =
        Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d(limb), Eigen::Vector3d(counterpart));
    const double scale = counterpart.norm() / limb.norm();
    return to + scale * Vec3d(turn * Eigen::Vector3d(place - from));
  }

 private:
  /// From the joint to the mean of the joints below that have counterparts, or else from the one
  /// above; the same of the counterpart.
  [[nodiscard]] std::pair<Vec3d, Vec3d> limbs(std::uint32_t bone) const {
    const auto joint = [&](std::uint32_t of) {
      return Vec3d(from_rest_.model_from_bone[of].translation());
    };
    const auto other = [&](std::uint32_t of) {
      return Vec3d(to_rest_.model_from_bone[matches_[of]].translation());
    };
    Vec3d limb = Vec3d::Zero(), counterpart = Vec3d::Zero();
    int below = 0;
    for (std::uint32_t child = bone + 1; child < matches_.size(); ++child) {
      if (from_.skeleton.bones[child].parent != bone || matches_[child] == kNone) continue;
      limb += joint(child) - joint(bone);
      counterpart += other(child) - other(bone);
      ++below;
    }
    if (below > 0) return {limb / below, counterpart / below};
    const std::uint32_t above = matched(from_.skeleton.bones[bone].parent);
    if (above == kNone) return {limb, counterpart};
    return {joint(bone) - joint(above), other(bone) - other(above)};
  }

  const Character& from_;
  const ModelPose &from_rest_, &to_rest_;
  double size_ratio_;
  std::vector<std::uint32_t> matches_;
};

/// Vertices as places in triangles.
std::vector<SurfaceAnchor> anchors_of(const Character& character, const LipCurve& lips) {
  std::map<std::uint32_t, SurfaceAnchor> known;
  const Mesh& mesh = character.meshes[lips.mesh];
  for (std::uint32_t i = 0; i < mesh.triangle_count(); ++i)
    for (std::size_t corner = 0; corner < 3; ++corner) {
      SurfaceAnchor anchor{lips.mesh, {i, {0, 0, 0}}};
      anchor.birth.barycentric[corner] = 1;
      known.emplace(mesh.triangles[i][corner], anchor);
    }
  std::vector<SurfaceAnchor> anchors;
  for (const std::uint32_t vertex : lips.vertices) anchors.push_back(known.at(vertex));
  return anchors;
}

/// Indices of places at about even distances along a run; the ends are among them.
std::vector<std::size_t> even_places(const std::vector<Vec3d>& places) {
  std::vector<double> along = {0};
  for (std::size_t i = 1; i < places.size(); ++i)
    along.push_back(along.back() + (places[i] - places[i - 1]).norm());
  std::vector<std::size_t> chosen;
  for (std::size_t k = 0; k < kPlacesOfCurve; ++k) {
    const double wanted = along.back() * static_cast<double>(k) / (kPlacesOfCurve - 1);
    const auto at = std::min(std::lower_bound(along.begin(), along.end(), wanted), along.end() - 1);
    const auto index = static_cast<std::size_t>(at - along.begin());
    if (chosen.empty() || index > chosen.back()) chosen.push_back(index);
  }
  return chosen;
}

Result<WoundTarget> carry_wound(const Character& torn,
                                const std::shared_ptr<const Character>& character) {
  const std::optional<LipCurve> lips = read_lips(torn);
  if (!lips)
    return Status::failure(StatusCode::not_found, kNone,
                           "there are no lips of a tear without width and walls");
  const Result<ModelPose> from_rest = rest_pose(torn), to_rest = rest_pose(*character);
  if (!from_rest) return from_rest.error();
  if (!to_rest) return to_rest.error();
  std::vector<Vec3d> places(lips->vertices.size());
  const PosedPlaces posed(torn, anchors_of(torn, *lips));
  if (const Status status = posed.pose(*from_rest, places, {}); !status) return status;
  const MatchedBones bones(torn, *character, *from_rest, *to_rest,
                           diagonal_of(*character, *to_rest) / diagonal_of(torn, *from_rest));
  const Result<TornModel> model = TornModel::create(character);
  if (!model) return model.error();
  Result<SurfaceQuery> query = SurfaceQuery::create(*model);
  if (!query) return query.error();
  if (const Status status = query->set_pose(*to_rest); !status) return status;
  const Mesh& mesh = torn.meshes[lips->mesh];
  WoundTarget target;
  target.is_closed = lips->is_closed;
  for (const std::size_t i : even_places(places)) {
    Vec3d carried = Vec3d::Zero();
    double weight = 0;
    for (const Influence& influence : mesh.weights.of(lips->vertices[i])) {
      const std::uint32_t bone = bones.matched(torn.skins[mesh.skin].bones[influence.slot]);
      if (bone == kNone) continue;
      const auto share = static_cast<double>(influence.weight);
      carried += share * bones.carried(bone, places[i]);
      weight += share;
    }
    if (!(weight > 0))
      return Status::failure(
          StatusCode::not_found, kNone, "no bone of the model has a name like '%.80s' or one above",
          torn.skeleton
              .bones[torn.skins[mesh.skin].bones[mesh.weights.of(lips->vertices[i])[0].slot]]
              .name.c_str());
    const auto found = query->find_nearest(carried / weight);
    if (!found) return found.error();
    if (!found->has_value())
      return Status::failure(StatusCode::not_found, kNone, "the model has no surface");
    target.places.push_back((*found)->anchor);
  }
  return target;
}

}  // namespace
}  // namespace plan

Result<WoundTarget> wound_like(const Character& torn,
                               const std::shared_ptr<const Character>& character) {
  if (character == nullptr)
    return Status::failure(StatusCode::empty_input, kNone, "there is no character");
  return or_out_of_memory([&]() -> Result<WoundTarget> {
    if (const Status status = validate_character(torn); !status) return status;
    if (const Status status = validate_character(*character); !status) return status;
    return plan::carry_wound(torn, character);
  });
}

}  // namespace sunder
