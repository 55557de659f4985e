// Displaced vertices match the definition to float precision; their bits do not depend on earlier
// displacements, the number of tasks, or the layout; normals and tangents are those of the
// displaced surface.

#include <sunder/skinning/skinned_mesh.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include <gtest/gtest.h>

#include "skinning/internal/reference.h"
#include "support/machine/allocation_count.h"
#include "support/machine/backward_threads.h"
#include "support/machine/stress.h"
#include "support/models/posed_arrays.h"
#include "support/models/random_displacements.h"
#include "support/models/random_skin.h"

namespace sunder {
namespace {

using test::make_soft;
using test::PosedArrays;
using test::Random;
using test::RandomSkin;
using test::Soft;
using test::with_zero;

/// As in skinned_mesh_test.cpp: in order, gathered, sparse; sizes around that of a block and above
/// that of a window.
std::vector<RandomSkin> kinds() {
  return {{1, 1, 1, 0, false, 1},      {17, 8, 8, 2, true, 8},        {333, 60, 4, 3, true, 6},
          {500, 300, 4, 0, true, 300}, {700, 400, 24, 1, false, 400}, {1000, 5, 1, 0, false, 5},
          {5000, 64, 4, 1, false, 6},  {9000, 64, 8, 0, true, 64},    {9000, 12, 1, 0, false, 12}};
}

/// Neighbours share their bones in the first window and not in later ones.
void share_bones_in_first_window(Mesh& mesh) {
  SkinWeights weights;
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    const auto influences = mesh.weights.of(v);
    if (v < 4096)
      weights.append(std::vector<Influence>{{v / 1000, 1.0f}});
    else
      weights.append(std::vector<Influence>(influences.begin(), influences.end()));
  }
  mesh.weights = weights;
}

SkinnedMesh skinned(const Mesh& mesh, std::size_t slots) {
  Result<SkinnedMesh> made = SkinnedMesh::create(source_of(mesh), slots);
  EXPECT_TRUE(made) << made.error().text();
  return std::move(*made);
}

/// sum_k w_k U_k.
Vec3d displacement_of(const Soft& soft, std::uint32_t vertex) {
  Vec3d sum = Vec3d::Zero();
  if (soft.rows[vertex] == kNone) return sum;
  const ParticleInfluences& by = soft.influences[soft.rows[vertex]];
  for (std::size_t k = 0; k < 4; ++k)
    sum += double{by.weights[k]} * soft.displacements[by.particles[k]].head<3>().cast<double>();
  return sum;
}

std::vector<bool> moved_vertices(const Soft& soft) {
  std::vector<bool> is_moved(soft.rows.size());
  for (const IndexRange& range : soft.moved)
    for (std::uint32_t v = range.first; v < range.first + range.count; ++v) is_moved[v] = true;
  return is_moved;
}

bool has_same_bits(const Vec3f& a, const Vec3f& b) {
  return std::memcmp(a.data(), b.data(), sizeof(a)) == 0;
}

TEST(VertexDisplacements, agree_with_the_definition_in_double) {
  Random random(1);
  for (const RandomSkin& kind : kinds())
    for (const std::size_t padding : {0, 3}) {
      const Mesh mesh = test::make_random_skin(random, kind);
      const auto exact = test::random_palette(random, kind.slots);
      const std::vector<float> weights(kind.morph_targets, 0.4f);
      BonePalette palette = *BonePalette::create(kind.slots, kind.morph_targets);
      ASSERT_TRUE(palette.set(test::in_float(exact), weights));
      const SkinnedMesh made = skinned(mesh, kind.slots);
      Soft soft = make_soft(random, kind.vertices);
      PosedArrays bones(mesh, padding);
      PosedBuffer to_bones(bones.target());
      ASSERT_TRUE(made.deform(palette, to_bones));
      for (int round = 0; round < 6; ++round) {
        soft.move_some(random);
        PosedArrays posed(mesh, padding);
        PosedBuffer buffer(posed.target());
        const VertexDisplacements view = soft.view(false);
        ASSERT_TRUE(made.deform(palette, buffer, {}, &view));
        const std::vector<bool> is_moved = moved_vertices(soft);
        for (std::uint32_t v = 0; v < kind.vertices; ++v) {
          if (!is_moved[v]) {
            ASSERT_TRUE(posed.is_same(v, bones, v)) << "vertex " << v << " is in no range";
            continue;
          }
          const Vec3d expected =
              deform_position_reference(mesh, v, exact, weights) + displacement_of(soft, v);
          ASSERT_LT((posed.position(v).cast<double>() - expected).norm(), 1e-6) << "vertex " << v;
          ASSERT_TRUE(has_same_bits(posed.normal(v), bones.normal(v)))
              << "without gradients normals are as bones turn them";
        }
        EXPECT_TRUE(posed.margins_are_untouched());
      }
    }
}

/// Whether ranges are ascending, disjoint, and contain every changed vertex.
void expect_ranges_cover(std::span<const IndexRange> ranges, const std::vector<bool>& changed) {
  std::vector<bool> covered(changed.size());
  std::uint32_t end = 0;
  for (const IndexRange& range : ranges) {
    ASSERT_GT(range.count, 0u);
    ASSERT_TRUE(range.first > end || (range.first == 0 && end == 0)) << "ranges touch or descend";
    end = range.first + range.count;
    ASSERT_LE(end, changed.size());
    std::fill(covered.begin() + range.first, covered.begin() + end, true);
  }
  for (std::size_t v = 0; v < changed.size(); ++v)
    ASSERT_TRUE(covered[v] || !changed[v]) << "vertex " << v << " changed unreported";
}

TEST(VertexDisplacements, have_the_same_bits_after_any_earlier_displacement) {
  for (int seed = 1; seed <= test::stressed(3, 30); ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    for (const SkinningMethod method : {SkinningMethod::linear, SkinningMethod::dual_quaternion})
      for (const RandomSkin& kind : kinds()) {
        Mesh mesh = test::make_random_skin(random, kind);
        if (kind.slots == 12 && seed % 2 == 0) share_bones_in_first_window(mesh);
        const SkinnedMesh made = skinned(mesh, kind.slots);
        auto matrices = test::in_float(test::random_palette(random, kind.slots, 1.2));
        const std::vector<float> weights(kind.morph_targets, 0.4f);
        BonePalette palette = *BonePalette::create(kind.slots, kind.morph_targets, method);
        ASSERT_TRUE(palette.set(matrices, weights));
        Soft soft = make_soft(random, kind.vertices);
        const std::size_t padding = random.index(2) == 0 ? 0 : 2;
        const bool unit_length = random.index(2) == 0;
        PosedArrays posed(mesh, padding, unit_length), before(mesh, padding, unit_length);
        PosedBuffer buffer(posed.target());
        for (int frame = 0; frame < 12; ++frame) {
          if (random.index(2) == 0) {
            matrices[random.index(kind.slots)] =
                test::in_float(test::random_palette(random, 1, 1.2))[0];
            ASSERT_TRUE(palette.set(matrices, weights));
          }
          if (random.index(2) == 0) soft.move_some(random);
          if (random.index(2) == 0) soft.displace(random);
          if (random.index(4) == 0) continue;  // a frame without deform()
          const VertexDisplacements view = soft.view(random.index(2) == 0);
          const VertexDisplacements* displacements = random.index(5) == 0 ? nullptr : &view;
          const Status status = made.deform(palette, buffer, {}, displacements);
          ASSERT_TRUE(status) << status.text();

          PosedArrays anew(mesh, padding, unit_length);
          PosedBuffer to_anew(anew.target());
          ASSERT_TRUE(made.deform(palette, to_anew, {}, displacements));
          ASSERT_EQ(posed.first_difference(anew), kNone);
          std::vector<bool> changed(kind.vertices);
          for (std::uint32_t v = 0; v < kind.vertices; ++v)
            changed[v] = !posed.is_same(v, before, v);
          expect_ranges_cover(buffer.dirty_vertices(), changed);
          PosedBuffer to_before(before.target());
          ASSERT_TRUE(made.deform(palette, to_before, {}, displacements));
        }
        EXPECT_TRUE(posed.margins_are_untouched());
      }
  }
}

TEST(VertexDisplacements, follow_vertices_that_come_and_go) {
  for (int seed = 1; seed <= test::stressed(3, 30); ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    for (RandomSkin kind :
         {RandomSkin{900, 40, 4, 0, false, 6}, RandomSkin{900, 12, 1, 0, false, 12}}) {
      const Mesh whole = test::make_random_skin(random, kind);
      const auto first_vertices = [&](std::uint32_t count) {
        Mesh mesh = whole;
        mesh.positions.resize(count);
        mesh.normals.resize(count);
        mesh.weights.first.resize(count + 1);
        mesh.weights.influences.resize(mesh.weights.first[count]);
        return mesh;
      };
      BonePalette palette = *BonePalette::create(kind.slots, 0);
      ASSERT_TRUE(palette.set(test::in_float(test::random_palette(random, kind.slots)), {}));
      std::uint32_t count = 600;
      SkinnedMesh made = skinned(first_vertices(count), kind.slots);
      PosedArrays posed(whole);
      PosedBuffer buffer(posed.target());
      Soft soft = make_soft(random, kind.vertices);
      for (int step = 0; step < 20; ++step) {
        const std::uint32_t next = 1 + random.index(899);
        ASSERT_TRUE(made.update(source_of(first_vertices(next)), std::min(count, next)));
        count = next;
        if (random.index(3) == 0) continue;
        buffer.set_vertex_count(count);
        soft.rows.resize(count, 7);
        soft.move_some(random);
        const VertexDisplacements view = soft.view();
        ASSERT_TRUE(made.deform(palette, buffer, {}, &view));
        const Mesh mesh = first_vertices(count);
        PosedArrays anew(mesh);
        PosedBuffer to_anew(anew.target());
        ASSERT_TRUE(made.deform(palette, to_anew, {}, &view));
        for (std::uint32_t v = 0; v < count; ++v)
          ASSERT_TRUE(posed.is_same(v, anew, v)) << "vertex " << v << " of " << count;
      }
    }
  }
}

TEST(VertexDisplacements, have_the_same_bits_at_every_number_of_tasks) {
  Random random(4);
  const RandomSkin kind = {40000, 64, 4, 0, true, 8};
  const Mesh mesh = test::make_random_skin(random, kind);
  const SkinnedMesh made = skinned(mesh, kind.slots);
  BonePalette palette = *BonePalette::create(kind.slots, 0);
  ASSERT_TRUE(palette.set(test::in_float(test::random_palette(random, kind.slots)), {}));
  Soft soft = make_soft(random, kind.vertices, 500);
  soft.moved = {{5, 1}, {6, 20000}, {25000, 0}, {30001, 9999}};
  const VertexDisplacements view = soft.view();
  PosedArrays alone(mesh);
  PosedBuffer buffer(alone.target());
  ASSERT_TRUE(made.deform(palette, buffer, {}, &view));
  for (const std::uint32_t threads : {1u, 2u, 4u, 8u}) {
    test::BackwardThreads pool{threads};
    PosedArrays posed(mesh);
    PosedBuffer of_threads(posed.target());
    ASSERT_TRUE(made.deform(palette, of_threads, pool.hook(), &view));
    EXPECT_EQ(pool.calls, 2u);
    EXPECT_EQ(posed.first_difference(alone), kNone) << threads << " threads";
    EXPECT_TRUE(posed.margins_are_untouched());
  }
}

TEST(VertexDisplacements, only_blocks_that_are_displaced_or_were_are_written) {
  Random random(5);
  for (const RandomSkin& kind :
       {RandomSkin{2000, 50, 3, 0, false, 4}, RandomSkin{9000, 12, 1, 0, false, 12}}) {
    const Mesh mesh = test::make_random_skin(random, kind);
    const SkinnedMesh made = skinned(mesh, kind.slots);
    BonePalette palette = *BonePalette::create(kind.slots, 0);
    ASSERT_TRUE(palette.set(test::in_float(test::random_palette(random, kind.slots)), {}));
    PosedArrays posed(mesh);
    PosedBuffer buffer(posed.target());
    ASSERT_TRUE(made.deform(palette, buffer));
    Soft soft = make_soft(random, kind.vertices);
    const auto written = [&](std::vector<IndexRange> moved) {
      soft.moved = std::move(moved);
      posed.erase();
      const VertexDisplacements view = soft.view();
      EXPECT_TRUE(made.deform(palette, buffer, {}, &view));
      std::uint32_t count = 0;
      for (std::uint32_t v = 0; v < kind.vertices; ++v) count += !posed.is_untouched(v);
      for (const IndexRange& range : soft.moved) EXPECT_FALSE(posed.is_untouched(range.first));
      return count;
    };
    EXPECT_EQ(written({}), 0u);
    EXPECT_EQ(written({{1000, 1}}), 16u);
    EXPECT_EQ(written({{1000, 1}}), 16u) << "displacements may have changed";
    EXPECT_EQ(written({{10, 1}, {1900, 1}}), 48u);
    EXPECT_EQ(written({}), 32u) << "back to where bones put them";
    EXPECT_EQ(written({}), 0u);
    EXPECT_TRUE(buffer.dirty_vertices().empty());
    const VertexDisplacements nothing;
    EXPECT_TRUE(made.deform(palette, buffer, {}, &nothing));
    EXPECT_TRUE(buffer.dirty_vertices().empty());
  }
}

TEST(VertexDisplacements, frames_allocate_nothing_once_warm) {
  Random random(6);
  const RandomSkin kind = {9000, 12, 1, 0, false, 12};
  const Mesh mesh = test::make_random_skin(random, kind);
  const SkinnedMesh made = skinned(mesh, kind.slots);
  BonePalette palette = *BonePalette::create(kind.slots, 0);
  ASSERT_TRUE(palette.set(test::in_float(test::random_palette(random, kind.slots)), {}));
  PosedArrays posed(mesh);
  PosedBuffer buffer(posed.target());
  Soft soft = make_soft(random, kind.vertices);
  soft.moved = {{3, 2000}, {4095, 2}, {8999, 1}};
  const VertexDisplacements view = soft.view();
  ASSERT_TRUE(made.deform(palette, buffer, {}, &view));
  ASSERT_TRUE(made.deform(palette, buffer));
  const std::uint64_t before = test::allocation_count();
  for (int frame = 0; frame < 6; ++frame)
    ASSERT_TRUE(made.deform(palette, buffer, {}, frame % 3 == 2 ? nullptr : &view));
  EXPECT_EQ(test::allocation_count(), before);
}

/// A sheet in the plane z = 0 on one bone, four particles with smooth weights, tangents along x.
struct Sheet {
  static constexpr std::uint32_t kCells = 20;
  Mesh mesh;
  Soft soft;
  Mat3d turn = Mat3d::Identity();
  std::array<Vec3d, 4> directions;

