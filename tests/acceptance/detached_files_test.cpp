// Every available rigged file is cut through its middle in a pose of its clips, and all pieces but
// the largest come free: each as a character that plays, is saved and loaded again.
#include <sunder/io/character_file.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/detached_piece.h>
#include <sunder/tear/topology.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/machine/gltf_validator.h"
#include "support/machine/temporary_folder.h"
#include "support/models/make_model.h"
#include "support/models/rigs.h"
#include "support/models/shared_models.h"
#include "support/oracles/model_state.h"

namespace sunder {
namespace {

using test::Random;

constexpr std::size_t kMostPieces = 12;

ModelPose some_pose(const Character& character, Random& random) {
  if (character.clips.empty()) return test::random_pose(character, random, 0.4, 1.0);
  const std::uint32_t clip = random.index(static_cast<std::uint32_t>(character.clips.size()));
  const double duration = static_cast<double>(character.clips[clip].duration);
  return *make_pose(character, ClipPose{clip, random.uniform(0, duration)});
}

Vec3d middle_of(const Character& character, const ModelPose& pose) {
  Vec3d least = Vec3d::Constant(HUGE_VAL), most = -least;
  for (std::uint32_t m = 0; m < character.meshes.size(); ++m)
    for (const Vec3d& p : test::posed_positions(character, m, pose)) {
      least = least.cwiseMin(p);
      most = most.cwiseMax(p);
    }
  return 0.5 * (least + most);
}

std::size_t count_live(const Character& character) {
  std::size_t count = 0;
  for (const Mesh& mesh : character.meshes)
    count += static_cast<std::size_t>(
        std::count_if(mesh.triangles.begin(), mesh.triangles.end(),
                      [](const Triangle& triangle) { return !is_retired(triangle); }));
  return count;
}

void expect_same_positions(const DetachedPiece& piece, const Character& before,
                           const ModelPose& pose, const ModelPose& of_piece, double tolerance) {
  for (std::uint32_t i = 0; i < piece.meshes.size(); ++i) {
    const auto now = test::posed_positions(*piece.character, i, of_piece),
               then = test::posed_positions(before, piece.meshes[i].mesh, pose);
    double worst = 0;
    for (std::uint32_t v = 0; v < now.size(); ++v)
      worst = std::max(worst, (now[v] - then[piece.meshes[i].vertex_old_from_new[v]]).norm());
    EXPECT_LE(worst, tolerance);
  }
}

void save_and_load(const Character& character, const test::TemporaryFolder& folder) {
  const auto file = folder.path() / "piece.glb";
  ASSERT_TRUE(save_glb(file, character));
  const auto loaded = load_character(file);
  ASSERT_TRUE(loaded) << loaded.error().text();
  EXPECT_EQ(count_live(*loaded->character), count_live(character));
  if (test::has_gltf_validator()) {
    EXPECT_EQ(test::validate_glb(file).errors, 0);
  }
}

class DetachedFiles : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(DetachedFiles, come_free_and_are_characters) {
  const auto loaded = load_character(GetParam());
  ASSERT_TRUE(loaded) << loaded.error().text();
  Random random(11);
  TornModel model = test::make_model(*loaded->character);
  const ModelPose pose = some_pose(model.source(), random);
  PlaneCut cut;
  cut.point = middle_of(model.source(), pose);
  cut.normal = random.direction();
  cut.caps = true;
  const auto report = model.cut(pose, cut);
  ASSERT_TRUE(report) << report.error().text();
  if (report->pieces.size() < 2) GTEST_SKIP() << "the cut divides nothing";
  const auto state = test::state_of(model);
  const Character before = model.character();
  std::vector<PieceDescription> pieces;
  for (const TornPiece& piece : report->pieces) pieces.push_back(*model.describe_piece(piece));
  std::sort(pieces.begin(), pieces.end(),
            [](const auto& a, const auto& b) { return a.triangle_count > b.triangle_count; });
  pieces.erase(pieces.begin());
  pieces.resize(std::min(pieces.size(), kMostPieces));

  const test::TemporaryFolder folder;
  std::size_t faces = 0;
  const double size = test::posed_diagonal(before, pose);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const PieceDescription::Triangles& of = pieces[i].meshes[0];
    DetachOptions options;
    options.motion = i % 2 == 0 ? PieceMotion::frozen : PieceMotion::animated;
    const auto piece = detach(model, pose, PieceOfTriangle{of.mesh, of.triangles[0]}, options);
    ASSERT_TRUE(piece) << piece.error().text();
    ASSERT_TRUE(validate_character(*piece->character));
    EXPECT_EQ(piece->report.triangles_retired, pieces[i].triangle_count);
    EXPECT_GT(piece->mass.mass, 0);
    EXPECT_TRUE(piece->mass.centre.allFinite() && piece->mass.inertia.allFinite());
    faces += piece->report.triangles_retired;
    if (options.motion == PieceMotion::frozen) {
      expect_same_positions(*piece, before, pose, *rest_pose(*piece->character), 2e-6 * size);
      if (has_convex_hulls()) {
        const auto hulls = convex_hulls(*piece);
        ASSERT_TRUE(hulls) << hulls.error().text();
        EXPECT_GE(hulls->size(), 1u);
        EXPECT_LE(hulls->size(), 8u);
      }
    } else {
      const ModelPose other = some_pose(before, random);
      expect_same_positions(*piece, before, other, other, 0);
    }
    save_and_load(*piece->character, folder);
  }
  EXPECT_EQ(faces + count_live(model.character()), count_live(before));

  const auto file = folder.path() / "torn.glb";
  ASSERT_TRUE(save_glb(file, model.character(), *loaded));
  const auto again = load_character(file);
  ASSERT_TRUE(again) << again.error().text();
  EXPECT_EQ(count_live(*again->character), count_live(model.character()));
  if (test::has_gltf_validator()) {
    EXPECT_EQ(test::validate_glb(file).errors, 0);
  }

  for (std::size_t i = 0; i < pieces.size(); ++i) ASSERT_TRUE(model.undo());
  EXPECT_EQ(test::difference(test::state_of(model), state), "");
}

INSTANTIATE_TEST_SUITE_P(Models, DetachedFiles, testing::ValuesIn(test::rigged_models({".glb"})),
                         [](const auto& file) {
                           std::string name = file.param.stem().string();
                           std::replace_if(
                               name.begin(), name.end(), [](char c) { return !std::isalnum(c); },
                               '_');
                           return name;
                         });

}  // namespace
}  // namespace sunder
