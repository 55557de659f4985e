#include "support/models/animated_rig.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "support/models/rigs.h"

namespace sunder::test {
namespace {

constexpr std::uint32_t kRings = 30, kSides = 16, kHeight = 3;

/// Bones below random earlier ones, most of them below a recent one, so that there are limbs.
std::vector<Vec3d> add_bones(Character& character, const AnimatedRig& wanted, Random& random) {
  std::vector<Vec3d> joints;
  character.skeleton.bones.clear();
  Skin& skin = character.skins[0];
  skin.bones.clear();
  skin.bone_from_bind.clear();
  for (std::uint32_t i = 0; i < wanted.bones; ++i) {
    Bone bone;
    bone.name = "bone" + std::to_string(i);
    Vec3d joint(random.uniform(-0.3, 0.3), kHeight * (i + 0.5) / wanted.bones,
                random.uniform(-0.3, 0.3));
    if (i > 0) {
      bone.parent = random.index(4) == 0 ? random.index(i) : i - 1;
      bone.rest.translation = (joint - joints[bone.parent]).cast<float>();
      joint = joints[bone.parent] + Vec3d(bone.rest.translation.cast<double>());
    } else {
      bone.rest.translation = joint.cast<float>();
    }
    joints.push_back(joint);
    character.skeleton.bones.push_back(bone);
    skin.bones.push_back(i);
    Affine3f bone_from_bind = Affine3f::Identity();
    bone_from_bind.translation() = -joint.cast<float>();
    skin.bone_from_bind.push_back(bone_from_bind);
  }
  return joints;
}

/// The nearest joints, by weights that fall off with the distance.
SkinWeights weigh(const Mesh& mesh, const std::vector<Vec3d>& joints, std::uint32_t influences) {
  SkinWeights weights;
  const double reach = 0.3 + kHeight / static_cast<double>(joints.size());
  for (const Vec3f& position : mesh.positions) {
    std::vector<std::pair<double, std::uint32_t>> nearest;
    for (std::uint32_t i = 0; i < joints.size(); ++i)
      nearest.emplace_back((position.cast<double>() - joints[i]).squaredNorm(), i);
    const std::size_t kept = std::min<std::size_t>(influences, nearest.size());
    std::partial_sort(nearest.begin(), nearest.begin() + static_cast<std::ptrdiff_t>(kept),
                      nearest.end());
    std::vector<Influence> of_vertex;
    double sum = 0;
    for (std::size_t i = 0; i < kept; ++i)
      sum += std::exp((nearest[0].first - nearest[i].first) / (reach * reach));
    for (std::size_t i = 0; i < kept; ++i)
      of_vertex.push_back(
          {nearest[i].second,
           static_cast<float>(std::exp((nearest[0].first - nearest[i].first) / (reach * reach)) /
                              sum)});
    weights.append(of_vertex);
  }
  return weights;
}

Quatf random_turn(double angle, Random& random) {
  const Eigen::Vector3d axis = random.direction();
  return Quatf(Quatd(Eigen::AngleAxisd{random.uniform(-angle, angle), axis}).cast<float>());
}

Clip random_clip(const Character& character, std::uint32_t number, double wildest, Random& random) {
  Clip clip;
  clip.name = "clip" + std::to_string(number);
  clip.duration = static_cast<float>(random.uniform(0.3, 3.0));
  // Some clips move gently, some do not move at all, and some are wild.
  const double angle = wildest * std::pow(random.uniform(0, 1), 3);
  const std::uint32_t keys = 2 + random.index(5);
  for (std::uint32_t bone = 0; bone < character.skeleton.bones.size(); ++bone) {
    if (random.index(3) == 0) continue;
    Channel channel;
    channel.target = ChannelTarget::rotation;
    channel.index = bone;
    channel.width = 4;
    for (std::uint32_t key = 0; key < keys; ++key) {
      channel.times.push_back(clip.duration * static_cast<float>(key) /
                              static_cast<float>(keys - 1));
      const Quatf rotation = character.skeleton.bones[bone].rest.rotation *
                             random_turn(number % 7 == 3 ? 0 : angle, random);
      channel.values.insert(channel.values.end(),
                            {rotation.x(), rotation.y(), rotation.z(), rotation.w()});
    }
    clip.channels.push_back(std::move(channel));
  }
  return clip;
}

}  // namespace

AnimatedRig any_animated_rig(Random& random) {
  AnimatedRig rig;
  rig.bones = static_cast<std::uint32_t>(std::exp(random.uniform(std::log(2.0), std::log(200.0))));
  rig.influences = 1 + random.index(12);
  rig.clips = random.index(10) == 0 ? 60 : 1 + random.index(8);
  rig.wildest = random.index(2) == 0 ? 0.3 : 2.0;
  rig.is_bent_at_rest = random.index(2) == 0;
  return rig;
}

Character make_animated_rig(const AnimatedRig& wanted, Random& random) {
  Character character = make_tube(kRings, kSides, kHeight);
  const std::vector<Vec3d> joints = add_bones(character, wanted, random);
  character.meshes[0].weights = weigh(character.meshes[0], joints, wanted.influences);
  if (wanted.is_bent_at_rest)
    for (Bone& bone : character.skeleton.bones) bone.rest.rotation = random_turn(0.4, random);
  character.clips.clear();
  for (std::uint32_t i = 0; i < wanted.clips; ++i)
    character.clips.push_back(random_clip(character, i, wanted.wildest, random));
  return character;
}

}  // namespace sunder::test
