// SkinnedMesh matches the definition to float precision, and its bits do not depend on blocks,
// vectors, tasks, layouts, or what was written before.

#include <sunder/skinning/deform.h>
#include <sunder/skinning/skinned_mesh.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include <gtest/gtest.h>

#include "skinning/internal/reference.h"
#include "support/machine/backward_threads.h"
#include "support/machine/stress.h"
#include "support/models/posed_arrays.h"
#include "support/models/random_skin.h"

namespace sunder {
namespace {

using test::PosedArrays;
using test::Random;
using test::RandomSkin;

std::vector<float> random_morph_weights(Random& random, std::size_t count) {
  std::vector<float> weights;
  for (std::size_t i = 0; i < count; ++i)
    weights.push_back(random.index(3) == 0 ? 0.0f : static_cast<float>(random.uniform(0, 1)));
  return weights;
}

SkinnedMesh skinned_mesh(const Mesh& mesh, std::size_t slots) {
  Result<SkinnedMesh> made = SkinnedMesh::create(source_of(mesh), slots);
  EXPECT_TRUE(made) << made.error().text();
  return std::move(*made);
}

void write(const SkinnedMesh& mesh, const BonePalette& palette, PosedBuffer& buffer,
           const ParallelFor& parallel_for = {}) {
  const Status status = mesh.deform(palette, buffer, parallel_for);
  ASSERT_TRUE(status) << status.text();
}

BonePalette palette_of(const std::vector<Affine3f>& matrices,
                       const std::vector<float>& morph_weights,
                       SkinningMethod method = SkinningMethod::linear) {
  BonePalette palette = *BonePalette::create(matrices.size(), morph_weights.size(), method);
  EXPECT_TRUE(palette.set(matrices, morph_weights));
  return palette;
}

/// Kinds of meshes: few bones shared by neighbours, as in rigs; random bones; more influences than
/// engines support; sizes around that of a block, and above that of a window.
std::vector<RandomSkin> mesh_kinds() {
  return {{1, 1, 1, 0, false, 1},        {15, 3, 2, 1, false, 3},   {16, 4, 4, 0, true, 4},
          {17, 8, 8, 2, true, 8},        {333, 60, 4, 3, true, 6},  {500, 300, 4, 0, true, 300},
          {700, 400, 24, 1, false, 400}, {1000, 5, 1, 0, false, 5}, {5000, 64, 4, 1, false, 6},
          {9000, 64, 8, 0, true, 64}};
}

TEST(SkinnedMesh, agrees_with_the_double_precision_reference) {
  Random random(11);
  for (const RandomSkin& kind : mesh_kinds())
    for (const double scale : {1.0, 1.5}) {
      const Mesh mesh = test::make_random_skin(random, kind);
      const auto exact = test::random_palette(random, kind.slots, scale);
      const auto weights = random_morph_weights(random, kind.morph_targets);
      PosedArrays posed(mesh, 0, true);
      PosedBuffer buffer(posed.target());
      write(skinned_mesh(mesh, kind.slots), palette_of(test::in_float(exact), weights), buffer);
      for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
        const Vec3d expected = deform_position_reference(mesh, v, exact, weights);
        ASSERT_LT((posed.position(v).cast<double>() - expected).norm(), 1e-6 * scale * scale)
            << "vertex " << v;
        // If bones disagree, blended normals may be short, which increases relative errors.
        const Vec3d normal = deform_normal_reference(mesh, v, exact, weights);
        Mat3d blended = Mat3d::Zero();
        for (const Influence& influence : mesh.weights.of(v))
          blended += influence.weight * compute_normal_matrix(exact[influence.slot].linear());
        Vec3d bind = mesh.normals[v].cast<double>();
        for (std::size_t j = 0; j < mesh.morph_targets.size(); ++j)
          if (!mesh.morph_targets[j].normal_deltas.empty())
            bind += weights[j] * mesh.morph_targets[j].normal_deltas[v].cast<double>();
        ASSERT_LT((posed.normal(v).cast<double>() - normal).norm() * (blended * bind).norm(),
                  2e-6 * scale * scale)
            << "vertex " << v;
      }
      EXPECT_TRUE(posed.margins_are_untouched());
    }
}

TEST(SkinnedMesh, tangents_go_by_the_linear_part_and_keep_w) {
  Random random(12);
  const RandomSkin kind = {200, 20, 3, 0, true, 6};
  const Mesh mesh = test::make_random_skin(random, kind);
  const auto exact = test::random_palette(random, kind.slots, 1.5);
  PosedArrays posed(mesh);
  PosedBuffer buffer(posed.target());
  write(skinned_mesh(mesh, kind.slots), palette_of(test::in_float(exact), {}), buffer);
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    Vec3d expected = Vec3d::Zero();
    for (const Influence& influence : mesh.weights.of(v))
      expected += influence.weight *
                  (exact[influence.slot].linear() * mesh.tangents[v].head<3>().cast<double>());
    ASSERT_LT((posed.tangent(v).head<3>().cast<double>() - expected).norm(), 1e-6);
    ASSERT_EQ(posed.tangent(v).w(), mesh.tangents[v].w());
  }
}

