// Operations aimed by bone, on procedural rigs.
#include <sunder/aim/aim.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/topology.h>
#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/models/make_model.h"
#include "support/models/rigs.h"
#include "support/oracles/model_state.h"
#include "support/oracles/torn_invariants.h"

namespace sunder {
namespace {

using test::make_model;
using test::Random;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr double kPi = std::numbers::pi;
enum : std::uint32_t { kSkin, kSleeve, kClub, kOtherArm };

/// Adds a copy of a tube, scaled across its axis and moved.
void add_tube(Character& character, const Mesh& tube, const std::string& name, float across,
              const Vec3f& move) {
  Mesh mesh = tube;
  mesh.name = name;
  mesh.first_morph_weight = static_cast<std::uint32_t>(character.rest_morph_weights.size());
  character.rest_morph_weights.push_back(0.0f);
  for (Vec3f& position : mesh.positions)
    position = Vec3f(across * position.x(), position.y(), across * position.z()) + move;
  character.meshes.push_back(std::move(mesh));
}

/// An arm of three bones along y in a sleeve, a club beside it that the hand holds, and another
/// arm. The forearm reaches from y = 1 to 2, the arm is a metre wide and the sleeve 1.2 m.
Character make_armed_arm() {
  Character character = test::make_tube(24, 16, 3);
  const Mesh tube = character.meshes[0];
  for (std::uint32_t i = 0; i < 3; ++i)
    character.skeleton.bones[i].name = std::array{"rig:UpperArm", "rig:ForeArm", "rig:Hand"}[i];
  Bone other;
  other.name = "rig:OtherArm";
  other.rest.translation = Vec3f(3, 0, 0);
  character.skeleton.bones.push_back(other);
  Bone still;
  still.name = "rig:Still";
  character.skeleton.bones.push_back(still);
  Skin& skin = character.skins[0];
  skin.bones.push_back(3);
  Affine3f bone_from_bind = Affine3f::Identity();
  bone_from_bind.translation() = Vec3f(-3, 0, 0);
  skin.bone_from_bind.push_back(bone_from_bind);
  character.meshes[0].name = "skin";
  add_tube(character, tube, "sleeve", 1.2f, Vec3f::Zero());
  add_tube(character, tube, "club", 0.2f, Vec3f(0.95f, 0, 0));
  test::attach_to(character.meshes[kClub], 2);
  add_tube(character, tube, "other", 1.0f, Vec3f(3, 0, 0));
  test::attach_to(character.meshes[kOtherArm], 3);
  return character;
}

std::set<std::uint32_t> torn_meshes(const TornModel& model) {
  std::set<std::uint32_t> torn;
  for (std::uint32_t m = 0; m < model.source().meshes.size(); ++m)
    if (!(model.character().meshes[m] == model.source().meshes[m])) torn.insert(m);
  return torn;
}

TearReport apply_aimed(TornModel& model, const AimedOperation& aimed) {
  const auto plain = resolve(model, aimed);
  EXPECT_TRUE(plain) << plain.error().text();
  if (!plain) return {};
  const auto report = apply_operation(model, *plain);
  EXPECT_TRUE(report) << report.error().text();
  return report ? *report : TearReport{};
}

Status failure_of(const TornModel& model, const AimedOperation& aimed) {
  const auto plain = resolve(model, aimed);
  EXPECT_FALSE(plain);
  return plain.error();
}

SeverOperation sever_at(const std::string& bone, double at) {
  SeverOperation sever;
  sever.place = {bone, at};
  return sever;
}

SlashOperation slash_at(const std::string& bone, double at) {
  SlashOperation slash;
  slash.place = {bone, at};
  return slash;
}

TEST(Sever, cuts_skin_and_sleeve_but_neither_club_nor_the_other_arm) {
  for (const double at : {0.0, 0.1, 0.37, 0.5, 0.81, 1.0}) {
    SCOPED_TRACE(at);
    TornModel model = make_model(make_armed_arm());
    const TearReport report = apply_aimed(model, sever_at("ForeArm", at));
    EXPECT_EQ(torn_meshes(model), (std::set<std::uint32_t>{kSkin, kSleeve}));
    EXPECT_EQ(report.runs, 2u);
    EXPECT_EQ(report.pieces.size(), 4u);
    EXPECT_EQ(report.open_sections, 0u);
    EXPECT_EQ(count_topology(model.character())->boundary_edges, 0u);
  }
}

TEST(Sever, a_bone_that_moves_nothing_is_the_rigid_parts_below_it) {
  TornModel model = make_model(test::make_block_figure());
  const TearReport report = apply_aimed(model, sever_at("head", 0.2));
  EXPECT_EQ(torn_meshes(model), (std::set<std::uint32_t>{1}));
  EXPECT_EQ(report.runs, 1u);
  EXPECT_TRUE(at_nearest_share(make_model(test::make_block_figure()), sever_at("head", 0.1)));
  const auto before_it =
      at_nearest_share(make_model(test::make_block_figure()), sever_at("head", 0.0));
  ASSERT_FALSE(before_it) << "blocks are cut at the share that is asked for, or not";
  EXPECT_THAT(std::string(before_it.error().text()), HasSubstr("no share of the bone"));
  Character moved =
      test::make_block_figure();  // Here a clip says that the part is a limb of its own.
  moved.clips.push_back({"wag", 1.0f, {}});
  moved.clips[0].channels.push_back(
      {ChannelTarget::rotation, 2, 4, {}, {0.0f, 1.0f}, {0, 0, 0, 1, 0, 0, 1, 0}});
  TornModel animated = make_model(std::move(moved));
  EXPECT_THAT(std::string(failure_of(animated, sever_at("head", 0.2)).text()),
              HasSubstr("moves no vertex"));
}

TEST(Sever, leans_by_its_tilt_towards_the_view) {
  TornModel model = make_model(make_armed_arm());
  SeverOperation sever = sever_at("rig:ForeArm", 0.5);
  sever.tilt = 0.4;
  sever.from = ViewSide::left;
  const auto plain = resolve(model, sever);
  ASSERT_TRUE(plain) << plain.error().text();
  const PlaneCut& cut = std::get<CutOperation>(*plain).cut;
  EXPECT_NEAR((cut.normal - Vec3d(std::sin(0.4), std::cos(0.4), 0)).norm(), 0, 1e-6);
  EXPECT_NEAR((cut.point - Vec3d(0, 1.5, 0)).norm(), 0, 1e-6);
  EXPECT_EQ(cut.sections.size(), 2u);
  sever.tilt = 1.5;
  EXPECT_EQ(failure_of(model, sever).code(), StatusCode::invalid_argument);
}

TEST(Sever, also_cuts_what_a_slash_has_opened) {
  TornModel model = make_model(make_armed_arm());
  SlashOperation slash = slash_at("ForeArm", 0.5);
  slash.turn = kPi / 2;
  slash.options.layers = Layers::all;
  EXPECT_GT(apply_aimed(model, slash).runs, 0u);
  const TearReport report = apply_aimed(model, sever_at("ForeArm", 0.5));
  EXPECT_EQ(report.runs, 2u);
  EXPECT_EQ(report.pieces.size(), 4u);
  EXPECT_EQ(torn_meshes(model), (std::set<std::uint32_t>{kSkin, kSleeve}));
}

/// Caps lie in the plane up to the error of their weights in the pose, lips at rest up to rounding.
TEST(Sever, refuses_to_cut_where_the_limb_was_severed) {
  Random random(11);
  for (int i = 0; i < 40; ++i) {
    SCOPED_TRACE(i);
    const std::uint32_t bones = 2 + random.index(3);
    TornModel model = make_model(test::make_tube(8 * bones, 8 + random.index(12), bones));
    SeverOperation sever =
        sever_at("bone" + std::to_string(random.index(bones)), random.uniform(0.3, 0.9));
    sever.caps = i % 2 == 0;
    if (sever.caps) sever.pose = test::random_pose(model.source(), random, 0.3, 1.0);
    EXPECT_EQ(apply_aimed(model, sever).pieces.size(), 2u);
    const auto before = test::state_of(model);
    EXPECT_THAT(std::string(failure_of(model, sever).text()), HasSubstr("severed before"));
    EXPECT_EQ(test::difference(test::state_of(model), before), "");
    sever.place.at -= 0.1;
    EXPECT_FALSE(apply_aimed(model, sever).pieces.empty());
  }
}

TEST(Sever, follows_the_pose) {
  Random random(4);
  for (int i = 0; i < 60; ++i) {
    SCOPED_TRACE(i);
    const std::uint32_t bones = 2 + random.index(4);
    TornModel model = make_model(test::make_tube(8 * bones, 6 + random.index(14), bones));
    SeverOperation sever =
        sever_at("bone" + std::to_string(random.index(bones)), random.uniform(0.3, 0.7));
    sever.pose = test::random_pose(model.source(), random, 0.3, 1.0);
    const TearReport report = apply_aimed(model, sever);
    EXPECT_EQ(report.runs, 1u);
    EXPECT_EQ(report.pieces.size(), 2u);
    EXPECT_EQ(report.caps, 2u);
    EXPECT_EQ(count_topology(model.character())->boundary_edges, 0u);
    EXPECT_THAT(test::broken_laws(model), IsEmpty());
  }
}

TEST(Slash, opens_the_outer_surface_on_the_side_that_is_seen) {
  const std::array<std::pair<ViewSide, Vec3d>, 3> sides = {
      std::pair{ViewSide::front, Vec3d(0, 0, 1)}, std::pair{ViewSide::back, Vec3d(0, 0, -1)},
      std::pair{ViewSide::right, Vec3d(-1, 0, 0)}};
  for (const auto& [side, direction] : sides)
    for (const Layers layers : {Layers::nearest, Layers::all}) {
      TornModel model = make_model(make_armed_arm());
      SlashOperation slash = slash_at("ForeArm", 0.45);
      slash.from = side;
      slash.options.layers = layers;
      const TearReport report = apply_aimed(model, slash);
      EXPECT_GT(report.runs, 0u);
      EXPECT_EQ(torn_meshes(model), layers == Layers::all
                                        ? (std::set<std::uint32_t>{kSkin, kSleeve})
                                        : (std::set<std::uint32_t>{kSleeve}));
      for (const std::uint32_t m : torn_meshes(model)) {
        const Mesh& mesh = model.character().meshes[m];
        for (std::uint32_t v = model.source().meshes[m].vertex_count(); v < mesh.vertex_count();
             ++v)
          EXPECT_GT(mesh.positions[v].cast<double>().dot(direction), 0);
      }
    }
}

/// The front of a shin moves with the thigh for most of its length.
TEST(Slash, that_would_lie_on_other_limbs_goes_to_another_share) {
  Character character = test::make_tube(60, 16, 3);
  Mesh& mesh = character.meshes[0];
  mesh.weights = SkinWeights();
  for (const Vec3f& at : mesh.positions) {
    const bool is_front = at.z() > -0.1f && at.y() > 0.97f && at.y() < 1.7f;
    const std::uint32_t slot = at.y() > 1.97f ? 2 : at.y() > 0.97f ? 1 : 0;
    const std::array influences = {Influence{slot, is_front ? 0.25f : 1.0f}, Influence{0, 0.75f}};
    mesh.weights.append({influences.data(), is_front ? 2u : 1u});
  }
  const TornModel model = make_model(std::move(character));
  const SlashOperation slash = slash_at("bone1", 0.5);
  EXPECT_THAT(std::string(failure_of(model, slash).text()),
              testing::HasSubstr("the limb moves 25 % of what the stroke would lie on"));
  const auto moved = at_nearest_share(model, slash);
  ASSERT_TRUE(moved) << moved.error().text();
  EXPECT_GE(std::get<SlashOperation>(*moved).place.at, 0.65);
}

TEST(Slash, from_the_left_comes_between_club_and_arm) {
  TornModel model = make_model(make_armed_arm());
  SlashOperation slash = slash_at("ForeArm", 0.5);
  slash.from = ViewSide::left;
  EXPECT_GT(apply_aimed(model, slash).runs, 0u);
  EXPECT_EQ(torn_meshes(model), std::set<std::uint32_t>{kSleeve});
}

TEST(Slash, without_a_side_is_seen_from_the_front_or_if_the_bone_points_there_from_the_left) {
  const TornModel model = make_model(make_armed_arm());
  SlashOperation any = slash_at("ForeArm", 0.5), sided = any;
  sided.from = ViewSide::front;
  const auto stroke_of = [&](const SlashOperation& slash) {
    const auto plain = resolve(model, slash);
    EXPECT_TRUE(plain) << plain.error().text();
    return plain ? std::get<TearOperation>(*plain).stroke : Stroke();
  };
  EXPECT_EQ(stroke_of(any), stroke_of(sided));
  BonesPose forwards;  // turns +y to +z
  forwards.bones.push_back({"rig:UpperArm", {}, Quatf(std::sqrt(0.5f), std::sqrt(0.5f), 0, 0), {}});
  any.pose = sided.pose = forwards;
  EXPECT_THAT(std::string(failure_of(model, sided).text()), HasSubstr("along the bone"));
  sided.from = ViewSide::left;
  EXPECT_EQ(stroke_of(any), stroke_of(sided));
}

TEST(Slash, has_the_length_and_turn_that_are_asked_for) {
  for (const double turn : {0.0, 0.5, kPi / 2, -0.7}) {
    TornModel model = make_model(make_armed_arm());
    SlashOperation slash = slash_at("ForeArm", 0.5);
    slash.turn = turn;
    slash.length = {0.3, AimedLength::Unit::metres};
    const auto plain = resolve(model, slash);
    ASSERT_TRUE(plain) << plain.error().text();
    const Stroke& stroke = std::get<TearOperation>(*plain).stroke;
    Vec3d way = stroke.back().base - stroke.front().base;
    way.z() = 0;
    EXPECT_NEAR(way.norm(), 0.3, 1e-6);
    // Seen from the front, the bone points up and the model's left is on the right.
    const Vec3d expected(std::cos(turn), std::sin(turn), 0);
    EXPECT_NEAR(std::abs(way.dot(expected)), 0.3, 1e-6);
    const auto report = apply_operation(model, *plain);
    ASSERT_TRUE(report);
    EXPECT_GE(report->length_posed, 0.299);
    EXPECT_LE(report->length_posed, 0.33);
  }
}

TEST(Slash, in_widths_ends_at_the_outline) {
  TornModel model = make_model(make_armed_arm());
  SlashOperation slash = slash_at("ForeArm", 0.5);
  for (const double widths : {0.5, 1.0}) {
    slash.length = {widths, AimedLength::Unit::widths};
    const auto plain = resolve(model, slash);
    ASSERT_TRUE(plain) << plain.error().text();
    const Stroke& stroke = std::get<TearOperation>(*plain).stroke;
    const double across = std::abs(stroke.back().base.x() - stroke.front().base.x());
    EXPECT_NEAR(across, 1.2 * std::min(widths, 1.0), widths < 1 ? 1e-3 : 0.1);
  }
}

/// A number meant in another unit is no silent cut to the outline.
TEST(Slash, beyond_the_limb_is_refused_with_the_range) {
  TornModel model = make_model(make_armed_arm());
  const auto fault = [&](const std::function<void(SlashOperation&)>& set) {
    SlashOperation slash = slash_at("ForeArm", 0.5);
    set(slash);
    const auto plain = resolve(model, slash);
    if (plain) return std::string("accepted");
    EXPECT_EQ(plain.error().code(), StatusCode::invalid_argument);
    return std::string(plain.error().text());
  };
  using Unit = AimedLength::Unit;
  for (const double metres : {1.5, 2.0, 7.0, 160.0, 1e9}) {
    EXPECT_THAT(fault([&](auto& slash) {
                  slash.length = {metres, Unit::metres};
                }),
                AllOf(HasSubstr("'rig:ForeArm' at 0.5: length is "), HasSubstr("at most 1.2")));
    EXPECT_THAT(fault([&](auto& slash) {
                  slash.depth = {metres, Unit::metres};
                }),
                HasSubstr("depth is "));
    EXPECT_THAT(fault([&](auto& slash) { slash.options.width = metres; }), HasSubstr("width is "));
    EXPECT_THAT(fault([&](auto& slash) { slash.options.wall_depth = metres; }),
                HasSubstr("wall_depth is "));
    EXPECT_THAT(fault([&](auto& slash) { slash.options.lip_roll = metres; }),
                HasSubstr("lip_roll is "));
    EXPECT_THAT(fault([&](auto& slash) { slash.in_widths.lip_roll = metres; }),
                HasSubstr("lip_roll is "));
  }
  EXPECT_THAT(fault([&](auto& slash) {
                slash.length = {5, Unit::widths};
              }),
              HasSubstr("length is 6 m; it must be at most 1.2"));
}

TEST(Slash, along_the_limb_may_be_longer_than_the_limb_is_wide) {
  TornModel model = make_model(make_armed_arm());
  SlashOperation slash = slash_at("ForeArm", 0.5);
  slash.turn = kPi / 2;
  slash.length = {1.5, AimedLength::Unit::metres};
  const auto plain = resolve(model, slash);
  ASSERT_TRUE(plain) << plain.error().text();
  const Stroke& stroke = std::get<TearOperation>(*plain).stroke;
  EXPECT_NEAR(std::abs(stroke.back().base.y() - stroke.front().base.y()), 1.5, 0.1);
}

TEST(Slash, takes_the_lengths_of_its_options_in_widths) {
  TornModel model = make_model(make_armed_arm());
  SlashOperation slash = slash_at("ForeArm", 0.5);
  slash.options.width = 0.5;
  slash.in_widths = {.width = 0.01, .wall_depth = 0.02, .lip_roll = 0.001};
  const auto plain = resolve(model, slash);
  ASSERT_TRUE(plain) << plain.error().text();
  const TearOptions& options = std::get<TearOperation>(*plain).options;
  EXPECT_NEAR(options.width, 0.012, 1e-4);
  EXPECT_NEAR(options.wall_depth, 0.024, 1e-4);
  EXPECT_NEAR(options.lip_roll, 0.0012, 1e-5);
}

TEST(Slash, of_a_given_depth_stays_that_deep) {
  TornModel model = make_model(make_armed_arm());
  SlashOperation slash = slash_at("ForeArm", 0.5);
  slash.depth = AimedLength{0.05, AimedLength::Unit::metres};
  slash.options.layers = Layers::all;
  EXPECT_GT(apply_aimed(model, slash).runs, 0u);
  EXPECT_EQ(torn_meshes(model), std::set<std::uint32_t>{kSleeve}) << "the skin is 0.1 m below";
}

TEST(Slash, of_any_depth_spares_what_is_behind_the_limb) {
  TornModel model = make_model(make_armed_arm());
  SlashOperation slash = slash_at("ForeArm", 0.5);
  slash.from = ViewSide::right;
  slash.depth = AimedLength{1, AimedLength::Unit::widths};
  slash.options.layers = Layers::all;
  EXPECT_GT(apply_aimed(model, slash).runs, 0u);
  EXPECT_EQ(torn_meshes(model), (std::set<std::uint32_t>{kSkin, kSleeve}));
}

TEST(Slash, follows_the_pose) {
  Random random(5);
  for (int i = 0; i < 60; ++i) {
    SCOPED_TRACE(i);
    const std::uint32_t bones = 2 + random.index(4);
    TornModel model = make_model(test::make_tube(8 * bones, 8 + random.index(12), bones));
    SlashOperation slash =
        slash_at("bone" + std::to_string(random.index(bones)), random.uniform(0.2, 0.8));
    slash.turn = random.uniform(-3, 3);
    slash.from =
        random.index(2) == 0
            ? View(ViewSide::front)
            : View(ViewDirection{{random.uniform(-1, 1), 0, 1.0}, ViewDirection::Space::bone});
    if (random.index(2) == 0) slash.options.width = 0.02;
    slash.pose = test::random_pose(model.source(), random, 0.3, 1.0);
    const TearReport report = apply_aimed(model, slash);
    EXPECT_EQ(report.runs, 1u);
    EXPECT_EQ(report.segments_missed, 0u);
    EXPECT_TRUE(report.pieces.empty());
    EXPECT_THAT(test::broken_laws(model), IsEmpty());
  }
}

TEST(Puncture, goes_in_or_through) {
  for (const bool is_through : {false, true})
    for (const bool wall : {false, true}) {
      TornModel model = make_model(test::make_tube(24, 16, 3));
      PunctureOperation puncture;
      puncture.place = {"bone1", 0.5};
      puncture.radius = {0.1, AimedLength::Unit::metres};
      puncture.is_through = is_through;
      puncture.wall = wall;
      EXPECT_GT(apply_aimed(model, puncture).runs, 0u);
      EXPECT_EQ(count_topology(model.character())->boundary_loops, wall         ? 0u
                                                                   : is_through ? 2u
                                                                                : 1u);
      EXPECT_THAT(test::broken_laws(model), IsEmpty());
    }
}

TEST(Puncture, keeps_clear_of_the_club) {
  TornModel model = make_model(make_armed_arm());
  PunctureOperation puncture;
  puncture.place = {"ForeArm", 0.5};
  puncture.from = ViewSide::right;
  puncture.is_through = true;
  apply_aimed(model, puncture);
  EXPECT_EQ(torn_meshes(model), (std::set<std::uint32_t>{kSkin, kSleeve}));
}

TEST(Aim, finds_bones_without_their_namespace) {
  const Character character = make_armed_arm();
  EXPECT_EQ(*find_bone(character.skeleton, "Hand"), 2u);
  EXPECT_EQ(*find_bone(character.skeleton, "rig:Hand"), 2u);
  const auto unknown = find_bone(character.skeleton, "ForArm");
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().code(), StatusCode::not_found);
  EXPECT_THAT(std::string(unknown.error().text()), HasSubstr("'rig:ForeArm'"));
  EXPECT_THAT(std::string(find_bone(character.skeleton, "zzzzzz").error().text()),
              Not(HasSubstr("did you mean")));
  Character twice = character;
  twice.skeleton.bones[4].name = "second:Hand";
  EXPECT_EQ(find_bone(twice.skeleton, "Hand").error().code(), StatusCode::invalid_argument);
  EXPECT_EQ(*find_bone(twice.skeleton, "rig:Hand"), 2u);
}

TEST(Aim, refuses_what_it_cannot_hit) {
  TornModel model = make_model(make_armed_arm());
  const auto before = test::state_of(model);
  EXPECT_EQ(failure_of(model, sever_at("Still", 0.5)).code(), StatusCode::not_found);
  EXPECT_THAT(std::string(failure_of(model, sever_at("Still", 0.5)).text()),
              HasSubstr("moves no vertex"));
  EXPECT_EQ(failure_of(model, sever_at("ForeArm", 1.2)).code(), StatusCode::invalid_argument);
  EXPECT_EQ(failure_of(model, sever_at("ForeArm", std::numeric_limits<double>::quiet_NaN())).code(),
            StatusCode::non_finite_value);
  SlashOperation slash = slash_at("ForeArm", 0.5);
  slash.from = ViewSide::top;
  EXPECT_THAT(std::string(failure_of(model, slash).text()), HasSubstr("along the bone"));
  slash.from = ViewDirection{Vec3d(1e-9, 1.0, 0.0)};
  EXPECT_THAT(std::string(failure_of(model, slash).text()), HasSubstr("along the bone"));
  slash.from = ViewDirection{Vec3d::Zero()};
  EXPECT_EQ(failure_of(model, slash).code(), StatusCode::invalid_argument);
  slash = slash_at("ForeArm", 0.5);
  slash.length.value = 0;
  EXPECT_EQ(failure_of(model, slash).code(), StatusCode::invalid_argument);
  PunctureOperation puncture;
  puncture.place = {"ForeArm", 0.5};
  puncture.is_through = true;
  puncture.depth = AimedLength{0.1, AimedLength::Unit::metres};
  EXPECT_EQ(failure_of(model, puncture).code(), StatusCode::invalid_argument);
  puncture.depth.reset();
  puncture.radius = {1.3, AimedLength::Unit::metres};
  EXPECT_THAT(std::string(failure_of(model, puncture).text()),
              HasSubstr("radius is 1.3 m; it must be at most 1.2 m"));
  slash = slash_at("ForeArm", 0.5);
  slash.pose = ClipPose{std::string("Swim"), 0.0};
  EXPECT_EQ(failure_of(model, slash).code(), StatusCode::not_found);
  EXPECT_EQ(test::difference(test::state_of(model), before), "");
}

/// A skirt from y = 0 to 3 whose upper third the hips move, and each half below a thigh. All three
/// bones hang on a root that moves nothing.
Character make_skirt() {
  Character character = test::make_tube(24, 16, 3);
  const std::array names = {"Hips", "Thigh.L", "Thigh.R"};
  const std::array places = {Vec3f(0, 3, 0), Vec3f(0.25f, 2, 0), Vec3f(-0.25f, 2, 0)};
  character.skeleton.bones.assign(1, Bone{});
  character.skeleton.bones[0].name = "Root";
  Skin& skin = character.skins[0];
  skin.bones.clear();
  skin.bone_from_bind.clear();
  for (std::uint32_t i = 0; i < 3; ++i) {
    Bone bone;
    bone.name = names[i];
    bone.parent = 0;
    bone.rest.translation = places[i];
    character.skeleton.bones.push_back(bone);
    skin.bones.push_back(i + 1);
    Affine3f bone_from_bind = Affine3f::Identity();
    bone_from_bind.translation() = -places[i];
    skin.bone_from_bind.push_back(bone_from_bind);
  }
  character.clips.clear();
  Mesh& mesh = character.meshes[0];
  mesh.weights = SkinWeights();
  for (const Vec3f& position : mesh.positions) {
    const float hips = std::clamp(position.y() - 1.5f, 0.0f, 1.0f),
                left = std::clamp(0.5f + 2 * position.x(), 0.0f, 1.0f);
    std::vector<Influence> influences;
    for (const Influence& one : {Influence{0, hips}, Influence{1, (1 - hips) * left},
                                 Influence{2, (1 - hips) * (1 - left)}})
      if (one.weight > 0) influences.push_back(one);
    mesh.weights.append(influences);
  }
  return character;
}

TEST(Sever, a_skirt_round_both_thighs_is_of_neither) {
  const TornModel model = make_model(make_skirt());
  for (const char* const thigh : {"Thigh.L", "Thigh.R"})
    EXPECT_THAT(std::string(failure_of(model, sever_at(thigh, 0.5)).text()),
                HasSubstr("not of the limb alone"));
}

TEST(Aim, keeps_the_pose_and_options_of_the_operation) {
  const TornModel model = make_model(test::make_tube(24, 16, 3));
  SlashOperation slash = slash_at("bone1", 0.5);
  slash.pose = ClipPose{std::string("Bend"), 0.5};
  slash.options.width = 0.03;
  const auto plain = resolve(model, slash);
  ASSERT_TRUE(plain);
  const TearOperation& tear = std::get<TearOperation>(*plain);
  EXPECT_EQ(std::get<ClipPose>(tear.pose).time, 0.5);
  EXPECT_EQ(tear.options, slash.options);
}

/// The length of the path that blades stand on.
double length_of(const Stroke& stroke) {
  double length = 0;
  for (std::size_t i = 1; i < stroke.size(); ++i)
    length += (stroke[i].base + stroke[i].tip - stroke[i - 1].base - stroke[i - 1].tip).norm() / 2;
  return length;
}

TEST(Incision, is_straight_on_an_unrolled_prism) {
  constexpr std::uint32_t kSides = 12, kRings = 18;
  const TornModel model = make_model(test::make_tube(kRings, kSides, 3));
  // Triangle 2 (ring * sides + side) has its first corner at that ring and side.
  const double side = 2 * 0.5 * std::sin(kPi / kSides), ring = 3.0 / kRings;
  Random random(6);
  for (int i = 0; i < 40; ++i) {
    const std::uint32_t from_side = random.index(kSides), sides = random.index(5),
                        from_ring = random.index(kRings), to_ring = random.index(kRings);
    IncisionOperation incision;
    incision.points = {{0u, 2 * (from_ring * kSides + from_side), {1, 0, 0}},
                       {0u, 2 * (to_ring * kSides + (from_side + sides) % kSides), {1, 0, 0}}};
    if (sides == 0 && from_ring == to_ring) continue;
    const auto plain = resolve(model, incision);
    ASSERT_TRUE(plain) << plain.error().text();
    const double exact =
        std::hypot(side * sides, ring * (static_cast<double>(to_ring) - from_ring));
    const double length = length_of(std::get<TearOperation>(*plain).stroke);
    EXPECT_GE(length, exact * (1 - 1e-5));
    EXPECT_LE(length, exact * (1 + 0.02));
  }
}

TEST(Incision, is_torn_where_it_runs) {
  Random random(7);
  for (int i = 0; i < 20; ++i) {
    SCOPED_TRACE(i);
    TornModel model = make_model(test::make_bumpy_ball(400));
    const std::uint32_t count = model.source().meshes[0].triangle_count();
    IncisionOperation incision;
    const std::uint32_t start = random.index(count);
    // Places near one another, so that the path does not meet itself.
    incision.points = {{std::string(model.source().meshes[0].name), start, {1, 2, 1}},
                       {0u, (start + 20) % count, {0.2, 0.3, 0.5}}};
    incision.pose = test::random_pose(model.source(), random, 0.2, 1.0);
    const auto plain = resolve(model, incision);
    ASSERT_TRUE(plain) << plain.error().text();
    const auto report = apply_operation(model, *plain);
    ASSERT_TRUE(report) << report.error().text();
    EXPECT_GE(report->runs, 1u);
    EXPECT_EQ(report->segments_missed, 0u);
    const double length = length_of(std::get<TearOperation>(*plain).stroke);
    EXPECT_NEAR(report->length_posed, length, 0.02 * length);
  }
}

TEST(Incision, refuses_places_that_do_not_exist) {
  TornModel model = make_model(make_armed_arm());
  IncisionOperation incision;
  incision.points = {{0u, 0, {1, 0, 0}}};
  EXPECT_EQ(failure_of(model, incision).code(), StatusCode::invalid_argument);
  incision.points.push_back({0u, 1u << 30, {1, 0, 0}});
  EXPECT_EQ(failure_of(model, incision).code(), StatusCode::index_out_of_range);
  incision.points[1] = {std::string("skim"), 4, {1, 0, 0}};
  EXPECT_THAT(std::string(failure_of(model, incision).text()), HasSubstr("did you mean 'skin'"));
  incision.points[1] = {0u, 4, {1, -1, 0.5}};
  EXPECT_EQ(failure_of(model, incision).code(), StatusCode::invalid_argument);
  incision.points[1] = {std::string("club"), 4, {1, 1, 1}};
  EXPECT_THAT(std::string(failure_of(model, incision).text()), HasSubstr("does not connect"));
}

}  // namespace
}  // namespace sunder
