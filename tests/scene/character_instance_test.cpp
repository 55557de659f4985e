// An instance gives the same results, bit for bit, as the same calls on its parts.

#include <sunder/scene/character_instance.h>
#include <sunder/skinning/pose.h>
#include <sunder/skinning/skinned_mesh.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

#include <gtest/gtest.h>

#include "scene/frames.h"
#include "support/machine/allocation_count.h"
#include "support/machine/stress.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"

namespace sunder {
namespace {

constexpr double kScreenFrame = 1.0 / 60;

template <class Vector>
bool same_bits(std::span<const Vector> a, std::span<const Vector> b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size_bytes()) == 0);
}

SoftTissue coarse_tissue() {
  SoftTissue soft;
  soft.decomposition.range = 0.2;
  return soft;
}

Status draw_frame(CharacterInstance& instance, const ModelPose& pose, double seconds) {
  const Status status = instance.advance(pose, seconds);
  return status ? instance.draw() : status;
}

CharacterInstance make_instance(const std::shared_ptr<const Character>& character, bool is_soft,
                                const TornCapacity& capacity = {}) {
  CharacterAssetOptions options;
  if (is_soft) options.soft = coarse_tissue();
  CharacterInstance instance = value_of(CharacterInstance::create(character, options, capacity));
  EXPECT_TRUE(instance.prepare_to_tear());
  return instance;
}

/// The parts of an instance, called one by one.
class Parts {
 public:
  Parts(const std::shared_ptr<const Character>& character, bool is_soft)
      : model(value_of(TornModel::create(character))) {
    if (is_soft) {
      const SoftTissue soft = coarse_tissue();
      set = std::make_unique<ParticleSet>(
          value_of(ParticleSet::create(model, *rest_pose(*character), soft.decomposition)));
      body = std::make_unique<SoftBody>(
          value_of(SoftBody::create(*set, *rest_pose(*character), soft.materials)));
    }
    for (const Mesh& mesh : character->meshes) {
      const std::size_t slots = character->skins[mesh.skin].bones.size();
      meshes_.push_back(
          std::make_unique<OfMesh>(mesh, slots, character->rest_morph_weights.size()));
    }
  }

  void follow(std::span<const ChangeRecord> changes) {
    if (set) {
      ASSERT_TRUE(set->follow(model, changes));
    }
    for (const ChangeRecord& change : changes)
      for (const MeshChange& of_mesh : change.meshes) {
        Index first = of_mesh.first_vertex;
        if (of_mesh.rewritten.empty() && !of_mesh.dirty_vertices.empty())
          first = std::min(first, of_mesh.dirty_vertices.begin()->first);
        meshes_[of_mesh.mesh]->first_changed =
            std::min(meshes_[of_mesh.mesh]->first_changed, first);
      }
    for (Index m = 0; m < meshes_.size(); ++m) meshes_[m]->update(model, m);
  }

  void frame(const ModelPose& pose, double seconds) {
    if (body) {
      ASSERT_TRUE(body->step(model, pose, seconds));
    }
    for (Index m = 0; m < meshes_.size(); ++m) {
      OfMesh& of = *meshes_[m];
      ASSERT_TRUE(of.palette.set(model.character().skins[model.character().meshes[m].skin], pose));
      if (body) {
        const auto moved = body->moved_vertices(model, m);
        const VertexDisplacements displaced{set->vertex_points(m), set->influences(),
                                            body->displacements(), moved,
                                            set->gradients(model), body->rotations()};
        ASSERT_TRUE(of.skinned.deform(of.palette, of.buffer, {}, &displaced));
      } else {
        ASSERT_TRUE(of.skinned.deform(of.palette, of.buffer));
      }
    }
  }

  void expect_same(CharacterInstance& instance) const {
    ASSERT_EQ(instance.model()->digest(), model.digest());
    for (Index m = 0; m < meshes_.size(); ++m) {
      const PosedMesh posed = instance.mesh(m);
      ASSERT_TRUE(same_bits<Vec3f>(posed.positions, meshes_[m]->positions)) << "mesh " << m;
      ASSERT_TRUE(same_bits<Vec3f>(posed.normals, meshes_[m]->normals)) << "mesh " << m;
      ASSERT_TRUE(same_bits<Vec4f>(posed.tangents, meshes_[m]->tangents)) << "mesh " << m;
    }
  }

