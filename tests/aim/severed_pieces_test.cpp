// What a sever takes off, judged by the weights of what is left: hands with shields and clubs.
#include <sunder/aim/aim.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/detached_piece.h>
#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/models/make_model.h"
#include "support/models/rigs.h"
#include "support/oracles/torn_invariants.h"

namespace sunder {
namespace {

using test::make_model;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr std::uint32_t kHand = 2;  // bone and slot

/// Adds a copy of a mesh, scaled and moved, that follows one slot alone.
void add_prop(Character& character, const Mesh& shape, const std::string& name, const Vec3f& scale,
              const Vec3f& move, std::uint32_t slot) {
  Mesh mesh = shape;
  mesh.name = name;
  mesh.first_morph_weight = static_cast<std::uint32_t>(character.rest_morph_weights.size());
  character.rest_morph_weights.push_back(0.0f);
  for (Vec3f& position : mesh.positions) position = position.cwiseProduct(scale) + move;
  test::attach_to(mesh, slot);
  character.meshes.push_back(std::move(mesh));
}

/// An arm along y, a metre wide, from y = 0 to 3; the hand begins at y = 2. The bones lie beside
/// the surface, inside what the hand holds: a shield that is larger than the hand, or a club of
/// twenty pieces, from y = 1 to 4.
Character make_armed_hand(bool is_club) {
  Character character = test::make_tube(24, 16, 3);
  for (std::uint32_t i = 0; i < 3; ++i)
    character.skeleton.bones[i].name = std::array{"UpperArm", "ForeArm", "Hand"}[i];
  const Mesh tube = character.meshes[0];
  for (Vec3f& position : character.meshes[0].positions) position.x() -= 1.2f;
  if (!is_club) {
    add_prop(character, tube, "shield", {1.2f, 1, 6}, {0, 1, 0}, kHand);
    return character;
  }
  for (int i = 0; i < 20; ++i)
    add_prop(character, tube, "club" + std::to_string(i), {0.1f, 1, 0.1f},
             {0.15f * static_cast<float>(i % 5 - 2), 1, 0.15f * static_cast<float>(i / 5 - 2)},
             kHand);
  return character;
}

SeverOperation sever_of(const std::string& bone, double at) {
  SeverOperation sever;
  sever.place = {bone, at};
  return sever;
}

double weight_of(const Character& character, const Mesh& mesh, std::uint32_t vertex,
                 std::uint32_t bone) {
  double sum = 0;
  for (const Influence& influence : mesh.weights.of(vertex))
    if (character.skins[mesh.skin].bones[influence.slot] == bone) sum += influence.weight;
  return sum;
}

/// Sum of a bone's weights over the corners of the triangles that are left of a mesh.
double weight_left(const Character& character, std::uint32_t m, std::uint32_t bone) {
  const Mesh& mesh = character.meshes[m];
  double sum = 0;
  for (const Triangle& triangle : mesh.triangles)
    if (!is_retired(triangle))
      for (const std::uint32_t vertex : triangle) sum += weight_of(character, mesh, vertex, bone);
  return sum;
}

double weight_left(const TornModel& model, std::uint32_t bone) {
  double sum = 0;
  for (std::uint32_t m = 0; m < model.character().meshes.size(); ++m)
    sum += weight_left(model.character(), m, bone);
  return sum;
}

/// Severs, takes off all that comes free, and returns how many pieces that were.
std::size_t sever_and_detach(TornModel& model, const SeverOperation& sever) {
  const auto plain = resolve(model, sever);
  const auto pieces = severed_pieces(model, sever);
  EXPECT_TRUE(plain) << plain.error().text();
  EXPECT_TRUE(pieces) << pieces.error().text();
  if (!plain || !pieces) return 0;
  EXPECT_TRUE(apply_operation(model, *plain));
  for (const auto* const places : {&pieces->severed, &pieces->props})
    for (const PiecePlace& place : *places) {
      const auto report = apply_operation(model, DetachOperation{sever.pose, place});
      EXPECT_TRUE(report) << report.error().text();
    }
  EXPECT_THAT(test::broken_laws(model), IsEmpty());
  return pieces->severed.size() + pieces->props.size();
}

TEST(SeveredPieces, a_hand_comes_off_and_what_it_holds_goes_along_whole) {
  for (const bool is_club : {false, true}) {
    SCOPED_TRACE(is_club);
    TornModel model = make_model(make_armed_hand(is_club));
    const double before = weight_left(model.character(), 0, kHand);
    EXPECT_EQ(sever_and_detach(model, sever_of("Hand", 0)), is_club ? 21u : 2u);
    EXPECT_LT(weight_left(model.character(), 0, kHand), 0.5 * before);
    for (std::uint32_t m = 1; m < model.character().meshes.size(); ++m) {
      EXPECT_EQ(weight_left(model.character(), m, kHand), 0.0) << m;
      EXPECT_EQ(model.character().meshes[m].vertex_count(), model.source().meshes[m].vertex_count())
          << "it is not cut";
    }
    EXPECT_GT(weight_left(model, 0), 0.0) << "the upper arm stays";
  }
}

TEST(SeveredPieces, what_the_hand_holds_comes_off_with_the_forearm) {
  for (const double at : {0.0, 0.3, 0.6, 0.9}) {
    SCOPED_TRACE(at);
    TornModel model = make_model(make_armed_hand(false));
    EXPECT_EQ(sever_and_detach(model, sever_of("ForeArm", at)), 2u);
    EXPECT_EQ(weight_left(model.character(), 1, kHand), 0.0);
    EXPECT_GT(weight_left(model, 0), 0.0);
  }
}

TEST(SeveredPieces, what_lies_before_a_cut_inside_the_last_bone_stays) {
  Character character = test::make_tube(24, 16, 3);
  const Mesh tube = character.meshes[0];
  // The last bone reaches from y = 2 to 3: a ring at its beginning and one at its end.
  add_prop(character, tube, "low", {1.5f, 0.05f, 1.5f}, {0, 2.1f, 0}, kHand);
  add_prop(character, tube, "high", {1.5f, 0.05f, 1.5f}, {0, 2.75f, 0}, kHand);
  for (const double at : {0.0, 0.6}) {
    SCOPED_TRACE(at);
    TornModel model = make_model(Character(character));
    EXPECT_EQ(sever_and_detach(model, sever_of("bone2", at)), at == 0 ? 3u : 2u);
    EXPECT_EQ(weight_left(model.character(), 1, kHand) > 0, at > 0);
    EXPECT_EQ(weight_left(model.character(), 2, kHand), 0.0);
  }
}

/// A body from y = 0 to 2, a head of its own on it whose neck moves a little with the body, and a
/// hat that holds most of what the bone of the head moves.
Character make_hidden_head() {
  Character character = test::make_tube(24, 16, 3);
  const Mesh tube = character.meshes[0];
  Mesh& body = character.meshes[0];
  for (Vec3f& position : body.positions) position.y() *= 2.0f / 3;
  body.weights = SkinWeights();
  for (std::uint32_t vertex = 0; vertex < body.vertex_count(); ++vertex) {
    const Influence whole{body.positions[vertex].y() < 1 ? 0u : 1u, 1.0f};
    body.weights.append({&whole, 1});
  }
  add_prop(character, tube, "head", {0.6f, 0.4f, 0.6f}, {0, 1.9f, 0}, kHand);
  Mesh& head = character.meshes[1];
  head.weights = SkinWeights();
  for (std::uint32_t vertex = 0; vertex < head.vertex_count(); ++vertex) {
    const bool is_neck = head.positions[vertex].y() < 1.98f;
    const std::array influences = {Influence{kHand, is_neck ? 0.5f : 1.0f}, Influence{1, 0.5f}};
    head.weights.append({influences.data(), is_neck ? 2u : 1u});
  }
  add_prop(character, tube, "hat", {3, 1, 3}, {0, 2.4f, 0}, kHand);
  return character;
}

TEST(SeveredPieces, a_head_comes_off_below_a_hat_that_is_larger) {
  TornModel model = make_model(make_hidden_head());
  const auto sever = at_nearest_share(model, sever_of("bone2", 0));
  ASSERT_TRUE(sever) << sever.error().text();
  const double before = weight_left(model.character(), 1, kHand);
  EXPECT_EQ(sever_and_detach(model, std::get<SeverOperation>(*sever)), 2u);
  EXPECT_LT(weight_left(model.character(), 1, kHand), 0.3 * before);
  EXPECT_EQ(weight_left(model.character(), 2, kHand), 0.0);
}

/// The area that a bone moves, by its weights, of what is left of a mesh at rest.
double area_left(const TornModel& model, std::uint32_t m, std::uint32_t bone) {
  const Character& character = model.character();
  const Mesh& mesh = character.meshes[m];
  double sum = 0;
  for (const Triangle& triangle : mesh.triangles) {
    if (is_retired(triangle)) continue;
    const Vec3f a = mesh.positions[triangle[0]];
    const Vec3f across = (mesh.positions[triangle[1]] - a).cross(mesh.positions[triangle[2]] - a);
    for (const std::uint32_t vertex : triangle)
      sum += across.norm() / 6 * weight_of(character, mesh, vertex, bone);
  }
  return sum;
}

/// Weights by height: of each slot from its height upwards, without blends.
void weigh_by_height(Mesh& mesh, const std::vector<std::pair<float, std::uint32_t>>& slots) {
  mesh.weights = SkinWeights();
  for (const Vec3f& position : mesh.positions) {
    Influence whole{slots.front().second, 1.0f};
    for (const auto& [height, slot] : slots)
      if (position.y() >= height) whole.slot = slot;
    mesh.weights.append({&whole, 1});
  }
}

/// Moves the joint of a bone that hangs on none along y.
void place_root(Character& character, std::uint32_t bone, float y) {
  character.skeleton.bones[bone].parent = kNone;
  character.skeleton.bones[bone].rest.translation = Vec3f(0, y, 0);
  Affine3f bone_from_bind = Affine3f::Identity();
  bone_from_bind.translation() = Vec3f(0, -y, 0);
  character.skins[0].bone_from_bind[bone] = bone_from_bind;
}

/// Severs at the default share or the nearest one that works, and takes off all that comes free.
std::size_t sever_somewhere(TornModel& model, const std::string& bone) {
  SeverOperation wanted = sever_of(bone, 0);
  wanted.caps = false;  // their area is not what is left
  const auto sever = at_nearest_share(model, wanted);
  EXPECT_TRUE(sever) << sever.error().text();
  return sever ? sever_and_detach(model, std::get<SeverOperation>(*sever)) : 0;
}

/// A tube whose weights a test replaces: without morph targets and clips.
Character plain_tube(std::uint32_t rings, std::uint32_t sides, std::uint32_t bone_count) {
  Character character = test::make_tube(rings, sides, bone_count);
  character.rest_morph_weights.clear();
  character.meshes[0].morph_targets.clear();
  character.clips.clear();
  return character;
}

/// The tip of a spike consists of crossed faces alone, and another part touches it there.
TEST(SeveredPieces, a_tip_comes_off_and_what_touches_it_stays) {
  Character character = plain_tube(2, 8, 3);
  Mesh spike = character.meshes[0];
  spike.name = "spike";
  for (Vec3f& position : spike.positions)
    if (position.y() > 2.9f) position = Vec3f(0, 3, 0);
  weigh_by_height(spike, {{0.0f, 0}, {1.0f, kHand}});
  Mesh& leaf = character.meshes[0];
  for (Vec3f& position : leaf.positions) position += Vec3f(0.5f, 3, 0);
  weigh_by_height(leaf, {{0.0f, 0}});
  for (Vec3f& position : leaf.positions)  // the lower rim ends in the tip
    if (position.y() < 3.1f) position = Vec3f(0, 3, 0);
  character.meshes.push_back(std::move(spike));
  TornModel model = make_model(std::move(character));
  const double leaf_before = area_left(model, 0, 0), before = area_left(model, 1, kHand);
  EXPECT_EQ(sever_and_detach(model, sever_of("bone2", 0.5)), 1u);
  EXPECT_EQ(area_left(model, 0, 0), leaf_before);
  EXPECT_LT(area_left(model, 1, kHand), before - 0.1);
}

/// A flat list of bones, of which the head moves most, and whose joint lies in its upper half.
TEST(SeveredPieces, a_head_that_hangs_on_no_bone_comes_off_and_the_body_stays) {
  Character character = test::make_tube(30, 16, 3);
  character.clips.clear();
  place_root(character, 0, 0);
  place_root(character, 1, 1);
  place_root(character, kHand, 2.6f);
  weigh_by_height(character.meshes[0], {{0.0f, 0}, {0.85f, 1}, {1.65f, kHand}});
  TornModel model = make_model(std::move(character));
  const double head = area_left(model, 0, kHand), body = area_left(model, 0, 1),
               legs = area_left(model, 0, 0);
  EXPECT_EQ(sever_somewhere(model, "bone2"), 1u);
  EXPECT_LT(area_left(model, 0, kHand), 0.5 * head);
  EXPECT_GE(area_left(model, 0, 1), 0.9 * body);
  EXPECT_EQ(area_left(model, 0, 0), legs);
}

/// The joint of the foot lies at the knee: a cut there would take the calf along.
TEST(SeveredPieces, most_of_what_the_parent_moves_stays) {
  Character character = test::make_tube(30, 16, 3);
  character.clips.clear();
  weigh_by_height(character.meshes[0], {{0.0f, 0}, {0.95f, 1}, {1.45f, kHand}});
  character.skeleton.bones[kHand].rest.translation = Vec3f(0, 0.02f, 0);
  character.skins[0].bone_from_bind[kHand].translation() = Vec3f(0, -1.02f, 0);
  TornModel model = make_model(std::move(character));
  const double parent = area_left(model, 0, 1), limb = area_left(model, 0, kHand);
  EXPECT_EQ(sever_somewhere(model, "bone2"), 1u);
  EXPECT_GE(area_left(model, 0, 1), 0.25 * parent);
  EXPECT_LT(area_left(model, 0, kHand), 0.5 * limb);
}

/// A doll of shells; the ball in its hip lies before the joint, and moves with hip and thigh.
TEST(SeveredPieces, a_limb_of_a_doll_comes_off_as_a_whole) {
  Character character = test::make_tube(24, 16, 3);
  character.clips.clear();
  const Mesh shell = character.meshes[0], small = test::make_tube(10, 8, 3).meshes[0];
  for (Vec3f& position : character.meshes[0].positions) position.y() *= 0.3f;
  weigh_by_height(character.meshes[0], {{0.0f, 0}});
  add_prop(character, small, "ball", {0.3f, 0.03f, 0.3f}, {0, 0.88f, 0}, 1);
  Mesh& ball = character.meshes[1];
  ball.weights = SkinWeights();
  const std::array of_both = {Influence{0, 0.6f}, Influence{1, 0.4f}};
  for (std::uint32_t vertex = 0; vertex < ball.vertex_count(); ++vertex)
    ball.weights.append(of_both);
  add_prop(character, shell, "thigh", {1, 0.3f, 1}, {0, 1.02f, 0}, 1);
  add_prop(character, shell, "shin", {1, 0.3f, 1}, {0, 2.05f, 0}, kHand);
  TornModel model = make_model(std::move(character));
  const double hip = area_left(model, 0, 0), thigh = area_left(model, 2, 1);
  EXPECT_EQ(sever_somewhere(model, "bone1"), 2u);
  EXPECT_EQ(area_left(model, 0, 0), hip);
  EXPECT_LT(area_left(model, 2, 1), 0.7 * thigh);
  EXPECT_EQ(area_left(model, 3, kHand), 0.0);
}

/// The cut-off hand is a part of the body still: it counts as what the forearm held.
TEST(SeveredPieces, a_limb_is_severed_again_beyond_and_before_an_earlier_cut) {
  for (const double at : {0.3, 0.8}) {
    TornModel model = make_model(test::make_tube(24, 16, 3));
    const auto first = resolve(model, sever_of("bone1", 0.5));
    ASSERT_TRUE(first);
    ASSERT_TRUE(apply_operation(model, *first));
    const auto second = resolve(model, sever_of("bone1", at));
    ASSERT_TRUE(second) << second.error().text();
    EXPECT_EQ(apply_operation(model, *second)->pieces.size(), 2u);
  }
}

/// Adds a bone that begins at a height, with a slot of the same number.
std::uint32_t add_bone(Character& character, const std::string& name, Index parent, float y) {
  const auto bone = static_cast<std::uint32_t>(character.skeleton.bones.size());
  Bone added;
  added.name = name;
  character.skeleton.bones.push_back(added);
  character.skins[0].bones.push_back(bone);
  character.skins[0].bone_from_bind.emplace_back();
  place_root(character, bone, y);
  if (parent == kNone) return bone;
  character.skeleton.bones[bone].parent = parent;
  float above = 0;
  for (Index i = parent; i != kNone; i = character.skeleton.bones[i].parent)
    above += character.skeleton.bones[i].rest.translation.y();
  character.skeleton.bones[bone].rest.translation.y() -= above;
  return bone;
}

/// Weights by a function of the place, one slot per vertex.
template <class SlotAt>
void weigh_by_place(Mesh& mesh, SlotAt slot_at) {
  mesh.weights = SkinWeights();
  for (const Vec3f& position : mesh.positions) {
    const Influence whole{slot_at(position), 1.0f};
    mesh.weights.append({&whole, 1});
  }
}

std::string refusal_of(const TornModel& model, const std::string& bone) {
  const auto sever = at_nearest_share(model, sever_of(bone, 0));
  EXPECT_FALSE(sever);
  return sever ? "" : std::string(sever.error().text());
}

/// A thumb that the skeleton hangs on the forearm lies on the hand, and beside the fingers.
TEST(SeveredPieces, a_thumb_that_hangs_on_the_forearm_goes_with_the_hand_and_not_with_the_fingers) {
  Character character = test::make_tube(60, 16, 3);
  character.clips.clear();
  const std::uint32_t fingers = add_bone(character, "Fingers", kHand, 2.2f),
                      thumb = add_bone(character, "Thumb", 1, 2.1f);
  weigh_by_place(character.meshes[0], [&](const Vec3f& at) {
    if (at.x() > 0.3f && at.y() > 2.12f && at.y() < 2.52f) return thumb;
    return at.y() > 2.17f ? fingers : at.y() > 1.97f ? kHand : at.y() > 1 ? 1u : 0u;
  });
  for (const std::string bone : {"bone2", "Fingers"}) {
    SCOPED_TRACE(bone);
    TornModel model = make_model(Character(character));
    const double before = area_left(model, 0, thumb), limb = area_left(model, 0, fingers);
    EXPECT_EQ(sever_somewhere(model, bone), 1u);
    EXPECT_LT(area_left(model, 0, fingers), 0.5 * limb);
    if (bone == "Fingers")
      EXPECT_GT(area_left(model, 0, thumb), 0.5 * before);
    else
      EXPECT_EQ(area_left(model, 0, thumb), 0.0);
  }
}

/// The right half of a fish's front is its neck, the left half its back: neither is a part of the
/// other, although no bone of this flat list adjoins the neck as much as the back does.
TEST(SeveredPieces, what_adjoins_the_body_too_is_no_part_of_the_limb) {
  Character character = test::make_tube(60, 16, 3);
  character.clips.clear();
  place_root(character, 0, 0);
  place_root(character, 1, 1.5f);
  place_root(character, kHand, 2.4f);
  const std::uint32_t fin = add_bone(character, "fin", kNone, 1.6f);
  weigh_by_place(character.meshes[0], [&](const Vec3f& at) {
    if (at.y() < 1.5f) return 0u;
    return at.x() < 0 ? 1u : at.y() < 2.4f ? fin : kHand;
  });
  const TornModel model = make_model(std::move(character));
  EXPECT_THAT(refusal_of(model, "bone1"), testing::HasSubstr("moved by 33 % 'fin'"));
}

/// A thumb's breadth beyond the last ring a spike has one vertex, with a quarter of the weights.
TEST(SeveredPieces, where_triangles_are_large_what_comes_off_holds_most_of_the_vertices_weights) {
  Character character = plain_tube(3, 8, 3);
  Mesh& mesh = character.meshes[0];
  mesh.weights = SkinWeights();
  for (Vec3f& position : mesh.positions) {
    if (position.y() > 2.9f) position = Vec3f(0, 3, 0);
    const std::array halves = {Influence{kHand, 0.5f}, Influence{1, 0.5f}};
    const Influence whole{position.y() > 2.9f ? kHand : position.y() > 0.9f ? 1u : 0u, 1.0f};
    if (position.y() > 1.9f && position.y() < 2.1f)
      mesh.weights.append(halves);
    else
      mesh.weights.append({&whole, 1});
  }
  character.skeleton.bones[kHand].rest.translation = Vec3f(0, 1.02f, 0);
  character.skins[0].bone_from_bind[kHand].translation() = Vec3f(0, -2.02f, 0);
  const TornModel model = make_model(std::move(character));
  EXPECT_TRUE(resolve(model, sever_of("bone2", 0))) << "with a share it may take less";
  EXPECT_THAT(refusal_of(model, "bone2"), testing::HasSubstr("of what the bones move on the body"));
}

/// A fin stands on an edge of the body, where its bone moves some of the body too.
TEST(SeveredPieces, a_part_that_stands_on_an_edge_of_the_body_is_of_it) {
  Character character = plain_tube(30, 16, 3);
  const Mesh tube = character.meshes[0];
  const std::uint32_t fin = add_bone(character, "fin", 1, 1.5f);
  character.skeleton.bones[fin].rest.translation.x() = 0.4f;
  character.skins[0].bone_from_bind[fin].translation().x() = -0.4f;
  weigh_by_place(character.meshes[0], [&](const Vec3f& at) {
    return at.x() > 0.4f && std::abs(at.y() - 1.5f) < 0.15f ? fin : at.y() > 1 ? 1u : 0u;
  });
  add_prop(character, tube, "fin", {1, 1, 1}, {0, 0, 0}, fin);
  Mesh& mesh = character.meshes[1];
  mesh.first_morph_weight = 0;
  character.rest_morph_weights.clear();
  for (Vec3f& at : mesh.positions) {
    const bool is_foot = at.y() == 0 && at.x() > 0.4f && at.z() <= 0;  // two neighbours at its rim
    at = is_foot ? Vec3f(0.5f, at.z() < 0 ? 1.6f : 1.5f, 0)
                 : Vec3f(0.6f + 0.5f * at.y(), 1.5f + 0.4f * at.x(), 0.1f * at.z());
  }
  TornModel model = make_model(std::move(character));
  const double before = area_left(model, 1, fin);
  EXPECT_EQ(sever_somewhere(model, "fin"), 1u);
  EXPECT_LT(area_left(model, 1, fin), 0.5 * before);
}

/// A helper bone moves a ring round the neck; the head behind it hangs on the neck.
TEST(SeveredPieces, a_larger_limb_is_no_part_of_a_bone_that_it_adjoins) {
  Character character = test::make_tube(60, 16, 3);
  character.clips.clear();
  const std::uint32_t helper = add_bone(character, "helper", 0, 1.8f);
  weigh_by_place(character.meshes[0], [&](const Vec3f& at) {
    if (at.y() > 1.97f) return kHand;
    const bool is_of_helper = at.y() > 1.77f && at.x() < 0.49f;  // beside it, neck and head adjoin
    return is_of_helper ? helper : at.y() > 0.97f ? 1u : 0u;
  });
  const TornModel model = make_model(std::move(character));
  EXPECT_FALSE(refusal_of(model, "helper").empty());
}

TEST(NearestShare, moves_only_what_cannot_be_hit) {
  Character character = test::make_tube(24, 16, 3);
  const Mesh tube = character.meshes[0];
  Bone other;
  other.name = "Other";
  other.rest.translation = Vec3f(3, 0, 0);
  character.skeleton.bones.push_back(other);
  character.skins[0].bones.push_back(3);
  Affine3f bone_from_bind = Affine3f::Identity();
  bone_from_bind.translation() = Vec3f(-3, 0, 0);
  character.skins[0].bone_from_bind.push_back(bone_from_bind);
  add_prop(character, tube, "late", {1, 0.9f, 1}, {3, 0.3f, 0}, 3);  // it begins beyond its joint
  const TornModel model = make_model(std::move(character));
  const auto share_of = [&](const SeverOperation& sever) {
    const auto moved = at_nearest_share(model, sever);
    EXPECT_TRUE(moved) << moved.error().text();
    return moved ? std::get<SeverOperation>(*moved).place.at : -1.0;
  };
  EXPECT_EQ(share_of(sever_of("bone1", 0)), 0.0);
  EXPECT_FALSE(resolve(model, sever_of("Other", 0)));
  const double share = share_of(sever_of("Other", 0));
  EXPECT_GT(share, 0.05);
  EXPECT_LE(share, 0.2);
  EXPECT_TRUE(resolve(model, sever_of("Other", share)));
  EXPECT_EQ(at_nearest_share(model, sever_of("nobody", 0)).error().text(),
            find_bone(model.character().skeleton, "nobody").error().text());
}

TEST(NearestShare, names_the_bone_that_can_be_severed_instead) {
  Character character = test::make_tube(60, 16, 3);
  character.clips.clear();
  const std::uint32_t helper = add_bone(character, "helper", 1, 1.8f);
  weigh_by_place(character.meshes[0], [&](const Vec3f& at) {
    if (at.y() > 1.97f) return kHand;
    const bool is_of_helper = at.y() > 1.77f && at.x() < 0.49f;
    return is_of_helper ? helper : at.y() > 0.97f ? 1u : 0u;
  });
  const TornModel model = make_model(std::move(character));
  EXPECT_THAT(refusal_of(model, "helper"),
              testing::HasSubstr("'bone1', which moves it, can be severed"));
  EXPECT_TRUE(at_nearest_share(model, sever_of("bone1", 0)));
}

/// The meshes that are left of a model when the pieces of a limb are taken off.
std::vector<std::string> meshes_left(Character character, const std::string& bone) {
  TornModel model = make_model(std::move(character));
  const auto pieces = limb_pieces(model, sever_of(bone, 0));
  EXPECT_TRUE(pieces) << pieces.error().text();
  if (!pieces) return {};
  for (const PiecePlace& place : pieces->places)
    EXPECT_TRUE(apply_operation(model, DetachOperation{{}, place}));
  std::vector<std::string> left;
  for (const Mesh& mesh : model.character().meshes)
    if (!std::ranges::all_of(mesh.triangles, is_retired)) left.push_back(mesh.name);
  return left;
}

TEST(LimbPieces, a_head_of_blocks_comes_off_whole) {
  EXPECT_THAT(meshes_left(test::make_block_figure(), "head"), ElementsAre("tube"));
  EXPECT_THAT(meshes_left(test::make_block_figure(), "cube"), ElementsAre("tube"));
  const TornModel model = make_model(test::make_block_figure());
  EXPECT_TRUE(limb_pieces(model, sever_of("head", 0))->are_rigid_parts);
  EXPECT_FALSE(limb_pieces(model, sever_of("cube", 0))->are_rigid_parts);
}

TEST(LimbPieces, of_a_limb_that_is_joined_to_the_rest_there_are_none) {
  const auto failure_of = [](Character character, const std::string& bone) {
    const auto pieces = limb_pieces(make_model(std::move(character)), sever_of(bone, 0));
    EXPECT_FALSE(pieces);
    return std::string(pieces.error().text());
  };
  EXPECT_THAT(failure_of(test::make_tube(24, 16, 3), "bone2"), HasSubstr("joined to the rest"));
  EXPECT_THAT(failure_of(test::make_block_figure(), "trunk"), HasSubstr("all of the model"));
  EXPECT_THAT(failure_of(test::make_block_figure(), "Tail"), HasSubstr("no bone is named"));
  Character idle = test::make_block_figure();
  test::attach_to(idle.meshes[1], 0);
  EXPECT_THAT(failure_of(std::move(idle), "head"), HasSubstr("move nothing"));
}

}  // namespace
}  // namespace sunder
