#include <sunder/particles/authored_tissue.h>

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "particles/clusters/structure_of.h"
#include "particles/soft_scene.h"
#include "support/machine/random.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"
#include "support/oracles/membrane.h"

namespace sunder {
namespace {

using testing::HasSubstr;

/// Tissue with the same factors everywhere.
AuthoredTissue uniform(const Character& character, float factor) {
  AuthoredTissue tissue;
  for (const Mesh& mesh : character.meshes) {
    const std::vector<float> values(mesh.vertex_count(), factor);
    tissue.meshes.push_back({values, values, values, values, values});
  }
  return tissue;
}

/// A sheet that is torn and pulled open, and the places of its particles at the end.
struct PulledSheet {
  std::shared_ptr<const Character> character;
  TornModel model;
  ModelPose pose;
  ParticleSet set;
  SoftBody body;

  PulledSheet(const SoftMaterial& material, const AuthoredTissue& tissue, double tension)
      : character(std::make_shared<const Character>(test::make_sheet(40))),
        model(*TornModel::create(character)),
        pose(*bind_pose(*character)),
        set(*ParticleSet::create(model, pose, {0.1}, tissue)),
        body(*SoftBody::create(set, pose, {&material, 1})) {
    EXPECT_TRUE(body.set_tension({tension, {}}));
    const Stroke stroke = {test::down_at(0.31, 0.48), test::down_at(0.62, 0.53)};
    ChangeRecord change;
    EXPECT_TRUE(model.tear(pose, stroke, {}, &change));
    EXPECT_TRUE(set.follow(model, {&change, 1}));
    for (int i = 0; i < 60; ++i) EXPECT_TRUE(body.step(model, pose, 1.0 / 60));
  }
};

void expect_same_bits(PulledSheet& a, PulledSheet& b) {
  const auto moved_a = a.body.displacements(), moved_b = b.body.displacements();
  ASSERT_EQ(moved_a.size(), moved_b.size());
  double farthest = 0;
  for (std::size_t p = 0; p < moved_a.size(); ++p) {
    EXPECT_EQ(moved_a[p], moved_b[p]) << p;
    farthest = std::max(farthest, double{moved_a[p].norm()});
    EXPECT_EQ(a.body.mass(static_cast<Index>(p)), b.body.mass(static_cast<Index>(p)));
  }
  EXPECT_GT(farthest, 0.005);
}

TEST(authored_tissue, factors_of_one_change_no_bit) {
  const SoftMaterial material = *find_material("skin");
  PulledSheet plain(material, {}, 1.2);
  PulledSheet ones(material, uniform(*plain.character, 1), 1.2);
  expect_same_bits(plain, ones);
}

TEST(authored_tissue, even_factors_are_those_of_the_material) {
  SoftMaterial material = *find_material("skin");
  const float factor = 1.7f;
  PulledSheet with_factors(material, uniform(test::make_sheet(40), factor), 1.2);
  const double one{factor}, two = one * one;
  material.areal_density *= one;
  material.membrane_damping *= one;
  material.membrane_stiffness *= two;  // of stiffness and of thickness
  PulledSheet other(material, {}, one * 1.2);
  expect_same_bits(with_factors, other);
}

TEST(authored_tissue, new_points_have_the_factors_of_their_place) {
  test::Random random(11);
  const auto factors = [](const Vec3d& at) {
    return test::FactorsAt{1 + 0.5 * at.x() + 0.25 * at.y(), 2 - at.y(), 0.5 + at.x()};
  };
  const auto character = std::make_shared<const Character>(test::make_sheet(24));
  TornModel model = *TornModel::create(character);
  const ModelPose pose = *bind_pose(*character);
  ParticleSet set = *ParticleSet::create(model, pose, {0.1}, test::authored(*character, factors));
  const auto check = [&] {
    const auto& points = particles::StructureOf::in(set).authored.of_points;
    ASSERT_GE(points.size(), set.point_count());
    for (Index p = 0; p < set.point_count(); ++p) {
      const test::FactorsAt wanted = factors(set.positions()[p].cast<double>());
      EXPECT_NEAR(points[p].stiffness, wanted.stiffness, 1e-5) << p;
      EXPECT_NEAR(points[p].tension, wanted.tension, 1e-5) << p;
      EXPECT_NEAR(points[p].thickness, wanted.thickness, 1e-5) << p;
    }
  };
  for (int i = 0; i < 12; ++i) {
    ChangeRecord change;
    ASSERT_TRUE(model.tear(pose, test::turning_stroke(random), {}, &change));
    ASSERT_TRUE(set.follow(model, {&change, 1}));
    check();
    if (i % 3 != 1) continue;
    ASSERT_TRUE(model.undo(&change));
    ASSERT_TRUE(set.follow(model, {&change, 1}));
    if (i % 2 == 0) continue;
    ASSERT_TRUE(model.redo(&change));
    ASSERT_TRUE(set.follow(model, {&change, 1}));
    check();
  }
}

TEST(authored_tissue, a_restored_set_goes_on_with_the_same_bits) {
  test::Random random(12);
  const auto character = std::make_shared<const Character>(test::make_sheet(24));
  const auto factors = [](const Vec3d& at) { return test::FactorsAt{0.5 + at.x(), 1, 1}; };
  TornModel model = *TornModel::create(character);
  const ModelPose pose = *bind_pose(*character);
  const auto asset =
      *ParticleAsset::create(model, pose, {0.1}, test::authored(*character, factors));
  ParticleSet set = *ParticleSet::create(asset, model);
  const SoftMaterial material;
  SoftBody body = *SoftBody::create(set, pose, {&material, 1});
  ASSERT_TRUE(body.set_tension({1.0, {}}));
  const auto tear = [&](ParticleSet& of, ChangeRecord& change) {
    ASSERT_TRUE(model.tear(pose, test::turning_stroke(random), {}, &change));
    ASSERT_TRUE(of.follow(model, {&change, 1}));
  };
  ChangeRecord change;
  tear(set, change);
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(body.step(model, pose, 1.0 / 60));
  ParticleSet other = *ParticleSet::restore(asset, model, *set.save());
  SoftBody other_body = *SoftBody::create(other, pose, {&material, 1});
  ASSERT_TRUE(other_body.set_tension({1.0, {}}));
  ASSERT_TRUE(other_body.restore(*body.save()));
  tear(set, change);
  ASSERT_TRUE(other.follow(model, {&change, 1}));
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(body.step(model, pose, 1.0 / 60));
    ASSERT_TRUE(other_body.step(model, pose, 1.0 / 60));
  }
  EXPECT_TRUE(std::ranges::equal(body.displacements(), other_body.displacements()));
}

TEST(authored_tissue, faults_are_named) {
  const Character character = test::make_sheet(4);
  const auto fault = [&](const AuthoredTissue& tissue) {
    const Status status = validate_authored_tissue(tissue, character);
    EXPECT_FALSE(status);
    const auto shared = std::make_shared<const Character>(character);
    const TornModel model = *TornModel::create(shared);
    EXPECT_FALSE(ParticleAsset::create(model, *bind_pose(character), {}, tissue));
    return std::string(status.text());
  };
  AuthoredTissue tissue = uniform(character, 1);
  EXPECT_TRUE(validate_authored_tissue(tissue, character));
  tissue.meshes[0].toughness[7] = 0;
  EXPECT_THAT(fault(tissue), HasSubstr("vertex 7: the factor of toughness is 0"));
  tissue.meshes[0].toughness[7] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(validate_authored_tissue(tissue, character).code(), StatusCode::non_finite_value);
  tissue = uniform(character, 1);
  tissue.meshes[0].tension[3] = 0;
  EXPECT_TRUE(validate_authored_tissue(tissue, character));
  tissue.meshes[0].strength.pop_back();
  EXPECT_THAT(fault(tissue), HasSubstr("strength has 24 values; the mesh has 25 vertices"));
  tissue.meshes.resize(2);
  EXPECT_THAT(fault(tissue), HasSubstr("2 meshes"));
  tissue = {{}, {{{{0, 0}, {0, 99}}, 0.5}}};
  EXPECT_THAT(fault(tissue), HasSubstr("perforation 0, place 1"));
  tissue = {{}, {{{{0, 0}, {0, 1, {0.5, 0.6, 0.2}}}, 0.5}}};
  EXPECT_THAT(fault(tissue), HasSubstr("barycentrics"));
  tissue = {{}, {{{{0, 0}, {0, 1}}, 1.5}}};
  EXPECT_THAT(fault(tissue), HasSubstr("strength of perforation 0"));
  tissue = {{}, {{{{0, 0}}, 0.5}}};
  EXPECT_THAT(fault(tissue), HasSubstr("at least two"));
}

/// A sheet with everything from which fields are sampled.
Character painted_sheet() {
  Character character = test::make_sheet(8);
  Mesh& mesh = character.meshes[0];
  std::vector<Vec4f> colors;
  std::vector<Vec2f> uvs;
  CustomAttribute attribute{"_STRENGTH", 2, true, {}};
  for (const Vec3f& at : mesh.positions) {
    colors.emplace_back(at.x(), at.y(), 0.25f, 1.0f);
    uvs.emplace_back(at.x(), at.y());
    attribute.values.push_back(at.y());
    attribute.values.push_back(3 * at.x());
  }
  mesh.color_sets = {colors};
  mesh.uv_sets = {uvs};
  mesh.custom_attributes.push_back(attribute);
  return character;
}

TEST(sample_field, takes_colours_attributes_bones_and_textures) {
  const Character character = painted_sheet();
  const Mesh& mesh = character.meshes[0];
  const auto color = *sample_field(character, 0, {VertexColor{0, 1}, 0.5, 2.0});
  const auto attribute = *sample_field(character, 0, {VertexAttribute{"_STRENGTH", 1}});
  const auto bone = *sample_field(character, 0, {BoneWeight{character.skeleton.bones[0].name}});
  TextureChannel texture{5, 3, {}, 0, 2};
  for (int i = 0; i < 15; ++i)  // x along u, in the third channel
    for (const int value : {0, 0, 51 * (i % 5), 0})
      texture.rgba.push_back(static_cast<std::uint8_t>(value));
  const auto painted = *sample_field(character, 0, {texture});
  ASSERT_EQ(color.size(), mesh.vertex_count());
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    const Vec3f& at = mesh.positions[v];
    EXPECT_NEAR(color[v], 0.5 + 1.5 * at.y(), 1e-6);
    EXPECT_EQ(attribute[v], 3 * at.x());
    float weight = 0;
    for (const Influence& influence : mesh.weights.of(v))
      if (influence.slot == 0) weight += influence.weight;
    EXPECT_EQ(bone[v], weight);
    // Texels are at 0.1, 0.3, ... with 0, 0.2, ...; linear in between, and repeated.
    if (at.x() >= 0.1f && at.x() <= 0.9f) {
      EXPECT_NEAR(painted[v], at.x() - 0.1, 1e-6);
    }
  }
}

