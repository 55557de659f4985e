// Weights transferred between models: the laws, and each trap of the task.

#include <sunder/skinning/skinned_mesh.h>
#include <sunder/validation/transfer.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/validation/match/weld.h"
#include "pipeline/validation/transfer/laplacian.h"
#include "support/models/changed_surfaces.h"
#include "support/models/make_model.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"

namespace sunder {
namespace {

using test::Random;
using test::weight_distance;
using testing::Contains;
using testing::Field;
using testing::HasSubstr;

TransferResult transfer(const Character& source, const Character& target,
                        const TransferOptions& options = {}) {
  auto result = transfer_weights(source, target, options);
  EXPECT_TRUE(result) << result.error().text();
  if (!result) return {};
  const Status status = validate_character(result->character);
  EXPECT_TRUE(status) << status.text();
  return std::move(*result);
}

/// The largest difference of weights between two characters with the same vertices.
double largest_difference(const Character& a, const Character& b) {
  double largest = 0;
  for (Index m = 0; m < a.meshes.size(); ++m)
    for (Index v = 0; v < a.meshes[m].vertex_count(); ++v)
      largest = std::max(largest, weight_distance(a, m, v, b, m, v));
  return largest;
}

/// A tube whose middle bulges, too far from a tube without the bulge to be matched.
Character bulging(Character tube, float height = 0.8f) {
  Mesh& mesh = tube.meshes[0];
  float top = 0;
  for (const Vec3f& position : mesh.positions) top = std::max(top, position.y());
  for (Vec3f& position : mesh.positions) {
    const float along = position.y() / top;
    const float by = along > 0.35f && along < 0.65f ? 1 + height : 1.0f;
    position.x() *= by;
    position.z() *= by;
  }
  return tube;
}

/// Removes all knowledge of a rig: one bone, to which everything is attached.
Character without_skin(Character character) {
  Bone bone;
  bone.name = "node";
  character.skeleton.bones = {bone};
  Skin skin;
  skin.name = "node";
  skin.bones = {0};
  skin.bone_from_bind = {Affine3f::Identity()};
  character.skins = {skin};
  character.clips.clear();
  const std::vector<Influence> all = {{0, 1.0f}};
  for (Mesh& mesh : character.meshes) {
    mesh.skin = 0;
    mesh.weights = {};
    for (Index v = 0; v < mesh.vertex_count(); ++v) mesh.weights.append(all);
  }
  return character;
}

/// The weights of all vertices replaced by nonsense, so that nothing that is found can be a rest.
Character forgotten(Character character) {
  const std::vector<Influence> all = {{0, 1.0f}};
  for (Mesh& mesh : character.meshes) {
    mesh.weights = {};
    for (Index v = 0; v < mesh.vertex_count(); ++v) mesh.weights.append(all);
  }
  return character;
}

/// Two bones at the left and right of x = 0 and a middle one, and two sheets that nearly touch.
Character two_socks(float gap) {
  Character character = test::make_sheet(4, 1.0f);
  character.skeleton.bones.clear();
  Skin& skin = character.skins[0];
  skin.bones.clear();
  skin.bone_from_bind.clear();
  for (const auto& [name, x] : {std::pair{"foot.L", -0.5f}, {"foot.R", 0.5f}}) {
    Bone bone;
    bone.name = name;
    bone.rest.translation = {x, 0, 0};
    skin.bones.push_back(static_cast<Index>(character.skeleton.bones.size()));
    character.skeleton.bones.push_back(bone);
    Affine3f bone_from_bind = Affine3f::Identity();
    bone_from_bind.translation().x() = -x;
    skin.bone_from_bind.push_back(bone_from_bind);
  }
  Mesh left = character.meshes[0];
  const auto stand = [&](Mesh& mesh, float x, Index slot) {
    const std::vector<Influence> all = {{slot, 1.0f}};
    mesh.weights = {};
    for (Vec3f& position : mesh.positions) {
      position = {x, position.y(), position.x()};
      mesh.weights.append(all);
    }
  };
  Mesh right = left;
  stand(left, -gap / 2, 0);
  stand(right, gap / 2, 1);
  right.name = "right";
  character.meshes = {left, right};
  return character;
}

Index count_of(const TransferResult& result, TransferOutcome outcome) {
  Index count = 0;
  for (const auto& of_mesh : result.outcomes)
    count += static_cast<Index>(std::ranges::count(of_mesh, outcome));
  return count;
}

// ---- The laws

TEST(Transfer, a_model_gets_its_own_weights_back) {
  for (const Character& character : {test::make_sheet(9), test::make_tube(8, 12, 4),
                                     test::make_two_tubes(4, 6), test::make_bumpy_ball(800)})
    for (const TransferMethod method :
         {TransferMethod::closest_point, TransferMethod::inpainting}) {
      TransferOptions options;
      options.method = method;
      const TransferResult result = transfer(character, forgotten(character), options);
      EXPECT_EQ(result.matched_share(), 1.0);
      EXPECT_EQ(result.coincident, result.vertices);
      EXPECT_LE(largest_difference(result.character, character), 1e-7);
      EXPECT_TRUE(result.findings.empty());
      EXPECT_EQ(result.character.skins, character.skins);
    }
}

TEST(Transfer, the_unit_does_not_matter) {
  const Character source = test::make_tube(16, 12, 4), target = bulging(test::make_tube(20, 14, 4));
  const TransferResult metres = transfer(source, target);
  EXPECT_GT(metres.inpainted, 50u);
  for (const float factor : {0.01f, 100.0f}) {
    const TransferResult other =
        transfer(test::scaled(source, factor), test::scaled(target, factor));
    EXPECT_EQ(other.inpainted, metres.inpainted);
    EXPECT_LE(largest_difference(other.character, metres.character), 1e-6);
  }
}

TEST(Transfer, the_order_of_vertices_does_not_matter) {
  Random random(4);
  const Character source = test::make_tube(16, 12, 4), target = bulging(test::make_tube(20, 14, 4));
  const TransferResult straight = transfer(source, target);
  for (int i = 0; i < 5; ++i) {
    std::vector<Index> old_from_new(target.meshes[0].vertex_count());
    std::iota(old_from_new.begin(), old_from_new.end(), 0u);
    for (Index k = static_cast<Index>(old_from_new.size()); k > 1; --k)
      std::swap(old_from_new[k - 1], old_from_new[random.index(k)]);
    Character permuted = target;
    ASSERT_TRUE(reorder_vertices(permuted.meshes[0], old_from_new));
    const TransferResult result = transfer(source, permuted);
    for (Index v = 0; v < old_from_new.size(); ++v)
      EXPECT_LE(weight_distance(result.character, 0, v, straight.character, 0, old_from_new[v]),
                1e-9);
  }
}

TEST(Transfer, weights_are_valid_on_any_surface) {
  Random random(12);
  int done = 0;
  for (int i = 0; i < 80; ++i) {
    const Character source = test::make_soup(random), target = test::make_soup(random);
    TransferOptions options;
    options.distance = random.uniform(0.01, 0.5);
    options.smoothing_sweeps = random.index(3);
    options.maximum_influences = random.index(4);
    const auto result = transfer_weights(source, target, options);
    if (!result) {
      EXPECT_THAT(result.error().code(),
                  testing::AnyOf(StatusCode::not_found, StatusCode::empty_input));
      continue;
    }
    ++done;
    const Status status = validate_character(result->character);
    EXPECT_TRUE(status) << status.text();
  }
  EXPECT_GT(done, 40);
}

/// Groups the vertices that stand at one place of one tear side and expects equal weights in each.
void expect_equal_copies(const Character& character) {
  using Place = std::tuple<float, float, float, float, Index>;
  std::map<Place, std::map<std::string, float>> weights_at;
  for (const Mesh& mesh : character.meshes) {
    const auto sides = validation::tear_sides(mesh);
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      std::map<std::string, float> weights;
      for (const Influence& influence : mesh.weights.of(v))
        weights[character.skeleton.bones[character.skins[mesh.skin].bones[influence.slot]].name] =
            influence.weight;
      const Vec3f& p = mesh.positions[v];
      const auto [at, is_new] = weights_at.try_emplace(
          {p.x(), p.y(), p.z(), sides.empty() ? 0.0f : sides[v], mesh.skin}, weights);
      EXPECT_EQ(at->second, weights);
    }
  }
}

TEST(Transfer, coincident_copies_get_equal_bits) {
  const Character source = test::make_tube(16, 12, 4);
  for (const TransferMethod method : {TransferMethod::closest_point, TransferMethod::inpainting}) {
    TransferOptions options;
    options.method = method;
    options.smoothing_sweeps = 5;
    const TransferResult result = transfer(source, bulging(test::make_tube(21, 14, 4)), options);
    EXPECT_LT(result.points, result.vertices);
    expect_equal_copies(result.character);
  }
}

TEST(Transfer, a_torn_model_gets_the_weights_of_its_births) {
  Random random(21);
  Index appended = 0, lips = 0;
  for (int i = 0; i < 12; ++i) {
    TornModel model = test::make_model(test::random_character(random));
    for (int k = 0; k < 3; ++k)
      ASSERT_TRUE(test::play(model, test::random_tear(model, random, false)));
    const Character& torn = model.character();
    const TransferResult result = transfer(model.source(), forgotten(torn));
    expect_equal_copies(result.character);
    for (Index m = 0; m < torn.meshes.size(); ++m)
      for (Index v = 0; v < torn.meshes[m].vertex_count(); ++v) {
        EXPECT_LE(weight_distance(result.character, m, v, torn, m, v), 1e-4);
        appended += v >= model.source().meshes[m].vertex_count();
      }
    lips += result.points > transfer(model.source(), model.source()).points;
  }
  EXPECT_GT(appended, 100u);
  EXPECT_GT(lips, 5u);
}

// ---- Inpainting

TEST(Inpainting, continues_a_linear_function_exactly) {
  const Character source = test::make_sheet(20);
  Character target = test::make_sheet(20);
  for (Vec3f& position : target.meshes[0].positions)
    if ((position - Vec3f(0.5f, 0.5f, 0)).norm() < 0.3f) position.z() += 1e-3f;
  for (const double smoothness : {0.0, 1e-3, 1.0}) {
    TransferOptions options;
    options.distance = 5e-4;
    options.smoothness = smoothness;
    const TransferResult result = transfer(source, forgotten(target), options);
    EXPECT_GT(result.inpainted, 50u);
    EXPECT_LE(largest_difference(result.character, source), 2e-4);
  }
}

/// Two parallel fingers with a bone each and 0.1 m between them if their radius is 0.5 m.
Character two_fingers(float radius) {
  Character character = test::make_tube(12, 16, 2);
  character.skeleton.bones[1].parent = kNone;
  character.rest_morph_weights.clear();
  character.clips.clear();
  Mesh finger = character.meshes[0];
  finger.morph_targets.clear();
  character.meshes.clear();
  for (const Index slot : {0u, 1u}) {
    Mesh& mesh = character.meshes.emplace_back(finger);
    mesh.name += std::to_string(slot);
    mesh.weights = {};
    const std::vector<Influence> all = {{slot, 1.0f}};
    for (Vec3f& position : mesh.positions) {
      position.x() = position.x() * 2 * radius + (slot == 0 ? -0.55f : 0.55f);
      position.z() *= 2 * radius;
      mesh.weights.append(all);
    }
  }
  return character;
}

TEST(Inpainting, is_better_than_the_closest_point_between_fingers) {
  // So thick that the inner sides of the fingers reach into each other.
  const Character source = two_fingers(0.5f), truth = two_fingers(0.65f);
  const auto error = [&](TransferMethod method) {
    TransferOptions options;
    options.method = method;
    const TransferResult result = transfer(source, forgotten(truth), options);
    EXPECT_EQ(result.inpainted > 0, method == TransferMethod::inpainting);
    double sum = 0;
    for (Index m = 0; m < 2; ++m)
      for (Index v = 0; v < truth.meshes[m].vertex_count(); ++v)
        sum += weight_distance(result.character, m, v, truth, m, v);
    return sum;
  };
  EXPECT_GT(error(TransferMethod::closest_point), 50);
  EXPECT_LT(error(TransferMethod::inpainting), 1);
}

TEST(Inpainting, obtuse_and_shared_edges_are_clamped_and_counted) {
  // A needle, an obtuse pair, and an edge of three faces.
  const std::vector<Vec3d> positions = {{0, 0, 0},       {1, 0, 0}, {0.5, 0.01, 0},
                                        {0.5, -0.01, 0}, {0, 0, 1}, {0.5, 1e-9, 3}};
  const std::vector<Triangle> triangles = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}, {2, 3, 5}};
  const validation::Laplacian laplacian = validation::make_laplacian(positions, triangles);
  EXPECT_GT(laplacian.clamped_edges, 0u);
  for (int row = 0; row < laplacian.stiffness.outerSize(); ++row) {
    double sum = 0;
    for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator at(laplacian.stiffness, row);
         at; ++at) {
      if (at.col() != row) {
        EXPECT_LT(at.value(), 0);
      }
      sum += at.value();
    }
    EXPECT_NEAR(sum, 0, 1e-9);
  }
  for (const double mass : laplacian.mass) EXPECT_GT(mass, 0);
}

