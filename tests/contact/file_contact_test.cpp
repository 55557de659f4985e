// Queries and previews on models of files: quantised weights, several meshes and skins, many
// influences, and robots.

#include <sunder/io/character_file.h>
#include <sunder/io/robot_file.h>
#include <sunder/tear/contact.h>
#include <sunder/tear/preview.h>

#include <cctype>
#include <cmath>

#include <gtest/gtest.h>

#include "support/models/rigs.h"
#include "support/models/shared_models.h"
#include "support/oracles/contact_oracle.h"

namespace sunder::test {
namespace {

std::vector<std::vector<Vec3d>> positions_of(const TornModel& model, const ModelPose& pose) {
  std::vector<std::vector<Vec3d>> positions;
  for (std::uint32_t m = 0; m < model.character().meshes.size(); ++m)
    positions.push_back(posed_positions(model.character(), m, pose));
  return positions;
}

/// Queries of the model in a pose agree with a test of every face.
void expect_agreement(const TornModel& model, const ModelPose& pose, Random& random) {
  SurfaceQuery query = *SurfaceQuery::create(model);
  ASSERT_TRUE(query.set_pose(pose));
  const ContactOracle oracle(model.character(), positions_of(model, pose));
  const double size = posed_diagonal(model.character(), pose);
  for (int i = 0; i < 12; ++i) {
    const auto& face =
        oracle.faces()[random.index(static_cast<std::uint32_t>(oracle.faces().size()))];
    const Vec3d target = (face.corners[0] + face.corners[1] + face.corners[2]) / 3;
    const Vec3d away = random.direction();
    const Vec3d origin = target + size * away;
    const auto crossings = oracle.crossings(origin, -away, 1e-6);
    const auto hit = query.cast_ray({origin, -away});
    ASSERT_TRUE(hit);
    if (!crossings.empty() && std::abs(crossings[0].least) > 1e-6) {
      ASSERT_TRUE(*hit);
      EXPECT_NEAR((*hit)->distance, crossings[0].along, 1e-8 * size);
    }
    const Vec3d point = target + 0.02 * size * random.direction();
    const auto nearest = query.find_nearest(point);
    ASSERT_TRUE(nearest && *nearest);
    EXPECT_NEAR((*nearest)->distance, oracle.distance(point, point), 1e-8 * size);
  }
}

/// A model in random poses, torn twice; each tear was previewed.
void tear_and_query(std::shared_ptr<const Character> character) {
  auto model = TornModel::create(character);
  ASSERT_TRUE(model) << model.error().text();
  Random random(3);
  for (int i = 0; i < 2; ++i) {
    const ModelPose pose = random_pose(*character, random, 0.4, 1.0);
    expect_agreement(*model, pose, random);
    const Stroke stroke = random_stroke(*character, pose, random);
    TearOptions options;
    options.width = i * 0.002 * posed_diagonal(*character, pose);
    const std::uint64_t digest = model->digest();
    const auto preview = preview_tear(*model, pose, stroke, options);
    ASSERT_TRUE(preview) << preview.error().text();
    EXPECT_EQ(model->digest(), digest);
    const auto report = model->tear(pose, stroke, options);
    ASSERT_TRUE(report);
    EXPECT_EQ(preview->report.faces_crossed, report->faces_crossed);
    EXPECT_EQ(preview->report.length_posed, report->length_posed);
    EXPECT_EQ(preview->report.vertices_added, report->vertices_added);
    EXPECT_EQ(preview->report.pieces.size(), report->pieces.size());
    expect_agreement(*model, pose, random);
  }
}

class FileContact : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(FileContact, queries_and_previews_agree_with_every_face) {
  const auto loaded = load_character(GetParam());
  ASSERT_TRUE(loaded) << loaded.error().text();
  tear_and_query(loaded->character);
}

INSTANTIATE_TEST_SUITE_P(Models, FileContact, testing::ValuesIn(rigged_gltf_models()),
                         [](const auto& of) {
                           std::string name = of.param.stem().string();
                           for (char& c : name)
                             if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
                           return name;
                         });

TEST(RobotContact, queries_and_previews_agree_with_every_face) {
  SUNDER_SKIP_WITHOUT_SHARED_MODELS();
  const auto files = files_below(shared_models() / "urdf" / "panda", {".urdf"});
  ASSERT_FALSE(files.empty());
  RobotLoadOptions options;
  options.package_roots = {shared_models() / "urdf"};
  const auto robot = load_robot(files.front(), options);
  ASSERT_TRUE(robot) << robot.error().text();
  tear_and_query(robot->model.character);
}

}  // namespace
}  // namespace sunder::test