TEST(SkinnedMesh, a_vertex_has_the_same_bits_at_any_index) {
  // The lips of a tear and the sides of a seam are coincident vertices, far apart in their buffers;
  // they must not crack.
  Random random(13);
  for (const SkinningMethod method : {SkinningMethod::linear, SkinningMethod::dual_quaternion})
    for (const RandomSkin& kind : mesh_kinds()) {
      const Mesh mesh = test::make_random_skin(random, kind);
      const auto matrices = test::in_float(test::random_palette(random, kind.slots, 1.3));
      const auto weights = random_morph_weights(random, kind.morph_targets);
      const BonePalette palette = palette_of(matrices, weights, method);
      PosedArrays posed(mesh);
      PosedBuffer buffer(posed.target());
      write(skinned_mesh(mesh, kind.slots), palette, buffer);

      std::vector<std::uint32_t> shuffle(mesh.vertex_count());
      std::iota(shuffle.begin(), shuffle.end(), 0u);
      for (std::uint32_t i = 0; i + 1 < mesh.vertex_count(); ++i)
        std::swap(shuffle[i], shuffle[i + random.index(mesh.vertex_count() - i)]);
      for (const auto& order : {shuffle, *order_for_skinning(mesh)}) {
        Mesh other = mesh;
        ASSERT_TRUE(reorder_vertices(other, order));
        PosedArrays other_posed(other);
        PosedBuffer other_buffer(other_posed.target());
        write(skinned_mesh(other, kind.slots), palette, other_buffer);
        for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v)
          ASSERT_TRUE(other_posed.is_same(v, posed, order[v])) << "vertex " << v;
      }
      const auto in_order = SkinnedMesh::create(source_of(mesh), kind.slots, VertexGathering::none);
      ASSERT_TRUE(in_order);
      PosedArrays posed_in_order(mesh);
      PosedBuffer buffer_in_order(posed_in_order.target());
      write(*in_order, palette, buffer_in_order);
      for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v)
        ASSERT_TRUE(posed_in_order.is_same(v, posed, v)) << "not gathered, vertex " << v;
    }
}

TEST(SkinnedMesh, has_the_same_bits_at_every_number_of_tasks) {
  Random random(14);
  const RandomSkin kind = {40000, 64, 4, 0, false, 8};
  const Mesh mesh = test::make_random_skin(random, kind);
  const SkinnedMesh made = skinned_mesh(mesh, kind.slots);
  const BonePalette palette =
      palette_of(test::in_float(test::random_palette(random, kind.slots)), {});
  PosedArrays alone(mesh);
  PosedBuffer buffer(alone.target());
  write(made, palette, buffer);
  for (const std::uint32_t threads : {1u, 2u, 4u, 8u}) {
    test::BackwardThreads pool{threads};
    PosedArrays posed(mesh);
    PosedBuffer of_threads(posed.target());
    write(made, palette, of_threads, pool.hook());
    EXPECT_EQ(pool.calls, 1u);
    EXPECT_EQ(posed.first_difference(alone), kNone) << threads << " threads";
    EXPECT_TRUE(posed.margins_are_untouched());
  }
}