  explicit Sheet(Random& random) {
    for (std::uint32_t i = 0; i <= kCells; ++i)
      for (std::uint32_t j = 0; j <= kCells; ++j) {
        const double x = 0.05 * i, y = 0.05 * j;
        mesh.positions.push_back(Vec3d(x, y, 0).cast<float>());
        mesh.normals.emplace_back(0.0f, 0.0f, 1.0f);
        mesh.tangents.emplace_back(1.0f, 0.0f, 0.0f, -1.0f);
        mesh.weights.append(std::vector<Influence>{{0, 1.0f}});
        std::array<std::uint32_t, 4> order = {0, 1, 2, 3};
        const std::array<double, 4> weights = weights_at(mesh.positions.back().cast<double>());
        std::sort(order.begin(), order.end(),
                  [&](std::uint32_t a, std::uint32_t b) { return weights[a] > weights[b]; });
        ParticleInfluences influences;
        ParticleGradients gradients;
        for (std::size_t k = 0; k < 4; ++k) {
          influences.particles[k] = gradients.particles[k] = order[k];
          influences.weights[k] = static_cast<float>(weights[order[k]]);
          for (int axis = 0; axis < 2; ++axis) {
            Vec3d step = Vec3d::Zero();
            step[axis] = 1e-5;
            const Vec3d at = mesh.positions.back().cast<double>();
            gradients.of_weights[k][axis] = static_cast<float>(
                (weights_at(at + step)[order[k]] - weights_at(at - step)[order[k]]) / 2e-5);
          }
        }
        soft.influences.push_back(influences);
        soft.gradients.push_back(gradients);
        soft.rows.push_back(static_cast<std::uint32_t>(soft.rows.size()));
      }
    for (Vec3d& direction : directions) direction = random.direction();
    soft.moved = {{0, mesh.vertex_count()}};
  }

