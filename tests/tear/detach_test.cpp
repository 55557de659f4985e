#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>
#include <sunder/skinning/skinned_mesh.h>
#include <sunder/tear/detached_piece.h>
#include <sunder/tear/refit_job.h>
#include <sunder/tear/tear_stroke.h>
#include <sunder/tear/topology.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/models/make_model.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"
#include "support/oracles/model_state.h"
#include "support/oracles/torn_invariants.h"

namespace sunder {
namespace {

using test::difference;
using test::make_model;
using test::make_tube;
using test::Random;
using test::state_of;
using testing::HasSubstr;
using testing::IsEmpty;

using Face = std::pair<std::uint32_t, std::uint32_t>;  // mesh, triangle

ModelPose rest_of(const Character& character) { return *rest_pose(character); }

/// The faces that are drawn.
std::vector<Face> live_faces(const Character& character) {
  std::vector<Face> faces;
  for (std::uint32_t m = 0; m < character.meshes.size(); ++m)
    for (std::uint32_t t = 0; t < character.meshes[m].triangle_count(); ++t)
      if (!is_retired(character.meshes[m].triangles[t])) faces.emplace_back(m, t);
  return faces;
}

/// A cut of a tube across its axis, with caps.
PlaneCut across(double height, bool caps = true) {
  PlaneCut cut;
  cut.point = Vec3d(0, height, 0);
  cut.normal = Vec3d(0, 1, 0);
  cut.caps = caps;
  return cut;
}

/// Height of the middle of a character's posed box.
Vec3d middle_of(const Character& character, const ModelPose& pose) {
  const auto positions = test::posed_positions(character, 0, pose);
  Vec3d least = positions[0], most = positions[0];
  for (const Vec3d& p : positions) {
    least = least.cwiseMin(p);
    most = most.cwiseMax(p);
  }
  return 0.5 * (least + most);
}

std::vector<PieceDescription> describe(const TornModel& model, const TornPieces& pieces) {
  std::vector<PieceDescription> described;
  for (const TornPiece& piece : pieces) described.push_back(*model.describe_piece(piece));
  return described;
}

/// A tube cut in two in its rest pose.
struct CutTube {
  TornModel model;
  ModelPose pose;
  std::vector<PieceDescription> pieces;