TEST(Inpainting, areas_sum_to_that_of_the_surface) {
  const Character ball = test::make_bumpy_ball(300);
  std::vector<Vec3d> positions;
  for (const Vec3f& position : ball.meshes[0].positions)
    positions.push_back(position.cast<double>());
  double area = 0;
  for (const auto& [a, b, c] : ball.meshes[0].triangles)
    area += (positions[b] - positions[a]).cross(positions[c] - positions[a]).norm() / 2;
  const auto laplacian = validation::make_laplacian(positions, ball.meshes[0].triangles);
  EXPECT_NEAR(std::accumulate(laplacian.mass.begin(), laplacian.mass.end(), 0.0), area,
              1e-9 * area);
}

TEST(Inpainting, smoothing_keeps_far_vertices) {
  const Character source = test::make_tube(40, 12, 4), target = bulging(test::make_tube(40, 12, 4));
  TransferOptions options;
  options.smoothing_sweeps = 10;
  const TransferResult plain = transfer(source, target),
                       smoothed = transfer(source, target, options);
  EXPECT_GT(largest_difference(plain.character, smoothed.character), 1e-4);
  for (Index v = 0; v < target.meshes[0].vertex_count(); ++v)
    if (target.meshes[0].positions[v].y() < 0.5f) {
      EXPECT_EQ(weight_distance(plain.character, 0, v, smoothed.character, 0, v), 0);
    }
}

