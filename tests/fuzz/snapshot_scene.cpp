#include "fuzz/snapshot_scene.h"

#include <sunder/skinning/pose.h>

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

Character morphing_sheet() {
  Character character = test::make_sheet(10);
  MorphTarget target;
  target.name = "wave";
  for (std::size_t v = 0; v < character.meshes[0].positions.size(); ++v)
    target.position_deltas.emplace_back(0.0f, 0.0f, v % 3 == 0 ? 0.125f : 0.0f);
  character.meshes[0].morph_targets = {target};
  character.rest_morph_weights = {0.25f};
  return character;
}

std::shared_ptr<const CharacterAsset> make_asset(Character character, WeightPolicy policy) {
  character.clips = {slide()};
  CharacterAssetOptions options;
  options.weights.policy = policy;
  options.soft.emplace();
  options.soft->decomposition.range = 0.25;
  options.soft->tension = {2.0, {}};
  auto asset = CharacterAsset::create(std::make_shared<Character>(std::move(character)), options);
  require(asset.error());
  return *asset;
}

/// Makes calls on an instance, frame by frame.
class Director {
 public:
  Director(Scene& scene, InstanceId id) : scene_(scene), id_(id) {}

  void send(SceneCommand command, bool in_background = false) {
    CommandOptions options;
    options.in_background = in_background;
    require(scene_.submit(id_, std::move(command), options).error());
    frame();
    if (in_background) frame();
  }
  void frame() {
    require(scene_.update(1.0 / 64));
    for (const CommandResult& result : scene_.results()) require(result.status);
  }
  [[nodiscard]] CharacterInstance& instance() { return *scene_.find(id_); }

 private:
  Scene& scene_;
  InstanceId id_;
};

TearCommand tear_across(double x, double y, double to_x, double to_y) {
  return {{test::down_at(x, y), test::down_at(to_x, to_y)}, {}};
}

void play_layers(Scene& scene, InstanceId id, const Character& character) {
  ClipPlayer& player = *scene.player(id);
  auto clip = std::make_shared<Clip>(slide());
  clip->name = "own";
  LayerOptions below, above;
  below.mode = PlayMode::ping_pong;
  require(player.play(clip, below).error());
  above.kind = LayerKind::additive;
  above.weight = 0.5f;
  above.fade_in = 1.0;
  BoneMask mask;
  mask.bones = {0.5f, 1.0f};
  above.mask = std::make_shared<const BoneMask>(mask);
  Result<Pose> rest = local_rest_pose(character);
  require(rest.error());
  above.reference = std::make_shared<const Pose>(std::move(*rest));
  require(player.play(clip, above).error());
}

void tear_richly(Director& director) {
  director.send(tear_across(0.2, 0.2, 0.6, 0.7));
  WeightsOperation weights;
  weights.weights.policy = WeightPolicy::refit;
  director.send(weights, true);
  PlaneCut cut;
  cut.point = Vec3d(0.75, 0, 0);
  cut.normal = Vec3d(1, 0.125, 0);
  director.send(cut);
  director.send(DetachCommand{PieceNear{Vec3d(0.9375, 0.5, 0)}, {}});
  director.send(tear_across(0.3, 0.8, 0.5, 0.1));
  director.send(UndoCommand{});
}

void move_tissue(CharacterInstance& instance) {
  SoftBody& body = *instance.body();
  require(body.hold(1, body.place(1) + Vec3d(0, 0, 0.0625)).error());
  require(body.hold_point(12, Vec3d(0.25, 0.25, 0.125)).error());
  require(body.set_force(2, Vec3d(0, 0.125, 0.25)));
  Collider ball{Collider::Sphere{0.125}};
  ball.place = Vec3d(0.5, 0.5, 0.0625);
  ball.friction = 0.5;
  require(body.set_colliders({&ball, 1}));
}

}  // namespace

SnapshotAssets make_snapshot_assets() {
  return {make_asset(test::make_sheet(8), WeightPolicy::barycentric),
          make_asset(morphing_sheet(), WeightPolicy::exact)};
}

Scene make_scene() {
  SceneOptions options;
  options.threads = 1;
  options.background_updates = 1;
  auto scene = Scene::create(options);
  require(scene.error());
  return std::move(*scene);
}

Scene make_torn_scene(const SnapshotAssets& assets) {
  Scene scene = make_scene();
  const auto torn = scene.spawn(assets[0]), still = scene.spawn(assets[0]);
  require(torn.error());
  require(still.error());
  require(scene.play(*torn, 0).error());
  Director director(scene, *torn);
  director.send(tear_across(0.2, 0.3, 0.7, 0.55));
  PlaneCut cut;
  cut.point = Vec3d(0.6, 0, 0);
  cut.normal = Vec3d(1, 0.25, 0);
  director.send(cut);
  director.send(UndoCommand{});
  return scene;
}

Scene make_rich_scene(const SnapshotAssets& assets) {
  Scene scene = make_scene();
  const auto rich = scene.spawn(assets[1]), gone = scene.spawn(assets[0]);
  require(rich.error());
  require(gone.error());
  require(scene.destroy(*gone));
  play_layers(scene, *rich, *assets[1]->character());
  Director director(scene, *rich);
  tear_richly(director);
  const auto open = scene.spawn(assets[0]), free = scene.spawn(assets[1]);
  require(open.error());
  require(free.error());
  require(scene.destroy(*free));
  FrameBudget budget;
  budget.settled_points = 5;
  scene.set_budget(budget);
  Director other(scene, *open);
  other.send(tear_across(0.3, 0.45, 0.8, 0.6));
  move_tissue(other.instance());
  other.send(tear_across(0.55, 0.15, 0.5, 0.8));
  return scene;
}

}  // namespace sunder::fuzz