  /// Products of squared sines and cosines, which sum to one.
  static std::array<double, 4> weights_at(const Vec3d& at) {
    const double a = std::pow(std::sin(1.3 * at.x() + 0.4 * at.y() + 0.2), 2),
                 b = std::pow(std::sin(1.7 * at.y() + 0.5), 2);
    return {a * b, a * (1 - b), (1 - a) * b, (1 - a) * (1 - b)};
  }
  [[nodiscard]] Vec3d surface(const Vec3d& at, double amount) const {
    const auto weights = weights_at(at);
    Vec3d sum = turn * at;
    for (std::size_t k = 0; k < 4; ++k) sum += amount * weights[k] * directions[k];
    return sum;
  }
  [[nodiscard]] Vec3d slope(const Vec3d& at, int axis, double amount) const {
    Vec3d step = Vec3d::Zero();
    step[axis] = 1e-5;
    return (surface(at + step, amount) - surface(at - step, amount)) / 2e-5;
  }
};

double angle_between(const Vec3d& a, const Vec3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

TEST(VertexDisplacements, turn_normals_as_the_displaced_surface_turns) {
  Random random(7);
  for (int round = 0; round < 10; ++round)
    for (const bool unit_length : {false, true}) {
      Sheet sheet(random);
      Affine3d bone = test::random_palette(random, 1)[0];
      if (round % 2 == 1) bone.linear() = bone.linear() * Mat3d(Vec3d(1.3, 0.8, 1.1).asDiagonal());
      sheet.turn = bone.linear();
      BonePalette palette = *BonePalette::create(1, 0);
      ASSERT_TRUE(palette.set(test::in_float({bone}), {}));
      const SkinnedMesh made = skinned(sheet.mesh, 1);
      sheet.soft.matrices.assign(4, Mat3d(bone.linear().inverse().transpose()).cast<float>());
      PosedArrays bones(sheet.mesh, 0, unit_length);
      PosedBuffer to_bones(bones.target());
      ASSERT_TRUE(made.deform(palette, to_bones));
      double last = 0, undisplaced = 0;
      for (const double amount : {0.08, 0.04, 0.02}) {
        sheet.soft.displacements.clear();
        for (const Vec3d& direction : sheet.directions)
          sheet.soft.displacements.push_back(with_zero((amount * direction).cast<float>()));
        PosedArrays posed(sheet.mesh, 0, unit_length);
        PosedBuffer buffer(posed.target());
        const VertexDisplacements view = sheet.soft.view();
        ASSERT_TRUE(made.deform(palette, buffer, {}, &view));
        double worst = 0;
        for (std::uint32_t v = 0; v < sheet.mesh.vertex_count(); ++v) {
          const Vec3d at = sheet.mesh.positions[v].cast<double>();
          const Vec3d along_x = sheet.slope(at, 0, amount), along_y = sheet.slope(at, 1, amount);
          const Vec3d normal = along_x.cross(along_y) * (bone.linear().determinant() < 0 ? -1 : 1);
          worst = std::max(worst, angle_between(posed.normal(v).cast<double>(), normal));
          undisplaced =
              std::max(undisplaced, angle_between(bones.normal(v).cast<double>(), normal));
          ASSERT_NEAR(posed.normal(v).norm(), unit_length ? 1.0f : bones.normal(v).norm(), 1e-6);

          const Vec3d tangent = posed.tangent(v).head<3>().cast<double>();
          ASSERT_LT(angle_between(tangent, along_x), 2e-6) << "tangents follow exactly";
          ASSERT_NEAR(tangent.norm(), unit_length ? 1.0 : bones.tangent(v).head<3>().norm(), 1e-6);
          ASSERT_EQ(posed.tangent(v).w(), -1.0f);
        }
        ASSERT_LT(worst, 2e-6) << "normals follow exactly, however far";
        last = worst;
      }
      EXPECT_GT(undisplaced, 0.02);
      EXPECT_LT(last, 0.1 * undisplaced);
    }
}

TEST(VertexDisplacements, keep_lengths_whose_squares_floats_do_not_hold) {
  Random random(9);
  Sheet sheet(random);
  BonePalette palette = *BonePalette::create(1, 0);
  ASSERT_TRUE(palette.set(test::in_float({test::random_palette(random, 1)[0]}), {}));
  sheet.soft.matrices.assign(4, Mat3f::Identity());
  for (const Vec3d& direction : sheet.directions)
    sheet.soft.displacements.push_back(with_zero((0.1 * direction).cast<float>()));
  const VertexDisplacements view = sheet.soft.view();
  const auto pose_into = [&](PosedArrays& posed, const VertexDisplacements* displacements) {
    PosedBuffer buffer(posed.target());
    ASSERT_TRUE(skinned(sheet.mesh, 1).deform(palette, buffer, {}, displacements));
  };
  PosedArrays ordinary(sheet.mesh);
  pose_into(ordinary, &view);
  const auto factor_of = [](std::uint32_t v) {  // beside one another, and most are ordinary
    return v % 5 == 1 ? 1e-30f : v % 5 == 3 ? 1e25f : 1.0f;
  };
  for (std::uint32_t v = 0; v < sheet.mesh.vertex_count(); ++v) {
    sheet.mesh.normals[v] *= factor_of(v);
    sheet.mesh.tangents[v].head<3>() *= factor_of(v);
  }
  PosedArrays bones(sheet.mesh), posed(sheet.mesh);
  pose_into(bones, nullptr);
  pose_into(posed, &view);
  for (std::uint32_t v = 0; v < sheet.mesh.vertex_count(); ++v) {
    const Vec3d normal = posed.normal(v).cast<double>();
    EXPECT_NEAR(normal.norm() / bones.normal(v).cast<double>().norm(), 1, 1e-6);
    EXPECT_LT(angle_between(normal / factor_of(v), ordinary.normal(v).cast<double>()), 1e-6);
    EXPECT_NEAR(posed.tangent(v).head<3>().cast<double>().norm() /
                    bones.tangent(v).head<3>().cast<double>().norm(),
                1, 1e-6);
    if (factor_of(v) != 1.0f) continue;
    EXPECT_EQ(posed.normal(v), ordinary.normal(v)) << "as without unusual neighbours";
    EXPECT_EQ(posed.tangent(v), ordinary.tangent(v));
  }
}

TEST(VertexDisplacements, gradients_are_turned_by_the_mean_of_the_particles) {
  Random random(8);
  const RandomSkin kind = {300, 20, 4, 0, true, 6};
  const Mesh mesh = test::make_random_skin(random, kind);
  const SkinnedMesh made = skinned(mesh, kind.slots);
  BonePalette palette = *BonePalette::create(kind.slots, 0);
  ASSERT_TRUE(palette.set(test::in_float(test::random_palette(random, kind.slots)), {}));
  Soft soft = make_soft(random, kind.vertices);
  soft.moved = {{0, kind.vertices}};
  PosedArrays bones(mesh), posed(mesh);
  PosedBuffer to_bones(bones.target()), buffer(posed.target());
  const VertexDisplacements view = soft.view();
  ASSERT_TRUE(made.deform(palette, to_bones));
  ASSERT_TRUE(made.deform(palette, buffer, {}, &view));
  for (std::uint32_t v = 0; v < kind.vertices; ++v) {
    const Vec3d n = bones.normal(v).cast<double>(), t = bones.tangent(v).head<3>().cast<double>();
    Vec3d normal = n, tangent = t;
    if (soft.rows[v] != kNone && soft.influences[soft.rows[v]].weights[0] > 0) {
      const ParticleInfluences& by = soft.influences[soft.rows[v]];
      Mat3d mean = Mat3d::Zero();
      for (std::size_t k = 0; k < 4; ++k)
        mean += double{by.weights[k]} * soft.matrices[by.particles[k]].cast<double>();
      Mat3d map = Mat3d::Identity();
      for (std::size_t k = 0; k < 4; ++k) {
        const ParticleGradients& of = soft.gradients[soft.rows[v]];
        const Vec3d u = soft.displacements[of.particles[k]].head<3>().cast<double>();
        const Vec3d g = mean * of.of_weights[k].cast<double>();
        map += u * g.transpose();
      }
      const Vec3d across = n.cross(Vec3d::Unit(std::abs(n.x()) < 0.5 * n.norm() ? 0 : 1));
      normal = (map * across).cross(map * n.cross(across));
      tangent = map * t;
      tangent -= normal * (normal.dot(tangent) / normal.squaredNorm());
    }
    ASSERT_LT((posed.normal(v).cast<double>() - normal * (n.norm() / normal.norm())).norm(), 1e-6)
        << "vertex " << v;
    ASSERT_LT(
        (posed.tangent(v).head<3>().cast<double>() - tangent * (t.norm() / tangent.norm())).norm(),
        1e-5)
        << "vertex " << v;
  }
}

TEST(VertexDisplacements, that_do_not_fit_are_refused_and_nothing_is_written) {
  Random random(9);
  const RandomSkin kind = {50, 6, 4, 0, false, 6};
  const Mesh mesh = test::make_random_skin(random, kind);
  const SkinnedMesh made = skinned(mesh, kind.slots);
  BonePalette palette = *BonePalette::create(kind.slots, 0);
  ASSERT_TRUE(palette.set(test::in_float(test::random_palette(random, kind.slots)), {}));
  Soft good = make_soft(random, kind.vertices);
  good.moved = {{0, 10}, {10, 40}};
  PosedArrays posed(mesh);
  PosedBuffer buffer(posed.target());
  const auto expect_fault = [&](const Soft& soft, StatusCode code, std::uint32_t index) {
    const VertexDisplacements view = soft.view();
    const Status fault = made.deform(palette, buffer, {}, &view);
    EXPECT_EQ(fault.code(), code) << fault.text();
    EXPECT_EQ(fault.index(), index) << fault.text();
  };
  Soft bad = good;
  bad.rows.pop_back();
  expect_fault(bad, StatusCode::size_mismatch, kNone);
  bad = good;
  bad.gradients.pop_back();
  expect_fault(bad, StatusCode::size_mismatch, kNone);
  bad = good;
  bad.matrices.pop_back();
  expect_fault(bad, StatusCode::size_mismatch, kNone);
  bad = good;
  bad.moved[1].count = 41;
  expect_fault(bad, StatusCode::index_out_of_range, 1);
  bad.moved[1] = {0xFFFF'FFFFu, 2};
  expect_fault(bad, StatusCode::index_out_of_range, 1);
  bad.moved[1] = {9, 1};
  expect_fault(bad, StatusCode::index_out_of_range, 1);
  for (std::uint32_t v = 0; v < kind.vertices; ++v) ASSERT_TRUE(posed.is_untouched(v));

  // An index beyond the last row means no row.
  Soft same = good;
  for (std::uint32_t& row : same.rows)
    if (row == kNone) row = static_cast<std::uint32_t>(good.influences.size());
  PosedArrays expected(mesh);
  PosedBuffer to_expected(expected.target());
  const VertexDisplacements view = good.view(), same_view = same.view();
  ASSERT_TRUE(made.deform(palette, buffer, {}, &same_view));
  ASSERT_TRUE(made.deform(palette, to_expected, {}, &view));
  EXPECT_EQ(posed.first_difference(expected), kNone);

  const SkinnedMesh empty = skinned(Mesh(), 3);
  BonePalette of_empty = *BonePalette::create(3, 0);
  ASSERT_TRUE(of_empty.set(std::vector<Affine3f>(3, Affine3f::Identity()), {}));
  PosedBuffer nothing({});
  Soft none;
  none.moved = {{0, 0}};
  const VertexDisplacements view_of_none = none.view();
  EXPECT_TRUE(empty.deform(of_empty, nothing, {}, &view_of_none));
}

}  // namespace
}  // namespace sunder