// ---- Traps

TEST(Transfer, a_part_without_match_does_not_stop_the_others) {
  const Character source = test::make_tube(8, 12, 4);
  Character target = source;
  Mesh far = source.meshes[0];
  far.name = "far";
  for (Vec3f& position : far.positions) position.x() += 30.0f;
  target.meshes.push_back(far);
  TransferOptions options;
  options.distance = 0.01;
  const TransferResult result = transfer(source, target, options);
  EXPECT_THAT(result.findings, Contains(Field(&Finding::code, "SUNDER_T_PART")));
  EXPECT_GE(result.parts_without_match, 1u);
  EXPECT_EQ(count_of(result, TransferOutcome::coincident), source.meshes[0].vertex_count());
  EXPECT_EQ(count_of(result, TransferOutcome::nearest), source.meshes[0].vertex_count());
  for (Index v = 0; v < source.meshes[0].vertex_count(); ++v)
    EXPECT_LE(weight_distance(result.character, 0, v, source, 0, v), 1e-7);
}

TEST(Transfer, degenerate_faces_and_loose_vertices_do_no_harm) {
  const Character source = test::make_tube(16, 12, 4);
  Character target = bulging(test::make_tube(20, 14, 4));
  const TransferResult plain = transfer(source, target);
  Mesh& mesh = target.meshes[0];
  for (Index v = 0; v + 2 < mesh.vertex_count(); v += 5) {
    mesh.triangles.push_back({v, v, v + 1});
    mesh.triangles.push_back({v, v, v});
    mesh.triangle_submesh.insert(mesh.triangle_submesh.end(), 2, 0);
  }
  const TransferResult result = transfer(source, target);
  EXPECT_LE(largest_difference(plain.character, result.character), 1e-9);
}