TEST(SkinnedMesh, a_small_mesh_does_not_ask_for_threads) {
  Random random(15);
  const Mesh mesh = test::make_random_skin(random, {3000, 20, 4, 0, false, 6});
  test::BackwardThreads pool{4};
  PosedArrays posed(mesh);
  PosedBuffer buffer(posed.target());
  write(skinned_mesh(mesh, 20), palette_of(test::in_float(test::random_palette(random, 20)), {}),
        buffer, pool.hook());
  EXPECT_EQ(pool.calls, 0u);
}

TEST(SkinnedMesh, strides_in_and_out_do_not_change_bits) {
  Random random(16);
  for (const RandomSkin& kind : mesh_kinds()) {
    if (kind.morph_targets > 0) continue;
    const Mesh mesh = test::make_random_skin(random, kind);
    const BonePalette palette =
        palette_of(test::in_float(test::random_palette(random, kind.slots, 1.2)), {});
    PosedArrays packed(mesh), padded(mesh, 3);
    PosedBuffer to_packed(packed.target()), to_padded(padded.target());
    const SkinnedMesh made = skinned_mesh(mesh, kind.slots);
    write(made, palette, to_packed);
    write(made, palette, to_padded);
    EXPECT_EQ(padded.first_difference(packed), kNone);
    EXPECT_TRUE(padded.margins_are_untouched());

    // Interleaved vertices of an engine, as bytes: position, normal, tangent, slots, weights, and
    // other data.
    const std::size_t places = kind.influences,
                      stride = 40 + 2 * places + 2 * (places % 2) + 4 * places + 4;
    std::vector<float> bytes(mesh.vertex_count() * stride / 4 + 1);
    unsigned char* base = reinterpret_cast<unsigned char*>(bytes.data());
    const std::size_t weights_at = 40 + 2 * places + 2 * (places % 2);
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
      unsigned char* vertex = base + stride * v;
      std::memcpy(vertex, mesh.positions[v].data(), 12);
      std::memcpy(vertex + 12, mesh.normals[v].data(), 12);
      if (!mesh.tangents.empty()) std::memcpy(vertex + 24, mesh.tangents[v].data(), 16);
      const auto influences = mesh.weights.of(v);
      for (std::size_t k = 0; k < influences.size(); ++k) {
        const auto slot = static_cast<std::uint16_t>(influences[k].slot);
        std::memcpy(vertex + 40 + 2 * k, &slot, 2);
        std::memcpy(vertex + weights_at + 4 * k, &influences[k].weight, 4);
      }
    }
    VertexSource source;
    source.vertex_count = mesh.vertex_count();
    source.positions = {bytes.data(), stride};
    source.normals = {bytes.data() + 3, stride};
    if (!mesh.tangents.empty()) source.tangents = {bytes.data() + 6, stride};
    source.influences.per_vertex = places;
    source.influences.slots = reinterpret_cast<const std::uint16_t*>(base + 40);
    source.influences.slot_stride = stride;
    source.influences.weights = reinterpret_cast<const float*>(base + weights_at);
    source.influences.weight_stride = stride;
    const Result<SkinnedMesh> of_engine = SkinnedMesh::create(source, kind.slots);
    ASSERT_TRUE(of_engine) << of_engine.error().text();
    PosedArrays posed(mesh);
    PosedBuffer buffer(posed.target());
    write(*of_engine, palette, buffer);
    EXPECT_EQ(posed.first_difference(packed), kNone);
  }
}

TEST(SkinnedMesh, weights_of_16_bits_are_65535ths) {
  Random random(17);
  const Mesh mesh = test::make_random_skin(random, {100, 6, 4, 0, false, 6});
  std::vector<std::uint16_t> slots(400), weights(400);
  Mesh rounded = mesh;
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    const auto influences = mesh.weights.of(v);
    for (std::size_t k = 0; k < influences.size(); ++k) {
      slots[4 * v + k] = static_cast<std::uint16_t>(influences[k].slot);
      weights[4 * v + k] = static_cast<std::uint16_t>(std::lround(influences[k].weight * 65535));
      rounded.weights.influences[mesh.weights.first[v] + k].weight =
          static_cast<float>(weights[4 * v + k]) / 65535.0f;
    }
  }
  VertexSource source = source_of(mesh);
  source.weights = nullptr;
  source.influences.per_vertex = 4;
  source.influences.slots = slots.data();
  source.influences.weights16 = weights.data();
  const Result<SkinnedMesh> made = SkinnedMesh::create(source, 6);
  ASSERT_TRUE(made) << made.error().text();
  const BonePalette palette = palette_of(test::in_float(test::random_palette(random, 6)), {});
  PosedArrays posed(mesh), expected(mesh);
  PosedBuffer buffer(posed.target()), to_expected(expected.target());
  write(*made, palette, buffer);
  write(skinned_mesh(rounded, 6), palette, to_expected);
  EXPECT_EQ(posed.first_difference(expected), kNone);
}