  explicit CutTube(const TornCapacity& capacity = {})
      : model(make_model(make_tube(12, 10, 3), capacity)), pose(rest_of(model.source())) {
    const auto report =
        model.cut(pose, across(middle_of(model.source(), pose).y() + 0.013), nullptr);
    EXPECT_TRUE(report) << report.error().text();
    if (report) pieces = describe(model, report->pieces);
    EXPECT_EQ(pieces.size(), 2u);
  }
  [[nodiscard]] PiecePlace on(std::size_t piece) const {
    const PieceDescription::Triangles& of = pieces[piece].meshes[0];
    return PieceOfTriangle{of.mesh, of.triangles[of.triangles.size() / 2]};
  }
};

/// One triangle of each component, by the kernel's points.
std::vector<Face> components(const TornModel& model) {
  std::vector<std::uint32_t> parent(model.point_count());
  for (std::uint32_t p = 0; p < parent.size(); ++p) parent[p] = p;
  const auto find = [&](std::uint32_t p) {
    while (parent[p] != p) p = parent[p] = parent[parent[p]];
    return p;
  };
  const auto points_of = [&](const Face& face) {
    return std::array{model.point_at(face.first, face.second, 0),
                      model.point_at(face.first, face.second, 1),
                      model.point_at(face.first, face.second, 2)};
  };
  const auto is_degenerate = [&](const Face& face) {
    const auto p = points_of(face);
    return p[0] == p[1] || p[1] == p[2] || p[2] == p[0];
  };
  const std::vector<Face> faces = live_faces(model.character());
  for (const Face& face : faces) {
    if (is_degenerate(face)) continue;
    const auto p = points_of(face);
    parent[find(p[1])] = find(p[0]);
    parent[find(p[2])] = find(p[0]);
  }
  std::vector<Face> first;
  std::set<std::uint32_t> seen;
  for (const Face& face : faces)
    if (!is_degenerate(face) && seen.insert(find(points_of(face)[0])).second) first.push_back(face);
  return first;
}

/// Checks that a mesh of a piece has the attributes of the mesh that it came from, bit for bit.
void expect_same_vertices(const Mesh& piece, const Mesh& before, const DetachedPiece::OfMesh& map) {
  ASSERT_EQ(piece.vertex_count(), map.vertex_old_from_new.size());
  ASSERT_TRUE(std::is_sorted(map.vertex_old_from_new.begin(), map.vertex_old_from_new.end()));
  for (std::uint32_t v = 0; v < piece.vertex_count(); ++v) {
    const std::uint32_t old = map.vertex_old_from_new[v];
    EXPECT_EQ(piece.positions[v], before.positions[old]);
    if (!before.normals.empty()) {
      EXPECT_EQ(piece.normals[v], before.normals[old]);
    }
    if (!before.tangents.empty()) {
      EXPECT_EQ(piece.tangents[v], before.tangents[old]);
    }
    for (std::size_t i = 0; i < before.uv_sets.size(); ++i)
      EXPECT_EQ(piece.uv_sets[i][v], before.uv_sets[i][old]);
    for (std::size_t i = 0; i < before.custom_attributes.size(); ++i)
      EXPECT_EQ(piece.custom_attributes[i].values[v], before.custom_attributes[i].values[old]);
    for (std::size_t i = 0; i < before.morph_targets.size(); ++i)
      EXPECT_EQ(piece.morph_targets[i].position_deltas[v],
                before.morph_targets[i].position_deltas[old]);
    const auto weights = piece.weights.of(v), of_old = before.weights.of(old);
    ASSERT_EQ(weights.size(), of_old.size());
    for (std::size_t i = 0; i < weights.size(); ++i) EXPECT_EQ(weights[i].weight, of_old[i].weight);
  }
  for (std::uint32_t t = 0; t < piece.triangle_count(); ++t) {
    const std::uint32_t old = map.triangle_old_from_new[t];
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_EQ(map.vertex_old_from_new[piece.triangles[t][k]], before.triangles[old][k]);
    EXPECT_EQ(piece.submeshes[piece.triangle_submesh[t]],
              before.submeshes[before.triangle_submesh[old]]);
  }
}

/// Positions of a piece in a pose of the model: those of the torn model.
void expect_same_positions(const DetachedPiece& piece, const Character& before,
                           const ModelPose& pose, const ModelPose& pose_of_piece,
                           double tolerance) {
  for (std::uint32_t i = 0; i < piece.meshes.size(); ++i) {
    const auto now = test::posed_positions(*piece.character, i, pose_of_piece),
               then = test::posed_positions(before, piece.meshes[i].mesh, pose);
    for (std::uint32_t v = 0; v < now.size(); ++v)
      ASSERT_LE((now[v] - then[piece.meshes[i].vertex_old_from_new[v]]).norm(), tolerance);
  }
}

class RandomDetachments : public testing::TestWithParam<int> {};

TEST_P(RandomDetachments, divide_the_model_and_are_reversible) {
  Random random(static_cast<std::uint64_t>(GetParam()));
  TornModel model =
      make_model(GetParam() % 3 == 0 ? test::make_two_tubes(6, 8) : test::random_character(random));
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(test::play(model, test::random_operation(model, random)));
  const ModelPose cut_in = test::random_pose(model.source(), random, 0.3);
  PlaneCut cut = across(0, true);
  cut.point = middle_of(model.source(), cut_in);
  cut.normal = random.direction();
  ASSERT_TRUE(model.cut(cut_in, cut));

  std::vector<test::ModelState> states = {state_of(model)};
  const Character before = model.character();
  std::vector<Face> united;
  for (std::vector<Face> left = components(model); left.size() > 1; left = components(model)) {
    const Face chosen = left[random.index(static_cast<std::uint32_t>(left.size()))];
    const ModelPose pose = test::random_pose(model.source(), random);
    DetachOptions options;
    options.motion = random.index(2) == 0 ? PieceMotion::frozen : PieceMotion::animated;
    options.axes = random.index(2) == 0 ? PieceAxes::principal : PieceAxes::model;
    ChangeRecord change;
    const auto piece =
        detach(model, pose, PieceOfTriangle{chosen.first, chosen.second}, options, &change);
    ASSERT_TRUE(piece) << piece.error().text();
    ASSERT_TRUE(validate_character(*piece->character));
    std::size_t retired = 0, rewritten = 0;
    for (const MeshChange& of : change.meshes) retired += of.retired.size();
    for (std::uint32_t i = 0; i < piece->meshes.size(); ++i) {
      const auto& map = piece->meshes[i];
      for (const std::uint32_t t : map.triangle_old_from_new) united.emplace_back(map.mesh, t);
      rewritten += map.triangle_old_from_new.size();
      if (options.motion == PieceMotion::animated)
        expect_same_vertices(piece->character->meshes[i], before.meshes[map.mesh], map);
    }
    EXPECT_EQ(retired, rewritten);
    EXPECT_EQ(piece->report.triangles_retired, retired);
    EXPECT_EQ(piece->report.pieces[0].triangle_count, retired);
    const double size = test::posed_diagonal(before, pose);
    if (options.motion == PieceMotion::animated) {
      expect_same_positions(*piece, before, pose, pose, 0);
      const ModelPose other = test::random_pose(model.source(), random);
      expect_same_positions(*piece, before, other, other, 0);
    } else {
      expect_same_positions(*piece, before, pose, rest_of(*piece->character), 2e-6 * size);
    }
    EXPECT_THAT(test::broken_laws(model), IsEmpty());
    states.push_back(state_of(model));
  }
  // Each face is left, or in one piece.
  const std::vector<Face> left = live_faces(model.character());
  united.insert(united.end(), left.begin(), left.end());
  std::sort(united.begin(), united.end());
  EXPECT_EQ(united, live_faces(before));

  const auto history = model.history();
  ASSERT_TRUE(history);
  TornModel replayed = make_model(model.source());
  for (const Operation& operation : *history) ASSERT_TRUE(apply_operation(replayed, operation));
  EXPECT_EQ(difference(state_of(replayed), state_of(model)), "");

  for (std::size_t at = states.size() - 1; at > 0; --at) {
    ASSERT_TRUE(model.undo());
    EXPECT_EQ(difference(state_of(model), states[at - 1]), "") << at;
  }
  for (std::size_t at = 1; at < states.size(); ++at) {
    ASSERT_TRUE(model.redo());
    EXPECT_EQ(difference(state_of(model), states[at]), "") << at;
  }
  while (model.undo_count() > 0) ASSERT_TRUE(model.undo());
  EXPECT_EQ(model.character(), model.source());
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomDetachments, testing::Range(1, 41));

TEST(Detach, mass_of_both_halves_is_that_of_the_whole) {
  CutTube tube;
  const auto of_whole = [&] {
    const auto positions = test::posed_positions(tube.model.source(), 0, tube.pose);
    return *compute_mass(positions, tube.model.source().meshes[0].triangles);
  }();
  const auto upper = detach(tube.model, tube.pose, tube.on(0));
  ASSERT_TRUE(upper);
  const auto positions = test::posed_positions(tube.model.character(), 0, tube.pose);
  const auto lower = compute_mass(positions, tube.model.character().meshes[0].triangles);
  ASSERT_TRUE(lower);
  EXPECT_EQ(upper->mass.rule, SolidRule::closed);
  EXPECT_EQ(lower->rule, SolidRule::closed);
  EXPECT_NEAR(upper->mass.mass + lower->mass, of_whole.mass, 1e-5 * of_whole.mass);
  const Vec3d centre =
      (upper->mass.mass * upper->mass.centre + lower->mass * lower->centre) / of_whole.mass;
  EXPECT_LT((centre - of_whole.centre).norm(), 1e-5);
  EXPECT_EQ(upper->model_from_piece.translation(), upper->mass.centre);
  EXPECT_EQ(upper->inertia_piece(0, 1), 0);
  EXPECT_LE(upper->inertia_piece(0, 0), upper->inertia_piece(2, 2));
  // In its own frame the piece's centre is the origin.
  std::vector<Vec3d> own;
  for (const Vec3f& p : upper->character->meshes[0].positions) own.push_back(p.cast<double>());
  const auto again = compute_mass(own, upper->character->meshes[0].triangles);
  ASSERT_TRUE(again);
  EXPECT_LT(again->centre.norm(), 1e-6);
  EXPECT_LT((again->inertia - upper->inertia_piece).norm(), 1e-5 * upper->inertia_piece.norm());
}

TEST(Detach, later_operations_pass_the_piece) {
  CutTube tube;
  ASSERT_TRUE(detach(tube.model, tube.pose, tube.on(0)));
  const Vec3d centre = tube.pieces[0].centroid_posed;
  const auto report = tube.model.cut(tube.pose, across(centre.y(), false));
  ASSERT_TRUE(report);
  EXPECT_EQ(report->runs, 0u);
  const Stroke through = {{centre + Vec3d(9, 0, 0), centre - Vec3d(9, 0, 0)},
                          {centre + Vec3d(9, 0, 0.05), centre - Vec3d(9, 0, -0.05)}};
  const auto torn = tube.model.tear(tube.pose, through);
  ASSERT_TRUE(torn);
  EXPECT_EQ(torn->runs, 0u);
  EXPECT_EQ(tube.model.undo_count(), 2u);
}

TEST(Detach, names_pieces_by_places) {
  for (const std::size_t piece : {std::size_t{0}, std::size_t{1}}) {
    CutTube by_triangle, by_place, by_bone;
    ASSERT_TRUE(detach(by_triangle.model, by_triangle.pose, by_triangle.on(piece)));
    const Vec3d near = by_place.pieces[piece].centroid_posed;
    ASSERT_TRUE(detach(by_place.model, by_place.pose, PieceNear{near}));
    EXPECT_EQ(by_place.model.digest(), by_triangle.model.digest());
    const auto& bones = by_bone.model.source().skeleton.bones;
    const bool is_upper = near.y() > by_bone.pieces[1 - piece].centroid_posed.y();
    const std::string bone = is_upper ? bones.back().name : bones.front().name;
    // Far away, on the wrong side.
    const PieceNear far{Vec3d(0, is_upper ? -50 : 50, 0), bone};
    ASSERT_TRUE(detach(by_bone.model, by_bone.pose, far));
    EXPECT_EQ(by_bone.model.digest(), by_triangle.model.digest());
  }
}

TEST(Detach, faults_are_named_and_change_nothing) {
  CutTube tube;
  const auto before = state_of(tube.model);
  const auto fault = [&](const PiecePlace& place, const DetachOptions& options = {}) {
    const auto piece = detach(tube.model, tube.pose, place, options);
    EXPECT_FALSE(piece);
    EXPECT_EQ(difference(state_of(tube.model), before), "");
    return piece.error();
  };
  EXPECT_EQ(fault(PieceOfTriangle{7, 0}).code(), StatusCode::index_out_of_range);
  EXPECT_EQ(fault(PieceOfTriangle{0, 1u << 30}).code(), StatusCode::index_out_of_range);
  EXPECT_EQ(fault(PieceNear{Vec3d(0, NAN, 0)}).code(), StatusCode::non_finite_value);
  EXPECT_EQ(fault(PieceNear{Vec3d(0, 1e61, 0)}).code(), StatusCode::invalid_argument);
  EXPECT_THAT(std::string(fault(PieceNear{Vec3d(0, 0, 0), "tail"}).text()), HasSubstr("'tail'"));
  DetachOptions options;
  options.mass.density = -1;
  EXPECT_EQ(fault(tube.on(0), options).code(), StatusCode::invalid_argument);
  options = {};
  options.motion = static_cast<PieceMotion>(9);
  EXPECT_EQ(fault(tube.on(0), options).code(), StatusCode::invalid_argument);
  options = {};
  options.axes = static_cast<PieceAxes>(9);
  EXPECT_EQ(fault(tube.on(0), options).code(), StatusCode::invalid_argument);
  const auto short_pose = detach(tube.model, {}, tube.on(0));
  EXPECT_EQ(short_pose.error().code(), StatusCode::size_mismatch);

  // A piece that is gone, and the last one.
  ASSERT_TRUE(detach(tube.model, tube.pose, tube.on(0)));
  const auto gone = detach(tube.model, tube.pose, tube.on(0));
  EXPECT_EQ(gone.error().code(), StatusCode::not_found);
  EXPECT_THAT(std::string(gone.error().text()), HasSubstr("removed"));
  const auto last = detach(tube.model, tube.pose, tube.on(1));
  EXPECT_EQ(last.error().code(), StatusCode::invalid_argument);
  EXPECT_THAT(std::string(last.error().text()), HasSubstr("all that is left"));
}

TEST(Detach, is_refused_while_a_stroke_is_in_progress) {
  CutTube tube;
  auto stroke = TearStroke::create(tube.model, tube.pose, {Vec3d(9, 9, 9), Vec3d(9, 8, 9)});
  ASSERT_TRUE(stroke);
  EXPECT_EQ(detach(tube.model, tube.pose, tube.on(0)).error().code(), StatusCode::invalid_argument);
  ASSERT_TRUE(stroke->cancel());
  EXPECT_TRUE(detach(tube.model, tube.pose, tube.on(0)));
}

TEST(Detach, has_limits_of_capacity) {
  CutTube small({2000, 600, 3});
  ASSERT_TRUE(detach(small.model, small.pose, small.on(0)));
  ASSERT_TRUE(small.model.undo());
  ASSERT_TRUE(small.model.redo());
  ASSERT_TRUE(small.model.undo());

  // A detachment appends nothing but an operation.
  TornModel tight = make_model(test::make_two_tubes(12, 10), {100, 10, 1});
  const ModelPose pose = rest_of(tight.source());
  ASSERT_TRUE(detach(tight, pose, PieceOfTriangle{0, 0}));
  const auto before = state_of(tight);
  EXPECT_FALSE(detach(tight, pose, PieceOfTriangle{1, 0}));
  EXPECT_EQ(difference(state_of(tight), before), "");
}

TEST(Detach, records_tell_which_vertices_are_released) {
  CutTube tube;
  const auto vertex_bits = [&](const Character& character) {
    std::vector<bool> used(character.meshes[0].vertex_count(), false);
    for (const Triangle& triangle : character.meshes[0].triangles)
      if (!is_retired(triangle))
        for (const std::uint32_t v : triangle) used[v] = true;
    return used;
  };
  const std::vector<bool> before = vertex_bits(tube.model.character());
  ChangeRecord change;
  const auto piece = detach(tube.model, tube.pose, tube.on(0), {}, &change);
  ASSERT_TRUE(piece);
  const std::vector<bool> after = vertex_bits(tube.model.character());
  std::vector<std::uint32_t> expected;
  for (std::uint32_t v = 0; v < before.size(); ++v)
    if (before[v] && !after[v]) expected.push_back(v);
  ASSERT_EQ(change.meshes.size(), 1u);
  EXPECT_EQ(change.meshes[0].released, expected);
  EXPECT_EQ(change.meshes[0].released, piece->meshes[0].vertex_old_from_new);
  EXPECT_EQ(change.meshes[0].vertex_count, 0u);
  EXPECT_THAT(change.meshes[0].returned, IsEmpty());
  ASSERT_TRUE(tube.model.undo(&change));
  EXPECT_THAT(change.meshes[0].released, IsEmpty());
  EXPECT_EQ(change.meshes[0].returned, expected);
  ASSERT_TRUE(tube.model.redo(&change));
  EXPECT_EQ(change.meshes[0].released, expected);
  EXPECT_THAT(change.meshes[0].returned, IsEmpty());
  ASSERT_TRUE(tube.model.undo());
  ASSERT_TRUE(tube.model.cut(tube.pose, across(0.1), &change));  // the record is written anew
  EXPECT_THAT(change.meshes[0].released, IsEmpty());
}

VertexTarget into(std::vector<Vec3f>& positions) {
  VertexTarget target;
  target.vertex_count = static_cast<std::uint32_t>(positions.size());
  target.positions.data = positions[0].data();
  return target;
}

/// A buffer that remembers what is not posed, and counts what is.
class CountingBuffer {
 public:
  CountingBuffer(const SkinnedMesh& skinned, std::uint32_t most)
      : skinned_(skinned), positions_(most), buffer_(into(positions_)) {}