TEST(Transfer, a_crack_of_the_source_stays_a_crack) {
  // Two rigid boxes that touch: the vertices coincide, the weights differ.
  const Character source = test::make_two_tubes(4, 6);
  const TransferResult result = transfer(source, forgotten(source));
  EXPECT_LE(largest_difference(result.character, source), 1e-7);
}

TEST(Transfer, nothing_matched_is_a_failure_that_says_how_far) {
  const Character source = test::make_tube(8, 12, 4);
  Character target = source;
  for (Vec3f& position : target.meshes[0].positions) position.x() += 50.0f;
  const auto result = transfer_weights(source, target, {});
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code(), StatusCode::not_found);
  EXPECT_THAT(std::string(result.error().text()), HasSubstr("are farther than"));
}

TEST(Transfer, options_out_of_range_are_refused) {
  const Character sheet = test::make_sheet(2);
  const auto code_of = [&](const auto& change) {
    TransferOptions options;
    change(options);
    const auto result = transfer_weights(sheet, sheet, options);
    return result ? StatusCode::ok : result.error().code();
  };
  EXPECT_EQ(code_of([](TransferOptions& o) { o.distance = -1; }), StatusCode::invalid_argument);
  EXPECT_EQ(code_of([](TransferOptions& o) { o.angle = std::nan(""); }),
            StatusCode::non_finite_value);
  EXPECT_EQ(code_of([](TransferOptions& o) { o.mix = 2; }), StatusCode::invalid_argument);
  EXPECT_EQ(code_of([](TransferOptions& o) { o.bones = {"nobody"}; }), StatusCode::not_found);
  EXPECT_EQ(code_of([](TransferOptions& o) {
              o.bone_names = {{"bone0", "nobody"}};
            }),
            StatusCode::not_found);
  EXPECT_EQ(code_of([](TransferOptions& o) { o.locked = {{true}}; }), StatusCode::size_mismatch);
  EXPECT_EQ(code_of([](TransferOptions& o) { o.keep_sides_apart = true; }),
            StatusCode::invalid_argument);
  EXPECT_EQ(code_of([](TransferOptions&) {}), StatusCode::ok);
}