/// Whether ranges are ascending, disjoint, and contain every changed vertex.
void expect_ranges_cover(std::span<const IndexRange> ranges, std::uint32_t vertices,
                         const std::vector<bool>& changed) {
  std::vector<bool> covered(vertices);
  std::uint32_t end = 0;
  for (const IndexRange& range : ranges) {
    ASSERT_GT(range.count, 0u);
    ASSERT_TRUE(range.first > end || (range.first == 0 && end == 0)) << "ranges touch or descend";
    end = range.first + range.count;
    ASSERT_LE(end, vertices);
    std::fill(covered.begin() + range.first, covered.begin() + end, true);
  }
  for (std::uint32_t v = 0; v < vertices; ++v)
    ASSERT_TRUE(covered[v] || !changed[v]) << "vertex " << v << " changed unreported";
}

TEST(SkinnedMesh, writing_moved_vertices_equals_writing_all) {
  for (int seed = 1; seed <= test::stressed(6, 30); ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    for (const SkinningMethod method : {SkinningMethod::linear, SkinningMethod::dual_quaternion})
      for (const RandomSkin& kind : mesh_kinds()) {
        const Mesh mesh = test::make_random_skin(random, kind);
        const SkinnedMesh made = skinned_mesh(mesh, kind.slots);
        auto matrices = test::in_float(test::random_palette(random, kind.slots, 1.2));
        auto weights = random_morph_weights(random, kind.morph_targets);
        BonePalette palette = *BonePalette::create(kind.slots, kind.morph_targets, method);
        PosedArrays posed(mesh), before(mesh);
        PosedBuffer buffer(posed.target()), to_before(before.target());
        for (int frame = 0; frame < 8; ++frame) {
          for (std::uint32_t i = random.index(3); i > 0; --i)
            matrices[random.index(kind.slots)] =
                test::in_float(test::random_palette(random, 1, 1.2))[0];
          if (kind.morph_targets > 0 && random.index(2) == 0)
            weights[random.index(kind.morph_targets)] = static_cast<float>(random.uniform(0, 1));
          ASSERT_TRUE(palette.set(matrices, weights));
          if (random.index(4) == 0) continue;  // a frame without deform()
          write(made, palette, buffer);

          PosedArrays anew(mesh);
          PosedBuffer to_anew(anew.target());
          write(made, palette, to_anew);
          ASSERT_EQ(posed.first_difference(anew), kNone);
          std::vector<bool> changed(mesh.vertex_count());
          for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v)
            changed[v] = !posed.is_same(v, before, v);
          expect_ranges_cover(buffer.dirty_vertices(), mesh.vertex_count(), changed);
          write(made, palette, to_before);
        }
        EXPECT_TRUE(posed.margins_are_untouched());
      }
  }
}

TEST(SkinnedMesh, vertices_that_did_not_move_are_not_written) {
  Random random(18);
  const RandomSkin kind = {2000, 50, 3, 1, false, 4};
  const Mesh mesh = test::make_random_skin(random, kind);
  const SkinnedMesh made = skinned_mesh(mesh, kind.slots);
  auto matrices = test::in_float(test::random_palette(random, kind.slots));
  BonePalette palette = palette_of(matrices, {0.5f});
  PosedArrays posed(mesh);
  PosedBuffer buffer(posed.target());
  write(made, palette, buffer);
  ASSERT_EQ(buffer.dirty_vertices().size(), 1u);
  EXPECT_EQ(buffer.dirty_vertices()[0], (IndexRange{0, mesh.vertex_count()}));

  posed.erase();
  ASSERT_TRUE(palette.set(matrices, std::vector<float>{0.5f}));
  write(made, palette, buffer);
  EXPECT_TRUE(buffer.dirty_vertices().empty());
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) ASSERT_TRUE(posed.is_untouched(v));

  matrices[20].translation().x() += 1;
  ASSERT_TRUE(palette.set(matrices, std::vector<float>{0.5f}));
  write(made, palette, buffer);
  std::uint32_t moved = 0, written = 0;
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    const auto influences = mesh.weights.of(v);
    const bool moves = std::any_of(influences.begin(), influences.end(),
                                   [](const Influence& i) { return i.slot == 20; });
    moved += moves;
    written += !posed.is_untouched(v);
    ASSERT_TRUE(!moves || !posed.is_untouched(v));
  }
  EXPECT_GT(moved, 0u);
  EXPECT_LT(written, moved + 200) << "whole blocks of 16 are written, and few others";
}