  TornModel model;
  std::unique_ptr<ParticleSet> set;
  std::unique_ptr<SoftBody> body;

 private:
  struct OfMesh {
    OfMesh(const Mesh& mesh, std::size_t slots, std::size_t morph_weights)
        : skinned(value_of(SkinnedMesh::create(source_of(mesh), slots))),
          palette(*BonePalette::create(slots, morph_weights)),
          buffer(VertexTarget()) {
      resize(mesh);
    }
    void resize(const Mesh& mesh) {
      positions.resize(mesh.positions.size());
      normals.resize(mesh.normals.size());
      tangents.resize(mesh.tangents.size());
      buffer.set_target({mesh.vertex_count(),
                         {positions.empty() ? nullptr : positions[0].data()},
                         {normals.empty() ? nullptr : normals[0].data()},
                         {tangents.empty() ? nullptr : tangents[0].data()}});
    }
    void update(const TornModel& model, Index m) {
      if (first_changed == kNone) return;
      VertexSource source = source_of(model.character().meshes[m]);
      source.per_influence = &model.influence_positions(m);
      ASSERT_TRUE(skinned.update(
          source, std::min({first_changed, skinned.vertex_count(), source.vertex_count})));
      resize(model.character().meshes[m]);
      first_changed = kNone;
    }

    SkinnedMesh skinned;
    BonePalette palette;
    std::vector<Vec3f> positions, normals;
    std::vector<Vec4f> tangents;
    PosedBuffer buffer;
    Index first_changed = kNone;
  };
  std::vector<std::unique_ptr<OfMesh>> meshes_;
};

/// The triangles of a mesh that are drawn, with their submeshes, in no order.
std::vector<std::array<Index, 4>> drawn_triangles(const Mesh& mesh) {
  std::vector<std::array<Index, 4>> drawn;
  for (Index t = 0; t < mesh.triangle_count(); ++t)
    if (const Triangle& of = mesh.triangles[t]; !is_retired(of))
      drawn.push_back({mesh.triangle_submesh[t], of[0], of[1], of[2]});
  std::sort(drawn.begin(), drawn.end());
  return drawn;
}

/// Buffers of an engine that starts from those of the asset and uploads only what changed.
class Mirror {
 public:
  explicit Mirror(const Mesh& source) {
    if (!source.uv_sets.empty()) uvs_ = source.uv_sets[0];
  }

  void upload(CharacterInstance& instance, Index index) {
    const PosedMesh mesh = instance.mesh(index, seen_);
    const Mesh& attributes = instance.character().meshes[index];
    copy(mesh.positions, mesh.dirty_vertices, positions_);
    copy(mesh.normals, mesh.dirty_vertices, normals_);
    if (!attributes.uv_sets.empty())
      copy(std::span<const Vec2f>(attributes.uv_sets[0]), mesh.dirty_attributes, uvs_);
    if (!mesh.initial_triangles.empty())
      triangles_.assign(mesh.initial_triangles.begin(), mesh.initial_triangles.end());
    triangles_.resize(mesh.triangle_capacity);
    for (const TriangleWrite& write : mesh.triangle_writes) {
      ASSERT_LT(write.place, mesh.triangle_capacity);
      triangles_[write.place] = write.triangle;
    }
    seen_ = mesh.epoch;
  }
  void expect_same(CharacterInstance& instance, Index index) const {
    const PosedMesh mesh = instance.mesh(index, seen_);
    const Mesh& attributes = instance.character().meshes[index];
    EXPECT_TRUE(mesh.dirty_vertices.empty());
    EXPECT_TRUE(mesh.dirty_attributes.empty());
    EXPECT_TRUE(mesh.triangle_writes.empty());
    EXPECT_TRUE(same_bits<Vec3f>(mesh.positions, positions_));
    EXPECT_TRUE(same_bits<Vec3f>(mesh.normals, normals_));
    if (!attributes.uv_sets.empty()) {
      EXPECT_TRUE(same_bits<Vec2f>(attributes.uv_sets[0], uvs_));
    }
    std::vector<std::array<Index, 4>> drawn;
    std::vector<int> ranges_of(attributes.submeshes.size());
    for (const DrawRange& range : mesh.ranges) {
      ASSERT_LE(++ranges_of.at(range.submesh), 2);
      for (Index t = range.first_triangle; t < range.first_triangle + range.triangle_count; ++t)
        if (const Triangle& of = triangles_.at(t); !is_retired(of))
          drawn.push_back({range.submesh, of[0], of[1], of[2]});
    }
    std::sort(drawn.begin(), drawn.end());
    EXPECT_EQ(drawn, drawn_triangles(attributes));
  }

