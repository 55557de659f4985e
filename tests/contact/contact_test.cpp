// Queries of the posed, torn surface find the same as testing every face.

#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>
#include <sunder/skinning/skinned_mesh.h>
#include <sunder/tear/contact.h>

#include <cmath>
#include <functional>
#include <thread>

#include <gtest/gtest.h>

#include "support/machine/allocation_count.h"
#include "support/machine/stress.h"
#include "support/models/make_model.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"
#include "support/oracles/contact_oracle.h"

namespace sunder {
namespace {

using test::ContactOracle;
using test::Random;

constexpr double kEdge = 1e-7;  ///< Barycentric: nearer to an edge, rounding decides.

Character some_character(Random& random) {
  switch (random.index(4)) {
    case 0: return test::make_soup(random);
    case 1: return test::make_two_tubes(3 + random.index(4), 5 + random.index(6));
    case 2: return test::make_bumpy_ball(100 + random.index(200));
    default: return test::random_character(random);
  }
}

bool has_area(const Character& character) {
  return std::ranges::any_of(character.meshes, [](const Mesh& mesh) {
    return std::ranges::any_of(mesh.triangles, [&](const Triangle& t) {
      return (mesh.positions[t[1]] - mesh.positions[t[0]])
                 .cross(mesh.positions[t[2]] - mesh.positions[t[0]])
                 .norm() > 1e-4f;
    });
  });
}

void tear_at_random(TornModel& model, Random& random, std::uint32_t operations) {
  if (!has_area(model.source())) return;
  for (std::uint32_t i = 0; i < operations; ++i) {
    ASSERT_TRUE(test::play(model, test::random_operation(model, random)));
    if (random.index(4) == 0) (void)model.undo();
  }
}

std::vector<std::vector<Vec3d>> positions_of(const TornModel& model, const ModelPose& pose) {
  std::vector<std::vector<Vec3d>> positions;
  for (std::uint32_t m = 0; m < model.character().meshes.size(); ++m)
    positions.push_back(test::posed_positions(model.character(), m, pose));
  return positions;
}

/// A model, torn at random and in a random pose, its query and its oracle.
struct Case {
  Case(Random& random, std::uint32_t operations)
      : model(test::make_model(some_character(random))), query(*SurfaceQuery::create(model)) {
    tear_at_random(model, random, operations);
    stand_in(test::random_pose(model.source(), random));
  }
  void stand_in(const ModelPose& wanted) {
    pose = wanted;
    const Status status = query.set_pose(pose);
    EXPECT_TRUE(status) << status.text();
    size = test::posed_diagonal(model.character(), pose);
  }
  [[nodiscard]] ContactOracle oracle() const {
    return {model.character(), positions_of(model, pose)};
  }