TEST(SkinnedMesh, ranges_ascend_where_the_first_vertices_are_gathered_last) {
  Random random(23);
  Mesh mesh;
  for (std::uint32_t v = 0; v < 304; ++v) {
    mesh.positions.push_back(random.direction().cast<float>());
    mesh.weights.append(std::vector<Influence>{{v < 16 ? 40 : random.index(40), 1.0f}});
  }
  const SkinnedMesh made = skinned_mesh(mesh, 41);
  auto matrices = test::in_float(test::random_palette(random, 41));
  BonePalette palette = palette_of(matrices, {});
  PosedArrays posed(mesh);
  PosedBuffer buffer(posed.target());
  write(made, palette, buffer);
  for (const std::size_t slot : {39, 40}) matrices[slot].translation().x() += 1;
  ASSERT_TRUE(palette.set(matrices, std::vector<float>{}));
  write(made, palette, buffer);
  std::vector<bool> changed;
  for (std::uint32_t v = 0; v < 304; ++v) changed.push_back(mesh.weights.of(v)[0].slot >= 39);
  expect_ranges_cover(buffer.dirty_vertices(), 304, changed);
}

TEST(SkinnedMesh, a_buffer_written_by_another_mesh_is_rewritten) {
  Random random(19);
  const Mesh mesh = test::make_random_skin(random, {100, 6, 4, 0, false, 6});
  const SkinnedMesh made = skinned_mesh(mesh, 6), same = skinned_mesh(mesh, 6);
  const auto matrices = test::in_float(test::random_palette(random, 6));
  const BonePalette palette = palette_of(matrices, {}), twin = palette_of(matrices, {});
  PosedArrays posed(mesh);
  PosedBuffer buffer(posed.target());
  const auto is_written = [&](const SkinnedMesh& from, const BonePalette& by) {
    write(from, by, buffer);
    return !buffer.dirty_vertices().empty();
  };
  EXPECT_TRUE(is_written(made, palette));
  EXPECT_FALSE(is_written(made, palette));
  EXPECT_TRUE(is_written(made, twin));
  EXPECT_TRUE(is_written(same, twin));
  EXPECT_FALSE(is_written(same, twin));
  buffer.set_target(posed.target());
  EXPECT_TRUE(is_written(same, twin));
}