 private:
  template <class T>
  static void copy(std::span<const T> from, std::span<const IndexRange> ranges,
                   std::vector<T>& to) {
    to.resize(from.size());
    if (from.empty()) return;
    Index end = 0;
    for (const IndexRange& range : ranges) {
      ASSERT_GE(range.first, end);
      ASSERT_GT(range.count, 0u);
      end = range.first + range.count;
      ASSERT_LE(end, from.size());
      std::copy_n(from.begin() + range.first, range.count, to.begin() + range.first);
    }
  }

  std::uint64_t seen_ = 0;
  std::vector<Vec3f> positions_, normals_;
  std::vector<Triangle> triangles_;
  std::vector<Vec2f> uvs_;
};

/// Random calls, the same on an instance and on the parts.
class Duel {
 public:
  Duel(const std::shared_ptr<const Character>& character, bool is_soft, std::uint64_t seed)
      : random_(seed), instance_(make_instance(character, is_soft)), parts_(character, is_soft) {
    for (int i = 0; i < 2; ++i)
      for (Index m = 0; m < character->meshes.size(); ++m)
        mirrors_[i].emplace_back(character->meshes[m]);
  }

  void run(int steps) {
    for (int i = 0; i < steps && !testing::Test::HasFatalFailure(); ++i) {
      SCOPED_TRACE("step " + std::to_string(i));
      for (std::uint32_t n = random_.index(3); n > 0; --n) operate();
      push();
      frame();
    }
  }

 private:
  void operate() {
    switch (random_.index(8)) {
      case 0: return apply(UndoOperation{1 + random_.index(2)});
      case 1: return apply(RedoOperation{1});
      case 2: return stroke();
      case 3: return reweigh();
      default: return apply(test::random_operation(parts_.model, random_));
    }
  }

  void apply(const Operation& operation) {
    std::vector<ChangeRecord> changes, of_instance;
    const auto expected = apply_operation(parts_.model, operation, &changes);
    const auto found = instance_.apply(operation, random_.index(2) == 0 ? &of_instance : nullptr);
    ASSERT_EQ(found.has_value(), expected.has_value());
    if (expected) {
      ASSERT_EQ(found->faces_crossed, expected->faces_crossed);
      parts_.follow(changes);
    }
  }

  void reweigh() {
    WeightsOperation wanted;
    wanted.weights.policy = random_.index(2) == 0 ? WeightPolicy::exact : WeightPolicy::pose_exact;
    wanted.pose = test::random_pose(parts_.model.source(), random_);
    apply(wanted);
  }

  /// Over frames, in a pose that changes.
  void stroke() {
    const Character& source = parts_.model.source();
    ModelPose pose = test::random_pose(source, random_);
    const Stroke blades = test::random_stroke(source, pose, random_, 0.3, 4);
    auto expected = TearStroke::create(parts_.model, pose, blades[0]);
    ASSERT_TRUE(expected);
    ASSERT_TRUE(instance_.begin_stroke(pose, blades[0]));
    ASSERT_FALSE(instance_.undo());
    ChangeRecord change;
    for (std::size_t i = 1; i < blades.size(); ++i) {
      if (i == 2)
        pose.model_from_bone.back() =
            pose.model_from_bone.back() * Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitX());
      const auto by_hand = expected->extend(pose, blades[i], 0.1 * static_cast<double>(i), &change);
      const auto found = instance_.extend_stroke(pose, blades[i], 0.1 * static_cast<double>(i));
      ASSERT_EQ(found.has_value(), by_hand.has_value());
      if (by_hand) parts_.follow({&change, 1});
      frame();
    }
    if (random_.index(4) == 0) {
      ASSERT_TRUE(expected->cancel(&change));
      ASSERT_TRUE(instance_.cancel_stroke());
      return parts_.follow({&change, 1});
    }
    const auto by_hand = expected->end(&change);
    const auto found = instance_.end_stroke();
    ASSERT_TRUE(by_hand);
    ASSERT_TRUE(found) << found.error().text();
    ASSERT_EQ(found->faces_crossed, by_hand->faces_crossed);
    parts_.follow({&change, 1});
  }

  /// Something for the tissue to do.
  void push() {
    if (!parts_.body) return;
    const Index point = random_.index(parts_.model.source().meshes[0].vertex_count() / 2);
    const Vec3d impulse = 1e-3 * random_.direction();
    const Status expected = parts_.body->add_point_impulse(point, impulse);
    ASSERT_EQ(instance_.body()->add_point_impulse(point, impulse).code(), expected.code());
  }

  void frame() {
    if (random_.index(3) > 0) pose_ = test::random_pose(parts_.model.source(), random_, 0.1);
    if (pose_.model_from_bone.empty()) pose_ = *rest_pose(parts_.model.source());
    const double seconds = random_.index(4) == 0 ? 0.0 : kScreenFrame;
    parts_.frame(pose_, seconds);
    const Status status = draw_frame(instance_, pose_, seconds);
    ASSERT_TRUE(status) << status.text();
    parts_.expect_same(instance_);
    for (Index m = 0; m < mirrors_[0].size(); ++m) {
      mirrors_[0][m].upload(instance_, m);
      mirrors_[0][m].expect_same(instance_, m);
      if (random_.index(3) > 0) continue;  // the second engine misses frames
      mirrors_[1][m].upload(instance_, m);
      mirrors_[1][m].expect_same(instance_, m);
    }
  }

  test::Random random_;
  CharacterInstance instance_;
  Parts parts_;
  std::array<std::vector<Mirror>, 2> mirrors_;
  ModelPose pose_;
};

