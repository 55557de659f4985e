#pragma once

#include <sunder/scene/character_instance.h>

#include <memory>
#include <vector>

#include "scene/actor/level_tissue.h"
#include "scene/threads/background.h"

namespace sunder::scene {

/// The coarser levels of detail of an instance. A level is torn by replaying the operations of the
/// finest one, in the background, when it is about to be shown.
class DetailLevels {
 public:
  /// The level that a height on the screen asks for: 0 is the finest.
  [[nodiscard]] static Index wanted(const CharacterAsset& finest, double height);
  /// Brings the wanted level up to date with the finest instance, or starts to.
  /// @return the level that can be shown now: the wanted one, or the one that is shown.
  /// @throws std::bad_alloc, std::system_error
  Index prepare(Index wanted, CharacterInstance& finest, Background& background);
  [[nodiscard]] Index shown() const { return shown_; }
  /// Whether the level that was wanted last is not shown yet, or not up to date.
  [[nodiscard]] bool is_changing() const { return is_changing_; }
  void show(Index level) { shown_ = level; }
  /// Another level is wanted, but not prepared in this update.
  void postpone() { is_changing_ = true; }
  /// The instance of a level from 1 on.
  [[nodiscard]] CharacterInstance& at(Index level) { return *levels_[level - 1].instance; }
  [[nodiscard]] const CharacterInstance& at(Index level) const {
    return *levels_[level - 1].instance;
  }
  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  /// The operations that a level reproduces.
  struct State {
    std::uint64_t newest = 0;
    std::uint32_t count = 0;
    bool operator==(const State&) const = default;
  };
  struct Job {
    std::shared_ptr<const CharacterAsset> asset;
    std::vector<Operation> history;
    ModelPose pose;
    LevelTissue tissue;  ///< Of the finest level when the job began.
    State state;
    std::unique_ptr<CharacterInstance> made;  ///< Null if it failed.
    void run();
  };
  struct Level {
    std::unique_ptr<CharacterInstance> instance;
    State state;
    std::shared_ptr<Job> job;  ///< Null: none is under way.
    std::shared_ptr<OnceJob> once;
    SwapTime time = SwapTime(0);
  };
  void start(Level& level, Index number, const State& state, CharacterInstance& finest,
             Background& background);

  std::vector<Level> levels_;  ///< From level 1 on.
  Index shown_ = 0;
  bool is_changing_ = false;
};

}  // namespace sunder::scene