TEST(sample_field, faults_are_named) {
  Character character = painted_sheet();
  const auto fault = [&](const FieldSource& source, std::uint32_t mesh = 0) {
    const auto sampled = sample_field(character, mesh, source);
    EXPECT_FALSE(sampled);
    return std::string(sampled.error().text());
  };
  EXPECT_THAT(fault({VertexColor{}}, 3), HasSubstr("mesh 3"));
  EXPECT_THAT(fault({VertexColor{1, 0}}), HasSubstr("no colours 1"));
  EXPECT_THAT(fault({VertexColor{0, 4}}), HasSubstr("channel"));
  EXPECT_THAT(fault({VertexAttribute{"_STRENGHT"}}), HasSubstr("no attribute '_STRENGHT'"));
  EXPECT_THAT(fault({VertexAttribute{"_STRENGTH", 2}}), HasSubstr("component"));
  EXPECT_THAT(fault({BoneWeight{"tail"}}), HasSubstr("no bone 'tail'"));
  EXPECT_THAT(fault({TextureChannel{2, 2, {0, 0, 0}, 0, 0}}), HasSubstr("3 bytes"));
  EXPECT_THAT(fault({TextureChannel{1, 1, {0, 0, 0, 0}, 1, 0}}), HasSubstr("no UVs 1"));
  character.meshes[0].color_sets[0][5][0] = std::numeric_limits<float>::infinity();
  EXPECT_THAT(fault({VertexColor{}}), HasSubstr("vertex 5"));
}

TEST(authored_tissue, gaps_are_those_of_finite_elements_with_the_same_fields) {
  const auto factors = [](const Vec3d& at) {
    return test::FactorsAt{std::exp2(2 * at.y() - 1), 1 + 0.5 * at.x(), 1.5 - at.x()};
  };
  for (const double range : {0.2, 0.1}) {
    test::SlitSheet sheet(80, 0.2, range, {}, 1, 0, factors);
    sheet.open(1.2);
    const test::GapProfile gap = gap_of(sheet), wanted = reference_gap(sheet, 1.2);
    EXPECT_NEAR(gap.widest() / wanted.widest(), 1, 0.05) << range;
    EXPECT_LT(rms_difference(gap, wanted), 0.06) << range;
  }
}

}  // namespace
}  // namespace sunder
