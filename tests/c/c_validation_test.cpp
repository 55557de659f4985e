// What C programs see of validation and of the force on a blade is what C++ programs see.

#include <sunder/tear/blade_force.h>
#include <sunder/validation/validation.h>

#include <cmath>
#include <memory>
#include <string>

#include "c/c_objects.h"
#include "c/c_twins.h"
#include "support/models/animated_rig.h"

namespace sunder::test {
namespace {

/// A rig, and the same with other weights at some vertices.
struct Skins {
  explicit Skins(std::uint64_t seed) {
    Random random(seed);
    source = make_animated_rig({}, random);
    target = source;
    auto& influences = target.meshes[0].weights.influences;
    const auto& first = target.meshes[0].weights.first;
    for (int i = 0; i < 20; ++i) {
      const std::uint32_t vertex = random.index(target.meshes[0].vertex_count());
      if (first[vertex + 1] - first[vertex] < 2) continue;
      std::swap(influences[first[vertex]].weight, influences[first[vertex] + 1].weight);
    }
  }
  Character source, target;
};

TEST(CValidation, findings_and_figures_are_those_of_the_library) {
  ASSERT_NE(sunder_features() & SUNDER_FEATURE_VALIDATION, 0u);
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Skins skins(seed);
    ValidationOptions wanted;
    wanted.random_poses = 16;
    wanted.limits_from = seed % 2 == 0 ? LimitsFrom::clips : LimitsFrom::none;
    const auto expected = validate_skin(std::make_shared<const Character>(skins.source),
                                        std::make_shared<const Character>(skins.target), wanted);
    ASSERT_TRUE(expected);

    const sunder_character source = create(skins.source), target = create(skins.target);
    sunder_validation_options options = sunder_default_validation_options();
    options.random_poses = 16;
    options.has_clip_limits = seed % 2 == 0 ? 1 : 0;
    sunder_report report = 0;
    ASSERT_EQ(sunder_validate(source, target, &options, &report), SUNDER_OK) << sunder_last_error();
    EXPECT_DONE(sunder_destroy_character(source));  // A report keeps what it needs.
    EXPECT_DONE(sunder_destroy_character(target));

    sunder_report_info info = {};
    info.struct_size = sizeof info;
    EXPECT_DONE(sunder_get_report(report, &info));
    EXPECT_EQ(info.found, expected->bracket.found);
    EXPECT_EQ(info.certified, expected->bracket.certified);
    EXPECT_EQ(info.diagonal, expected->diagonal);
    EXPECT_GT(info.sampled, 0);
    EXPECT_GT(info.pose_count, 16u);
    EXPECT_EQ(info.error_count + info.warning_count + info.note_count, expected->findings.size());

    const sunder_finding* findings = nullptr;
    std::uint32_t count = 0;
    EXPECT_DONE(sunder_get_findings(report, &findings, &count));
    ASSERT_EQ(count, expected->findings.size());
    EXPECT_GT(count, 0u);
    for (std::uint32_t i = 0; i < count; ++i) {
      const Finding& finding = expected->findings[i];
      EXPECT_EQ(findings[i].code, finding.code);
      EXPECT_EQ(findings[i].text, finding.text);
      EXPECT_EQ(findings[i].advice, finding.advice);
      EXPECT_EQ(findings[i].unit, finding.unit);
      EXPECT_EQ(findings[i].value, finding.value);
      EXPECT_EQ(findings[i].count, finding.count);
      EXPECT_EQ(findings[i].severity, static_cast<std::uint32_t>(finding.severity));
      EXPECT_EQ(findings[i].vertex,
                finding.places.empty() ? SUNDER_NONE : finding.places[0].vertex);
    }

    const float *deviations = nullptr, *bounds = nullptr;
    EXPECT_DONE(sunder_get_vertex_deviations(report, &deviations, &bounds, &count));
    ASSERT_EQ(count, expected->vertex_deviation.size());
    EXPECT_EQ(info.vertex_count, count);
    double largest = 0;
    for (std::uint32_t v = 0; v < count; ++v) {
      const float wanted_deviation = expected->vertex_deviation[v];
      EXPECT_TRUE(deviations[v] == wanted_deviation ||
                  (std::isnan(deviations[v]) && std::isnan(wanted_deviation)));
      largest = std::max(largest, static_cast<double>(deviations[v]));
    }
    EXPECT_GT(largest, 0);
    EXPECT_DONE(sunder_destroy_report(report));
    EXPECT_EQ(sunder_get_report(report, &info), SUNDER_INVALID_HANDLE);
  }
}

TEST(CValidation, options_out_of_range_are_refused) {
  const sunder_character rig = create(make_tube(6, 5, 3));
  const auto refuses = [&](auto change) {
    sunder_validation_options options = sunder_default_validation_options();
    change(options);
    sunder_report report = 77;
    EXPECT_EQ(sunder_validate(rig, rig, &options, &report), SUNDER_INVALID_ARGUMENT);
    EXPECT_EQ(report, 77u);
    return std::string(sunder_last_error());
  };
  EXPECT_NE(refuses([](auto& options) { options.random_poses = 100001; }).find("random_poses"),
            std::string::npos);
  EXPECT_NE(
      refuses([](auto& options) { options.maximum_deviation = -1; }).find("maximum_deviation"),
      std::string::npos);
  EXPECT_DONE(sunder_destroy_character(rig));
}

/// The largest value from a vertex on, NaN aside.
double largest_from(const float* values, std::uint32_t first, std::uint32_t count) {
  double largest = 0;
  for (std::uint32_t v = first; v < count; ++v)
    if (values[v] > largest) largest = static_cast<double>(values[v]);
  return largest;
}

TEST(CValidation, an_instance_is_compared_with_what_it_was_and_the_newest_operation_apart) {
  Twins twins(make_tube(24, 12, 6), false);
  const sunder_blade strokes[2][2] = {
      {{{0, 1.5, 1}, {0, 1.5, 0}}, {{0.05, 1.1, 1}, {0.05, 1.1, 0}}},
      {{{0, 0.9, 1}, {0, 0.9, 0}}, {{0.05, 0.5, 1}, {0.05, 0.5, 0}}}};
  sunder_validation_options options = sunder_default_validation_options();
  options.random_poses = 16;
  sunder_report_info info = {};
  info.struct_size = sizeof info;
  const auto validate = [&] {
    sunder_report report = 0;
    EXPECT_DONE(sunder_validate_instance(twins.c_scene, twins.c_id, &options, &report));
    EXPECT_DONE(sunder_get_report(report, &info));
    return report;
  };
  twins.update();
  EXPECT_DONE(sunder_destroy_report(validate()));  // before any tear
  EXPECT_EQ(info.certified, 0);
  EXPECT_EQ(info.newest_points, 0u);

  // The first tear keeps one influence per vertex, which is wrong; the second keeps all.
  std::uint32_t before = 0;
  for (int i = 0; i < 2; ++i) {
    sunder_tear_options tear = sunder_default_tear_options();
    tear.weight_policy = SUNDER_WEIGHTS_BARYCENTRIC;
    tear.maximum_influences = i == 0 ? 1 : 0xFFFFFFFF;
    before = posed_mesh(twins.c_scene, twins.c_id, 0).vertex_count;
    EXPECT_DONE(sunder_submit_tear(twins.c_scene, twins.c_id, strokes[i], 2, &tear, 0, nullptr));
    EXPECT_DONE(sunder_update(twins.c_scene, 0));
    const sunder_report report = validate();
    const float *deviations = nullptr, *bounds = nullptr;
    std::uint32_t count = 0;
    EXPECT_DONE(sunder_get_vertex_deviations(report, &deviations, &bounds, &count));
    ASSERT_EQ(count, posed_mesh(twins.c_scene, twins.c_id, 0).vertex_count);
    EXPECT_GT(count, before);
    EXPECT_GT(info.newest_points, 0u);
    EXPECT_EQ(info.newest_uncertified, 0u);
    EXPECT_EQ(info.newest_sampled, largest_from(deviations, before, count));
    EXPECT_EQ(info.newest_certified, largest_from(bounds, before, count));
    EXPECT_GE(info.newest_certified, info.newest_sampled);
    EXPECT_EQ(largest_from(deviations, 0, 12 * 24), 0);  // what was there is as it was
    if (i == 0) {
      EXPECT_GT(info.newest_sampled, 0.01);
      EXPECT_EQ(info.newest_certified, static_cast<float>(info.certified));
    } else {
      EXPECT_LT(info.newest_certified, 0.5 * info.certified);
    }
    EXPECT_DONE(sunder_destroy_report(report));
  }
}

TEST(CValidation, an_instance_that_is_not_there_and_wrong_options_are_refused) {
  Twins twins(make_tube(6, 5, 3), false);
  sunder_report report = 77;
  EXPECT_EQ(sunder_validate_instance(0, twins.c_id, nullptr, &report), SUNDER_INVALID_HANDLE);
  EXPECT_EQ(sunder_validate_instance(twins.c_scene, twins.c_id + 1, nullptr, &report),
            SUNDER_NOT_FOUND);
  EXPECT_EQ(sunder_validate_instance(twins.c_scene, twins.c_id, nullptr, nullptr),
            SUNDER_NULL_POINTER);
  sunder_validation_options options = sunder_default_validation_options();
  options.random_angle = -1;
  EXPECT_EQ(sunder_validate_instance(twins.c_scene, twins.c_id, &options, &report),
            SUNDER_INVALID_ARGUMENT);
  EXPECT_EQ(report, 77u);
}

TEST(CBladeForce, is_that_of_the_library_and_opposes_the_motion) {
  sunder_cutting_resistance tissue = sunder_default_cutting_resistance();
  tissue.toughness = 2000;
  tissue.thickness = 0.002;
  tissue.friction = 30;
  const double motion[3] = {0.003, -0.001, 0.002};
  double force[3] = {};
  EXPECT_DONE(sunder_blade_force(&tissue, 0.004, 0.01, motion, force));
  const auto wanted = blade_force({2000, 0.002, 30, tissue.greatest},
                                  {0.004, 0.01, Vec3d(motion[0], motion[1], motion[2])});
  ASSERT_TRUE(wanted);
  double work = 0;
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(force[i], wanted->newtons * wanted->direction[i]);
    work += force[i] * motion[i];
  }
  EXPECT_LT(work, 0);
  EXPECT_EQ(sunder_blade_force(&tissue, -1, 0.01, motion, force), SUNDER_INVALID_ARGUMENT);
  EXPECT_EQ(sunder_blade_force(nullptr, 0, 0, motion, force), SUNDER_NULL_POINTER);
}

}  // namespace
}  // namespace sunder::test
