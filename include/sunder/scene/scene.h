#pragma once

#include <sunder/animation/clip_player.h>
#include <sunder/core/parallel_for.h>
#include <sunder/scene/character_instance.h>
#include <sunder/scene/frame_stats.h>
#include <sunder/scene/scene_command.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <memory_resource>
#include <span>
#include <vector>

namespace sunder {

/// A hook by which a scene runs work that takes longer than a frame.
struct BackgroundHook {
  /// Calls task(data) once, on any thread, now or later. Null: the scene has a thread of its own.
  void (*run)(void* context, void (*task)(void* data), void* data) = nullptr;
  void* context = nullptr;  ///< Handed to `run`.
};

struct SceneOptions {
  /// The caller's job system. Its tasks may allocate, unlike those of other calls. Without it the
  /// scene has a pool of `threads` threads.
  ParallelFor parallel_for;
  std::uint32_t threads = 0;  ///< 0: one per core. 1: the calling thread does all the work.
  BackgroundHook background;
  /// 0: what runs in the background takes effect as soon as it has finished, which depends on the
  /// speed of the machine. Otherwise exactly so many updates after the one that begins it; if it
  /// has not finished then, the update waits for it. The same calls then give the same bits
  /// anywhere.
  std::uint32_t background_updates = 0;
  /// Heights on the screen, in pixels, below which an instance is updated in every second frame,
  /// and in every fourth; see Scene::set_screen_height(). One that is being torn never is.
  std::array<double, 2> slower_below = {0, 0};
  /// The scene, its instances and their background work allocate from it, on all threads; see
  /// MemoryScope. It outlives the scene, its assets, and results that are kept. Null: the heap.
  std::pmr::memory_resource* memory = nullptr;
};

/// The optional work that one update may do, over all instances. Units of work, not time, so that
/// the same calls give the same bits on every machine: record what was set to replay it.
struct FrameBudget {
  static constexpr std::uint32_t kUnlimited = ~std::uint32_t{0};
  /// Points at which particles next to lips are separated; 500 per instance at most. A wound opens
  /// later if they are few. By default the wounds of four instances open as fast as one.
  std::uint32_t settled_points = 2000;
  /// Instances whose refit is swapped in, whose level of detail changes, or that are packed.
  std::uint32_t model_work = kUnlimited;
};

struct SpawnOptions {
  TornCapacity capacity;  ///< Room for operations. Default: the instance grows as needed.
  bool is_visible = true;
};

/// How much a snapshot may make, because it may come from a stranger: a few bytes name an instance
/// that takes megabytes.
struct RestoreOptions {
  TornCapacity capacity;             ///< Of each instance; that of the saved one is not kept.
  std::uint32_t instances = 65'536;  ///< Places for instances, also those that are free.
  std::uint64_t operations =
      65'536;  ///< Done and undone ones of all instances, replayed one by one.
  /// Bytes of all instances, as memory_bytes() counts them; while one is read, about as much again.
  std::size_t memory = std::size_t{1} << 31u;
};

/// The instances of a snapshot, read and checked on any thread, so that the frame that takes them
/// over only exchanges them:
///
///   auto loaded = LoadedSnapshot::create(bytes, assets);  // on any thread
///   if (loaded) status = scene.restore(*loaded);          // in a frame
///
/// They allocate from the resource of MemoryScope::current(), which has to be that of the scene.
class SUNDER_API LoadedSnapshot {
 public:
  /// @return as Scene::restore() of the bytes. O(operations of all instances), allocates.
  static Result<LoadedSnapshot> create(
      std::span<const std::byte> snapshot,
      std::span<const std::shared_ptr<const CharacterAsset>> assets,
      const RestoreOptions& options = {});
  ~LoadedSnapshot();
  LoadedSnapshot(LoadedSnapshot&&) noexcept;
  LoadedSnapshot& operator=(LoadedSnapshot&&) noexcept;

 private:
  friend class Scene;
  struct Data;
  explicit LoadedSnapshot(std::unique_ptr<Data> data);
  std::unique_ptr<Data> data_;  ///< Null: moved from.
};

/// Many characters, updated once per frame: what changed is animated, torn, stepped and posed; what
/// did not is not even looked at. Cost is in proportion to the instances that are active.
///
/// One thread at a time, except for submit(), which any thread may call at any time. Results have
/// the same bits for any number of threads. A failing call changes nothing. See docs/frame.md.
class SUNDER_API Scene {
 public:
  /// @return limit_exceeded: out of memory or threads.
  static Result<Scene> create(const SceneOptions& options = {});
  ~Scene();
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;

  // ---- Instances. Calls with the name of an instance that does not exist return not_found.

  /// An instance in the rest pose. @return as CharacterInstance::create(). O(bones).
  Result<InstanceId> spawn(std::shared_ptr<const CharacterAsset> asset,
                           const SpawnOptions& options = {});
  /// Its commands that are not applied yet fail.
  Status destroy(InstanceId instance);
  [[nodiscard]] bool contains(InstanceId instance) const;
  [[nodiscard]] std::uint32_t instance_count() const;
  /// An instance, for calls between updates: queries, holds and forces on its tissue, operations
  /// whose result is needed at once. Null if it does not exist. Valid until it is destroyed.
  [[nodiscard]] CharacterInstance* find(InstanceId instance);
  [[nodiscard]] const CharacterInstance* find(InstanceId instance) const;

