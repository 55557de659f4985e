// Operations are written and read back to the same bits.

#include <sunder/io/operation_log.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "support/machine/random.h"
#include "support/machine/temporary_folder.h"

namespace sunder {
namespace {

using test::Random;

// ---- Operations with random bits

/// Any double up to `largest`: of all magnitudes, round ones and ones without a short text, zeros
/// of both signs.
double any_number(Random& random, double largest = 1e9) {
  switch (random.index(8)) {
    case 0: return 0.0;
    case 1: return -0.0;
    case 2: return static_cast<double>(random.index(2001)) - 1000.0;
    case 3:
      return std::bit_cast<double>(
          std::uint64_t{random.index(0xFFFF'FFFF)});  // Below the smallest normal one.
    case 4: return random.uniform(-largest, largest);
    default: return random.uniform(-1, 1) * std::exp2(random.uniform(-300, 0)) * largest;
  }
}

/// A length that an operation accepts: not below 1e-30.
double any_above_zero(Random& random) {
  const double number = std::abs(any_number(random));
  return number > 1e-30 ? number : 0.125;
}

double any_at_least_zero(Random& random) { return std::abs(any_number(random)); }

Vec3d any_point(Random& random) {
  return {any_number(random), any_number(random), any_number(random)};
}

Vec3d any_direction(Random& random) {
  Vec3d direction = any_point(random);
  if (direction == Vec3d::Zero()) direction.y() = -0.5;
  return direction;
}

std::string any_name(Random& random) {
  const char* const parts[] = {"Arm", "/", "~1", "\"", "\\", "\n", "Ä", "骨", " ", "\t"};
  std::string name = "b" + std::to_string(random.index(1000));
  for (std::uint32_t i = random.index(4); i > 0; --i) name += parts[random.index(std::size(parts))];
  return name;
}

BonesPose any_bones_pose(Random& random) {
  const auto vector = [&] { return Vec3f(any_point(random).cast<float>()); };
  BonesPose pose;
  for (std::uint32_t i = random.index(5); i > 0; --i) {
    BonesPose::Bone bone;
    bone.name = std::to_string(i) + any_name(random);  // Names are unique.
    if (random.index(2) == 0) bone.translation = vector();
    if (random.index(2) == 0) {
      const Vec3d axis = random.direction();
      bone.rotation = Quatf(
          Quatd(Eigen::AngleAxisd(random.uniform(-4, 4), Eigen::Vector3d(axis))).cast<float>());
    }
    if (random.index(2) == 0) bone.scale = vector();
    pose.bones.push_back(bone);
  }
  return pose;
}

ModelPose any_model_pose(Random& random) {
  ModelPose pose;
  for (std::uint32_t i = random.index(6); i > 0; --i) {
    Affine3d matrix;
    for (int k = 0; k < 12; ++k) matrix.matrix().data()[k] = any_number(random, 1e30);
    pose.model_from_bone.push_back(matrix);
  }
  for (std::uint32_t i = random.index(3); i > 0; --i)
    pose.morph_weights.push_back(static_cast<float>(any_number(random)));
  return pose;
}

ClipPose any_clip_pose(Random& random) {
  ClipPose pose;
  if (random.index(2) == 0)
    pose.clip = any_name(random);
  else
    pose.clip = random.index(kNone);
  pose.time = any_at_least_zero(random);
  return pose;
}

PoseSpec any_pose(Random& random) {
  switch (random.index(5)) {
    case 0: return RestPose{};
    case 1: return BindPose{};
    case 2: return any_clip_pose(random);
    case 3: return any_bones_pose(random);
    default: return any_model_pose(random);
  }
}

WeightOptions any_weights(Random& random) {
  WeightOptions weights{static_cast<WeightPolicy>(random.index(4)), 0};
  if (weights.policy != WeightPolicy::exact && random.index(2) == 0)
    weights.maximum_influences = random.index(kNone);
  return weights;
}

std::optional<WeightOptions> any_weights_if_any(Random& random) {
  return random.index(2) == 0 ? std::nullopt : std::optional(any_weights(random));
}

TearOperation any_tear(Random& random) {
  TearOperation tear{.pose = any_pose(random), .stroke = {}, .pose_changes = {}, .options = {}};
  const std::uint32_t blade_count = 2 + random.index(4);
  for (std::uint32_t i = 0; i < blade_count; ++i) {
    Blade blade{any_point(random), any_point(random)};
    if (blade.base == blade.tip) blade.tip.x() += 1.0;
    tear.stroke.push_back(blade);
    if (i > 0 && random.index(3) == 0) tear.pose_changes.push_back({i, any_pose(random)});
  }
  tear.options = {any_at_least_zero(random), random.index(2) == 0 ? Layers::nearest : Layers::all,
                  any_at_least_zero(random), any_weights_if_any(random)};
  return tear;
}

CutOperation any_cut(Random& random) {
  CutOperation operation{any_pose(random),
                         {any_point(random),
                          any_direction(random),
                          {},
                          random.index(2) == 0,
                          {},
                          any_weights_if_any(random)}};
  if (random.index(2) == 0)
    for (std::uint32_t i = 3 + random.index(3); i > 0; --i)
      operation.cut.bounds.push_back(any_point(random));
  if (random.index(2) == 0)
    for (std::uint32_t i = 1 + random.index(3); i > 0; --i)
      operation.cut.sections.push_back(any_point(random));
  if (random.index(2) == 0) operation.cut.first_hit = {any_point(random), any_direction(random)};
  if (random.index(2) == 0) operation.cut.bone = "fore\"arm_l";
  return operation;
}

DrillOperation any_drill(Random& random) {
  const double radius = any_above_zero(random);
  return {any_pose(random),
          {any_point(random), any_direction(random), radius, any_above_zero(random),
           random.index(2) == 0 ? 0.0 : random.uniform(1e-5, 1) * radius, random.index(2) == 0,
           any_weights_if_any(random)}};
}

WeldOperation any_weld(Random& random) {
  WeldOperation operation{any_pose(random),
                          {{}, random.index(2) == 0 ? 0.0 : any_above_zero(random)}};
  for (std::uint32_t i = random.index(4); i > 0; --i)
    operation.weld.places.push_back(any_point(random));
  return operation;
}

SutureOperation any_suture(Random& random) {
  SutureOperation operation{any_pose(random), {}};
  Suture& suture = operation.suture;
  for (std::uint32_t i = random.index(4); i > 0; --i) suture.places.push_back(any_point(random));
  suture.reach = random.index(2) == 0 ? 0.0 : any_above_zero(random);
  suture.spacing = any_above_zero(random);
  suture.stiffness = random.uniform(1e-3, 1e12);
  suture.tension = random.index(2) == 0 ? 0.0 : random.uniform(0, 1e12);
  suture.strength = random.index(2) == 0 ? 0.0 : random.uniform(0, 1e12);
  return operation;
}

DetachOperation any_detach(Random& random) {
  if (random.index(2) == 0)
    return {any_pose(random), PieceOfTriangle{random.index(kNone), random.index(kNone)}};
  return {any_pose(random), PieceNear{any_point(random), random.index(2) == 0 ? "" : "b\"one"}};
}

RefitOptions any_refit(Random& random) {
  RefitOptions refit;
  refit.poses.clip_samples = random.index(65'537);
  refit.poses.range_of_motion = random.index(2) == 0;
  for (std::uint32_t i = random.index(3); i > 0; --i) {
    JointLimit limit{random.index(kNone), any_direction(random), any_number(random),
                     any_number(random)};
    if (limit.lower > limit.upper) std::swap(limit.lower, limit.upper);
    refit.poses.joint_limits.push_back(limit);
  }
  for (std::uint32_t i = random.index(3); i > 0; --i) refit.poses.poses.push_back(any_pose(random));
  refit.importance = {
      any_at_least_zero(random), {}, any_at_least_zero(random), any_at_least_zero(random)};
  for (std::uint32_t i = random.index(3); i > 0; --i)
    refit.importance.of_clip.push_back({"clip \"" + std::to_string(i), any_at_least_zero(random)});
  refit.bound = random.index(2) == 0 ? 0.0 : std::min(1e9, 1 + any_at_least_zero(random));
  refit.moves_bind = random.index(2) == 0;
  refit.is_coupled = random.index(2) == 0;
  refit.smoothness = any_at_least_zero(random);
  return refit;
}

WeightsOperation any_weights_operation(Random& random) {
  WeightsOperation operation;
  operation.first_operation = random.index(kNone);
  if (random.index(2) == 0) operation.operation_count = 1 + random.index(kNone - 1);
  operation.weights = any_weights(random);
  if (operation.weights.policy == WeightPolicy::pose_exact) operation.pose = any_pose(random);
  if (operation.weights.policy == WeightPolicy::refit) operation.refit = any_refit(random);
  return operation;
}

Operation any_operation(Random& random) {
  switch (random.index(12)) {
    case 0: return UndoOperation{1 + random.index(kNone - 1)};
    case 1: return RedoOperation{1 + random.index(kNone - 1)};
    case 2:
    case 3: return any_cut(random);
    case 4:
    case 5: return any_drill(random);
    case 6:
    case 7: return any_weights_operation(random);
    case 8: return any_detach(random);
    case 9: return any_weld(random);
    case 10: return any_suture(random);
    default: return any_tear(random);
  }
}

// ---- Their bits

/// All bits of operations as text; two operations are equal if and only if these are.
class Bits {
 public:
  std::string text;

  void add(double value) { text += "d" + std::to_string(std::bit_cast<std::uint64_t>(value)); }
  void add(float value) { text += "f" + std::to_string(std::bit_cast<std::uint32_t>(value)); }
  void add(std::uint32_t value) { text += "u" + std::to_string(value); }
  void add(bool value) { text += value ? "t" : "n"; }
  void add(const std::string& value) { text += "s" + std::to_string(value.size()) + value; }
  template <class Scalar, int Rows, int Columns, int Options>
  void add(const Eigen::Matrix<Scalar, Rows, Columns, Options>& matrix) {
    for (Eigen::Index i = 0; i < matrix.size(); ++i) add(matrix.data()[i]);
  }
  void add(const Affine3d& transform) { add(transform.matrix()); }
  void add(const Quatf& rotation) { add(rotation.coeffs()); }
  template <class T>
  void add(const std::optional<T>& value) {
    add(value.has_value());
    if (value) add(*value);
  }
  template <class T>
  void add(const std::vector<T>& values) {
    add(static_cast<std::uint32_t>(values.size()));
    for (const T& value : values) add(value);
  }
  template <class... T>
  void add(const std::variant<T...>& value) {
    add(static_cast<std::uint32_t>(value.index()));
    std::visit([&](const auto& kind) { add(kind); }, value);
  }
  void add(const RestPose&) {}
  void add(const BindPose&) {}
  void add(const ClipPose& pose) { add(pose.clip), add(pose.time); }
  void add(const BonesPose::Bone& bone) {
    add(bone.name), add(bone.translation), add(bone.rotation), add(bone.scale);
  }
  void add(const BonesPose& pose) { add(pose.bones); }
  void add(const ModelPose& pose) { add(pose.model_from_bone), add(pose.morph_weights); }
  void add(const Blade& blade) { add(blade.base), add(blade.tip); }
  void add(const TearOperation::PoseChange& change) { add(change.blade), add(change.pose); }
  void add(const WeightOptions& weights) {
    add(static_cast<std::uint32_t>(weights.policy)), add(weights.maximum_influences);
  }
  void add(const JointLimit& limit) {
    add(limit.bone), add(limit.axis), add(limit.lower), add(limit.upper);
  }
  void add(const PoseSetSpec& set) {
    add(set.clip_samples), add(set.range_of_motion), add(set.joint_limits), add(set.poses);
  }
  void add(const RefitOptions& refit) {
    add(refit.importance.clips), add(refit.importance.range_of_motion), add(refit.importance.poses);
    for (const RefitImportance::OfClip& of : refit.importance.of_clip) add(of.clip), add(of.factor);
    add(refit.bound), add(refit.poses), add(refit.moves_bind), add(refit.is_coupled),
        add(refit.smoothness);
  }
  void add(const TearOperation& tear) {
    add(tear.pose), add(tear.stroke), add(tear.pose_changes), add(tear.options.width);
    add(tear.options.layers == Layers::all), add(tear.options.wall_depth),
        add(tear.options.weights), add(tear.options.wall_material), add(tear.options.lip_roll);
  }
  void add(const SectionRay& ray) { add(ray.origin), add(ray.direction); }
  void add(const CutOperation& operation) {
    add(operation.pose), add(operation.cut.point), add(operation.cut.normal),
        add(operation.cut.bounds), add(operation.cut.caps);
    add(operation.cut.sections), add(operation.cut.weights);
    add(operation.cut.bone), add(operation.cut.cap_material);
    add(operation.cut.first_hit);
  }
  void add(const DrillOperation& operation) {
    add(operation.pose), add(operation.bore.origin), add(operation.bore.direction),
        add(operation.bore.radius);
    add(operation.bore.depth), add(operation.bore.chord_tolerance), add(operation.bore.wall),
        add(operation.bore.weights), add(operation.bore.wall_material);
  }
  void add(const WeldOperation& operation) {
    add(operation.pose), add(operation.weld.places), add(operation.weld.reach);
  }
  void add(const SutureOperation& operation) {
    const Suture& of = operation.suture;
    add(operation.pose), add(of.places), add(of.reach), add(of.spacing), add(of.stiffness);
    add(of.tension), add(of.strength);
  }
  void add(const WeightsOperation& operation) {
    add(operation.first_operation), add(operation.operation_count), add(operation.weights),
        add(operation.pose), add(operation.refit);
  }
  void add(const PieceOfTriangle& piece) { add(piece.mesh), add(piece.triangle); }
  void add(const PieceNear& piece) { add(piece.point), add(piece.bone); }
  void add(const DetachOperation& operation) { add(operation.pose), add(operation.piece); }
  void add(const UndoOperation& operation) { add(operation.count); }
  void add(const RedoOperation& operation) { add(operation.count); }
};

std::string bits(const std::vector<Operation>& operations) {
  Bits result;
  result.add(operations);
  return result.text;
}

// ---- Tests

class FormattedOperations : public testing::TestWithParam<std::uint64_t> {};

TEST_P(FormattedOperations, AreReadBackToTheSameBits) {
  Random random(GetParam());
  for (int log = 0; log < 60; ++log) {
    std::vector<Operation> operations;
    for (std::uint32_t i = random.index(8); i > 0; --i) operations.push_back(any_operation(random));
    const std::string text = *format_operations(operations);
    const auto again = parse_operations(text);
    ASSERT_TRUE(again) << again.error().text() << "\n" << text;
    ASSERT_EQ(bits(*again), bits(operations)) << text;
    ASSERT_EQ(*format_operations(*again), text);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, FormattedOperations, testing::Range<std::uint64_t>(0, 40));

TEST(FormatOperations, TakesALineForAnOperationAndOneForEachBlade) {
  TearOperation tear;
  ModelPose pose;
  pose.model_from_bone.assign(100, Affine3d::Identity());
  tear.stroke.assign(5, {{0, 0, 1}, {0, 0, 0}});
  tear.pose_changes = {{3, pose}};
  const std::string text =
      *format_operations(std::vector<Operation>{tear, UndoOperation{}, CutOperation{pose, {}}});
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 4 + 1 + 5 + 1 + 1 + 1);
  EXPECT_NE(text.find("\n    {\"op\":\"undo\",\"count\":1},\n"), std::string::npos) << text;
}

// A short log at a pose of many bones would become a long one, which nobody could read.
TEST(FormatOperations, WritesNoMoreThanIsRead) {
  ModelPose pose;
  pose.model_from_bone.assign(100'000, Affine3d::Identity());
  const Operation cut = CutOperation{pose, {}};
  std::vector<Operation> operations(3, cut);
  const auto some = format_operations(operations);
  ASSERT_TRUE(some) << some.error().text();
  EXPECT_EQ(parse_operations(*some)->size(), 3u);
  operations.resize(operations.size() * (std::size_t{64} << 20) / some->size() + 2, cut);
  const auto many = format_operations(operations);
  EXPECT_EQ(many.error().code(), StatusCode::limit_exceeded);
  EXPECT_NE(many.error().text().find("67108864 bytes"), std::string_view::npos)
      << many.error().text();
}

TEST(FormatOperations, OfWeightsOnlyWhatHasAMeaningIsWritten) {
  const auto text_of = [](const WeightsOperation& operation) {
    return *format_operations(std::vector<Operation>{operation});
  };
  WeightsOperation operation;
  operation.pose = BindPose{};
  operation.weights.policy = WeightPolicy::exact;
  EXPECT_NE(text_of(operation).find(
                R"({"op":"weights","first":0,"weights":{"policy":"exact","influences":0}})"),
            std::string::npos)
      << text_of(operation);
  operation.operation_count = 2;
  operation.weights = {WeightPolicy::pose_exact, 4};
  EXPECT_NE(
      text_of(operation).find(
          R"({"op":"weights","first":0,"count":2,"weights":{"policy":"pose_exact","influences":4},"pose":"bind"})"),
      std::string::npos)
      << text_of(operation);
  operation.weights.policy = WeightPolicy::refit;
  EXPECT_EQ(text_of(operation).find("bind\"}"), std::string::npos) << text_of(operation);
  EXPECT_NE(text_of(operation).find(R"("refit":{"poses":{"clip_samples":32,)"), std::string::npos)
      << text_of(operation);
  EXPECT_EQ(format_operations(std::vector<Operation>{CutOperation{}})->find("weights"),
            std::string::npos);
}

TEST(FormatOperations, AnyNumberOfInfluencesThatIsAppliedIsReadBack) {
  CutOperation cut;
  for (const std::uint32_t most : {0u, 1u, kNone - 1, kNone}) {
    cut.cut.weights = WeightOptions{WeightPolicy::barycentric, most};
    const std::vector<Operation> operations = {cut};
    const auto again = parse_operations(*format_operations(operations));
    ASSERT_TRUE(again) << again.error().text();
    EXPECT_EQ(bits(*again), bits(operations));
  }
}

TEST(FormatOperations, AnEmptyLogIsOne) {
  const auto operations = parse_operations(*format_operations({}));
  ASSERT_TRUE(operations) << operations.error().text();
  EXPECT_TRUE(operations->empty());
}

TEST(FormatOperations, NamesThatAreNoUtf8AreMendedForAValidLog) {
  CutOperation cut;
  cut.pose = ClipPose{
      "W\xFF"
      "alk",
      0.0};
  EXPECT_TRUE(parse_operations(*format_operations(std::vector<Operation>{cut})));
}

TEST(SaveOperations, IsLoadedAgain) {
  Random random(7);
  std::vector<Operation> operations;
  for (int i = 0; i < 30; ++i) operations.push_back(any_operation(random));
  const test::TemporaryFolder folder;
  const auto file = folder.write("log.json", std::string_view("an older log"));
  const Status status = save_operations(file, operations);
  ASSERT_TRUE(status) << status.text();
  const auto again = load_operations(file);
  ASSERT_TRUE(again) << again.error().text();
  EXPECT_EQ(bits(*again), bits(operations));
}

TEST(SaveOperations, LeavesNothingBehindWhereItFails) {
  const test::TemporaryFolder folder;
  std::filesystem::create_directories(folder.path() / "taken.json" / "inside");
  const std::vector<Operation> operations = {UndoOperation{}};
  EXPECT_EQ(save_operations(folder.path() / "taken.json", operations).code(),
            StatusCode::file_unreadable);
  EXPECT_EQ(save_operations(folder.path() / "no" / "folder.json", operations).code(),
            StatusCode::file_unreadable);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

}  // namespace
}  // namespace sunder
