#include "fuzz/snapshot_scene.h"

#include <cstdio>
#include <cstdlib>
#include <utility>

#include "support/models/rigs.h"

namespace sunder::fuzz {
namespace {

void require(const Status& status) {
  if (status) return;
  std::fprintf(stderr, "%s\n", status.text().data());
  std::abort();
}

Clip slide() {
  Clip clip{"slide", 2.0f, {}};
  Channel channel;
  channel.index = 1;
  channel.times = {0.0f, 1.0f, 2.0f};
  channel.values = {0.5f, 0, 0, 0.75f, 0, 0.25f, 0.5f, 0, 0};
  clip.channels = {channel};
  return clip;
}

}  // namespace

std::shared_ptr<const CharacterAsset> make_snapshot_asset() {
  auto character = std::make_shared<Character>(test::make_sheet(8));
  character->clips = {slide()};
  CharacterAssetOptions options;
  options.soft.emplace();
  options.soft->decomposition.range = 0.25;
  options.soft->tension = {2.0, {}};
  auto asset = CharacterAsset::create(std::move(character), options);
  require(asset.error());
  return *asset;
}

Scene make_scene() {
  SceneOptions options;
  options.threads = 1;
  auto scene = Scene::create(options);
  require(scene.error());
  return std::move(*scene);
}

Scene make_torn_scene(const std::shared_ptr<const CharacterAsset>& asset) {
  Scene scene = make_scene();
  const auto torn = scene.spawn(asset), still = scene.spawn(asset);
  require(torn.error());
  require(still.error());
  require(scene.play(*torn, 0).error());
  const auto send = [&](SceneCommand command) {
    require(scene.submit(*torn, std::move(command)).error());
    require(scene.update(1.0 / 64));
    for (const CommandResult& result : scene.results()) require(result.status);
  };
  send(TearCommand{{test::down_at(0.2, 0.3), test::down_at(0.7, 0.55)}, {}});
  PlaneCut cut;
  cut.point = Vec3d(0.6, 0, 0);
  cut.normal = Vec3d(1, 0.25, 0);
  send(cut);
  send(UndoCommand{});
  return scene;
}

}  // namespace sunder::fuzz