TEST(SkinnedMesh, follows_vertices_that_come_and_go) {
  for (int seed = 1; seed <= test::stressed(5, 30); ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    for (RandomSkin kind : mesh_kinds()) {
      kind.vertices += 300;
      const Mesh whole = test::make_random_skin(random, kind);
      const auto first_vertices = [&](std::uint32_t count) {
        Mesh mesh = whole;
        mesh.positions.resize(count);
        mesh.normals.resize(count);
        if (!mesh.tangents.empty()) mesh.tangents.resize(count);
        mesh.weights.first.resize(count + 1);
        mesh.weights.influences.resize(mesh.weights.first[count]);
        for (MorphTarget& target : mesh.morph_targets)
          for (auto* deltas :
               {&target.position_deltas, &target.normal_deltas, &target.tangent_deltas})
            if (!deltas->empty()) deltas->resize(count);
        return mesh;
      };
      auto matrices = test::in_float(test::random_palette(random, kind.slots, 1.2));
      const auto weights = random_morph_weights(random, kind.morph_targets);
      BonePalette palette = palette_of(matrices, weights);
      std::uint32_t count = kind.vertices - 300;
      SkinnedMesh made = skinned_mesh(first_vertices(count), kind.slots);
      PosedArrays posed(whole);
      VertexTarget target = posed.target();
      target.vertex_count = count;
      PosedBuffer buffer(target);
      write(made, palette, buffer);
      for (int step = 0; step < 10; ++step) {
        const std::uint32_t next = kind.vertices - 300 + random.index(300),
                            first_changed = std::min(count, next);
        const Mesh mesh = first_vertices(next);
        const Status status = made.update(source_of(mesh), first_changed);
        ASSERT_TRUE(status) << status.text();
        ASSERT_EQ(made.vertex_count(), next);
        count = next;
        if (random.index(2) == 0) matrices[random.index(kind.slots)].translation().y() += 0.1f;
        ASSERT_TRUE(palette.set(matrices, weights));
        if (random.index(3) == 0) continue;
        buffer.set_vertex_count(count);
        write(made, palette, buffer);
        PosedArrays anew(mesh);
        PosedBuffer to_anew(anew.target());
        write(skinned_mesh(mesh, kind.slots), palette, to_anew);
        for (std::uint32_t v = 0; v < count; ++v)
          ASSERT_TRUE(posed.is_same(v, anew, v)) << "vertex " << v << " of " << count;
      }
    }
  }
}

TEST(SkinnedMesh, a_thousand_kilometres_away_nothing_changes) {
  Random random(20);
  const RandomSkin kind = {500, 12, 4, 0, false, 6};
  const Mesh mesh = test::make_random_skin(random, kind);
  Skin skin;
  ModelPose near, far;
  const auto pose = test::random_palette(random, kind.slots);
  Affine3d model_from_character = Affine3d::Identity();
  model_from_character.translation() = Vec3d(1e6, -4e5, 7e5);
  model_from_character.linear() =
      Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitY()).toRotationMatrix();
  for (std::uint32_t slot = 0; slot < kind.slots; ++slot) {
    skin.bones.push_back(slot);
    skin.bone_from_bind.push_back(Affine3f::Identity());
    near.model_from_bone.push_back(pose[slot]);
    far.model_from_bone.push_back(model_from_character * pose[slot]);
  }
  BonePalette at_home = *BonePalette::create(kind.slots, 0),
              away = *BonePalette::create(kind.slots, 0);
  ASSERT_TRUE(at_home.set(skin, near));
  ASSERT_TRUE(away.set(skin, far, model_from_character));
  const SkinnedMesh made = skinned_mesh(mesh, kind.slots);
  PosedArrays posed(mesh), posed_away(mesh);
  PosedBuffer buffer(posed.target()), buffer_away(posed_away.target());
  write(made, at_home, buffer);
  write(made, away, buffer_away);
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v)
    ASSERT_LT((posed_away.position(v).cast<double>() - deform_position_reference(mesh, v, pose, {}))
                  .norm(),
              1e-6);
}

TEST(SkinnedMesh, refuses_mismatching_arguments_and_writes_nothing) {
  Random random(21);
  const Mesh mesh = test::make_random_skin(random, {50, 6, 4, 1, false, 6});
  const SkinnedMesh made = skinned_mesh(mesh, 6);
  const BonePalette palette = palette_of(test::in_float(test::random_palette(random, 6)), {0.5f});
  PosedArrays posed(mesh);
  const auto code_of = [&](const BonePalette& by, const VertexTarget& target) {
    PosedBuffer buffer(target);
    return made.deform(by, buffer).code();
  };
  EXPECT_EQ(
      code_of(palette_of(test::in_float(test::random_palette(random, 5)), {0.5f}), posed.target()),
      StatusCode::size_mismatch);
  EXPECT_EQ(
      code_of(palette_of(test::in_float(test::random_palette(random, 6)), {}), posed.target()),
      StatusCode::size_mismatch);
  Mesh beyond = mesh;  // whose first weight and their number add to zero in 32 bits
  beyond.first_morph_weight = 0u - static_cast<std::uint32_t>(mesh.morph_targets.size());
  PosedBuffer buffer(posed.target());
  EXPECT_EQ(skinned_mesh(beyond, 6).deform(palette, buffer).code(), StatusCode::size_mismatch);
  EXPECT_EQ(code_of(*BonePalette::create(6, 1), posed.target()), StatusCode::invalid_argument);
  VertexTarget target = posed.target();
  target.vertex_count = 49;
  EXPECT_EQ(code_of(palette, target), StatusCode::size_mismatch);
  target = posed.target();
  target.tangents = target.positions;
  EXPECT_EQ(code_of(palette, target), StatusCode::invalid_argument);
  target = posed.target();
  target.normals.stride = 8;
  EXPECT_EQ(code_of(palette, target), StatusCode::invalid_argument);
  target.normals.stride = 14;
  EXPECT_EQ(code_of(palette, target), StatusCode::invalid_argument);
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) EXPECT_TRUE(posed.is_untouched(v));
}