TEST(character_instance, has_the_bits_of_its_parts_called_by_hand) {
  const std::shared_ptr<const Character> characters[] = {
      std::make_shared<const Character>(test::make_tube(20, 16, 5)),
      std::make_shared<const Character>(test::make_two_tubes(10, 10)),
      std::make_shared<const Character>(test::make_sheet(8))};
  for (int seed = 1; seed <= test::stressed(8, 20); ++seed)
    for (const auto& character : characters)
      for (const bool is_soft : {false, true}) {
        SCOPED_TRACE("seed " + std::to_string(seed) + (is_soft ? ", soft" : ", rigid"));
        Duel(character, is_soft, static_cast<std::uint64_t>(seed)).run(12);
        if (HasFatalFailure()) return;
      }
}

/// An instance of a tube that is torn once, and moves.
struct TornTube {
  std::shared_ptr<const Character> character =
      std::make_shared<const Character>(test::make_tube(30, 16, 5));
  test::Random random{3};
  CharacterInstance instance;
  std::vector<ModelPose> poses;

  explicit TornTube(bool is_soft, const TornCapacity& capacity = {})
      : instance(make_instance(character, is_soft, capacity)) {
    for (int i = 0; i < 8; ++i) poses.push_back(test::random_pose(*character, random, 0.1));
    tear();
    for (const ModelPose& pose : poses) EXPECT_TRUE(draw_frame(instance, pose, kScreenFrame));
  }
  void tear() {
    const auto report = instance.tear(poses[0], test::random_stroke(*character, poses[0], random));
    ASSERT_TRUE(report) << report.error().text();
    ASSERT_GT(report->runs, 0u);
  }
};

TEST(character_instance, frames_without_a_tear_do_not_allocate) {
  for (const bool is_soft : {false, true}) {
    TornTube tube(is_soft);
    if (is_soft) {
      ASSERT_TRUE(tube.instance.body()->set_gravity({0, -9.81, 0}));
    }
    for (int i = 0; i < 20; ++i)
      ASSERT_TRUE(
          draw_frame(tube.instance, tube.poses[static_cast<std::size_t>(i) % 8], kScreenFrame));
    const std::uint64_t before = test::allocation_count();
    for (int i = 0; i < 40; ++i)
      (void)draw_frame(tube.instance, tube.poses[static_cast<std::size_t>(i / 2) % 8],
                       kScreenFrame);
    EXPECT_EQ(test::allocation_count(), before) << (is_soft ? "soft" : "rigid");
  }
}