// ---- Bones and skins

TEST(Transfer, a_target_without_skin_gets_the_skeleton_of_the_source) {
  Random random(6);
  const Character source = test::make_tube(8, 12, 4);
  const Character target = without_skin(source);
  const TransferResult result = transfer(source, target);
  EXPECT_TRUE(result.has_adopted_skeleton);
  EXPECT_THAT(result.findings, Contains(Field(&Finding::code, "SUNDER_T_SKELETON")));
  const Character& skinned = result.character;
  ASSERT_EQ(skinned.skeleton.bones.size(), 1 + source.skeleton.bones.size());
  EXPECT_EQ(skinned.skeleton.bones[0], target.skeleton.bones[0]);
  EXPECT_EQ(skinned.skins[0], target.skins[0]);
  ModelPose pose = test::random_pose(source, random);
  pose.morph_weights.assign(pose.morph_weights.size(), 0.0f);
  ModelPose own = pose;
  own.model_from_bone.insert(own.model_from_bone.begin(), Affine3d::Identity());
  const auto expected = test::posed_positions(source, 0, pose),
             found = test::posed_positions(skinned, 0, own);
  for (std::size_t v = 0; v < expected.size(); ++v)
    EXPECT_LE((expected[v] - found[v]).norm(), 1e-5);
}