  /// Counts the vertices that deform() writes when every bone moves.
  std::uint32_t count_written(const Character& character, Random& random) {
    positions_.assign(positions_.size(), Vec3f(7e7f, 0, 0));
    VertexTarget target = into(positions_);
    target.vertex_count = skinned_.vertex_count();
    buffer_.set_target(target);
    auto palette =
        BonePalette::create(character.skins[0].bones.size(), character.rest_morph_weights.size());
    EXPECT_TRUE(palette->set(character.skins[0], test::random_pose(character, random)));
    EXPECT_TRUE(skinned_.deform(*palette, buffer_));
    return static_cast<std::uint32_t>(std::count_if(positions_.begin(), positions_.end(),
                                                    [](const Vec3f& p) { return p.x() != 7e7f; }));
  }
  PosedBuffer& buffer() { return buffer_; }

 private:
  const SkinnedMesh& skinned_;
  std::vector<Vec3f> positions_;
  PosedBuffer buffer_;
};

TEST(Detach, fewer_vertices_are_skinned) {
  Random random(2);
  TornModel model = make_model(make_tube(80, 30, 3));
  const ModelPose pose = rest_of(model.source());
  const auto cut = model.cut(pose, across(middle_of(model.source(), pose).y() + 0.003));
  ASSERT_TRUE(cut);
  const Character& character = model.character();
  auto skinned =
      SkinnedMesh::create(source_of(character.meshes[0]), character.skins[0].bones.size());
  ASSERT_TRUE(skinned);
  const std::uint32_t all = character.meshes[0].vertex_count();
  CountingBuffer counting(*skinned, 2 * all);
  EXPECT_EQ(counting.count_written(character, random), all);

  ChangeRecord change;
  const std::vector<PieceDescription> pieces = describe(model, cut->pieces);
  const PieceDescription::Triangles& of = pieces[0].meshes[0];
  ASSERT_TRUE(detach(model, pose, PieceOfTriangle{of.mesh, of.triangles[0]}, {}, &change));
  const std::vector<std::uint32_t> released = change.meshes[0].released;
  ASSERT_TRUE(skinned->release(released, counting.buffer()));
  const std::uint32_t less = counting.count_written(character, random);
  EXPECT_LT(less, all - released.size() * 3 / 4);
  EXPECT_GE(less, all - released.size());

  // A tear of the rest: the blocks at the end are made anew.
  const auto again = model.cut(pose, across(pieces[1].centroid_posed.y()));
  ASSERT_TRUE(again);
  ASSERT_GT(again->runs, 0u);
  const std::uint32_t grown = character.meshes[0].vertex_count();
  ASSERT_TRUE(skinned->update(source_of(character.meshes[0]), all));
  const std::uint32_t written = counting.count_written(character, random);
  EXPECT_LT(written, grown - released.size() * 3 / 4);
  EXPECT_GE(written, grown - released.size());
  ASSERT_TRUE(model.undo());
  ASSERT_TRUE(skinned->update(source_of(character.meshes[0]), all));
  EXPECT_EQ(counting.count_written(character, random), less);

  // Taken back, a buffer that missed poses has the bits of one that did not.
  std::vector<Vec3f> positions(all, Vec3f::Zero()), fresh(all, Vec3f::Zero());
  PosedBuffer buffer(into(positions)), of_fresh(into(fresh));
  ASSERT_TRUE(skinned->release(released, buffer));
  auto palette =
      BonePalette::create(character.skins[0].bones.size(), character.rest_morph_weights.size());
  const ModelPose last = test::random_pose(character, random);
  ASSERT_TRUE(palette->set(character.skins[0], pose));
  ASSERT_TRUE(skinned->deform(*palette, buffer));
  ASSERT_TRUE(palette->set(character.skins[0], last));
  ASSERT_TRUE(skinned->deform(*palette, buffer));
  ASSERT_TRUE(model.undo(&change));
  ASSERT_TRUE(skinned->take_back(change.meshes[0].returned, buffer));
  ASSERT_TRUE(skinned->take_back(change.meshes[0].returned, counting.buffer()));
  ASSERT_TRUE(skinned->deform(*palette, buffer));
  EXPECT_EQ(counting.count_written(character, random), all);
  ASSERT_TRUE(skinned->deform(*palette, of_fresh));
  EXPECT_EQ(positions, fresh);
  EXPECT_TRUE(skinned->deform(*palette, buffer));
  EXPECT_THAT(buffer.dirty_vertices(), IsEmpty());
  const std::vector<std::uint32_t> beyond = {all};
  EXPECT_EQ(skinned->release(beyond, buffer).code(), StatusCode::index_out_of_range);
}

TEST(Detach, pieces_are_characters_like_any_other) {
  CutTube tube;
  DetachOptions options;
  for (const PieceMotion motion : {PieceMotion::frozen, PieceMotion::animated}) {
    options.motion = motion;
    const auto piece = detach(tube.model, tube.pose, tube.on(0), options);
    ASSERT_TRUE(piece) << piece.error().text();
    auto model = TornModel::create(piece->character);
    ASSERT_TRUE(model);
    // Its points are those of the torn model.
    const auto& map = piece->meshes[0];
    std::map<std::uint32_t, std::uint32_t> old_of_point, point_of_old;
    for (std::uint32_t t = 0; t < map.triangle_old_from_new.size(); ++t)
      for (std::uint32_t k = 0; k < 3; ++k) {
        const std::uint32_t point = model->point_at(0, t, k), old = map.old_points[t][k];
        EXPECT_EQ(old_of_point.try_emplace(point, old).first->second, old);
        EXPECT_EQ(point_of_old.try_emplace(old, point).first->second, point);
      }
    // It is cut, and detached again.
    const ModelPose pose = rest_of(*piece->character);
    PlaneCut cut = across(0);
    cut.point = middle_of(*piece->character, pose);
    cut.normal = Vec3d(0.1, 1, 0.2);
    const auto report = model->cut(pose, cut);
    ASSERT_TRUE(report);
    ASSERT_EQ(report->pieces.size(), 2u);
    const PieceOfTriangle of = {report->pieces[1].mesh, report->pieces[1].triangle};
    const auto smaller = detach(*model, pose, of, options);
    ASSERT_TRUE(smaller) << smaller.error().text();
    EXPECT_TRUE(TornModel::create(smaller->character));
    const auto topology = count_topology(*smaller->character);
    ASSERT_TRUE(topology);
    EXPECT_EQ(topology->boundary_loops, 0u);
    EXPECT_EQ(topology->components, 1u);
    ASSERT_TRUE(tube.model.undo());
  }
}

TEST(Detach, an_animated_piece_plays_the_clips) {
  CutTube tube;
  DetachOptions options;
  options.motion = PieceMotion::animated;
  const Character before = tube.model.character();
  const auto piece = detach(tube.model, tube.pose, tube.on(0), options);
  ASSERT_TRUE(piece);
  ASSERT_FALSE(piece->character->clips.empty());
  EXPECT_LE(piece->character->skins[0].bones.size(), before.skins[0].bones.size());
  for (const double time : {0.0, 0.3, 1.1, 2.0}) {
    const auto pose = make_pose(*piece->character, ClipPose{0u, time});
    ASSERT_TRUE(pose);
    expect_same_positions(*piece, before, *pose, *pose, 0);
  }
}

TEST(Detach, exact_vertices_are_frozen_where_they_are) {
  TornModel model = make_model(make_tube(12, 10, 3));
  Random random(4);
  const ModelPose pose = rest_of(model.source()),
                  bent = test::random_pose(model.source(), random, 1.0);
  PlaneCut cut = across(middle_of(model.source(), pose).y() + 0.013);
  cut.weights = WeightOptions{WeightPolicy::exact};
  const auto report = model.cut(pose, cut);
  ASSERT_TRUE(report);
  const Character before = model.character();
  VertexSource source = source_of(before.meshes[0]);
  const InfluencePositions exact = model.influence_positions(0);
  ASSERT_FALSE(exact.vertices.empty());
  source.per_influence = &exact;
  auto skinned = SkinnedMesh::create(source, before.skins[0].bones.size());
  ASSERT_TRUE(skinned);
  std::vector<Vec3f> posed(before.meshes[0].vertex_count());
  PosedBuffer buffer(into(posed));
  auto palette =
      BonePalette::create(before.skins[0].bones.size(), before.rest_morph_weights.size());
  ASSERT_TRUE(palette->set(before.skins[0], bent));
  ASSERT_TRUE(skinned->deform(*palette, buffer));

  const PieceOfTriangle of = {report->pieces[0].mesh, report->pieces[0].triangle};
  const auto piece = detach(model, bent, of);
  ASSERT_TRUE(piece);
  const auto now = test::posed_positions(*piece->character, 0, rest_of(*piece->character));
  for (std::uint32_t v = 0; v < now.size(); ++v)
    EXPECT_LT((now[v] - posed[piece->meshes[0].vertex_old_from_new[v]].cast<double>()).norm(),
              3e-6);
}

TEST(Detach, points_of_a_piece_that_is_gone_may_be_reweighed) {
  CutTube tube;
  Random random(8);
  WeightsOperation refit;
  refit.weights.policy = WeightPolicy::refit;
  refit.refit.poses.range_of_motion = true;
  auto job = RefitJob::create(tube.model, refit);
  ASSERT_TRUE(job) << job.error().text();
  ASSERT_TRUE(detach(tube.model, tube.pose, tube.on(0)));
  job->run();
  EXPECT_TRUE(job->swap_in(tube.model));
  WeightsOperation exact;
  exact.weights.policy = WeightPolicy::exact;
  EXPECT_TRUE(tube.model.reweigh(exact));
  EXPECT_TRUE(tube.model.reweigh(refit));
  EXPECT_THAT(test::broken_laws(tube.model), IsEmpty());
  while (tube.model.undo_count() > 0) ASSERT_TRUE(tube.model.undo());
  EXPECT_EQ(tube.model.character(), tube.model.source());
}

TEST(Detach, a_compacted_model_has_no_trace_of_the_piece) {
  CutTube tube;
  const auto piece = detach(tube.model, tube.pose, tube.on(0));
  ASSERT_TRUE(piece);
  const std::uint32_t vertices = tube.model.character().meshes[0].vertex_count();
  ASSERT_TRUE(tube.model.compact());
  EXPECT_EQ(
      tube.model.character().meshes[0].vertex_count() + piece->meshes[0].vertex_old_from_new.size(),
      vertices);
}

TEST(Detach, nothing_is_made_of_a_piece_that_vanishes) {
  CutTube tube;
  DetachOptions options;
  options.motion = PieceMotion::none;
  const auto piece = detach(tube.model, tube.pose, tube.on(0), options);
  ASSERT_TRUE(piece);
  EXPECT_EQ(piece->character, nullptr);
  EXPECT_GT(piece->report.triangles_retired, 0u);
  EXPECT_EQ(convex_hulls(*piece).error().code(), StatusCode::invalid_argument);
}

TEST(Detach, hulls_of_a_piece_are_in_its_frame) {
  if (!has_convex_hulls()) GTEST_SKIP() << "built without Qhull";
  CutTube tube;
  const auto piece = detach(tube.model, tube.pose, tube.on(0));
  ASSERT_TRUE(piece);
  const auto one = convex_hulls(*piece, {1, 255});
  ASSERT_TRUE(one) << one.error().text();
  ASSERT_EQ(one->size(), 1u);
  EXPECT_NEAR((*one)[0].volume / piece->mass.volume, 1, 0.2);  // a tube is nearly convex
  const auto parts = convex_hulls(*piece, {8, 64});
  ASSERT_TRUE(parts);
  EXPECT_GT(parts->size(), 1u);
  EXPECT_EQ(convex_hulls(DetachedPiece{}).error().code(), StatusCode::invalid_argument);
}

}  // namespace
}  // namespace sunder
