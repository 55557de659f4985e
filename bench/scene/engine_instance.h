#pragma once

#include <sunder/scene/scene.h>

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace sunder::bench {

/// Work in the background, run between two frames on the same thread: what a frame takes and
/// allocates is then its own, and the same in every run.
class DeferredWork {
 public:
  [[nodiscard]] BackgroundHook hook();
  /// Runs what waits.
  void run();

 private:
  std::vector<std::function<void()>> waiting_;
};

/// The cost of a frame for the thread that updates.
struct EngineFrame {
  double microseconds = 0;  ///< Processor time of Scene::update() and Scene::mesh().
  std::uint64_t uploaded_bytes = 0;
  std::uint64_t allocations = 0;
};

/// A soft character in a scene, with vertex and index buffers as an engine has them: 40 bytes per
/// vertex (position, normal, tangent), which follow the scene by what it says has changed.
class EngineInstance {
 public:
  /// @param background_updates  as SceneOptions::background_updates.
  EngineInstance(const std::shared_ptr<const Character>& character,
                 std::uint32_t background_updates);

  void submit(SceneCommand command, bool in_background = false);
  /// A frame at 90 Hz, then the uploads. Ends the program if a command failed.
  EngineFrame frame();
  /// Runs what waits in the background.
  void finish_background() { background_->run(); }
  /// Milliseconds of processor time that it takes to save the scene, and to restore it: to load the
  /// snapshot, which any thread may do, and to exchange it. The buffers start anew.
  struct SnapshotTimes {
    double save = 0, load = 0, exchange = 0;
    std::size_t bytes = 0;
  };
  SnapshotTimes save_and_restore();
  /// Vertices and triangles of the buffers that differ from what the scene draws.
  [[nodiscard]] std::uint64_t wrong_elements();

  [[nodiscard]] Scene& scene() { return scene_; }
  [[nodiscard]] CharacterInstance& instance() { return *scene_.find(id_); }

 private:
  using Vertex = std::array<float, 10>;
  std::uint64_t upload(const PosedMesh& mesh);

  std::shared_ptr<const CharacterAsset> asset_;
  std::unique_ptr<DeferredWork> background_ = std::make_unique<DeferredWork>();
  Scene scene_;
  InstanceId id_;
  std::vector<Vertex> vertices_;
  std::vector<Triangle> indices_;
  std::uint64_t seen_ = 0;
};

}  // namespace sunder::bench