TEST(character_instance, unchanged_data_is_not_written) {
  TornTube tube(true);
  for (int i = 0; i < 600; ++i)
    ASSERT_TRUE(draw_frame(tube.instance, tube.poses[0], kScreenFrame));  // comes to rest
  ASSERT_EQ(tube.instance.body()->awake_count(), 0u);
  const PosedMesh still = tube.instance.mesh(0, tube.instance.mesh(0).epoch);
  EXPECT_TRUE(still.dirty_vertices.empty());
  EXPECT_TRUE(still.triangle_writes.empty());
  EXPECT_TRUE(still.dirty_attributes.empty());

  const auto two = std::make_shared<const Character>(test::make_two_tubes(10, 10));
  CharacterInstance instance = make_instance(two, false);
  const ModelPose rest = *rest_pose(*two);
  ASSERT_TRUE(draw_frame(instance, rest, kScreenFrame));
  const std::uint64_t seen = instance.mesh(0).epoch;
  EXPECT_EQ(instance.mesh(0).dirty_vertices.size(), 1u);  // the first frame draws everything
  test::Random random(5);
  ASSERT_TRUE(instance.tear(rest, test::random_stroke(*two, rest, random, 0.05, 1)));
  ChangeRecord change;
  ASSERT_TRUE(instance.undo(&change));
  ASSERT_TRUE(instance.redo(&change));
  ASSERT_EQ(change.meshes.size(), 1u);
  const Index torn = change.meshes[0].mesh;
  EXPECT_TRUE(instance.mesh(torn).positions.empty());  // nothing to draw before the next frame
  EXPECT_FALSE(instance.mesh(1 - torn).positions.empty());
  ASSERT_TRUE(draw_frame(instance, rest, kScreenFrame));
  EXPECT_FALSE(instance.mesh(torn, seen).triangle_writes.empty());
  EXPECT_TRUE(instance.mesh(1 - torn, seen).dirty_vertices.empty());
  EXPECT_TRUE(instance.mesh(1 - torn, seen).triangle_writes.empty());
}

TEST(character_instance, a_failing_call_changes_nothing) {
  for (const bool is_soft : {false, true}) {
    TornTube tube(is_soft);
    CharacterInstance& instance = tube.instance;
    ASSERT_TRUE(draw_frame(instance, tube.poses[1], kScreenFrame));
    const std::uint64_t digest = instance.model()->digest();
    const PosedMesh before = instance.mesh(0);
    const std::vector<Vec3f> positions(before.positions.begin(), before.positions.end());
    ModelPose broken = tube.poses[2], shorter = tube.poses[2];
    broken.model_from_bone[3](0, 0) = std::numeric_limits<double>::quiet_NaN();
    shorter.model_from_bone.pop_back();
    const Stroke stroke = test::random_stroke(*tube.character, tube.poses[0], tube.random);
    EXPECT_EQ(draw_frame(instance, broken, kScreenFrame).code(), StatusCode::non_finite_value);
    EXPECT_EQ(draw_frame(instance, shorter, kScreenFrame).code(), StatusCode::size_mismatch);
    EXPECT_EQ(draw_frame(instance, tube.poses[2], -1).code(), StatusCode::invalid_argument);
    EXPECT_EQ(draw_frame(instance, tube.poses[2], std::numeric_limits<double>::infinity()).code(),
              StatusCode::non_finite_value);
    EXPECT_FALSE(instance.tear(broken, stroke));
    EXPECT_FALSE(instance.tear(tube.poses[0], {stroke.data(), 1}));
    EXPECT_FALSE(instance.redo());
    EXPECT_FALSE(instance.end_stroke());
    EXPECT_FALSE(instance.extend_stroke(tube.poses[0], stroke[0]));
    EXPECT_FALSE(instance.apply(UndoOperation{7}));
    EXPECT_EQ(instance.tear_overstretched().has_value(), is_soft);
    EXPECT_EQ(instance.model()->digest(), digest);
    EXPECT_TRUE(same_bits<Vec3f>(instance.mesh(0).positions, positions));
    ASSERT_TRUE(draw_frame(instance, tube.poses[1], 0));
    EXPECT_TRUE(same_bits<Vec3f>(instance.mesh(0).positions, positions));
  }
}

