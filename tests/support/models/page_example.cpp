#include "support/models/page_example.h"

#include <sunder/skinning/pose.h>
#include <sunder/weights/influences.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "support/machine/random.h"
#include "support/models/rigs.h"
#include "tools/demo/demo_rig.h"

namespace sunder::test {
namespace {

constexpr double kThreshold = 0.002;
constexpr int kRandomPoses = 59;

void keep_two_influences(Character& character) {
  for (Mesh& mesh : character.meshes) {
    SkinWeights pruned;
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      const auto all = mesh.weights.of(v);
      std::vector<Influence> influences(all.begin(), all.end());
      influences.resize(prune_influences(influences, 2));
      pruned.append(influences);
    }
    mesh.weights = std::move(pruned);
  }
}

std::vector<double> deviations(const PageExample& example, const ModelPose& pose) {
  const auto source = all_posed_positions(example.source, pose);
  const auto target = all_posed_positions(example.target, pose);
  std::vector<double> distances;
  for (std::size_t v = 0; v < source.size(); ++v)
    distances.push_back((source[v] - target[v]).norm());
  return distances;
}

double largest(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end());
}

void keep_larger(std::vector<float>& all, const std::vector<double>& values) {
  all.resize(values.size());
  for (std::size_t v = 0; v < values.size(); ++v)
    all[v] = std::max(all[v], static_cast<float>(values[v]));
}

void add_clip(PageExample& example) {
  const Clip& clip = example.source.clips.at(0);
  tools::PageSeries series{"Largest deviation", "m", kThreshold, 0, {}, {}};
  tools::PageArray array{"Largest deviation over the clips", "m", false, kThreshold, {}};
  tools::PageSeries rms{"RMS", "m", {}, 0, {}, {}};
  Pose pose = *local_rest_pose(example.source);
  ModelPose model_pose;
  for (int i = 0; i <= 60; ++i) {
    series.times.push_back(static_cast<double>(clip.duration) * i / 60.0);
    EXPECT_TRUE(sample_clip(clip, series.times.back(), pose));
    EXPECT_TRUE(compute_model_pose(example.source.skeleton, pose, model_pose));
    const auto distances = deviations(example, model_pose);
    series.values.push_back(largest(distances));
    rms.times.push_back(series.times.back());
    double square = 0;
    for (const double distance : distances) square += distance * distance;
    rms.values.push_back(std::sqrt(square / static_cast<double>(distances.size())));
    keep_larger(array.values, distances);
  }
  example.input.series.push_back(std::move(series));
  example.input.series.push_back(std::move(rms));
  example.input.arrays.push_back(std::move(array));
}

void add_random_poses(PageExample& example) {
  Random random(1);
  tools::PageArray array{"Largest deviation over 59 random poses", "m", false, kThreshold, {}};
  tools::PagePose worst{"Worst pose", {}};
  double found = -1;
  for (int i = 0; i < kRandomPoses; ++i) {
    const ModelPose pose = random_pose(example.source, random, 0.5, 1.0);
    const auto distances = deviations(example, pose);
    keep_larger(array.values, distances);
    if (largest(distances) <= found) continue;
    found = largest(distances);
    worst.model_from_bone = pose.model_from_bone;
  }
  example.input.arrays.insert(example.input.arrays.begin(), std::move(array));
  example.input.poses.push_back(std::move(worst));
}

double weight_of(const Mesh& mesh, Index v, Index slot) {
  for (const Influence& influence : mesh.weights.of(v))
    if (influence.slot == slot) return static_cast<double>(influence.weight);
  return 0;
}

/// A signed array; the pot has no value.
void add_weight_change(PageExample& example) {
  constexpr Index kTrunk2 = 2;
  tools::PageArray array{"Weight change of Trunk2", "share", true, {}, {}};
  const Mesh& source = example.source.meshes[0];
  const Mesh& target = example.target.meshes[0];
  for (Index v = 0; v < source.vertex_count(); ++v)
    array.values.push_back(
        static_cast<float>(weight_of(target, v, kTrunk2) - weight_of(source, v, kTrunk2)));
  array.values.resize(array.values.size() + example.source.meshes[1].vertex_count(),
                      std::numeric_limits<float>::quiet_NaN());
  example.input.arrays.push_back(std::move(array));
}

