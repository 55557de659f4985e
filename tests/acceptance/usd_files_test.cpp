// Torn models written as USD and posed by two independent readers: what UsdSkel says, applied to
// the text as three's parser reads it, and three's USDLoader.
#include <sunder/io/character_file.h>
#include <sunder/io/usd_file.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/machine/node_program.h"
#include "support/machine/temporary_folder.h"
#include "support/models/animated_rig.h"
#include "support/models/rigs.h"
#include "support/models/shared_models.h"

namespace sunder {
namespace {

using test::Random;

/// Torn by a wide gap, a slit with walls and a plane with caps, at random places.
std::shared_ptr<const Character> torn(const LoadedCharacter& loaded, Random& random) {
  auto model = TornModel::create(loaded.character);
  EXPECT_TRUE(model) << model.error().text();
  std::uint32_t pieces = 0;
  for (int i = 0; i < 3; ++i) {
    const ModelPose pose = test::random_pose(model->character(), random, 0.4, 1.1);
    const double diagonal = test::posed_diagonal(model->character(), pose);
    const Stroke stroke = test::random_stroke(model->character(), pose, random, 0.3);
    TearOptions gap;
    (i == 0 ? gap.width : gap.wall_depth) = 0.02 * diagonal;
    const auto report = i == 2 ? model->cut(pose, {stroke[0].tip, random.direction(), {}, true})
                               : model->tear(pose, stroke, gap);
    EXPECT_TRUE(report) << report.error().text();
    pieces += report->runs;
  }
  EXPECT_GT(pieces, 0u);
  return std::make_shared<const Character>(model->character());
}

/// What a half holds, by its definition: 11 binary digits.
float as_half(float value) {
  if (value == 0) return 0;
  const float unit = std::ldexp(1.0f, std::max(std::ilogb(value), -14) - 10);
  return std::nearbyint(value / unit) * unit;
}

/// The character with the scales of its clips as halves times those at rest, if halves cannot hold
/// the latter.
Character with_scales_as_halves(Character character) {
  for (Clip& clip : character.clips)
    for (Channel& channel : clip.channels) {
      if (channel.target != ChannelTarget::scale) continue;
      const Vec3f& rest = character.skeleton.bones[channel.index].rest.scale;
      for (std::size_t i = 0; i < channel.values.size(); ++i) {
        const float at_rest = rest[static_cast<int>(i % 3)];
        const bool is_half = std::abs(as_half(at_rest) - at_rest) <= 2e-7f * std::abs(at_rest);
        const float unit = is_half ? 1 : at_rest;
        channel.values[i] = as_half(channel.values[i] / unit) * unit;
      }
    }
  return character;
}

bool has_splines(const Clip& clip) {
  return std::any_of(clip.channels.begin(), clip.channels.end(), [](const Channel& channel) {
    return channel.interpolation == Interpolation::cubic_spline;
  });
}

bool is_constant(const Channel& channel) {
  for (std::size_t i = channel.width; i < channel.values.size(); ++i)
    if (channel.values[i] != channel.values[i - channel.width]) return false;
  return true;
}

/// Whether bones change their scale at different times, so that a sample for all of them rounds
/// scales between keys too.
bool has_rounded_scales(const Clip& clip) {
  const Channel* first = nullptr;
  for (const Channel& channel : clip.channels) {
    if (channel.target != ChannelTarget::scale || is_constant(channel)) continue;
    if (first != nullptr && channel.times != first->times) return true;
    first = &channel;
  }
  return false;
}

/// Shares of the diagonal.
double allowed_difference(const Clip* clip) {
  if (clip == nullptr) return 1e-5;
  if (has_splines(*clip)) return 1e-3;
  return has_rounded_scales(*clip) ? 5e-4 : 1e-5;
}

/// At rest without a clip.
ModelPose pose_at(const Character& character, const Clip* clip, double seconds) {
  Pose pose = *local_rest_pose(character);
  if (clip != nullptr) {
    EXPECT_TRUE(sample_clip(*clip, seconds, pose));
  }
  ModelPose model_pose;
  EXPECT_TRUE(compute_model_pose(character.skeleton, pose, model_pose));
  return model_pose;
}

bool is_written(const Mesh& mesh) {
  return !std::all_of(mesh.triangles.begin(), mesh.triangles.end(), is_retired);
}

enum class Way { spec, three };

/// The points of a mesh in the order in which a program writes them.
std::vector<Vec3d> in_order_of(Way way, const Mesh& mesh, const std::vector<Vec3d>& points) {
  if (way == Way::spec) return points;
  std::vector<Vec3d> corners;
  for (std::uint32_t submesh = 0; submesh < mesh.submeshes.size(); ++submesh)
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      if (mesh.triangle_submesh[t] == submesh && !is_retired(mesh.triangles[t]))
        for (const std::uint32_t vertex : mesh.triangles[t]) corners.push_back(points[vertex]);
  return corners;
}

std::vector<double> read_doubles(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  std::vector<double> numbers(bytes.size() / sizeof(double));
  std::memcpy(numbers.data(), bytes.data(), numbers.size() * sizeof(double));
  return numbers;
}

class UsdFile {
 public:
  /// @param extension  ".usda" or ".usdz".
  UsdFile(const Character& character, const LoadedCharacter& loaded, const std::string& extension)
      : character_(character), file_(folder_.path() / ("torn" + extension)) {
    const auto saved = save_usd(file_, character, loaded, {kAllInfluences});
    EXPECT_TRUE(saved) << saved.error().text();
  }

