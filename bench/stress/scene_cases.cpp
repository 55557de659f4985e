// Instances of a scene: made, torn, destroyed, saved and restored at random.

#include <sunder/scene/scene.h>
#include <sunder/skinning/pose.h>

#include <cstring>

#include "bench/stress/families.h"
#include "bench/stress/steps.h"
#include "support/machine/say.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"
#include "support/oracles/torn_invariants.h"

namespace sunder::stress {
namespace {

using test::Random;
using test::say;
using Assets = std::vector<std::shared_ptr<const CharacterAsset>>;

constexpr double kFrame = 1.0 / 64;
constexpr std::uint32_t kMostInstances = 100;

Assets make_assets(Random& random) {
  CharacterAssetOptions soft;
  soft.soft.emplace();
  soft.soft->decomposition.range = 0.3;
  Assets assets;
  for (const bool is_soft : {false, true}) {
    auto asset =
        CharacterAsset::create(std::make_shared<const Character>(test::random_character(random)),
                               is_soft ? soft : CharacterAssetOptions());
    if (asset) assets.push_back(std::move(*asset));
  }
  return assets;
}

Result<Scene> make_scene(std::uint32_t threads) {
  SceneOptions options;
  options.threads = threads;
  return Scene::create(options);
}

/// A scene, and random calls.
class BusyScene {
 public:
  BusyScene(Scene scene, const Assets& assets, CaseReport& report)
      : scene_(std::move(scene)), assets_(assets), report_(report) {}

  void frame(Random& random) {
    if (ids_.empty() || (ids_.size() < kMostInstances && random.index(3) == 0)) spawn(random);
    for (std::uint32_t n = random.index(5); n > 0 && !ids_.empty(); --n) act(random);
    expect(scene_.update(kFrame), "update");
    for (const CommandResult& result : scene_.results()) {
      const StatusCode code = result.status.code();
      ++report_.operations;
      if (code != StatusCode::ok && code != StatusCode::not_found &&
          code != StatusCode::invalid_argument)
        report_.violate("refusal", std::string(result.status.text()));
    }
  }

  /// Restored, the scene goes on with the same bits.
  void restore(Random& random) {
    expect(scene_.update(kFrame), "update");
    const auto bytes = scene_.save();
    if (!bytes) return report_.violate("snapshot", std::string(bytes.error().text()));
    auto other = make_scene(1);
    if (!other) return report_.violate("snapshot", std::string(other.error().text()));
    expect(other->restore(*bytes, assets_), "restore");
    const auto again = other->save();
    if (!again || *again != *bytes) report_.violate("snapshot", "another one after restoring");
    expect(scene_.update(kFrame), "update");
    expect(other->update(kFrame), "update");
    for (const InstanceId id : ids_) expect_same(*other, id);
    if (random.index(2) == 0) scene_ = std::move(*other);
  }

  void check() {
    for (const InstanceId id : ids_) {
      const TornModel* model = std::as_const(scene_).find(id)->model();
      if (model == nullptr) continue;
      report_.mix(model->digest());
      for (const std::string& fault : test::broken_laws(*model))
        report_.violate("cover and attributes", fault);
    }
  }

 private:
  void expect(const Status& status, const char* call) {
    if (!status) report_.violate("scene", say(call, ": ", status.text()));
  }
  template <class T>
  void expect(const Result<T>& result, const char* call) {
    expect(result.error(), call);
  }

  void expect_same(Scene& other, InstanceId id) {
    if (!other.contains(id)) return report_.violate("snapshot", "an instance is missing");
    const TornModel *a = std::as_const(scene_).find(id)->model(),
                    *b = std::as_const(other).find(id)->model();
    if ((a == nullptr) != (b == nullptr) || (a != nullptr && a->digest() != b->digest()))
      report_.violate("snapshot", "a model differs");
    const auto wanted = scene_.mesh(id, 0).positions, found = other.mesh(id, 0).positions;
    if (!found.empty() && (found.size() != wanted.size() ||
                           std::memcmp(found.data(), wanted.data(), wanted.size_bytes()) != 0))
      report_.violate("snapshot", "posed vertices differ");
  }

  void spawn(Random& random) {
    const auto id = scene_.spawn(assets_[random.index(static_cast<std::uint32_t>(assets_.size()))]);
    expect(id, "spawn");
    if (!id) return;
    ids_.push_back(*id);
    if (!scene_.find(*id)->character().clips.empty()) expect(scene_.play(*id, 0), "play");
  }

  void act(Random& random) {
    const InstanceId id = ids_[random.index(static_cast<std::uint32_t>(ids_.size()))];
    const CharacterInstance& instance = *std::as_const(scene_).find(id);
    const Character& source = *instance.asset()->character();
    switch (random.index(8)) {
      case 0: return expect(scene_.submit(id, UndoCommand{}), "submit");
      case 1: return expect(scene_.submit(id, RedoCommand{}), "submit");
      case 2: return expect(scene_.set_visible(id, random.index(3) > 0), "set_visible");
      case 3:
        expect(scene_.destroy(id), "destroy");
        std::erase(ids_, id);
        return;
      case 4:
        return expect(scene_.set_pose(id, test::random_pose(source, random, 0.3)), "set_pose");
      case 5: {
        PlaneCut cut;
        cut.point = Vec3d(0.3, random.uniform(0.2, 2.0), 0);
        cut.normal = random.direction();
        cut.caps = random.index(2) == 0;
        return expect(scene_.submit(id, cut), "submit");
      }
      default: break;
    }
    const ModelPose& pose = instance.pose();
    TearCommand tear;
    tear.stroke = test::random_stroke(
        source, pose.model_from_bone.empty() ? *rest_pose(source) : pose, random, 0.3, 3);
    tear.options.width = random.index(2) * 0.03;
    expect(scene_.submit(id, tear), "submit");
  }

  Scene scene_;
  const Assets& assets_;
  CaseReport& report_;
  std::vector<InstanceId> ids_;
};

}  // namespace

std::uint32_t threads_of_scenes = 0;

void busy_scenes(std::uint64_t seed, const Steps& steps, CaseReport& report) {
  Random random = random_of(seed, 0);
  const Assets assets = make_assets(random);
  const std::uint32_t threads = 1 + random.index(4);
  auto scene = make_scene(threads_of_scenes != 0 ? threads_of_scenes : threads);
  if (assets.size() != 2 || !scene) return report.violate("scene", "not made");
  BusyScene busy(std::move(*scene), assets, report);
  constexpr std::uint32_t kFrames = 60;
  for (std::uint32_t step = 1; step <= kFrames && report.violations.empty(); ++step) {
    if (!steps.has(step)) continue;
    Random numbers = random_of(seed, step);
    busy.frame(numbers);
    if (step % 20 == 0) busy.check();
    if (numbers.index(12) == 0) busy.restore(numbers);
  }
}

}  // namespace sunder::stress