TEST(Transfer, bones_may_have_other_numbers_and_names) {
  const Character source = test::make_tube(8, 12, 4);
  Character target = forgotten(source);
  for (Bone& bone : target.skeleton.bones) bone.name = "Rig:Bone_" + bone.name.substr(4);
  const TransferResult fuzzy = transfer(source, target);
  EXPECT_EQ(fuzzy.fuzzy_bones.size(), 4u);
  EXPECT_THAT(fuzzy.findings, Contains(Field(&Finding::code, "SUNDER_T_BONE_FUZZY")));
  TransferOptions options;
  for (int i = 0; i < 4; ++i)
    options.bone_names.push_back({"Rig:Bone_" + std::to_string(i), "bone" + std::to_string(3 - i)});
  const TransferResult given = transfer(source, target, options);
  EXPECT_TRUE(given.fuzzy_bones.empty());
  for (Index v = 0; v < source.meshes[0].vertex_count(); ++v)
    for (int i = 0; i < 4; ++i) {
      const std::string in_target = "Rig:Bone_" + std::to_string(i);
      EXPECT_NEAR(test::weight_of(fuzzy.character, 0, v, in_target),
                  test::weight_of(source, 0, v, "bone" + std::to_string(i)), 1e-7);
      EXPECT_NEAR(test::weight_of(given.character, 0, v, in_target),
                  test::weight_of(source, 0, v, "bone" + std::to_string(3 - i)), 1e-7);
    }
}

TEST(Transfer, a_lost_bone_is_told_and_its_weight_goes_to_its_ancestor) {
  const Character source = test::make_tube(8, 12, 4);
  Character target = forgotten(source);
  target.skeleton.bones[3].name = "somebody else";
  const TransferResult result = transfer(source, target);
  EXPECT_THAT(result.findings, Contains(Field(&Finding::code, "SUNDER_T_BONE_LOST")));
  for (Index v = 0; v < source.meshes[0].vertex_count(); ++v)
    EXPECT_NEAR(test::weight_of(result.character, 0, v, "bone2"),
                test::weight_of(source, 0, v, "bone2") + test::weight_of(source, 0, v, "bone3"),
                1e-6);
}

// ---- What users ask for

TEST(TransferOptions, a_dry_run_changes_nothing) {
  const Character source = test::make_tube(16, 12, 4), target = bulging(test::make_tube(20, 14, 4));
  TransferOptions options;
  options.dry_run = true;
  const TransferResult dry = transfer(source, target, options), wet = transfer(source, target);
  EXPECT_EQ(dry.character, target);
  EXPECT_EQ(dry.outcomes, wet.outcomes);
  EXPECT_TRUE(dry.steps.empty());
}

TEST(TransferOptions, chosen_bones_alone_are_replaced) {
  const Character source = test::make_tube(8, 12, 4), target = forgotten(source);
  TransferOptions options;
  options.bones = {"bone2"};
  const TransferResult result = transfer(source, target, options);
  for (Index v = 0; v < source.meshes[0].vertex_count(); ++v) {
    const double of_bone = test::weight_of(source, 0, v, "bone2");
    EXPECT_NEAR(test::weight_of(result.character, 0, v, "bone2"), of_bone, 1e-6);
    EXPECT_NEAR(test::weight_of(result.character, 0, v, "bone0"), 1 - of_bone, 1e-6);
  }
}

TEST(TransferOptions, mix_takes_a_share_and_the_default_takes_all) {
  const Character source = test::make_tube(8, 12, 4), target = forgotten(source);
  TransferOptions options;
  options.mix = 0.25;
  const TransferResult result = transfer(source, target, options);
  for (Index v = 0; v < source.meshes[0].vertex_count(); ++v)
    EXPECT_NEAR(test::weight_of(result.character, 0, v, "bone3"),
                0.25 * test::weight_of(source, 0, v, "bone3"), 1e-6);
}

TEST(TransferOptions, locked_vertices_keep_their_bits_and_bound_what_is_filled) {
  const Character source = test::make_tube(16, 12, 4);
  Character target = bulging(test::make_tube(20, 14, 4));
  const auto count = target.meshes[0].vertex_count();
  TransferOptions options;
  options.locked = {std::vector<bool>(count, false)};
  for (Index v = 0; v < count; v += 3) options.locked[0][v] = true;
  const TransferResult result = transfer(source, target, options);
  EXPECT_EQ(result.locked, (count + 2) / 3);
  for (Index v = 0; v < count; v += 3)
    EXPECT_TRUE(std::ranges::equal(result.character.meshes[0].weights.of(v),
                                   target.meshes[0].weights.of(v)));
}

