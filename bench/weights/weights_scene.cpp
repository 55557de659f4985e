#include "bench/weights/weights_scene.h"

#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/torn_weights.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "skinning/internal/reference.h"
#include "support/models/rigs.h"

#if SUNDER_BENCH_IO
#include <sunder/io/character_file.h>

#include <filesystem>
#endif

namespace sunder::bench {
namespace {

constexpr int kTears = 5;
constexpr std::uint32_t kClipSamples = 8;

ModelPose bent_pose(const Character& character, test::Random& random) {
  std::vector<std::uint32_t> lasting;
  for (std::uint32_t clip = 0; clip < character.clips.size(); ++clip)
    if (character.clips[clip].duration > 0) lasting.push_back(clip);
  if (lasting.empty()) return test::random_pose(character, random);
  const std::uint32_t clip = lasting[random.index(static_cast<std::uint32_t>(lasting.size()))];
  const double duration = static_cast<double>(character.clips[clip].duration);
  auto pose = make_pose(character, ClipPose{clip, random.uniform(0, duration)});
  if (!pose) std::abort();
  return *pose;
}

TornPoint describe_point(const Character& source, const TornModel& model, std::uint32_t mesh,
                         std::uint32_t vertex) {
  TornPoint point;
  point.mesh = mesh;
  point.vertex = vertex;
  const Birth birth = model.birth(mesh, vertex);
  const Mesh& of = source.meshes[mesh];
  point.corners = of.triangles[birth.triangle];
  point.barycentric = birth.barycentric;
  for (std::size_t k = 0; k < 3; ++k) {
    Eigen::Vector3d position = of.positions[point.corners[k]].cast<double>();
    for (std::size_t j = 0; j < of.morph_targets.size(); ++j)
      if (!of.morph_targets[j].position_deltas.empty())
        position += static_cast<double>(source.rest_morph_weights[of.first_morph_weight + j]) *
                    of.morph_targets[j].position_deltas[point.corners[k]].cast<double>();
    point.positions[k] = position;
    point.influences[k] = of.weights.of(point.corners[k]);
    point.exact.add(point.barycentric[k], point.positions[k], point.influences[k]);
  }
  return point;
}

/// Strokes are drawn again if they miss, or tear only places that a single bone moves, where all
/// policies are equal.
TornOnce tear_once(const std::shared_ptr<const Character>& character, test::Random& random) {
  for (int i = 0; i < 100; ++i) {
    auto model = TornModel::create(character);
    if (!model) std::abort();
    const ModelPose pose = bent_pose(*character, random);
    const auto report = model->tear(pose, test::random_stroke(*character, pose, random));
    if (!report) std::abort();
    if (report->runs == 0) continue;
    const auto errors = measure_weight_errors(*model, 0, kNone, {});
    if (!errors) std::abort();
    TornOnce torn{pose, std::move(*model), {}};
    for (const WeightErrors::OfPoint& point : errors->points)
      torn.points.push_back(describe_point(*character, torn.model, point.mesh, point.vertex));
    if (std::any_of(torn.points.begin(), torn.points.end(),
                    [](const TornPoint& p) { return p.exact.terms().size() > 1; }))
      return torn;
  }
  std::fprintf(stderr, "%s: no stroke tears it\n", character->name.c_str());
  std::exit(1);
}

std::optional<Poses> make_poses(const std::shared_ptr<const Character>& character,
                                const PoseSetSpec& spec) {
  const auto set = PoseSet::create(character, spec);
  if (!set) return std::nullopt;
  Poses poses{spec, {}, {}};
  for (const auto& [role, into] : {std::pair(PoseSet::Role::fit, &poses.fit),
                                   std::pair(PoseSet::Role::held_out, &poses.held_out)})
    for (std::size_t i = 0; i < set->size(role); ++i)
      if (!set->compute(role, i, into->emplace_back())) return std::nullopt;
  return poses;
}

WeightsModel make_model(std::string name, Character from) {
  WeightsModel model;
  model.name = std::move(name);
  model.character = std::make_shared<const Character>(std::move(from));
  const auto rest = make_pose(*model.character, RestPose{});
  if (!rest) std::abort();
  model.diagonal = test::posed_diagonal(*model.character, *rest);
  test::Random random(7);
  for (int i = 0; i < kTears; ++i) model.tears.push_back(tear_once(model.character, random));
  PoseSetSpec clips, turns;
  clips.clip_samples = kClipSamples;
  turns.clip_samples = 0;
  turns.range_of_motion = true;
  model.clips = make_poses(model.character, clips);
  auto range_of_motion = make_poses(model.character, turns);
  if (!range_of_motion) {
    std::fprintf(stderr, "%s: no joint turns\n", model.name.c_str());
    std::exit(1);
  }
  model.range_of_motion = std::move(*range_of_motion);
  std::fprintf(stderr,
               "%s: %u bones, %zu points of %d tears; poses of clips: %zu, held out %zu; of "
               "turning joints: %zu, %zu\n",
               model.name.c_str(), static_cast<unsigned>(model.character->skeleton.bones.size()),
               model.point_count(), kTears, model.clips ? model.clips->fit.size() : 0,
               model.clips ? model.clips->held_out.size() : 0, model.range_of_motion.fit.size(),
               model.range_of_motion.held_out.size());
  return model;
}

}  // namespace

Vec3d TornPoint::position() const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < 3; ++k) sum += barycentric[k] * positions[k];
  return sum;
}

Vec3d TornPoint::posed(const Character& source, std::span<const Affine3d> model_from_bind,
                       std::span<const float> morph_weights) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < 3; ++k)
    sum += barycentric[k] * deform_position_reference(source.meshes[mesh], corners[k],
                                                      model_from_bind, morph_weights);
  return sum;
}

std::size_t WeightsModel::point_count() const {
  std::size_t count = 0;
  for (const TornOnce& torn : tears) count += torn.points.size();
  return count;
}

std::vector<WeightsModel> make_weights_models() {
  std::vector<WeightsModel> models;
  models.push_back(make_model("tube", test::make_tube(24, 16, 8)));
#if SUNDER_BENCH_IO
  for (const char* name : {"cactoro.glb", "mannequiny.glb", "cesium_man.dae", "fox.glb",
                           "robot_expressive.glb", "soft_tube_14bones.fbx"}) {
    const std::filesystem::path file = std::filesystem::path(SUNDER_SHARED_MODELS "/rigged") / name;
    if (!std::filesystem::exists(file)) {
      std::fprintf(stderr, "%s is not there, and left out\n", file.string().c_str());
      continue;
    }
    const auto loaded = load_character(file);
    if (!loaded) {
      std::fprintf(stderr, "%s: %s\n", name, std::string(loaded.error().text()).c_str());
      std::exit(1);
    }
    models.push_back(make_model(file.stem().string(), *loaded->character));
  }
#else
  std::fprintf(stderr, "built without SUNDER_IO: the procedural rig alone\n");
#endif
  return models;
}

std::vector<std::vector<Affine3d>> palettes_of(const Character& character, const ModelPose& pose) {
  std::vector<std::vector<Affine3d>> palettes;
  for (const Skin& skin : character.skins) {
    palettes.emplace_back(skin.bones.size());
    if (!compute_palette(skin, pose, palettes.back())) std::abort();
  }
  return palettes;
}

}  // namespace sunder::bench