TEST(character_instance, compacted_is_as_one_made_of_what_is_left) {
  for (const bool is_soft : {false, true}) {
    TornTube tube(is_soft);
    CharacterInstance& instance = tube.instance;
    const Stroke stroke = test::random_stroke(*tube.character, tube.poses[1], tube.random);
    TearOptions gap;
    gap.width = 0.05;
    ASSERT_TRUE(instance.begin_stroke(tube.poses[1], stroke[0], gap));
    EXPECT_EQ(instance.compact().error().code(), StatusCode::invalid_argument);
    ASSERT_TRUE(instance.cancel_stroke());
    ASSERT_TRUE(instance.tear(tube.poses[1], stroke, gap));
    const std::uint32_t triangles = instance.character().meshes[0].triangle_count();
    const auto maps = instance.compact();
    ASSERT_TRUE(maps);
    EXPECT_LT(maps->meshes.at(0).triangle_old_from_new.size(), triangles);
    EXPECT_EQ(instance.model()->undo_count(), 0u);
    EXPECT_TRUE(instance.mesh(0).positions.empty());  // nothing to draw before the next frame

    CharacterInstance made =
        make_instance(std::make_shared<const Character>(instance.character()), is_soft);
    const auto expect_same = [&] {
      const PosedMesh a = instance.mesh(0), b = made.mesh(0);
      ASSERT_FALSE(a.positions.empty());
      EXPECT_TRUE(same_bits(a.positions, b.positions));
      EXPECT_TRUE(same_bits(a.normals, b.normals));
      EXPECT_EQ(drawn_triangles(instance.character().meshes[0]),
                drawn_triangles(made.character().meshes[0]));
      EXPECT_EQ(instance.model()->digest(), made.model()->digest());
    };
    const Stroke again = test::random_stroke(*tube.character, tube.poses[2], tube.random);
    for (CharacterInstance* of : {&instance, &made}) {
      if (is_soft) {
        ASSERT_TRUE(of->body()->add_impulse(0, {0, 0, 1}));
      }
      ASSERT_TRUE(draw_frame(*of, tube.poses[2], kScreenFrame));
    }
    expect_same();
    for (CharacterInstance* of : {&instance, &made}) {
      ASSERT_TRUE(of->tear(tube.poses[2], again));
      ASSERT_TRUE(draw_frame(*of, tube.poses[3], kScreenFrame));
    }
    expect_same();
  }
}

TEST(character_instance, buffers_of_fixed_capacity_stay_where_they_are) {
  TornTube tube(true, {4000, 8000, 40});
  const Vec3f* const data = tube.instance.mesh(0).positions.data();
  for (int i = 0; i < 6; ++i) {
    tube.tear();
    ASSERT_TRUE(draw_frame(tube.instance, tube.poses[0], kScreenFrame));
    EXPECT_EQ(tube.instance.mesh(0).positions.data(), data);
  }
}

TEST(character_instance, a_cancelled_stroke_leaves_nothing) {
  for (const bool is_soft : {false, true})
    for (const bool is_torn_before : {false, true}) {
      TornTube tube(is_soft);
      if (!is_torn_before) {
        ASSERT_TRUE(tube.instance.undo());
      }
      const ModelPose& pose = tube.poses[0];
      for (int i = 0; i < 600; ++i) ASSERT_TRUE(draw_frame(tube.instance, pose, kScreenFrame));
      const std::uint64_t digest = tube.instance.model()->digest();
      const PosedMesh before = tube.instance.mesh(0);
      const std::vector<Vec3f> positions(before.positions.begin(), before.positions.end());
      EXPECT_FALSE(tube.instance.cancel_stroke());
      const Stroke stroke = test::random_stroke(*tube.character, pose, tube.random);
      ASSERT_TRUE(tube.instance.begin_stroke(pose, stroke[0]));
      for (std::size_t i = 1; i < stroke.size(); ++i) {
        ASSERT_TRUE(tube.instance.extend_stroke(pose, stroke[i]));
        ASSERT_TRUE(draw_frame(tube.instance, pose, kScreenFrame));
      }
      EXPECT_NE(tube.instance.model()->digest(), digest);
      ASSERT_TRUE(tube.instance.cancel_stroke());
      ASSERT_TRUE(draw_frame(tube.instance, pose, kScreenFrame));
      EXPECT_EQ(tube.instance.model()->digest(), digest);
      EXPECT_TRUE(same_bits<Vec3f>(tube.instance.mesh(0).positions, positions));
    }
}

/// The same character, whose bind space has another unit.
Character in_bind_units(Character character, float units_per_metre) {
  for (Mesh& mesh : character.meshes)
    for (Vec3f& position : mesh.positions) position *= units_per_metre;
  for (Skin& skin : character.skins)
    for (Affine3f& bone_from_bind : skin.bone_from_bind) bone_from_bind.linear() /= units_per_metre;
  return character;
}

