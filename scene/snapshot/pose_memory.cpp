#include "scene/snapshot/pose_memory.h"

#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <utility>

#include "scene/snapshot/check_pose.h"

namespace sunder::scene {
namespace {

bool has_same_bits(const ModelPose& a, const ModelPose& b, std::span<const Index> bones) {
  const auto is_same = [&](Index bone) {
    return std::equal(a.model_from_bone[bone].data(), a.model_from_bone[bone].data() + 12,
                      b.model_from_bone[bone].data(), [](double x, double y) {
                        return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
                      });
  };
  return std::all_of(bones.begin(), bones.end(), is_same) && a.morph_weights == b.morph_weights;
}

/// Numbers that changed little share their leading bytes with those before.
int used_bytes(std::uint64_t bits) { return 8 - std::countl_zero(bits) / 8; }

}  // namespace

std::uint64_t hash_of(const ModelPose& pose) {
  std::uint64_t hash = 0xCBF29CE484222325u;  // FNV-1a over words
  const auto add = [&](std::uint64_t word) { hash = (hash ^ word) * 0x100000001B3u; };
  for (const Affine3d& bone : pose.model_from_bone)
    for (int i = 0; i < 12; ++i) {
      const auto bits = std::bit_cast<std::uint64_t>(bone.data()[i]);
      add(bits ^ (bits >> 32));
    }
  for (const float weight : pose.morph_weights) add(std::bit_cast<std::uint32_t>(weight));
  return hash;
}

PoseMemory::PoseMemory(std::shared_ptr<const Character> character,
                       std::span<const PoseOrigin> origins)
    : character_(std::move(character)), origins_(origins) {
  Result<ModelPose> rest = rest_pose(*character_);
  if (!rest) throw std::bad_alloc();
  previous_ = std::move(*rest);
  for (const Skin& skin : character_->skins)
    bones_.insert(bones_.end(), skin.bones.begin(), skin.bones.end());
  std::sort(bones_.begin(), bones_.end());
  bones_.erase(std::unique(bones_.begin(), bones_.end()), bones_.end());
}

Index PoseMemory::index_of(const Clip& clip) const {
  for (Index i = 0; i < character_->clips.size(); ++i)
    if (&character_->clips[i] == &clip) return i;
  return kNone;
}

const PoseOrigin* PoseMemory::find_origin(const ModelPose& pose) const {
  const std::uint64_t hash = hash_of(pose);
  const auto found = std::find_if(origins_.begin(), origins_.end(),
                                  [&](const PoseOrigin& origin) { return origin.hash == hash; });
  if (found == origins_.end()) return nullptr;
  const Result<ModelPose> again = make_pose(*character_, ClipPose{found->clip, found->time});
  return again && has_same_bits(*again, pose, bones_) ? &*found : nullptr;
}

template <class Pose, class Visit>
void PoseMemory::for_each_number(Pose& pose, Visit visit) const {
  for (const Index bone : bones_)
    for (int i = 0; i < 12; ++i) visit(pose.model_from_bone[bone].data()[i]);
  for (auto& weight : pose.morph_weights) visit(weight);
}

void PoseMemory::transfer_pose(SnapshotWriter& writer, const ModelPose& pose) {
  if (const PoseOrigin* const origin = find_origin(pose)) {
    auto form = PoseForm::moment;
    Index clip = origin->clip;
    double time = origin->time;
    writer(form, clip, time);
    return;
  }
  auto form = PoseForm::differences;
  writer(form);
  std::vector<std::uint64_t> before;
  const auto bits_of = [](auto number) {
    return std::bit_cast<std::uint64_t>(static_cast<double>(number));
  };
  for_each_number(previous_, [&](auto number) { before.push_back(bits_of(number)); });
  std::size_t next = 0;
  for_each_number(pose, [&](auto number) {
    const std::uint64_t difference = bits_of(number) ^ before[next++];
    const int count = used_bytes(difference);
    writer.write_bytes(static_cast<std::uint64_t>(count), 1);
    writer.write_bytes(difference, count);
  });
  previous_ = pose;
}

std::size_t PoseMemory::pose_bytes() const {
  return previous_.model_from_bone.size() * sizeof(Affine3d) +
         previous_.morph_weights.size() * sizeof(float);
}

void PoseMemory::read_moment(SnapshotReader& reader, ModelPose& pose) {
  Index clip = 0;
  double time = 0;
  reader(clip, time);
  if (!std::isfinite(time)) reader.fail("the moment of a pose is not a number");
  if (reader.has_failed()) return;
  Result<ModelPose> found = make_pose(*character_, ClipPose{clip, time});
  if (!found) return reader.fail("a pose is of a clip that the character does not have");
  pose = std::move(*found);
  read_origins_.push_back({hash_of(pose), clip, time});
}

void PoseMemory::transfer_pose(SnapshotReader& reader, ModelPose& pose) {
  PoseForm form = PoseForm::differences;
  reader(form);
  reader.take_memory(pose_bytes());
  if (reader.has_failed()) return;
  if (form == PoseForm::moment) return read_moment(reader, pose);
  for_each_number(previous_, [&](auto& number) {
    const std::uint64_t count = reader.read_bytes(1);
    if (count > 8) return reader.fail("a number has more than eight bytes");
    const std::uint64_t bits = std::bit_cast<std::uint64_t>(static_cast<double>(number)) ^
                               reader.read_bytes(static_cast<int>(count));
    number = static_cast<std::remove_reference_t<decltype(number)>>(std::bit_cast<double>(bits));
  });
  if (reader.has_failed()) return;
  if (!check_pose(*character_, previous_))
    return reader.fail("a number of a pose is out of its range");
  pose = previous_;
}

}  // namespace sunder::scene
