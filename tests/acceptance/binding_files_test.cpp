// Models of files bound to skeletons: to their own by automatic weights, which are compared with
// those of the artist, and by a mapping.

#include <sunder/binding/binding.h>
#include <sunder/io/character_file.h>
#include <sunder/skinning/pose.h>
#include <sunder/validation/validation.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/models/changed_surfaces.h"
#include "support/models/rigs.h"
#include "support/models/shared_models.h"

namespace sunder {
namespace {

using test::Random;

/// Automatic weights beside those of the artist: the mean sum over bones of their differences, and
/// the posed distance over random poses, RMS relative to the diagonal.
struct Figures {
  double l1 = 0, rms = 0, rms_of_rigid = 0;
};

std::vector<Vec3d> all_positions(const Character& character, const ModelPose& pose) {
  std::vector<Vec3d> all;
  for (Index m = 0; m < character.meshes.size(); ++m)
    for (const Vec3d& position : test::posed_positions(character, m, pose)) all.push_back(position);
  return all;
}

/// Each vertex on the bone with its largest weight, to say what an RMS means.
Character rigid(Character character) {
  for (Mesh& mesh : character.meshes) {
    SkinWeights weights;
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      const auto of = mesh.weights.of(v);
      const Influence most = *std::ranges::max_element(of, {}, &Influence::weight);
      weights.append(std::vector<Influence>{{most.slot, 1.0f}});
    }
    mesh.weights = std::move(weights);
  }
  return character;
}

double rms_distance(const Character& a, const Character& b) {
  Random random(1);
  double sum = 0, count = 0;
  const double diagonal = test::posed_diagonal(a, *rest_pose(a));
  for (int i = 0; i < 20; ++i) {
    const ModelPose pose = test::random_pose(a, random, 0.6, 1.0);
    const auto of_a = all_positions(a, pose), of_b = all_positions(b, pose);
    for (std::size_t v = 0; v < of_a.size(); ++v, ++count) sum += (of_a[v] - of_b[v]).squaredNorm();
  }
  return std::sqrt(sum / std::max(count, 1.0)) / diagonal;
}

Figures compare(const Character& artist, const Character& automatic) {
  Figures figures;
  double count = 0;
  for (Index m = 0; m < artist.meshes.size(); ++m)
    for (Index v = 0; v < artist.meshes[m].vertex_count(); ++v, ++count)
      figures.l1 += test::weight_distance(artist, m, v, automatic, m, v);
  figures.l1 /= std::max(count, 1.0);
  figures.rms = rms_distance(artist, automatic);
  figures.rms_of_rigid = rms_distance(artist, rigid(artist));
  return figures;
}

class BindingFiles : public testing::TestWithParam<std::filesystem::path> {
 protected:
  void SetUp() override {
    const auto loaded = load_character(GetParam());
    ASSERT_TRUE(loaded) << loaded.error().text();
    character_ = loaded->character;
    pose_ = *bind_pose(*character_);
  }

  /// The errors of a validation against a source, one per line. Automatic weights are not those of
  /// the artist, so that vertices under them deviate; by how much, Figures say.
  static std::string errors(const std::shared_ptr<const Character>& source, const Character& bound,
                            double allowed_deviation = ValidationOptions().error_deviation) {
    ValidationOptions options;
    options.maximum_deviation = options.error_deviation = allowed_deviation;
    const auto report = validate_skin(source, std::make_shared<const Character>(bound), options);
    if (!report) return std::string(report.error().text());
    std::string text;
    for (const Finding& finding : report->findings)
      if (finding.severity == Severity::error)
        text += std::string(finding.code) + ": " + finding.text + "\n";
    return text;
  }

  /// Models whose weights no automatic ones resemble: 130 random bones in a ball, bones that share
  /// their joints, and rigid parts of a machine. A validation against them finds bones that lost
  /// their weight to others.
  static bool is_like_no_artist() {
    const std::string name = GetParam().stem().string();
    return name == "many_bones" || name == "sail" || name == "robot_expressive";
  }

