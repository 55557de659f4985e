#include "bench/scene/scene_crowd.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>

#include "bench/harness/measure.h"
#include "support/models/rigs.h"

namespace sunder::bench {
namespace {

constexpr double kFrame = 1.0 / 90;

Scene make_scene(const Crowd::Options& of, BackgroundThreads& background) {
  SceneOptions options;
  options.threads = of.threads;
  options.background = background.hook();
  options.background_updates = of.background_updates;
  auto scene = Scene::create(options);
  require(scene.error(), "scene");
  return std::move(*scene);
}

std::shared_ptr<const CharacterAsset> make_asset(const std::shared_ptr<const Character>& character,
                                                 bool is_soft) {
  CharacterAssetOptions options;
  if (is_soft) {
    options.soft.emplace();
    options.soft->tension = {1.2, {}};
  }
  auto asset = CharacterAsset::create(character, options);
  require(asset.error(), "asset");
  return *asset;
}

LayerOptions layer(double start, PlayMode mode = PlayMode::loop) {
  LayerOptions options;
  options.time = start;
  options.mode = mode;
  return options;
}

}  // namespace

BackgroundHook BackgroundThreads::hook() {
  const auto run = [](void* of, void (*task)(void*), void* data) {
    static_cast<BackgroundThreads*>(of)->threads_.emplace_back(task, data);
  };
  return {run, this};
}

void BackgroundThreads::finish() {
  for (std::thread& thread : threads_) thread.join();
  threads_.clear();
}

void require(const Status& status, const char* what) {
  if (status) return;
  std::fprintf(stderr, "%s: %s\n", what, status.text().data());
  std::exit(1);
}

Clip swing_clip(std::uint32_t bones) {
  constexpr int kKeys = 9;
  Clip clip;
  clip.name = "Swing";
  clip.duration = 2.0f;
  for (std::uint32_t bone = 0; bone < bones; ++bone) {
    Channel channel{ChannelTarget::rotation, bone, 4, Interpolation::linear, {}, {}};
    for (int key = 0; key < kKeys; ++key) {
      const double phase = 2 * std::numbers::pi * key / (kKeys - 1);
      const double angle = 0.5 / bones * std::sin(phase + 0.1 * bone);
      channel.times.push_back(0.25f * static_cast<float>(key));
      channel.values.insert(channel.values.end(), {0.0f, 0.0f, static_cast<float>(std::sin(angle)),
                                                   static_cast<float>(std::cos(angle))});
    }
    clip.channels.push_back(std::move(channel));
  }
  return clip;
}

std::shared_ptr<const Character> make_crowd_model(std::uint32_t vertices, std::uint32_t bones) {
  auto character = std::make_shared<Character>(test::make_bumpy_ball(vertices));
  test::rig_along(*character, bones);
  character->clips = {swing_clip(bones)};
  return character;
}

Crowd::Crowd(std::shared_ptr<const Character> character, std::uint32_t count,
             const Options& options)
    : character_(std::move(character)),
      asset_(make_asset(character_, options.is_soft)),
      scene_(make_scene(options, *background_)),
      is_background_used_(options.background_updates > 0) {
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto id = scene_.spawn(asset_);
    require(id.error(), "spawn");
    ids_.push_back(*id);
  }
  for (const Vec3f& place : character_->meshes[0].positions) bounds_.extend(place.cast<double>());
  (void)frame();
}

void Crowd::play(std::uint32_t count) {
  for (std::uint32_t i = 0; i < count; ++i)
    require(scene_.play(ids_[i], 0, layer(0.01 * i)).error(), "play");
}

Blade Crowd::blade_at(double across, double height) const {
  const Vec3d centre = bounds_.center(), size = bounds_.sizes();
  const Vec3d inside(centre.x() + across * size.x(), bounds_.min().y() + height * size.y(),
                     centre.z() + 0.1 * size.z());
  return {inside + Vec3d(0, 0, size.z()), inside};
}

void Crowd::submit(std::uint32_t instance, SceneCommand command, bool in_background) {
  CommandOptions options;
  options.in_background = in_background;
  require(scene_.submit(ids_[instance], std::move(command), options).error(), "submit");
}

void Crowd::tear(std::uint32_t instance, double height, const TearOptions& options) {
  submit(instance, TearCommand{{blade_at(-0.2, height), blade_at(0.2, height)}, options});
}

void Crowd::cut(std::uint32_t instance, double height) {
  PlaneCut cut;
  cut.point = blade_at(0, height).tip;
  cut.normal = {0.1, 1, 0.2};
  cut.caps = true;
  submit(instance, cut, is_background_used_);
}

void Crowd::drill(std::uint32_t instance, double height) {
  const Blade axis = blade_at(0, height);
  Bore bore;
  bore.origin = axis.base;
  bore.direction = axis.tip - axis.base;
  bore.radius = 0.08 * bounds_.sizes().norm();
  bore.depth = bore.direction.norm();
  bore.wall = true;
  submit(instance, bore, is_background_used_);
}

void Crowd::undo(std::uint32_t instance) { submit(instance, UndoCommand{}); }

void Crowd::stroke_on(std::uint32_t instance, double way) {
  const Blade blade = blade_at(-0.25 + 0.5 * way, 0.45 + 0.05 * way);
  if (way == 0)
    submit(instance, BeginStrokeCommand{blade, {}, {}});
  else
    submit(instance, ExtendStrokeCommand{blade, 10 * way});
  if (way == 1) submit(instance, EndStrokeCommand{});
}

double Crowd::frame() {
  const double seconds = seconds_of([&] { require(scene_.update(kFrame), "update"); });
  for (const CommandResult& result : scene_.results()) require(result.status, "command");
  return seconds;
}

}  // namespace sunder::bench