TEST(character_instance, wounds_do_not_depend_on_the_unit_of_bind_space) {
  const Character tube = test::make_tube(30, 16, 5);
  const ModelPose rest = *rest_pose(tube);
  test::Random random{7};
  const Stroke stroke = test::random_stroke(tube, rest, random);
  const auto torn_by = [&](float units_per_metre) {
    auto instance = make_instance(
        std::make_shared<const Character>(in_bind_units(tube, units_per_metre)), true);
    EXPECT_TRUE(instance.body()->set_tension({20.0, {}}));
    EXPECT_TRUE(instance.tear(rest, stroke));
    for (int frame = 0; frame < 90; ++frame) EXPECT_TRUE(draw_frame(instance, rest, kScreenFrame));
    return instance;
  };
  CharacterInstance metres = torn_by(1.0f), units = torn_by(4096.0f);
  const auto wanted = metres.mesh(0).positions, found = units.mesh(0).positions;
  ASSERT_EQ(found.size(), wanted.size());
  const std::vector<Vec3d> still = test::posed_positions(metres.character(), 0, rest);
  double opening = 0;
  for (std::size_t v = 0; v < found.size(); ++v) {
    EXPECT_LT((found[v] - wanted[v]).norm(), 1e-4) << v;
    opening = std::max(opening, (wanted[v].cast<double>() - still[v]).norm());
  }
  EXPECT_GT(opening, 1e-3);
}

TEST(character_instance, tears_where_tissue_is_stretched) {
  const auto sheet = std::make_shared<const Character>(test::make_sheet(24));
  CharacterAssetOptions options;
  options.soft = coarse_tissue();
  options.soft->decomposition.range = 0.1;
  options.soft->materials[0].strength = 1.3;
  CharacterInstance instance = value_of(CharacterInstance::create(sheet, options));
  EXPECT_FALSE(instance.tear_overstretched());  // no soft body yet
  ASSERT_TRUE(instance.prepare_to_tear());
  EXPECT_FALSE(instance.tear_overstretched());  // no pose yet
  const ModelPose rest = *rest_pose(*sheet);
  for (const double side : {-1.0, 1.0})
    for (Index p = 0; p < instance.particles()->particle_count(); ++p) {
      const Vec3f& seed = instance.particles()->positions()[instance.particles()->seed(p)];
      if (side * (double{seed.x()} - 0.5) > 0.1)
        (void)instance.body()->hold(p, seed.cast<double>() + Vec3d(0.15 * side, 0, 0));
    }
  std::vector<ChangeRecord> changes;
  for (int i = 0; i < 60; ++i) {
    ASSERT_TRUE(draw_frame(instance, rest, kScreenFrame));
    ASSERT_TRUE(instance.tear_overstretched({}, &changes));
  }
  EXPECT_FALSE(changes.empty());
  EXPECT_GT(instance.model()->undo_count(), 0u);
  ASSERT_TRUE(draw_frame(instance, rest, kScreenFrame));
  EXPECT_EQ(instance.mesh(0).positions.size(), instance.character().meshes[0].vertex_count());
}

TEST(character_instance, a_refit_is_swapped_in) {
  TornTube tube(false);
  WeightsOperation wanted;
  wanted.weights.policy = WeightPolicy::refit;
  const auto job = tube.instance.begin_refit(wanted);
  ASSERT_TRUE(job) << job.error().text();
  job->run();
  const auto report = tube.instance.swap_in(*job);
  ASSERT_TRUE(report) << report.error().text();
  ASSERT_GT(report->points, 0u);
  ASSERT_TRUE(draw_frame(tube.instance, tube.poses[0], kScreenFrame));
  EXPECT_FALSE(tube.instance.mesh(0).dirty_attributes.empty());
}

TEST(character_instance, refuses_the_same_calls_as_its_parts) {
  EXPECT_EQ(CharacterInstance::create(std::shared_ptr<const Character>()).error().code(),
            StatusCode::empty_input);
  const auto sheet = std::make_shared<const Character>(test::make_sheet(4));
  CharacterAssetOptions options;
  options.soft.emplace();
  options.soft->materials.clear();
  EXPECT_EQ(CharacterInstance::create(sheet, options).error().code(), StatusCode::empty_input);
  options.soft.emplace();
  options.soft->decomposition.range = -1;
  EXPECT_EQ(CharacterInstance::create(sheet, options).error().code(), StatusCode::invalid_argument);
}

}  // namespace
}  // namespace sunder