/// The vertices of the flesh with the largest values, no two closer than a hand's breadth.
std::vector<FindingPlace> largest_places(const PageExample& example,
                                         const std::vector<float>& values, std::size_t count) {
  const Mesh& flesh = example.target.meshes[0];
  std::vector<Index> order(flesh.vertex_count());
  for (Index v = 0; v < order.size(); ++v) order[v] = v;
  std::stable_sort(order.begin(), order.end(),
                   [&](Index a, Index b) { return values[a] > values[b]; });
  std::vector<FindingPlace> places;
  for (const Index v : order) {
    const Vec3d position = flesh.positions[v].cast<double>();
    const bool is_new = std::none_of(places.begin(), places.end(), [&](const FindingPlace& place) {
      return (place.position - position).norm() < 0.08;
    });
    if (is_new) places.push_back({0, v, kNone, position, static_cast<double>(values[v])});
    if (places.size() == count) break;
  }
  return places;
}

Finding make_deviation(const PageExample& example) {
  const auto& values = example.input.arrays[0].values;
  Finding finding;
  finding.code = "SUNDER_W_POSED";
  finding.severity = Severity::error;
  finding.evidence = Evidence::sampled;
  finding.advice = "Keep four influences per vertex, or fit the two that are kept to the poses.";
  finding.threshold = kThreshold;
  finding.unit = "m";
  finding.places = largest_places(example, values, 8);
  finding.value = finding.places.front().value;
  for (const float value : values)
    if (static_cast<double>(value) > kThreshold) ++finding.count;
  char text[128];
  std::snprintf(text, sizeof text,
                "%u vertices leave the source by up to %.1f mm in %d random poses.",
                static_cast<unsigned>(finding.count), 1000 * finding.value, kRandomPoses);
  finding.text = text;
  return finding;
}

Finding make_dropped(const PageExample& example) {
  std::vector<float> dropped;
  for (std::size_t m = 0; m < example.source.meshes.size(); ++m)
    for (Index v = 0; v < example.source.meshes[m].vertex_count(); ++v) {
      const auto influences = example.source.meshes[m].weights.of(v);
      double mass = 0;
      for (std::size_t i = 2; i < influences.size(); ++i)
        mass += static_cast<double>(influences[i].weight);
      dropped.push_back(static_cast<float>(mass));
    }
  Finding finding;
  finding.code = "SUNDER_W_INFLUENCES";
  finding.severity = Severity::warning;
  finding.advice = "Export with the limit of the engine that the model is for.";
  finding.threshold = 0.01;
  finding.unit = "share";
  finding.places = largest_places(example, dropped, 8);
  finding.value = finding.places.front().value;
  for (const float mass : dropped)
    if (static_cast<double>(mass) > finding.threshold) ++finding.count;
  finding.text = std::to_string(finding.count) +
                 " vertices lost influences: the source has up to "
                 "six per vertex, the target two.";
  return finding;
}

void add_findings(PageExample& example) {
  example.findings = {make_deviation(example), make_dropped(example)};
  Finding limits;
  limits.code = "SUNDER_W_CERT_DEVIATION";
  limits.severity = Severity::note;
  limits.evidence = Evidence::not_tested;
  limits.text = "No bound for all poses: there are no joint limits.";
  limits.advice = "Give joint limits, by a file or from the clips.";
  example.findings.push_back(limits);
  example.input.findings = example.findings;
}

}  // namespace

std::vector<Index> bones_by_name(const Skeleton& source, const Skeleton& target) {
  std::vector<Index> matches;
  for (const Bone& bone : target.bones) {
    const auto match = std::find_if(source.bones.begin(), source.bones.end(),
                                    [&](const Bone& other) { return other.name == bone.name; });
    matches.push_back(
        match == source.bones.end() ? kNone : static_cast<Index>(match - source.bones.begin()));
  }
  return matches;
}

std::vector<Vec3d> all_posed_positions(const Character& character, const ModelPose& pose) {
  std::vector<Vec3d> all;
  for (std::uint32_t mesh = 0; mesh < character.meshes.size(); ++mesh) {
    const auto positions = posed_positions(character, mesh, pose);
    all.insert(all.end(), positions.begin(), positions.end());
  }
  return all;
}

void make_page_example(PageExample& example) {
  example.source = tools::make_cactus();
  example.target = example.source;
  keep_two_influences(example.target);
  example.input.source = &example.source;
  example.input.target = &example.target;
  example.input.source_title = "cactus.glb";
  example.input.target_title = "cactus_two_\u202einfluences.glb";
  example.input.source_bone_from_target =
      bones_by_name(example.source.skeleton, example.target.skeleton);
  add_clip(example);
  add_random_poses(example);
  add_weight_change(example);
  add_findings(example);
}

}  // namespace sunder::test