  // ---- Motion and visibility.

  /// Plays a clip of the asset. @return as ClipPlayer::play(); index_out_of_range for the clip.
  Result<LayerId> play(InstanceId instance, std::uint32_t clip, const LayerOptions& options = {});
  /// The player of an instance, for layers, cross-fades, and clips that are edited while they play.
  /// The scene advances it. Null if the instance does not exist, or without memory. Valid until the
  /// instance is destroyed, or the next update().
  [[nodiscard]] ClipPlayer* player(InstanceId instance);
  /// Ends what plays, and holds the present pose.
  Status stop(InstanceId instance);
  /// Sets the pose of the next update, and stops what plays. @return as
  /// CharacterInstance::advance(); size_mismatch for a local pose.
  Status set_pose(InstanceId instance, const ModelPose& pose);
  Status set_pose(InstanceId instance, const Pose& pose);
  /// An instance that is not visible is neither sampled, stepped nor posed. Time goes on for its
  /// clip.
  Status set_visible(InstanceId instance, bool is_visible);
  /// Far instances are updated less often and drawn by coarser levels of detail, on which tears are
  /// replayed in the background; see SceneOptions::slower_below and CharacterAssetOptions::coarser.
  /// One that is being torn never is.
  /// @param pixels  the height of the instance on the screen, > 0; initially infinite.
  Status set_screen_height(InstanceId instance, double pixels);

  // ---- Frames.

  /// Queues a command, to be applied in the next update in the order of the numbers. Thread-safe.
  /// @return limit_exceeded: out of memory.
  Result<CommandId> submit(InstanceId instance, SceneCommand command,
                           const CommandOptions& options = {});

  /// Sets the budget of the following updates. Instances take turns.
  void set_budget(const FrameBudget& budget);
  /// A budget that takes about so much time, by the rate that past updates measured. It depends on
  /// the machine; see FrameBudget.
  [[nodiscard]] FrameBudget budget_of(double microseconds) const;

  /// Advances by a frame. For each active instance, as tasks: samples its clip, applies its
  /// commands in the new pose, steps its tissue, and poses the vertices that changed.
  /// @param seconds  since the last update, >= 0.
  /// @return non_finite_value, invalid_argument (nothing is changed). An instance that fails, for
  ///         want of memory, keeps its last drawing and is tried again in the next update; the
  ///         failure of the first one is returned, with its slot.
  /// O(active instances, and what changed in them). No allocation once warm without commands.
  Status update(double seconds);

  /// Figures of the last update.
  [[nodiscard]] const FrameStats& stats() const;
  /// The outcomes of the commands of the last update, ascending. Valid until the next update.
  [[nodiscard]] std::span<const CommandResult> results() const;
  /// The instances that the last update posed anew, in the order of their slots.
  [[nodiscard]] std::span<const InstanceId> drawn() const;
  /// One mesh of an instance for drawing; see CharacterInstance::mesh(). Mesh and epoch are those
  /// of the level that is shown.
  [[nodiscard]] PosedMesh mesh(InstanceId instance, std::uint32_t mesh, std::uint64_t seen = 0);
  /// The level of detail that is shown: 0 is the asset of the instance, 1 its coarser level, and so
  /// on. An engine has buffers per level.
  [[nodiscard]] std::uint32_t shown_level(InstanceId instance) const;

  // ---- Snapshots.

  /// The state of all instances, as bytes: operations, poses, what plays, the motion of tissue.
  /// Assets are not part of it; moments of clips take the place of poses where they can.
  /// @return invalid_argument while a stroke or a command in the background is in progress;
  ///         limit_exceeded: out of memory. O(operations x bones + particles), allocates.
  [[nodiscard]] Result<std::vector<std::byte>> save() const;
  /// Makes the scene one that was saved. It goes on with the same bits, and the same names; engines
  /// start their buffers anew. What waits in submit() stays. The bytes are not trusted: a checksum
  /// finds accidents, then every number is checked.
  /// @param assets  those of the instances, in any order; found by digests of their characters and
  ///                of how these are divided into particles.
  /// @return unsupported_format, malformed_file (index: the byte, or the slot), not_found without
  ///         the asset of an instance, limit_exceeded (the text names the limit), the failure of an
  ///         operation, the fault of a pose, player, set or body. The scene is unchanged then.
  /// O(operations of all instances), allocates.
  Status restore(std::span<const std::byte> snapshot,
                 std::span<const std::shared_ptr<const CharacterAsset>> assets,
                 const RestoreOptions& options = {});
  /// The same with a snapshot that was read before, which holds the former instances afterwards:
  /// destroy it on any thread.
  /// @return invalid_argument if a scene has taken it already. O(instances).
  Status restore(LoadedSnapshot& loaded);

  struct Memory {
    std::size_t assets = 0;     ///< Shared structures, each counted once.
    std::size_t instances = 0;  ///< All instances, without their assets.
  };
  /// O(instances).
  [[nodiscard]] Memory memory_bytes() const;

 private:
  struct State;
  explicit Scene(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace sunder
