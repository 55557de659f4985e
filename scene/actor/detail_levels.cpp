#include "scene/actor/detail_levels.h"

namespace sunder::scene {
namespace {

/// Particles next to lips separate in so many points at once; nobody waits for it.
constexpr std::uint32_t kSettledPoints = 10'000;

const std::shared_ptr<const CharacterAsset>& asset_of(const CharacterInstance& finest,
                                                      Index level) {
  const std::shared_ptr<const CharacterAsset>* asset = &finest.asset();
  for (; level > 0; --level) asset = &(*asset)->options().coarser;
  return *asset;
}

}  // namespace

Index DetailLevels::wanted(const CharacterAsset& finest, double height) {
  Index level = 0;
  for (const CharacterAsset* asset = &finest;
       asset->options().coarser && height < asset->options().coarser_below;
       asset = asset->options().coarser.get())
    ++level;
  return level;
}

/// Makes an instance of the level and tears it. Operations that do not fit the coarser mesh, such
/// as one in a detail that it lacks, are left out.
void DetailLevels::Job::run() {
  Result<CharacterInstance> instance = CharacterInstance::create(asset);
  if (!instance) return;
  for (const Operation& operation : history) (void)instance->apply(operation);
  if (!tissue.places.empty() && asset->options().soft) {
    if (!instance->prepare_to_tear()) return;
    while (instance->settle(kSettledPoints)) {
    }
    if (!instance->advance(pose, 0)) return;
    tissue.give_to(*instance, pose);
  }
  made = std::make_unique<CharacterInstance>(std::move(*instance));
}

void DetailLevels::start(Level& level, Index number, const State& state, CharacterInstance& finest,
                         Background& background) {
  auto job = std::make_shared<Job>();
  job->asset = asset_of(finest, number);
  job->pose = finest.pose();
  job->tissue = LevelTissue::of(finest, job->pose);
  job->state = state;
  if (const TornModel* const model = finest.model()) {
    Result<std::vector<Operation>> history = model->history();
    if (!history) throw std::bad_alloc();
    job->history = std::move(*history);
  }
  level.once = std::make_shared<OnceJob>([job] {
    try {
      job->run();
    } catch (const std::bad_alloc&) {
      // The level stays as it is; the next update starts again.
    }
  });
  background.start([once = level.once] { once->run(); });
  level.time = background.swap_time();
  level.job = std::move(job);
}

Index DetailLevels::prepare(Index wanted, CharacterInstance& finest, Background& background) {
  is_changing_ = false;
  if (wanted == 0) return 0;
  if (levels_.size() < wanted) levels_.resize(wanted);
  Level& level = levels_[wanted - 1];
  if (level.job && level.time.has_come(*level.once)) {
    if (level.job->made) {
      level.instance = std::move(level.job->made);
      level.state = level.job->state;
    }
    level.job.reset();
  }
  const TornModel* const model = finest.model();
  const State state =
      model == nullptr ? State() : State{model->newest_operation(), model->undo_count()};
  if (level.instance && level.state == state) return wanted;
  is_changing_ = true;
  if (!level.job) start(level, wanted, state, finest, background);
  return shown_;
}

std::size_t DetailLevels::memory_bytes() const {
  std::size_t bytes = levels_.capacity() * sizeof(Level);
  for (const Level& level : levels_)
    if (level.instance) bytes += level.instance->memory_bytes();
  return bytes;
}

}  // namespace sunder::scene
