// A soft instance loses a piece: its particles and vertices go, and come back by undo.
#include <sunder/scene/character_instance.h>
#include <sunder/scene/scene_command.h>
#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <vector>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <gtest/gtest.h>

#include "support/machine/random.h"
#include "support/models/rigs.h"

namespace sunder {
namespace {

using test::Random;

std::uint32_t count_used(const ParticleSet& set) {
  std::set<std::uint32_t> used;
  for (const ParticleInfluences& row : set.influences())
    for (std::size_t i = 0; i < 4; ++i)
      if (row.weights[i] > 0) used.insert(row.particles[i]);
  return static_cast<std::uint32_t>(used.size());
}

struct DetachCase {
  std::shared_ptr<const Character> tube =
      std::make_shared<const Character>(test::make_tube(40, 24, 3));
  ModelPose pose = *rest_pose(*tube);
  CharacterInstance instance;

  explicit DetachCase(bool is_soft) : instance(make(tube, is_soft)) {}
  static CharacterInstance make(const std::shared_ptr<const Character>& tube, bool is_soft) {
    CharacterAssetOptions options;
    if (is_soft) options.soft.emplace();
    auto made = CharacterInstance::create(tube, options);
    EXPECT_TRUE(made) << made.error().text();
    EXPECT_TRUE(made->prepare_to_tear());
    return std::move(*made);
  }
  /// The top of the tube. @return its place.
  PieceNear cut_off() {
    const auto positions = test::posed_positions(*tube, 0, pose);
    double least = 1e9, most = -1e9;
    for (const Vec3d& p : positions) {
      least = std::min(least, p.y());
      most = std::max(most, p.y());
    }
    PlaneCut cut;
    cut.point = Vec3d(0, 0.4 * least + 0.6 * most + 0.0013, 0);
    cut.normal = Vec3d(0, 1, 0);
    cut.caps = true;
    EXPECT_TRUE(instance.cut(pose, cut));
    return PieceNear{Vec3d(0, most + 1, 0)};
  }
};

TEST(DetachFromInstance, released_vertices_are_not_skinned) {
  DetachCase scene(false);
  Random random(1);
  const auto advance = [&] {
    EXPECT_TRUE(scene.instance.advance(test::random_pose(*scene.tube, random), 0.01));
    EXPECT_TRUE(scene.instance.draw());
    return scene.instance.drawn_vertices();
  };
  (void)advance();
  const PieceNear place = scene.cut_off();
  (void)advance();
  const std::uint32_t all = advance();
  const auto piece = scene.instance.detach(scene.pose, place);
  ASSERT_TRUE(piece) << piece.error().text();
  (void)advance();
  EXPECT_LT(advance(), all);
  ASSERT_TRUE(scene.instance.undo());
  (void)advance();
  EXPECT_EQ(advance(), all);
  // In one frame: detached, put back, and the cut undone.
  ASSERT_TRUE(scene.instance.redo());
  ASSERT_TRUE(scene.instance.undo());
  ASSERT_TRUE(scene.instance.undo());
  (void)advance();
  const ModelPose pose = test::random_pose(*scene.tube, random);
  ASSERT_TRUE(scene.instance.advance(pose, 0.01));
  ASSERT_TRUE(scene.instance.draw());
  auto fresh = DetachCase::make(scene.tube, false);
  ASSERT_TRUE(fresh.advance(pose, 0.01));
  ASSERT_TRUE(fresh.draw());
  const auto now = scene.instance.mesh(0).positions, expected = fresh.mesh(0).positions;
  EXPECT_TRUE(std::equal(now.begin(), now.end(), expected.begin(), expected.end()));
}

TEST(DetachFromInstance, vertices_released_before_they_were_posed_are_zero) {
#ifdef __GLIBC__
  mallopt(M_PERTURB, 1);  // new memory is full of 0xFE
#endif
  DetachCase scene(false);
  ASSERT_TRUE(scene.instance.advance(scene.pose, 0.01));
  ASSERT_TRUE(scene.instance.draw());
  const std::size_t before = scene.instance.mesh(0).positions.size();
  // Both in one frame: the vertices along the cut that only the piece has are never posed.
  ASSERT_TRUE(scene.instance.detach(scene.pose, scene.cut_off()));
  ASSERT_TRUE(scene.instance.advance(scene.pose, 0.01));
  ASSERT_TRUE(scene.instance.draw());
  const auto positions = scene.instance.mesh(0).positions;
  ASSERT_GT(positions.size(), before);
  for (std::size_t v = 0; v < positions.size(); ++v)
    EXPECT_LT(positions[v].cwiseAbs().maxCoeff(), 100.0f) << "vertex " << v;
#ifdef __GLIBC__
  mallopt(M_PERTURB, 0);
#endif
}

TEST(DetachFromInstance, particles_of_the_piece_vanish) {
  DetachCase scene(true);
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(scene.instance.advance(scene.pose, 0.01));
  const PieceNear place = scene.cut_off();
  const std::uint32_t before = count_used(*scene.instance.particles());
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(scene.instance.advance(scene.pose, 0.01));
  const std::uint32_t before_settled = count_used(*scene.instance.particles());
  const auto piece = scene.instance.detach(scene.pose, place);
  ASSERT_TRUE(piece) << piece.error().text();
  // No particle of the piece is left to move anything.
  const auto points = scene.instance.particles()->vertex_points(0);
  std::set<std::uint32_t> old_points;
  for (const auto& corners : piece->meshes[0].old_points)
    old_points.insert(corners.begin(), corners.end());
  std::set<std::uint32_t> of_body, of_piece;
  const auto rows = scene.instance.particles()->influences();
  const Mesh& mesh = scene.instance.character().meshes[0];
  for (const Triangle& triangle : mesh.triangles) {
    if (is_retired(triangle)) continue;
    for (const std::uint32_t v : triangle)
      for (std::size_t i = 0; i < 4; ++i)
        if (points[v] < rows.size() && rows[points[v]].weights[i] > 0)
          of_body.insert(rows[points[v]].particles[i]);
  }
  for (const std::uint32_t point : old_points)
    if (point < rows.size())
      for (std::size_t i = 0; i < 4; ++i)
        if (rows[point].weights[i] > 0) of_piece.insert(rows[point].particles[i]);
  EXPECT_TRUE(of_piece.empty()) << of_piece.size() << " of " << before;
  EXPECT_LT(of_body.size(), before);
  // Work far from the cut is done in later frames.
  const auto settle = [&] {
    for (int i = 0; i < 5; ++i) ASSERT_TRUE(scene.instance.advance(scene.pose, 0.01));
  };
  settle();
  const std::uint32_t settled = count_used(*scene.instance.particles());
  ASSERT_TRUE(scene.instance.undo());
  settle();
  EXPECT_EQ(count_used(*scene.instance.particles()), before_settled);
  ASSERT_TRUE(scene.instance.redo());
  settle();
  EXPECT_EQ(count_used(*scene.instance.particles()), settled);

  // The piece is soft tissue of its own.
  auto soft = DetachCase::make(piece->character, true);
  const auto rest = rest_pose(*piece->character);
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(soft.advance(*rest, 0.01));
  EXPECT_GT(count_used(*soft.particles()), 0u);
}

/// The root of the mean square.
double magnitude(const std::vector<Vec3d>& vectors) {
  double sum = 0;
  for (const Vec3d& vector : vectors) sum += vector.squaredNorm();
  return std::sqrt(sum / static_cast<double>(vectors.size()));
}

TEST(DetachFromInstance, a_piece_keeps_the_motion_of_its_tissue) {
  for (const PieceMotion motion : {PieceMotion::animated, PieceMotion::frozen}) {
    DetachCase scene(true);
    for (int i = 0; i < 5; ++i) ASSERT_TRUE(scene.instance.advance(scene.pose, 0.01));
    const PieceNear place = scene.cut_off();
    ASSERT_TRUE(scene.instance.advance(scene.pose, 0.01));
    SoftBody& body = *scene.instance.body();
    for (std::uint32_t p = 0; p < body.particle_count(); ++p)
      ASSERT_TRUE(body.add_impulse(p, body.mass(p) * Vec3d(1, 2, 0)));
    for (int i = 0; i < 3; ++i) ASSERT_TRUE(scene.instance.advance(scene.pose, 0.01));

    PieceTissue tissue;
    DetachOptions options;
    options.motion = motion;
    const auto piece = scene.instance.detach(scene.pose, place, options, nullptr, &tissue);
    ASSERT_TRUE(piece) << piece.error().text();
    ASSERT_EQ(tissue.influences.size(), piece->points.size());
    ASSERT_FALSE(piece->points.empty());
    CharacterInstance detached = DetachCase::make(piece->character, true);
    ASSERT_TRUE(detached.inherit_motion(*piece, tissue));

    std::vector<Vec3d> wanted, missing, wanted_velocities, missing_velocities;
    const auto points = detached.particles()->vertex_points(0);
    const std::vector<Triangle>& triangles = piece->character->meshes[0].triangles;
    for (std::size_t t = 0; t < triangles.size(); ++t)
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const std::uint32_t old_point = piece->meshes[0].old_points[t][corner];
        const auto at = std::ranges::lower_bound(piece->points, old_point);
        ASSERT_TRUE(at != piece->points.end() && *at == old_point);
        const auto i = static_cast<std::size_t>(at - piece->points.begin());
        const PointMotion of = motion_at(tissue.influences[i], tissue.particles);
        if (!of.is_known) continue;
        const std::uint32_t point = points[triangles[t][corner]];
        wanted.push_back(of.displacement);
        missing.push_back(of.displacement - detached.body()->point_displacement(point));
        wanted_velocities.push_back(of.velocity);
        const ParticleInfluences& influences = detached.particles()->influences()[point];
        missing_velocities.push_back(
            of.velocity - motion_at(influences, detached.body()->particle_motions()).velocity);
      }
    ASSERT_GT(magnitude(wanted), 0);
    ASSERT_GT(magnitude(wanted_velocities), 0);
    EXPECT_LT(magnitude(missing), 0.2 * magnitude(wanted));
    EXPECT_LT(magnitude(missing_velocities), 0.2 * magnitude(wanted_velocities));
    // It goes on moving.
    ASSERT_TRUE(detached.advance(*rest_pose(*piece->character), 0.01));
    EXPECT_TRUE(detached.needs_step());
  }
}

TEST(DetachFromInstance, a_hard_piece_has_no_motion_of_tissue) {
  DetachCase scene(false);
  PieceTissue tissue;
  tissue.influences.emplace_back();
  const PieceNear place = scene.cut_off();
  const auto piece = scene.instance.detach(scene.pose, place, {}, nullptr, &tissue);
  ASSERT_TRUE(piece);
  EXPECT_TRUE(tissue.influences.empty());
  CharacterInstance detached = DetachCase::make(piece->character, false);
  EXPECT_EQ(detached.inherit_motion(*piece, tissue).code(), StatusCode::invalid_argument);
}

}  // namespace
}  // namespace sunder