  std::shared_ptr<const Character> character_;
  ModelPose pose_;
};

TEST_P(BindingFiles, automatic_weights_are_valid_and_resemble_those_of_the_artist) {
  HeatOptions options;
  options.place.rig_from_bone = pose_.model_from_bone;
  const auto bound = bind_by_heat(*character_, *character_, options);
  ASSERT_TRUE(bound) << bound.error().text();
  const Status status = validate_character(bound->character);
  ASSERT_TRUE(status) << status.text();
  EXPECT_EQ(errors(std::make_shared<const Character>(bound->character), bound->character), "");
  EXPECT_EQ(is_like_no_artist() ? std::string() : errors(character_, bound->character, 1e6), "");
  const Figures figures = compare(*character_, bound->character);
  std::printf(
      "%-28s L1 %.3f, posed RMS %.4f of the diagonal (rigid %.4f); heated %.2f, parts %u, "
      "without sight %u, clamped %u of %u, bones without weight %zu\n",
      GetParam().filename().c_str(), figures.l1, figures.rms, figures.rms_of_rigid,
      static_cast<double>(bound->heated_points) / bound->points, bound->components,
      bound->components_without_sight, bound->clamped_edges, bound->edges,
      bound->bones_without_weight.size());
}

TEST_P(BindingFiles, a_mapping_onto_the_own_skeleton_changes_nothing) {
  MappingOptions options;
  options.place.rig_from_bone = pose_.model_from_bone;
  const auto bound = bind_by_mapping(*character_, *character_, {}, options);
  ASSERT_TRUE(bound) << bound.error().text();
  EXPECT_EQ(errors(character_, bound->character), "");
  EXPECT_LE(rms_distance(*character_, bound->character), 1e-6);
}

TEST(BindingGlove, hangs_on_a_robot_hand) {
  SUNDER_SKIP_WITHOUT_SHARED_MODELS();
  const auto glove = load_character(test::shared_models() / "rigged/vr_glove.fbx");
  ASSERT_TRUE(glove) << glove.error().text();
  const auto hand =
      load_character(test::shared_models() / "urdf/allegro_hand_right/allegro_hand_right.urdf");
  ASSERT_TRUE(hand) << hand.error().text();
  std::vector<BonePair> pairs = {{"wrist_r", "base_link"}};
  const std::vector<std::pair<std::string, int>> fingers = {
      {"index", 1}, {"middle", 5}, {"ring", 9}, {"pinky", 9}, {"thumb", 13}};
  for (const auto& [finger, first] : fingers)
    for (int i = 0; i < 3; ++i)
      pairs.push_back({"finger_" + finger + "_" + std::to_string(i) + "_r",
                       "link_" + std::to_string(first + i) + ".0"});
  const auto place = fit_place(*glove->character, *hand->character, pairs);
  ASSERT_TRUE(place) << place.error().text();
  MappingOptions options;
  options.place.rig_from_model = *place;
  const auto bound = bind_by_mapping(*glove->character, *hand->character, pairs, options);
  ASSERT_TRUE(bound) << bound.error().text();
  EXPECT_EQ(bound->mapped_bones, pairs.size());
  EXPECT_LE(bound->largest_shape_error, 1e-6);
  EXPECT_EQ(bound->character.skeleton, hand->character->skeleton);
  const auto judged = std::make_shared<const Character>(bound->character);
  const auto report = validate_skin(judged, judged);
  ASSERT_TRUE(report);
  for (const Finding& finding : report->findings) EXPECT_NE(finding.severity, Severity::error);
  // Automatic weights on the same robot, where the glove stands.
  HeatOptions heat;
  heat.place = options.place;
  const auto heated = bind_by_heat(*glove->character, *hand->character, heat);
  ASSERT_TRUE(heated) << heated.error().text();
  EXPECT_TRUE(validate_character(heated->character));
}

std::string name_of(const testing::TestParamInfo<std::filesystem::path>& info) {
  std::string name = std::to_string(info.index) + "_" + info.param.stem().string();
  for (char& letter : name)
    if (!std::isalnum(static_cast<unsigned char>(letter))) letter = '_';
  return name;
}

INSTANTIATE_TEST_SUITE_P(Models, BindingFiles,
                         testing::ValuesIn(test::rigged_models({".glb", ".gltf", ".fbx", ".dae"})),
                         name_of);

}  // namespace
}  // namespace sunder