TEST(TransferOptions, flipped_normals_match_when_asked) {
  const Character source = test::make_tube(8, 12, 4);
  Character target = test::offset_shell(source, 0.005);
  for (Triangle& triangle : target.meshes[0].triangles) std::swap(triangle[0], triangle[1]);
  EXPECT_FALSE(transfer_weights(source, target, {}));
  TransferOptions options;
  options.flip_normals = true;
  EXPECT_EQ(transfer(source, target, options).matched_share(), 1.0);
}

TEST(TransferOptions, influences_are_limited_and_the_loss_is_told) {
  const Character source = test::make_tube(8, 12, 4);
  TransferOptions options;
  options.maximum_influences = 2;
  const TransferResult result = transfer(source, source, options);
  for (Index v = 0; v < source.meshes[0].vertex_count(); ++v)
    EXPECT_LE(result.character.meshes[0].weights.of(v).size(), 2u);
  const auto limit = std::ranges::find(result.steps, "limit", &TransferStep::name);
  ASSERT_NE(limit, result.steps.end());
  EXPECT_GT(limit->points, 0u);
  EXPECT_GT(limit->largest, 0.01);
}

/// Weight of the wrong foot, over all vertices.
double crossed_weight(const Character& character) {
  double sum = 0;
  for (Index m = 0; m < 2; ++m)
    for (Index v = 0; v < character.meshes[m].vertex_count(); ++v)
      sum += test::weight_of(character, m, v, m == 0 ? "foot.R" : "foot.L");
  return sum;
}

TEST(TransferOptions, left_and_right_stay_apart) {
  // The socks have been pulled so far inwards that each is closer to the other foot.
  const Character source = two_socks(0.04f);
  Character target = forgotten(two_socks(0.004f));
  for (Mesh& mesh : target.meshes)
    for (Vec3f& position : mesh.positions) position.y() += 0.01f;
  for (Vec3f& position : target.meshes[0].positions) position.x() += 0.001f;
  Character crossed = target;
  for (Vec3f& position : crossed.meshes[0].positions) position.x() += 0.0182f;  // beyond the middle
  EXPECT_GT(crossed_weight(transfer(source, crossed).character), 10);
  TransferOptions options;
  options.isolate_parts = true;
  options.keep_sides_apart = true;
  EXPECT_NEAR(crossed_weight(transfer(source, target, options).character), 0, 1e-9);
}

TEST(TransferOptions, parts_are_matched_as_a_whole) {
  // The upper end of the left sock bends over to the right foot; most of it stays at the left one.
  const Character source = two_socks(0.1f);
  Character target = forgotten(two_socks(0.1f));
  for (Vec3f& position : target.meshes[0].positions)
    if (position.y() > 0.7f) position.x() = 0.045f;
  TransferOptions options;
  options.distance = 0.2;
  EXPECT_GT(crossed_weight(transfer(source, target, options).character), 1);
  options.isolate_parts = true;
  EXPECT_NEAR(crossed_weight(transfer(source, target, options).character), 0, 1e-9);
}

// ---- Other tessellations

TEST(Transfer, a_subdivided_target_gets_interpolated_weights) {
  for (const Character& source :
       {test::make_tube(8, 12, 4), test::make_bumpy_ball(500), test::make_two_tubes(4, 6)}) {
    const Character truth = test::subdivided(source);
    const TransferResult result = transfer(source, forgotten(truth));
    EXPECT_EQ(result.matched_share(), 1.0);
    EXPECT_LE(largest_difference(result.character, truth), 1e-4);
  }
}

TEST(Transfer, an_offset_shell_and_a_decimated_target_come_close) {
  const Character source = test::make_bumpy_ball(3000);
  for (const Character& truth : {test::offset_shell(source, 0.01), test::decimated(source, 14)}) {
    const TransferResult result = transfer(source, forgotten(truth));
    double sum = 0;
    for (Index v = 0; v < truth.meshes[0].vertex_count(); ++v)
      sum += weight_distance(result.character, 0, v, truth, 0, v);
    EXPECT_GT(result.matched_share(), 0.95);
    EXPECT_LT(sum / truth.meshes[0].vertex_count(), 0.05);
  }
}

}  // namespace
}  // namespace sunder