TEST(SkinnedMesh, bad_vertices_are_named) {
  Random random(22);
  const Mesh good = test::make_random_skin(random, {50, 6, 4, 1, true, 6});
  const auto fault_of = [](const Mesh& mesh) {
    return SkinnedMesh::create(source_of(mesh), 6).error();
  };
  const auto expect_fault = [&](const Mesh& mesh, StatusCode code, std::uint32_t index) {
    const Status fault = fault_of(mesh);
    EXPECT_EQ(fault.code(), code) << fault.text();
    EXPECT_EQ(fault.index(), index) << fault.text();
  };
  Mesh mesh = good;
  mesh.positions[7].y() = std::numeric_limits<float>::quiet_NaN();
  expect_fault(mesh, StatusCode::non_finite_value, 7);
  mesh = good;
  mesh.tangents[49].w() = std::numeric_limits<float>::infinity();
  expect_fault(mesh, StatusCode::non_finite_value, 49);
  mesh = good;
  mesh.morph_targets[0].position_deltas[3].x() = std::numeric_limits<float>::infinity();
  expect_fault(mesh, StatusCode::non_finite_value, 3);
  mesh = good;
  mesh.weights.influences[mesh.weights.first[9]].slot = 6;
  expect_fault(mesh, StatusCode::index_out_of_range, 9);
  mesh = good;
  mesh.weights.influences[mesh.weights.first[9]].weight += 0.5f;
  expect_fault(mesh, StatusCode::weights_not_normalized, 9);
  mesh = good;
  mesh.weights.influences[mesh.weights.first[9]].weight = std::numeric_limits<float>::quiet_NaN();
  expect_fault(mesh, StatusCode::weights_not_normalized, 9);
  mesh = good;
  mesh.morph_targets[0].position_deltas.pop_back();
  expect_fault(mesh, StatusCode::size_mismatch, 0);
  mesh = good;
  mesh.weights.first.pop_back();
  expect_fault(mesh, StatusCode::size_mismatch, kNone);

  SkinnedMesh made = skinned_mesh(good, 6);
  mesh = good;
  mesh.positions[49].x() = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(made.update(source_of(mesh), 40).code(), StatusCode::non_finite_value);
  EXPECT_EQ(made.update(source_of(good), 51).code(), StatusCode::index_out_of_range);
  mesh = good;
  mesh.normals.clear();
  EXPECT_EQ(made.update(source_of(mesh), 50).code(), StatusCode::size_mismatch);
  const BonePalette palette = palette_of(test::in_float(test::random_palette(random, 6)), {0.5f});
  PosedArrays posed(good), expected(good);
  PosedBuffer buffer(posed.target()), to_expected(expected.target());
  write(made, palette, buffer);
  write(skinned_mesh(good, 6), palette, to_expected);
  EXPECT_EQ(posed.first_difference(expected), kNone) << "a failing update changed something";
}

TEST(SkinnedMesh, an_empty_mesh_is_valid) {
  const SkinnedMesh made = skinned_mesh(Mesh(), 3);
  BonePalette palette = *BonePalette::create(3, 0);
  ASSERT_TRUE(palette.set(std::vector<Affine3f>(3, Affine3f::Identity()), {}));
  PosedBuffer buffer({});
  EXPECT_TRUE(made.deform(palette, buffer));
  EXPECT_TRUE(buffer.dirty_vertices().empty());
}

}  // namespace
}  // namespace sunder
