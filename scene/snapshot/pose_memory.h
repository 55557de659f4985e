#pragma once

#include <sunder/core/character.h>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "scene/snapshot/archive.h"

namespace sunder::scene {

/// A moment of a clip whose pose an operation was applied in.
struct PoseOrigin {
  std::uint64_t hash = 0;  ///< Of the bits of the pose.
  Index clip = 0;
  double time = 0;
};

/// A hash of the bits of a pose.
[[nodiscard]] std::uint64_t hash_of(const ModelPose& pose);

/// How a pose is written.
enum class PoseForm : std::uint8_t { differences, moment };
template <>
inline constexpr PoseForm kLastEnumerator<PoseForm> = PoseForm::moment;

/// Writes and reads the poses of one character: as a moment of a clip where that gives the same
/// bits, otherwise as differences from the pose before. Only bones of skins are kept; others are at
/// rest when they are read.
class PoseMemory {
 public:
  /// @param origins  moments of clips to try. @throws std::bad_alloc
  PoseMemory(std::shared_ptr<const Character> character, std::span<const PoseOrigin> origins);

  /// The index of a clip of the character; kNone for another one.
  [[nodiscard]] Index index_of(const Clip& clip) const;
  /// Null if there is none.
  [[nodiscard]] std::shared_ptr<const Clip> clip(Index index) const {
    return index < character_->clips.size()
               ? std::shared_ptr<const Clip>(character_, &character_->clips[index])
               : nullptr;
  }

  void transfer_pose(SnapshotWriter& writer, const ModelPose& pose);
  void transfer_pose(SnapshotReader& reader, ModelPose& pose);
  /// The moments of clips that were read.
  [[nodiscard]] std::vector<PoseOrigin>& read_origins() { return read_origins_; }

 private:
  [[nodiscard]] const PoseOrigin* find_origin(const ModelPose& pose) const;
  /// Memory of a pose.
  [[nodiscard]] std::size_t pose_bytes() const;
  void read_moment(SnapshotReader& reader, ModelPose& pose);
  /// Calls visit(double&) for each number of the kept bones and visit(float&) for each morph
  /// weight.
  template <class Pose, class Visit>
  void for_each_number(Pose& pose, Visit visit) const;

  std::shared_ptr<const Character> character_;
  std::span<const PoseOrigin> origins_;
  std::vector<Index> bones_;  ///< Of all skins, ascending.
  ModelPose previous_;
  std::vector<PoseOrigin> read_origins_;
};

}  // namespace sunder::scene