  TornModel model;
  ModelPose pose;
  SurfaceQuery query;
  double size = 1;
};

/// A place near the surface: on a random face, and moved away from it by up to `far`.
Vec3d place_near(const ContactOracle& oracle, Random& random, double far) {
  const auto& face =
      oracle.faces()[random.index(static_cast<std::uint32_t>(oracle.faces().size()))];
  const double u = random.uniform(0, 1), v = random.uniform(0, 1 - u);
  const Vec3d on = (1 - u - v) * face.corners[0] + u * face.corners[1] + v * face.corners[2];
  return on + random.uniform(0, far) * random.direction();
}

/// Whether rounding decides what a line meets.
bool is_doubtful(const std::vector<ContactOracle::Crossing>& crossings) {
  return std::ranges::any_of(crossings, [](const ContactOracle::Crossing& crossing) {
    return std::abs(crossing.least) < kEdge;
  });
}

/// A contact agrees with itself and with the model.
void expect_sound(const SurfaceContact& contact, const TornModel& model, const ModelPose& pose,
                  double size) {
  const Mesh& mesh = model.character().meshes[contact.mesh];
  const Triangle& triangle = mesh.triangles[contact.triangle];
  ASSERT_FALSE(is_retired(triangle));
  const auto positions = test::posed_positions(model.character(), contact.mesh, pose);
  Vec3d place = Vec3d::Zero();
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_GE(contact.barycentric[k], 0);
    sum += contact.barycentric[k];
    place += contact.barycentric[k] * positions[triangle[k]];
  }
  EXPECT_NEAR(sum, 1, 1e-12);
  EXPECT_LT((place - contact.place).norm(), 1e-12 * size + 1e-12);
  EXPECT_EQ(contact.submesh, mesh.triangle_submesh[contact.triangle]);
  EXPECT_EQ(contact.material, mesh.submeshes[contact.submesh].material);
  std::vector<double> weights(model.character().skeleton.bones.size(), 0.0);
  for (std::size_t k = 0; k < 3; ++k)
    for (const Influence& influence : mesh.weights.of(triangle[k]))
      weights[model.character().skins[mesh.skin].bones[influence.slot]] +=
          contact.barycentric[k] * static_cast<double>(influence.weight);
  EXPECT_NEAR(weights[contact.bone], *std::ranges::max_element(weights), 1e-12);
  EXPECT_EQ(contact.anchor.mesh, contact.mesh);
  EXPECT_EQ(contact.anchor.birth.triangle, model.source_triangle(contact.mesh, contact.triangle));
}

TEST(Contact, rays_find_the_first_face) {
  std::size_t hits = 0, misses = 0;
  for (int seed = 0; seed < test::stressed(60, 20); ++seed) {
    Random random(1000 + seed);
    Case at(random, random.index(4));
    const ContactOracle oracle = at.oracle();
    if (oracle.faces().empty()) continue;
    for (int i = 0; i < 30; ++i) {
      Ray ray;
      ray.origin = place_near(oracle, random, at.size);
      const Vec3d target = place_near(oracle, random, 0.2 * at.size);
      ray.direction = random.uniform(0.1, 5) * (target - ray.origin);
      if (random.index(3) == 0) ray.length = random.uniform(0, at.size);
      const auto crossings = oracle.crossings(ray.origin, ray.direction.normalized(), kEdge);
      if (is_doubtful(crossings)) continue;
      const auto contact = at.query.cast_ray(ray);
      ASSERT_TRUE(contact) << contact.error().text();
      const bool is_met = !crossings.empty() && crossings[0].along <= ray.length;
      ASSERT_EQ(contact->has_value(), is_met) << "seed " << seed << " ray " << i;
      if (!is_met) {
        ++misses;
        continue;
      }
      ++hits;
      const SurfaceContact& found = **contact;
      EXPECT_NEAR(found.distance, crossings[0].along, 1e-9 * at.size);
      const bool is_alone =
          crossings.size() == 1 || crossings[1].along > crossings[0].along + 1e-9 * at.size;
      if (is_alone) {
        EXPECT_EQ(found.mesh, crossings[0].face->mesh);
        EXPECT_EQ(found.triangle, crossings[0].face->triangle);
        EXPECT_EQ(found.enters, crossings[0].enters);
      }
      EXPECT_EQ(found.enters, found.normal.dot(ray.direction) < 0);
      expect_sound(found, at.model, at.pose, at.size);
    }
  }
  EXPECT_GT(hits, 300u);
  EXPECT_GT(misses, 100u);
}

TEST(Contact, blades_find_every_layer_in_order) {
  std::vector<SurfaceContact> contacts;
  std::size_t most = 0;
  for (int seed = 0; seed < test::stressed(60, 20); ++seed) {
    Random random(2000 + seed);
    Case at(random, random.index(4));
    const ContactOracle oracle = at.oracle();
    if (oracle.faces().empty()) continue;
    for (int i = 0; i < 30; ++i) {
      const Blade blade{place_near(oracle, random, at.size),
                        place_near(oracle, random, 0.3 * at.size)};
      const Vec3d way = blade.tip - blade.base;
      if (way.norm() < 1e-3 * at.size) continue;
      auto crossings = oracle.crossings(blade.base, way, kEdge);
      std::erase_if(crossings, [](const auto& crossing) { return crossing.along > 1; });
      if (is_doubtful(crossings)) continue;
      ASSERT_TRUE(at.query.find_blade_contacts(blade, contacts));
      ASSERT_EQ(contacts.size(), crossings.size()) << "seed " << seed << " blade " << i;
      most = std::max(most, contacts.size());
      for (std::size_t k = 0; k < contacts.size(); ++k) {
        EXPECT_NEAR(contacts[k].distance, crossings[k].along * way.norm(), 1e-9 * at.size);
        EXPECT_NEAR(contacts[k].depth, contacts[k].normal.dot(contacts[k].place - blade.tip),
                    1e-12 * at.size);
        if (contacts[k].enters) {
          EXPECT_GE(contacts[k].depth, -1e-9 * at.size);
        }
        expect_sound(contacts[k], at.model, at.pose, at.size);
      }
    }
  }
  EXPECT_GE(most, 4u);
}

TEST(Contact, several_threads_query_one_model) {
  Random random(12);
  const Character tube = test::make_tube(20, 20, 5);
  TornModel model = test::make_model(tube);
  tear_at_random(model, random, 3);
  const ModelPose pose = test::random_pose(tube, random);
  std::vector<Ray> rays;
  for (int i = 0; i < 200; ++i) rays.push_back({3 * random.direction(), random.direction()});
  const auto distances = [&](std::vector<double>& found) {
    SurfaceQuery query = *SurfaceQuery::create(model);
    if (!query.set_pose(pose)) return;
    for (const Ray& ray : rays) {
      const auto hit = query.cast_ray({ray.origin, ray.direction - ray.origin});
      found.push_back(hit && *hit ? (*hit)->distance : -1);
    }
  };
  std::vector<std::vector<double>> found(4);
  std::vector<std::thread> threads;
  for (auto& of_thread : found) threads.emplace_back(distances, std::ref(of_thread));
  for (std::thread& thread : threads) thread.join();
  for (const auto& of_thread : found) EXPECT_EQ(of_thread, found[0]);
  EXPECT_EQ(found[0].size(), rays.size());
  EXPECT_GT(*std::ranges::max_element(found[0]), 0);
}

/// Through the middle of edges and through points, of one body: the numbers of entries and exits
/// agree, and each is found once.
TEST(Contact, a_crossing_on_an_edge_is_found_once) {
  const auto sheet = test::make_sheet(8);
  const TornModel model = test::make_model(sheet);
  auto query = *SurfaceQuery::create(model);
  ASSERT_TRUE(query.set_pose(*bind_pose(sheet)));
  std::vector<SurfaceContact> contacts;
  for (const double x : {0.25, 0.3125, 0.5})
    for (const double y : {0.25, 0.3125, 0.375}) {
      ASSERT_TRUE(query.find_blade_contacts(test::down_at(x, y), contacts));
      ASSERT_EQ(contacts.size(), 1u) << x << ' ' << y;
      EXPECT_DOUBLE_EQ(contacts[0].distance, 0.5);
      EXPECT_DOUBLE_EQ(contacts[0].depth, 0.5);
      EXPECT_TRUE(contacts[0].enters);
      EXPECT_EQ(contacts[0].normal, Vec3d(0, 0, 1));
    }
}

TEST(Contact, capsules_and_points_find_the_nearest_place) {
  std::size_t hits = 0, misses = 0;
  for (int seed = 0; seed < test::stressed(40, 20); ++seed) {
    Random random(3000 + seed);
    Case at(random, random.index(4));
    const ContactOracle oracle = at.oracle();
    if (oracle.faces().empty()) continue;
    for (int i = 0; i < 8; ++i) {
      Capsule capsule;
      capsule.base = place_near(oracle, random, 0.3 * at.size);
      capsule.tip =
          random.index(2) == 0
              ? capsule.base
              : Vec3d(capsule.base + random.uniform(0, 0.4) * at.size * random.direction());
      capsule.radius = random.uniform(0, 0.2) * at.size;
      const double distance = oracle.distance(capsule.base, capsule.tip);
      const auto contact = at.query.find_capsule_contact(capsule);
      ASSERT_TRUE(contact) << contact.error().text();
      if (std::abs(distance - capsule.radius) < 1e-8 * at.size) continue;
      ASSERT_EQ(contact->has_value(), distance < capsule.radius) << "seed " << seed << ' ' << i;
      const auto nearest = at.query.find_nearest(capsule.base);
      ASSERT_TRUE(nearest);
      ASSERT_TRUE(*nearest);
      EXPECT_NEAR((*nearest)->distance, oracle.distance(capsule.base, capsule.base),
                  1e-9 * at.size);
      expect_sound(**nearest, at.model, at.pose, at.size);
      if (!*contact) {
        ++misses;
        continue;
      }
      ++hits;
      // The golden section finds a distance of 0 only to within the root of its rounding.
      EXPECT_NEAR((*contact)->nearest.distance, distance, 1e-7 * at.size);
      EXPECT_GE((*contact)->deepest.depth, (*contact)->nearest.depth);
      expect_sound((*contact)->nearest, at.model, at.pose, at.size);
      expect_sound((*contact)->deepest, at.model, at.pose, at.size);
    }
  }
  EXPECT_GT(hits, 60u);
  EXPECT_GT(misses, 60u);
}

/// Whether a point is below a closed surface is known from the nearest place, on faces, edges and
/// points alike.
TEST(Contact, the_depth_is_positive_inside_a_closed_surface) {
  std::size_t inside = 0, outside = 0;
  for (int seed = 0; seed < test::stressed(12, 20); ++seed) {
    Random random(4000 + seed);
    const Character character = random.index(2) == 0
                                    ? test::make_bumpy_ball(100 + random.index(200))
                                    : test::make_tube(6, 9, 3);
    const TornModel model = test::make_model(character);
    auto query = *SurfaceQuery::create(model);
    const ModelPose pose = test::random_pose(character, random, 0.1, 1.05);
    ASSERT_TRUE(query.set_pose(pose));
    const ContactOracle oracle(character, positions_of(model, pose));
    const double size = test::posed_diagonal(character, pose);
    for (int i = 0; i < 100; ++i) {
      const Vec3d point = place_near(oracle, random, 0.1 * size);
      const double winding = oracle.winding(point);
      if (std::abs(winding - std::round(winding)) > 1e-6) continue;
      const bool is_inside = winding > 0.5;
      (is_inside ? inside : outside) += 1;
      const auto nearest = query.find_nearest(point);
      ASSERT_TRUE(nearest);
      EXPECT_EQ((*nearest)->depth > 0, is_inside) << "seed " << seed << " point " << i;
      EXPECT_NEAR(std::abs((*nearest)->depth), (*nearest)->distance, 1e-12 * size);
    }
  }
  EXPECT_GT(inside, 100u);
  EXPECT_GT(outside, 100u);
}

TEST(Contact, the_deepest_end_of_a_capsule_is_found) {
  const Character ball = test::make_bumpy_ball(400);
  const TornModel model = test::make_model(ball);
  auto query = *SurfaceQuery::create(model);
  const ModelPose pose = *bind_pose(ball);
  ASSERT_TRUE(query.set_pose(pose));
  const ContactOracle oracle(ball, positions_of(model, pose));
  Random random(7);
  for (int i = 0; i < 40; ++i) {
    const Vec3d out = 3 * random.direction();
    const Vec3d tip = random.uniform(0.1, 0.4) * random.direction();
    if (oracle.winding(tip) < 0.5 || oracle.winding(out) > 0.5) continue;
    const auto contact = query.find_capsule_contact({out, tip, 0.05});
    ASSERT_TRUE(contact);
    ASSERT_TRUE(*contact);
    EXPECT_EQ((*contact)->nearest.distance, 0);
    EXPECT_NEAR((*contact)->deepest.depth, 0.05 + oracle.distance(tip, tip), 1e-12);
  }
}

TEST(Contact, the_same_place_is_located_again) {
  for (int seed = 0; seed < test::stressed(30, 20); ++seed) {
    Random random(5000 + seed);
    Case at(random, random.index(4));
    const ContactOracle oracle = at.oracle();
    if (oracle.faces().empty()) continue;
    for (int i = 0; i < 20; ++i) {
      const auto nearest = at.query.find_nearest(place_near(oracle, random, 0.05 * at.size));
      ASSERT_TRUE(nearest && *nearest);
      const auto located = at.query.locate((*nearest)->anchor);
      ASSERT_TRUE(located) << located.error().text();
      ASSERT_TRUE(*located);
      EXPECT_LT(((*located)->place - (*nearest)->place).norm(), 1e-5 * at.size);
    }
  }
}

TEST(Contact, a_decal_keeps_its_place_when_the_surface_is_torn) {
  std::size_t kept = 0, removed = 0;
  for (int seed = 0; seed < test::stressed(40, 20); ++seed) {
    Random random(6000 + seed);
    Character character = test::random_character(random);
    TornModel model = test::make_model(character);
    auto query = *SurfaceQuery::create(model);
    const ModelPose bind = *bind_pose(character);
    ASSERT_TRUE(query.set_pose(bind));
    const double size = test::posed_diagonal(character, bind);
    std::vector<SurfaceContact> decals;
    const ContactOracle oracle(character, positions_of(model, bind));
    for (int i = 0; i < 30; ++i)
      decals.push_back(**query.find_nearest(place_near(oracle, random, 0.1 * size)));
    tear_at_random(model, random, 3);
    ASSERT_TRUE(query.set_pose(bind));
    const ContactOracle torn(model.character(), positions_of(model, bind));
    for (const SurfaceContact& decal : decals) {
      const auto located = query.locate(decal.anchor);
      ASSERT_TRUE(located);
      const double gap = torn.distance(decal.place, decal.place);
      if (!*located) {
        ++removed;
        EXPECT_GT(gap, 0);
        continue;
      }
      ++kept;
      EXPECT_LT(((*located)->place - decal.place).norm(), 1e-5 * size);
    }
  }
  EXPECT_GT(kept, 300u);
  EXPECT_GT(removed, 10u);
}

TEST(Contact, interpolated_normals_are_those_of_skinning) {
  Random random(8);
  const Character tube = test::make_tube(8, 12, 4);
  TornModel model = test::make_model(tube);
  tear_at_random(model, random, 2);
  auto query = *SurfaceQuery::create(model);
  const ModelPose pose = test::random_pose(tube, random);
  ContactOptions options;
  options.interpolates_normals = true;
  ASSERT_TRUE(query.set_pose(pose, options));
  const ContactOracle oracle(model.character(), positions_of(model, pose));
  const Mesh& mesh = model.character().meshes[0];
  std::vector<Affine3f> palette(model.character().skins[0].bones.size());
  ASSERT_TRUE(compute_palette(model.character().skins[0], pose, palette));
  DeformedMesh deformed;
  ASSERT_TRUE(deform_mesh(mesh, palette, pose.morph_weights, deformed));
  for (int i = 0; i < 50; ++i) {
    const SurfaceContact contact = **query.find_nearest(place_near(oracle, random, 0.1));
    Vec3d normal = Vec3d::Zero();
    for (std::size_t k = 0; k < 3; ++k)
      normal += contact.barycentric[k] *
                deformed.normals[mesh.triangles[contact.triangle][k]].cast<double>();
    EXPECT_LT((normal.normalized() - contact.interpolated_normal).norm(), 1e-5);
    EXPECT_NEAR(contact.normal.norm(), 1, 1e-12);
  }
}

/// Vertices with weights of any policy are met where they are drawn.
TEST(Contact, the_drawn_surface_is_met_under_every_weight_policy) {
  std::size_t apart = 0;
  for (const WeightPolicy policy :
       {WeightPolicy::pose_exact, WeightPolicy::refit, WeightPolicy::exact}) {
    for (int seed = 0; seed < test::stressed(6, 20); ++seed) {
      Random random(9000 + seed);
      const Character tube = test::make_tube(6, 9, 4);
      TornModel model = test::make_model(tube);
      WeightOptions weights;
      weights.policy = policy;
      if (policy != WeightPolicy::refit) {
        ASSERT_TRUE(model.set_weights(weights));
      }
      tear_at_random(model, random, 2);
      if (policy == WeightPolicy::refit && model.undo_count() > 0) {
        WeightsOperation wanted;
        wanted.weights = weights;
        (void)model.reweigh(wanted);
      }
      const ModelPose pose = test::random_pose(tube, random, 1.0, 1.5);
      const Mesh& mesh = model.character().meshes[0];
      VertexSource source = source_of(mesh);
      source.per_influence = &model.influence_positions(0);
      const std::size_t slots = model.character().skins[0].bones.size();
      const auto skinned = SkinnedMesh::create(source, slots);
      ASSERT_TRUE(skinned) << skinned.error().text();
      auto palette = *BonePalette::create(slots, pose.morph_weights.size());
      ASSERT_TRUE(palette.set(model.character().skins[0], pose));
      std::vector<Vec3f> drawn(mesh.vertex_count());
      VertexTarget target;
      target.vertex_count = mesh.vertex_count();
      target.positions = {drawn[0].data()};
      PosedBuffer buffer(target);
      ASSERT_TRUE(skinned->deform(palette, buffer));
      std::vector<Vec3d> positions;
      for (const Vec3f& position : drawn) positions.push_back(position.cast<double>());
      const double size = test::posed_diagonal(model.character(), pose);

      auto query = *SurfaceQuery::create(model);
      ASSERT_TRUE(query.set_pose(pose));
      const ContactOracle oracle(model.character(), {positions});
      auto torn = *SurfaceQuery::create(model);
      ContactOptions options;
      options.surface = ContactSurface::torn;
      ASSERT_TRUE(torn.set_pose(pose, options));
      for (int i = 0; i < 40; ++i) {
        const Vec3d point = place_near(oracle, random, 0.02 * size);
        const double distance = (*query.find_nearest(point))->distance;
        EXPECT_NEAR(distance, oracle.distance(point, point), 3e-6 * size);
        if (std::abs((*torn.find_nearest(point))->distance - distance) > 1e-5 * size) ++apart;
      }
    }
  }
  EXPECT_GT(apart, 0u) << "the test would not tell the surfaces apart";
}

// ---- Use.

class ContactUse : public testing::Test {
 protected:
  Character sheet = test::make_sheet(6);
  TornModel model = test::make_model(sheet);
  SurfaceQuery query = *SurfaceQuery::create(model);
  ModelPose pose = *bind_pose(sheet);
  std::vector<SurfaceContact> contacts;
};

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST_F(ContactUse, bad_input_is_refused) {
  ASSERT_TRUE(query.set_pose(pose));
  const auto code_of_ray = [&](const Ray& ray) { return query.cast_ray(ray).error().code(); };
  EXPECT_EQ(code_of_ray({{kNotANumber, 0, 0}, {0, 0, 1}}), StatusCode::non_finite_value);
  EXPECT_EQ(code_of_ray({{0, 0, 0}, {0, kInfinity, 1}}), StatusCode::non_finite_value);
  EXPECT_EQ(code_of_ray({{0, 0, 0}, {0, 0, 0}}), StatusCode::invalid_argument);
  EXPECT_EQ(code_of_ray({{0, 0, 0}, {0, 0, 1}, -1}), StatusCode::invalid_argument);
  EXPECT_EQ(code_of_ray({{0, 0, 0}, {0, 0, 1}, kNotANumber}), StatusCode::non_finite_value);
  EXPECT_EQ(code_of_ray({{0, 0, 1e61}, {0, 0, 1}}), StatusCode::invalid_argument);
  EXPECT_TRUE(query.cast_ray({{0.4, 0.3, 1}, {0, 0, -1}, 0}));

  contacts.resize(3);
  EXPECT_EQ(query.find_blade_contacts({{0, 0, 0}, {0, 0, 0}}, contacts).code(),
            StatusCode::invalid_argument);
  EXPECT_EQ(query.find_blade_contacts({{0, 0, kNotANumber}, {0, 0, 0}}, contacts).code(),
            StatusCode::non_finite_value);
  EXPECT_EQ(contacts.size(), 3u);

  const auto code_of_capsule = [&](const Capsule& capsule) {
    return query.find_capsule_contact(capsule).error().code();
  };
  EXPECT_EQ(code_of_capsule({{0, 0, 0}, {0, 0, 1}, -0.1}), StatusCode::invalid_argument);
  EXPECT_EQ(code_of_capsule({{0, 0, 0}, {0, 0, 1}, kInfinity}), StatusCode::invalid_argument);
  EXPECT_EQ(code_of_capsule({{0, 0, 0}, {0, 0, 1}, kNotANumber}), StatusCode::non_finite_value);
  EXPECT_EQ(code_of_capsule({{0, kNotANumber, 0}, {0, 0, 1}, 1}), StatusCode::non_finite_value);

  EXPECT_EQ(query.find_nearest({0, kNotANumber, 0}).error().code(), StatusCode::non_finite_value);
  EXPECT_EQ(query.find_nearest({0, 0, 0}, -1).error().code(), StatusCode::invalid_argument);

  const auto code_of_anchor = [&](const SurfaceAnchor& anchor) {
    return query.locate(anchor).error().code();
  };
  EXPECT_EQ(code_of_anchor({1, {0, {1, 0, 0}}}), StatusCode::index_out_of_range);
  EXPECT_EQ(code_of_anchor({0, {72, {1, 0, 0}}}), StatusCode::index_out_of_range);
  EXPECT_EQ(code_of_anchor({0, {0, {kNotANumber, 0, 0}}}), StatusCode::non_finite_value);
  EXPECT_EQ(code_of_anchor({0, {0, {2, -1, 0}}}), StatusCode::invalid_argument);
  EXPECT_EQ(code_of_anchor({0, {0, {0.5, 0, 0}}}), StatusCode::invalid_argument);
}

TEST_F(ContactUse, bad_poses_and_displacements_are_refused) {
  Random random(1);
  EXPECT_EQ(query.find_nearest({0, 0, 0}).error().code(), StatusCode::invalid_argument);
  ModelPose other = pose;
  other.model_from_bone.pop_back();
  EXPECT_EQ(query.set_pose(other).code(), StatusCode::size_mismatch);
  other = pose;
  other.model_from_bone[0].translation().x() = kNotANumber;
  EXPECT_EQ(query.set_pose(other).code(), StatusCode::non_finite_value);
  EXPECT_EQ(query.find_nearest({0, 0, 0}).error().code(), StatusCode::invalid_argument);

  std::vector<VertexDisplacements> displacements(2);
  ContactOptions options;
  options.displacements = displacements;
  EXPECT_EQ(query.set_pose(pose, options).code(), StatusCode::size_mismatch);
  const IndexRange all = {0, 1};
  displacements.resize(1);
  displacements[0].moved = {&all, 1};
  options.displacements = displacements;
  EXPECT_EQ(query.set_pose(pose, options).code(), StatusCode::size_mismatch);
  const std::vector<std::uint32_t> rows(sheet.meshes[0].vertex_count(), 0);
  const Vec4f away(0, 0, std::numeric_limits<float>::quiet_NaN(), 0);
  displacements[0].vertex_rows = rows;
  displacements[0].displacements = {&away, 1};
  EXPECT_EQ(query.set_pose(pose, options).code(), StatusCode::non_finite_value);
  ASSERT_TRUE(query.set_pose(pose));
  const double distance = (*query.find_nearest({0.3, 0.4, 1}))->distance;
  EXPECT_EQ(distance, 1);
  EXPECT_FALSE(query.set_pose(other));
  EXPECT_FALSE(query.set_pose(test::random_pose(sheet, random), options));
  EXPECT_EQ((*query.find_nearest({0.3, 0.4, 1}))->distance, distance);
}

TEST_F(ContactUse, a_changed_model_asks_for_the_pose_again) {
  ASSERT_TRUE(query.set_pose(pose));
  const Stroke stroke = {test::down_at(0.2, 0.5), test::down_at(0.8, 0.5)};
  TearOptions gap;
  gap.width = 0.1;
  ASSERT_TRUE(model.tear(pose, stroke, gap));
  EXPECT_EQ(query.cast_ray({{0.5, 0.5, 1}, {0, 0, -1}}).error().code(),
            StatusCode::invalid_argument);
  ASSERT_TRUE(query.set_pose(pose));
  EXPECT_FALSE(*query.cast_ray({{0.5, 0.5, 1}, {0, 0, -1}})) << "there is a gap";
  ASSERT_TRUE(model.undo());
  EXPECT_FALSE(query.cast_ray({{0.5, 0.5, 1}, {0, 0, -1}}));
  ASSERT_TRUE(query.set_pose(pose));
  EXPECT_TRUE(*query.cast_ray({{0.5, 0.5, 1}, {0, 0, -1}}));
  ASSERT_TRUE(model.redo());
  ASSERT_TRUE(model.compact());
  EXPECT_FALSE(query.cast_ray({{0.5, 0.5, 1}, {0, 0, -1}}));
  ASSERT_TRUE(query.set_pose(pose));
  EXPECT_FALSE(*query.cast_ray({{0.5, 0.5, 1}, {0, 0, -1}}));
  EXPECT_TRUE(*query.cast_ray({{0.5, 0.1, 1}, {0, 0, -1}}));
}

TEST_F(ContactUse, an_empty_model_is_met_nowhere) {
  Character empty = test::make_sheet(1);
  empty.meshes[0].triangles.clear();
  empty.meshes[0].triangle_submesh.clear();
  const TornModel nothing = test::make_model(empty);
  auto of_nothing = *SurfaceQuery::create(nothing);
  ASSERT_TRUE(of_nothing.set_pose(*bind_pose(empty)));
  EXPECT_FALSE(*of_nothing.cast_ray({{0, 0, 1}, {0, 0, -1}}));
  EXPECT_FALSE(*of_nothing.find_nearest({0, 0, 1}));
  EXPECT_FALSE(*of_nothing.find_capsule_contact({{0, 0, 0}, {1, 0, 0}, 1e6}));
}

TEST_F(ContactUse, a_query_does_not_allocate_once_warm_and_leaves_the_model_alone) {
  Random random(11);
  const Character tube = test::make_tube(20, 20, 5);
  TornModel torn = test::make_model(tube);
  tear_at_random(torn, random, 3);
  auto of_tube = *SurfaceQuery::create(torn);
  const std::uint64_t digest = torn.digest();
  std::vector<ModelPose> poses;
  for (int i = 0; i < 5; ++i) poses.push_back(test::random_pose(tube, random));
  const Blade blade = {{-2, 0.5, 0.01}, {2, 0.5, 0.02}};
  std::uint64_t before = 0;
  for (int round = 0; round < 2; ++round) {
    before = test::allocation_count();
    for (const ModelPose& at : poses) {
      ASSERT_TRUE(of_tube.set_pose(at));
      ASSERT_TRUE(of_tube.cast_ray({{2, 0.5, 0}, {-1, 0, 0}}));
      ASSERT_TRUE(of_tube.find_blade_contacts(blade, contacts));
      ASSERT_TRUE(of_tube.find_capsule_contact({blade.base, blade.tip, 0.1}));
      ASSERT_TRUE(of_tube.find_nearest({0.4, 0.4, 0.4}));
    }
  }
  EXPECT_EQ(test::allocation_count(), before);
  EXPECT_EQ(torn.digest(), digest);
  EXPECT_GT(of_tube.memory_bytes(), 1000u);
}

TEST_F(ContactUse, queries_share_the_trees_of_their_asset) {
  const auto character = std::make_shared<const Character>(test::make_bumpy_ball(20'000));
  const auto asset = *TornAsset::create(character);
  const TornModel one = std::move(*TornModel::create(asset)),
                  other = std::move(*TornModel::create(asset));
  auto of_one = *SurfaceQuery::create(one);
  ASSERT_TRUE(other.unpack());
  const std::uint64_t before = test::live_bytes();
  auto of_other = *SurfaceQuery::create(other);
  if (before > 0) {  // it is counted
    EXPECT_LT(test::live_bytes() - before, asset->memory_bytes().shared / 10);
  }
  for (SurfaceQuery* each : {&of_one, &of_other})
    ASSERT_TRUE(each->set_pose(*bind_pose(*character)));
  const auto wanted = *of_one.find_nearest({2, 1, 0.5}),
             found = *of_other.find_nearest({2, 1, 0.5});
  ASSERT_TRUE(wanted && found);
  EXPECT_EQ(wanted->place, found->place);
}

}  // namespace
}  // namespace sunder