  /// Compares the posed points of all meshes at ten moments of a clip, as they are written with
  /// `name`, or at rest. @return the largest distance by the diagonal.
  double largest_difference(Way way, const Clip* clip, const std::string& name) const {
    std::vector<double> moments = {0};
    if (clip != nullptr)
      for (int i = 1; i < 10; ++i)
        moments.push_back(static_cast<double>(clip->duration) * (0.013 + 0.107 * i));
    std::string arguments = (way == Way::spec ? "spec '" : "three '") + file_.string() + "' '" +
                            points_.string() + "' '" + name + "'";
    for (const double seconds : moments) arguments += " " + std::to_string(seconds);
    const auto run = test::run_node_program("usd_pose.mjs", arguments);
    EXPECT_TRUE(run && run->succeeded) << (run ? run->output : "node did not start");
    if (!run || !run->succeeded) return 1;
    const std::vector<double> found = read_doubles(points_);
    double largest = 0;
    std::size_t next = 0;
    for (const double seconds : moments)
      largest = std::max(
          largest, difference_at(way, pose_at(character_, clip, std::stod(std::to_string(seconds))),
                                 found, next));
    EXPECT_EQ(next, found.size());
    return largest;
  }

 private:
  double difference_at(Way way, const ModelPose& pose, const std::vector<double>& found,
                       std::size_t& next) const {
    const double diagonal = test::posed_diagonal(character_, pose);
    double largest = 0;
    for (std::uint32_t m = 0; m < character_.meshes.size(); ++m) {
      const Mesh& mesh = character_.meshes[m];
      if (!is_written(mesh)) continue;
      for (const Vec3d& point :
           in_order_of(way, mesh, test::posed_positions(character_, m, pose))) {
        if (next + 3 > found.size()) return 1;
        largest = std::max(largest,
                           (point - Vec3d(found[next], found[next + 1], found[next + 2])).norm());
        next += 3;
      }
    }
    return largest / diagonal;
  }

