// The whole path on every available rigged file: load, tear in two poses at three places each,
// check every invariant in twenty other poses, save, validate, load again and compare in motion.
#include <sunder/io/character_file.h>
#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>
#include <sunder/skinning/skinned_mesh.h>
#include <sunder/tear/topology.h>
#include <sunder/tear/torn_model.h>
#include <sunder/tear/torn_weights.h>

#include <algorithm>
#include <cstdlib>
#include <optional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/machine/gltf_validator.h"
#include "support/machine/temporary_folder.h"
#include "support/models/rigs.h"
#include "support/models/shared_models.h"
#include "support/oracles/torn_invariants.h"

namespace sunder {
namespace {

using test::Random;
using testing::IsEmpty;

/// A random pose: a random time of a random clip or, without clips, random rotations.
ModelPose some_pose(const Character& character, Random& random) {
  if (character.clips.empty() || random.index(4) == 0)
    return test::random_pose(character, random, 0.4, 1.1);
  const Clip& clip =
      character.clips[random.index(static_cast<std::uint32_t>(character.clips.size()))];
  Pose pose = *local_rest_pose(character);
  EXPECT_TRUE(sample_clip(clip, random.uniform(0, static_cast<double>(clip.duration)), pose));
  ModelPose model;
  EXPECT_TRUE(compute_model_pose(character.skeleton, pose, model));
  return model;
}

/// Triangles as a file stores them: grouped by submesh, in order, without retired ones.
std::vector<Triangle> in_file_order(const Mesh& mesh) {
  std::vector<Triangle> triangles;
  for (std::uint32_t submesh = 0; submesh < mesh.submeshes.size(); ++submesh)
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t)
      if (mesh.triangle_submesh[t] == submesh && !is_retired(mesh.triangles[t]))
        triangles.push_back(mesh.triangles[t]);
  return triangles;
}

void expect_same_in_motion(const Character& memory, const Character& file, Random& random) {
  ASSERT_EQ(file.meshes.size(), memory.meshes.size());
  ASSERT_EQ(file.skeleton, memory.skeleton);
  for (std::uint32_t m = 0; m < memory.meshes.size(); ++m)
    EXPECT_EQ(in_file_order(file.meshes[m]), in_file_order(memory.meshes[m]));
  for (int i = 0; i < 3; ++i) {
    const ModelPose pose = some_pose(memory, random);
    const double diagonal = test::posed_diagonal(memory, pose);
    for (std::uint32_t m = 0; m < memory.meshes.size(); ++m) {
      const auto in_memory = test::posed_positions(memory, m, pose),
                 in_file = test::posed_positions(file, m, pose);
      ASSERT_EQ(in_memory.size(), in_file.size());
      double worst = 0;
      for (std::size_t v = 0; v < in_memory.size(); ++v)
        worst = std::max(worst, (in_memory[v] - in_file[v]).norm());
      EXPECT_LE(worst, 1e-6 * diagonal) << "mesh " << m;
    }
  }
}

/// Faults of the source are repaired. Only references to images that do not exist stay.
void expect_valid_file(const std::filesystem::path& saved) {
  if (!test::has_gltf_validator()) return;
  const auto verdict = test::validate_glb(saved);
  EXPECT_TRUE(verdict.errors == 0 || verdict.output.find("IO_ERROR") != std::string::npos)
      << verdict.output;
  EXPECT_GE(verdict.errors, 0) << "the validator did not run";
}

/// Loads a file. Some of the available files are broken on purpose: they must be refused, with a
/// reason.
std::optional<LoadedCharacter> load_or_refuse(const std::filesystem::path& file) {
  auto loaded = load_character(file);
  if (loaded) return std::move(*loaded);
  EXPECT_FALSE(loaded.error().text().empty());
  return {};
}

void tear_and_save(const std::filesystem::path& file, std::uint64_t seed) {
  const auto loaded = load_or_refuse(file);
  if (!loaded) return;
  Random random(seed);
  std::uint32_t pieces = 0;
  const bool is_clear = test::is_clear_of_itself(*loaded->character);
  for (int pose_number = 0; pose_number < 2; ++pose_number) {
    auto model = TornModel::create(loaded->character);
    ASSERT_TRUE(model) << model.error().text();
    const ModelPose pose = some_pose(*loaded->character, random);
    for (int place = 0; place < 3; ++place) {
      const Stroke stroke = test::random_stroke(model->character(), pose, random);
      ChangeRecord change;
      const auto report = model->tear(pose, stroke, {}, &change);
      ASSERT_TRUE(report) << report.error().text();
      pieces += report->runs;
      ASSERT_THAT(test::broken_lips(*model, change), IsEmpty());
      if (place == 0 && report->runs == 1 && is_clear) {
        ASSERT_THAT(test::broken_closure(*model), IsEmpty());
      }
    }
    ASSERT_THAT(test::broken_laws(*model), IsEmpty());
    if (is_clear) {
      ASSERT_THAT(test::broken_surface(*model), IsEmpty());
    }
    for (int i = 0; i < 20; ++i)
      ASSERT_THAT(test::broken_closed_form(*model, some_pose(*loaded->character, random)),
                  IsEmpty());

    const test::TemporaryFolder folder;
    const auto saved = folder.path() / "torn.glb";
    const Status status = save_glb(saved, model->character(), *loaded, {kAllInfluences});
    ASSERT_TRUE(status) << status.text();
    expect_valid_file(saved);
    const auto again = load_character(saved);
    ASSERT_TRUE(again) << again.error().text();
    expect_same_in_motion(model->character(), *again->character, random);
    const TopologyCounts in_memory = *count_topology(model->character()),
                         in_file = *count_topology(*again->character);
    EXPECT_EQ(in_memory.components, in_file.components);
    EXPECT_EQ(in_memory.boundary_loops, in_file.boundary_loops);
  }
  EXPECT_GT(pieces, 0u) << "not one of six strokes tore anything";
}

Vec3d somewhere_on(const Character& character, const ModelPose& pose, Random& random) {
  return test::random_stroke(character, pose, random)[0].tip;
}

/// One of each operation, at random places.
std::vector<Operation> one_of_each(const Character& character, Random& random) {
  std::vector<Operation> operations;
  const auto add_tear = [&](double width, Layers layers, double wall_depth) {
    const ModelPose pose = some_pose(character, random);
    const double diagonal = test::posed_diagonal(character, pose);
    const Stroke stroke = test::random_stroke(character, pose, random, random.uniform(0.05, 0.4),
                                              1 + random.index(4));
    operations.push_back(
        TearOperation{pose, stroke, {}, {width * diagonal, layers, wall_depth * diagonal}});
  };
  add_tear(0.01, Layers::nearest, 0);
  add_tear(0, Layers::all, 0);
  add_tear(0.02, Layers::all, 0);
  add_tear(0.005, Layers::nearest, 0.01);
  add_tear(0, Layers::nearest, 0.01);
  for (const bool caps : {false, true}) {
    const ModelPose pose = some_pose(character, random);
    const Vec3d point = somewhere_on(character, pose, random), normal = random.direction();
    operations.push_back(CutOperation{pose, {point, normal, {}, caps}});
  }
  for (const bool wall : {false, true}) {
    const ModelPose pose = some_pose(character, random);
    const double diagonal = test::posed_diagonal(character, pose);
    const Blade along = test::random_stroke(character, pose, random)[0];
    operations.push_back(DrillOperation{
        pose, {along.base, along.tip - along.base, 0.02 * diagonal, 0.5 * diagonal, 0.0, wall}});
  }
  for (std::size_t i = operations.size(); i > 1; --i)
    std::swap(operations[i - 1], operations[random.index(static_cast<std::uint32_t>(i))]);
  return operations;
}

void operate_and_undo(const std::filesystem::path& file, std::uint64_t seed) {
  const auto loaded = load_or_refuse(file);
  if (!loaded) return;
  Random random(seed);
  auto model = TornModel::create(loaded->character);
  ASSERT_TRUE(model) << model.error().text();
  const std::uint32_t non_manifold = count_topology(*loaded->character)->non_manifold_edges;
  const bool is_clear = test::is_clear_of_itself(*loaded->character);
  std::vector<std::uint64_t> digests = {model->digest()};
  for (const Operation& operation : one_of_each(*loaded->character, random)) {
    SCOPED_TRACE(operation.index());
    const std::uint32_t done = model->undo_count();
    const auto report = apply_operation(*model, operation);
    ASSERT_TRUE(report) << report.error().text();
    ASSERT_THAT(test::broken_laws(*model), IsEmpty());
    if (is_clear) {
      ASSERT_LE(count_topology(model->character())->non_manifold_edges, non_manifold);
    }
    if (model->undo_count() > done) digests.push_back(model->digest());
  }
  const test::TemporaryFolder folder;
  const auto saved = folder.path() / "torn.glb";
  const Status status = save_glb(saved, model->character(), *loaded);
  ASSERT_TRUE(status) << status.text();
  expect_valid_file(saved);
  const auto again = load_character(saved);
  ASSERT_TRUE(again) << again.error().text();
  if (is_clear) {
    const TopologyCounts in_memory = *count_topology(model->character()),
                         in_file = *count_topology(*again->character);
    EXPECT_EQ(in_memory.components, in_file.components);
    EXPECT_EQ(in_memory.boundary_edges, in_file.boundary_edges);
  }

  auto replayed = TornModel::create(loaded->character);
  ASSERT_TRUE(replayed);
  for (const Operation& operation : *model->history())
    ASSERT_TRUE(apply_operation(*replayed, operation));
  EXPECT_EQ(replayed->digest(), digests.back());
  for (std::size_t i = digests.size(); i-- > 0;) {
    EXPECT_EQ(model->digest(), digests[i]);
    if (i > 0) {
      ASSERT_TRUE(model->undo());
    }
  }
  EXPECT_EQ(model->character(), model->source());
}

/// SkinnedMesh agrees with the definition, in a frame at the character's middle, also after tears.
void pose_by_runtime(const std::filesystem::path& file, std::uint64_t seed) {
  const auto loaded = load_or_refuse(file);
  if (!loaded) return;
  Random random(seed);
  auto model = TornModel::create(loaded->character);
  ASSERT_TRUE(model) << model.error().text();
  std::vector<SkinnedMesh> runtime;
  for (const Mesh& mesh : loaded->character->meshes) {
    auto made =
        SkinnedMesh::create(source_of(mesh), loaded->character->skins[mesh.skin].bones.size());
    ASSERT_TRUE(made) << made.error().text();
    runtime.push_back(std::move(*made));
  }
  for (int i = 0; i < 6; ++i) {
    const ModelPose pose = some_pose(model->character(), random);
    if (i > 1) {
      ChangeRecord change;
      const auto report =
          model->tear(pose, test::random_stroke(model->character(), pose, random), {}, &change);
      ASSERT_TRUE(report) << report.error().text();
      for (const MeshChange& of_mesh : change.meshes)
        ASSERT_TRUE(runtime[of_mesh.mesh].update(source_of(model->character().meshes[of_mesh.mesh]),
                                                 of_mesh.first_vertex));
    }
    const double diagonal = test::posed_diagonal(model->character(), pose);
    for (std::uint32_t m = 0; m < runtime.size(); ++m) {
      const Mesh& mesh = model->character().meshes[m];
      const Skin& skin = model->character().skins[mesh.skin];
      const auto expected = test::posed_positions(model->character(), m, pose);
      Affine3d model_from_character = Affine3d::Identity();
      for (const Vec3d& position : expected)
        model_from_character.translation() += position / static_cast<double>(expected.size());
      BonePalette palette = *BonePalette::create(skin.bones.size(), pose.morph_weights.size());
      ASSERT_TRUE(palette.set(skin, pose, model_from_character));
      std::vector<Vec3f> posed(mesh.vertex_count());
      PosedBuffer buffer(
          {mesh.vertex_count(), {posed.empty() ? nullptr : posed[0].data()}, {}, {}});
      const Status status = runtime[m].deform(palette, buffer);
      ASSERT_TRUE(status) << status.text();
      double worst = 0;
      for (std::size_t v = 0; v < posed.size(); ++v)
        worst = std::max(
            worst,
            (posed[v].cast<double>() + model_from_character.translation() - expected[v]).norm());
      EXPECT_LE(worst, 5e-7 * diagonal) << "mesh " << m;  // a micrometre of a character of 2 m
    }
  }
}

/// Torn in some poses and weighed by each policy: `exact` stays on the untorn surface, a fit is not
/// worse than interpolation, and the path of the tears does not depend on the policy.
void weigh_by_each_policy(const std::filesystem::path& file, std::uint64_t seed) {
  const auto loaded = load_or_refuse(file);
  if (!loaded) return;
  Random random(seed);
  auto model = TornModel::create(loaded->character);
  ASSERT_TRUE(model) << model.error().text();
  for (int i = 0; i < 4; ++i) {
    const ModelPose pose = some_pose(model->character(), random);
    const auto report = model->tear(pose, test::random_stroke(model->character(), pose, random));
    ASSERT_TRUE(report) << report.error().text();
  }
  if (model->undo_count() == 0) return;
  const auto interpolated = model->digest();
  PoseSetSpec spec;
  spec.clip_samples = 4;
  for (int i = 0; i < 4; ++i) spec.poses.emplace_back(some_pose(model->character(), random));
  const auto set = PoseSet::create(loaded->character, spec);
  ASSERT_TRUE(set) << set.error().text();
  std::vector<ModelPose> poses(set->size(PoseSet::Role::fit));
  for (std::size_t i = 0; i < poses.size(); ++i)
    ASSERT_TRUE(set->compute(PoseSet::Role::fit, i, poses[i]));
  const auto measured = [&] {
    auto errors = measure_weight_errors(*model, 0, 1, poses);
    EXPECT_TRUE(errors) << errors.error().text();
    return std::move(*errors);
  };
  const auto weigh = [&](const WeightsOperation& wanted) {
    const auto report = model->reweigh(wanted);
    ASSERT_TRUE(report) << report.error().text();
    ASSERT_THAT(test::broken_laws(*model), IsEmpty());
  };
  const WeightErrors before = measured();
  double reach = 0;  // posed positions are rounded relative to this
  for (const ModelPose& pose : poses)
    reach = std::max(reach, test::posed_diagonal(*loaded->character, pose));
  for (const Skin& skin : loaded->character->skins)
    for (const Affine3f& matrix : skin.bone_from_bind)
      reach = std::max(reach, static_cast<double>(matrix.translation().norm()));

  WeightsOperation exact;
  exact.operation_count = 1;
  exact.weights.policy = WeightPolicy::exact;
  weigh(exact);
  EXPECT_LE(measured().metres.maximum, 2e-7 * reach);

  WeightsOperation refit;
  refit.operation_count = 1;
  refit.weights = {WeightPolicy::refit, 4};
  refit.refit.poses = spec;
  weigh(refit);
  const WeightErrors after = measured();
  WeightsOperation barycentric;
  barycentric.operation_count = 1;
  barycentric.weights.maximum_influences = 4;
  weigh(barycentric);
  const WeightErrors pruned = measured();
  for (std::size_t i = 0; i < after.points.size(); ++i) {
    const bool has_morphs =
        !loaded->character->rest_morph_weights.empty();  // a fit assumes morph weights at rest
    EXPECT_LE(after.points[i].rms, pruned.points[i].rms + (has_morphs ? 1e-3 : 3e-7) * reach);
  }

  WeightsOperation pose_exact;
  pose_exact.operation_count = 1;
  pose_exact.weights.policy = WeightPolicy::pose_exact;
  pose_exact.pose = poses[0];
  const auto report = model->reweigh(pose_exact);
  ASSERT_TRUE(report) << report.error().text();
  const auto errors = measure_weight_errors(*model, 0, 1, {poses.data(), 1});
  ASSERT_TRUE(errors);
  EXPECT_LE(std::ranges::count_if(errors->points,
                                  [&](const auto& point) { return point.maximum > 1e-6 * reach; }),
            report->ill_conditioned);

  barycentric.weights = {};
  weigh(barycentric);
  EXPECT_EQ(model->digest(), interpolated);
  EXPECT_EQ(before.points.size(), after.points.size());
}

class RiggedFile : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(RiggedFile, is_torn_moves_on_and_comes_back_from_disk) {
  tear_and_save(GetParam(), std::hash<std::string>()(GetParam().filename().string()));
}

TEST_P(RiggedFile, is_posed_by_the_runtime_as_by_definition) {
  pose_by_runtime(GetParam(), std::hash<std::string>()(GetParam().filename().string()));
}

TEST_P(RiggedFile, is_weighed_by_each_policy) {
  weigh_by_each_policy(GetParam(), std::hash<std::string>()(GetParam().filename().string()));
}

TEST_P(RiggedFile, takes_every_operation_and_gives_it_back) {
  const std::uint64_t rounds = std::getenv("SUNDER_STRESS") != nullptr ? 20 : 1;
  for (std::uint64_t round = 0; round < rounds && !HasFatalFailure(); ++round)
    operate_and_undo(GetParam(), round + std::hash<std::string>()(GetParam().filename().string()));
}

std::vector<std::filesystem::path> files() {
  auto found = test::rigged_models({".glb", ".gltf", ".fbx", ".dae", ".x", ".b3d"});
  if (!test::assimp_models().empty()) {
    // Formats that can contain a skin; the rigid models among them are torn too.
    const auto more =
        test::files_below(test::assimp_models(), {".glb", ".gltf", ".fbx", ".dae", ".x", ".b3d",
                                                  ".md5mesh", ".ms3d", ".smd", ".cob", ".mdl"});
    found.insert(found.end(), more.begin(), more.end());
  }
  return found;
}

INSTANTIATE_TEST_SUITE_P(all, RiggedFile, testing::ValuesIn(files()), [](const auto& test_case) {
  std::string name = std::to_string(test_case.index) + "_" + test_case.param.filename().string();
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name;
});

/// Files that are broken on purpose end a test above early; our own and the shared ones must not.
TEST(RiggedFiles, can_be_loaded) {
  const auto rigged = test::rigged_models({".glb", ".gltf", ".fbx", ".dae", ".x", ".b3d"});
  EXPECT_GE(rigged.size(), test::shared_models().empty() ? 8u : 22u);
  for (const auto& file : rigged) EXPECT_TRUE(load_character(file)) << file;
}

}  // namespace
}  // namespace sunder
