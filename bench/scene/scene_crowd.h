#pragma once

#include <sunder/scene/scene.h>

#include <memory>
#include <thread>
#include <vector>

namespace sunder::bench {

/// A clip of two seconds in which all bones swing to and fro.
[[nodiscard]] Clip swing_clip(std::uint32_t bones);

/// A ball with bumps, of about so many vertices, on a chain of bones, with a clip in which all
/// bones move.
[[nodiscard]] std::shared_ptr<const Character> make_crowd_model(std::uint32_t vertices,
                                                                std::uint32_t bones);

/// A thread for each job.
class BackgroundThreads {
 public:
  ~BackgroundThreads() { finish(); }
  [[nodiscard]] BackgroundHook hook();
  void finish();

 private:
  std::vector<std::thread> threads_;
};

/// Instances of one model in a scene.
class Crowd {
 public:
  struct Options {
    bool is_soft = false;
    std::uint32_t threads = 1;
    /// Cuts with caps and bores with a wall run in the background and take effect so many updates
    /// later; 0: in the frame.
    std::uint32_t background_updates = 0;
  };
  Crowd(std::shared_ptr<const Character> character, std::uint32_t count, const Options& options);

  /// Lets the first `count` instances play; the others stand still.
  void play(std::uint32_t count);
  /// Submits a tear across the front of an instance, at a share of its height.
  void tear(std::uint32_t instance, double height, const TearOptions& options = {});
  /// Submits a cut across an instance, with caps.
  void cut(std::uint32_t instance, double height);
  /// Submits a bore with a wall into the front of an instance.
  void drill(std::uint32_t instance, double height);
  void undo(std::uint32_t instance);
  /// The same, as a stroke over frames: the blade of a share of its way. 0 begins it, 1 ends it.
  void stroke_on(std::uint32_t instance, double way);
  /// One frame at 90 Hz. @return seconds.
  double frame();
  /// Returns when nothing runs in the background.
  void finish_background() { background_->finish(); }
  [[nodiscard]] Scene& scene() { return scene_; }
  [[nodiscard]] InstanceId id(std::uint32_t instance) const { return ids_[instance]; }
  [[nodiscard]] const std::shared_ptr<const Character>& character() const { return character_; }

 private:
  [[nodiscard]] Blade blade_at(double across, double height) const;
  void submit(std::uint32_t instance, SceneCommand command, bool in_background = false);

  std::shared_ptr<const Character> character_;
  std::shared_ptr<const CharacterAsset> asset_;
  std::unique_ptr<BackgroundThreads> background_ = std::make_unique<BackgroundThreads>();
  Scene scene_;
  bool is_background_used_;
  std::vector<InstanceId> ids_;
  Eigen::AlignedBox3d bounds_;  ///< At rest.
};

/// Ends the program with the text of a failure.
void require(const Status& status, const char* what);

}  // namespace sunder::bench