  const Character& character_;
  const test::TemporaryFolder folder_;
  const std::filesystem::path file_, points_ = folder_.path() / "points";
};

/// three's loader knows none.
bool has_morph_targets(const Character& character) {
  return std::any_of(character.meshes.begin(), character.meshes.end(),
                     [](const Mesh& mesh) { return !mesh.morph_targets.empty(); });
}

/// The names of the clips in the file, as they are where they are unique identifiers.
std::string name_in_file(const Clip& clip) {
  std::string name = clip.name.empty() ? "Clip" : clip.name;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  if (std::isdigit(static_cast<unsigned char>(name[0])) != 0) name.insert(0, "_");
  return name;
}

/// At rest, or the only or the first and the last clip.
std::vector<const Clip*> some_clips(const Character& character) {
  if (character.clips.empty()) return {nullptr};
  if (character.clips.size() == 1) return {&character.clips.front()};
  return {&character.clips.front(), &character.clips.back()};
}

void expect_same_in_motion(Way way, const Character& character, const LoadedCharacter& loaded) {
  const Character halves = with_scales_as_halves(character);
  const UsdFile file(halves, loaded, way == Way::spec ? ".usda" : ".usdz");
  const auto& weights = halves.rest_morph_weights;
  const bool has_weights =
      std::any_of(weights.begin(), weights.end(), [](float weight) { return weight != 0; });
  double largest = 0;
  for (const Clip* const clip : some_clips(halves)) {
    const std::string name = clip != nullptr ? name_in_file(*clip) : (has_weights ? "Rest" : "-");
    const double difference = file.largest_difference(way, clip, name);
    EXPECT_LE(difference, allowed_difference(clip))
        << name << (way == Way::spec ? " by what UsdSkel says" : " in three");
    largest = std::max(largest, difference);
  }
  testing::Test::RecordProperty(way == Way::spec ? "by_spec_1e9" : "by_three_1e9",
                                static_cast<int>(largest * 1e9));
}

/// With at most four influences per vertex, as in a GLB.
LoadedCharacter with_four_influences(const Character& character, const LoadedCharacter& loaded) {
  const test::TemporaryFolder folder;
  SaveOptions four;
  four.maximum_influences = 4;
  EXPECT_TRUE(save_glb(folder.path() / "four.glb", character, loaded, four));
  auto again = load_character(folder.path() / "four.glb");
  EXPECT_TRUE(again) << again.error().text();
  return std::move(*again);
}

class TornAsUsd : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(TornAsUsd, torn_models_move_as_ours_in_other_readers) {
  if (!test::has_node_packages({"three"})) GTEST_SKIP() << "node or three is not installed";
  const auto loaded = load_character(GetParam());
  if (!loaded) GTEST_SKIP() << "broken on purpose: " << loaded.error().text();
  Random random(7);
  const std::shared_ptr<const Character> character = torn(*loaded, random);
  expect_same_in_motion(Way::spec, *character, *loaded);
  if (has_morph_targets(*character)) return;
  const LoadedCharacter four = with_four_influences(*character, *loaded);
  expect_same_in_motion(Way::three, *four.character, four);
}

/// A tube whose bones are moved by clips of every interpolation, a second skin that binds the same
/// bones in other places, and a third that may flatten what it moves.
Character odd_rig(bool flattens, Random& random) {
  Character character = test::make_two_tubes(6, 7);
  for (Bone& bone : character.skeleton.bones)
    bone.rest.scale = Vec3f(0.3f, static_cast<float>(random.uniform(0.5, 2)), 1.7f);
  const auto random_matrix = [&] {
    Eigen::Matrix3f linear;
    for (int i = 0; i < 9; ++i) linear(i / 3, i % 3) = static_cast<float>(random.uniform(-1, 1));
    Affine3f matrix = Affine3f::Identity();
    matrix.linear() = linear + 2 * Eigen::Matrix3f::Identity();
    for (int i = 0; i < 3; ++i) matrix.translation()[i] = static_cast<float>(random.uniform(-1, 1));
    return matrix;
  };
  const std::size_t slots = character.skins[0].bones.size();
  for (std::size_t slot = 0; slot < slots; ++slot)
    character.skins[0].bone_from_bind[slot] = random_matrix();
  // A common factor, but for one slot.
  const Affine3f factor = random_matrix();
  character.skins[1] = character.skins[0];
  for (Affine3f& bone_from_bind : character.skins[1].bone_from_bind)
    bone_from_bind = bone_from_bind * factor;
  character.skins[1].bone_from_bind.back() = random_matrix();
  character.skins.push_back(character.skins[0]);
  if (flattens) character.skins[2].bone_from_bind[0].linear().col(1).setZero();
  character.meshes.push_back(character.meshes[1]);
  character.meshes[2].skin = 2;
  character.clips.clear();
  for (const Interpolation interpolation :
       {Interpolation::linear, Interpolation::step, Interpolation::cubic_spline}) {
    Clip clip;
    clip.name = "Clip" + std::to_string(character.clips.size());
    for (std::uint32_t bone = 0; bone < character.skeleton.bones.size(); ++bone)
      for (const ChannelTarget target :
           {ChannelTarget::translation, ChannelTarget::rotation, ChannelTarget::scale}) {
        Channel channel{target,        bone, target == ChannelTarget::rotation ? 4u : 3u,
                        interpolation, {},   {}};
        const bool is_spline = interpolation == Interpolation::cubic_spline;
        for (int key = 0; key < 5; ++key) {
          channel.times.push_back(static_cast<float>(key + (key > 0) * random.uniform(0, 0.9)));
          for (std::uint32_t i = 0; i < channel.width * (is_spline ? 3 : 1); ++i)
            channel.values.push_back(
                target == ChannelTarget::scale && !is_spline
                    ? character.skeleton.bones[bone].rest.scale[static_cast<int>(i % 3)]
                    : static_cast<float>(random.uniform(0.3, 1)));
        }
        clip.duration = std::max(clip.duration, channel.times.back());
        clip.channels.push_back(std::move(channel));
      }
    character.clips.push_back(std::move(clip));
  }
  return character;
}

TEST(UsdFiles, odd_skins_and_clips_move_as_ours) {
  if (!test::has_node_packages({"three"})) GTEST_SKIP() << "node or three is not installed";
  Random random(11);
  for (int i = 0; i < 5; ++i) {
    Character character = odd_rig(i % 2 == 0, random);
    ASSERT_TRUE(validate_character(character)) << validate_character(character).text();
    expect_same_in_motion(Way::spec, character, {});
    character.clips.resize(2);
    expect_same_in_motion(Way::spec, character, {});
    // three decomposes matrices at rest, which a flat one does not survive.
    if (i % 2 != 0) expect_same_in_motion(Way::three, character, {});
  }
}

TEST(UsdFiles, random_rigs_with_many_influences_move_as_ours) {
  if (!test::has_node_packages({"three"})) GTEST_SKIP() << "node or three is not installed";
  Random random(12);
  for (int i = 0; i < 5; ++i) {
    const Character character = test::make_animated_rig({12, 11, 3, 1.5, i % 2 == 0}, random);
    expect_same_in_motion(Way::spec, character, {});
  }
}

std::string name_of(const std::filesystem::path& file) {
  std::string name =
      file.parent_path().parent_path().filename().string() + "_" + file.filename().string();
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
}

INSTANTIATE_TEST_SUITE_P(
    Rigged, TornAsUsd,
    testing::ValuesIn(test::rigged_models({".glb", ".gltf", ".vrm", ".fbx", ".dae", ".x", ".b3d"})),
    [](const auto& of) { return name_of(of.param) + "_" + std::to_string(of.index); });

}  // namespace
}  // namespace sunder
