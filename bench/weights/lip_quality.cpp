#include "bench/weights/lip_quality.h"

#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/torn_model.h>
#include <sunder/tear/torn_weights.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>

#include "bench/harness/measure.h"
#include "bench/weights/refit_rigs.h"
#include "support/models/rigs.h"

#if SUNDER_BENCH_COUPLED_REFIT
#include <sunder/coupled_refit/use.h>
#endif

namespace sunder::bench {
namespace {

constexpr int kLipTears = 4;
constexpr std::uint32_t kLipInfluences = 4;
constexpr std::size_t kMostClips = 8;
constexpr int kPosesOfClip = 4;
/// Faces of a smaller area than this share of the squared lip edge have no reliable normal.
constexpr double kLeastArea = 0.02;

using Positions = std::vector<std::vector<Vec3f>>;  ///< Per mesh.

/// An edge on both lips: the triangles on its sides, which share no vertex.
struct LipEdge {
  std::uint32_t mesh = 0;
  std::array<std::uint32_t, 2> triangles = {};
  std::array<std::array<std::uint32_t, 2>, 2> ends = {};  ///< Per side, in the same order.
};

/// The edges of new vertices that two triangles have at the same place without sharing a vertex.
std::vector<LipEdge> find_lips(const Character& source, const Character& torn) {
  using Place = std::array<float, 3>;
  std::vector<LipEdge> lips;
  for (std::uint32_t m = 0; m < torn.meshes.size(); ++m) {
    const Mesh& mesh = torn.meshes[m];
    const std::uint32_t first_new = source.meshes[m].vertex_count();
    const auto place = [&](std::uint32_t vertex) {
      const Vec3f& at = mesh.positions[vertex];
      return Place{at.x(), at.y(), at.z()};
    };
    std::map<std::array<Place, 2>, LipEdge> open;
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t)
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t from = mesh.triangles[t][k], to = mesh.triangles[t][(k + 1) % 3];
        if (from < first_new || to < first_new || place(from) == place(to)) continue;
        const auto twin = open.find({place(to), place(from)});
        if (twin == open.end()) {
          open[{place(from), place(to)}] = {m, {t, t}, {{{from, to}, {from, to}}}};
          continue;
        }
        LipEdge edge = twin->second;
        open.erase(twin);
        edge.triangles[1] = t;
        edge.ends[1] = {to, from};
        if (edge.ends[0][0] != edge.ends[1][0] && edge.ends[0][1] != edge.ends[1][1])
          lips.push_back(edge);
      }
  }
  return lips;
}

Positions posed(const Character& character, const ModelPose& pose) {
  Positions result(character.meshes.size());
  std::vector<Affine3f> palette;
  for (std::size_t m = 0; m < character.meshes.size(); ++m) {
    const Skin& skin = character.skins[character.meshes[m].skin];
    palette.resize(skin.bones.size());
    DeformedMesh deformed;
    if (!compute_palette(skin, pose, palette) ||
        !deform_mesh(character.meshes[m], palette, pose.morph_weights, deformed))
      std::abort();
    result[m] = std::move(deformed.positions);
  }
  return result;
}

/// New points where they are on the posed source.
Positions exact_positions(const Character& source, const TornModel& model, const ModelPose& pose) {
  Positions result = posed(source, pose);
  for (std::uint32_t m = 0; m < result.size(); ++m) {
    const Mesh& torn = model.character().meshes[m];
    for (auto v = static_cast<std::uint32_t>(result[m].size()); v < torn.vertex_count(); ++v) {
      const Birth birth = model.birth(m, v);
      const Triangle& triangle = source.meshes[m].triangles[birth.triangle];
      Eigen::Vector3d position = Eigen::Vector3d::Zero();
      for (int k = 0; k < 3; ++k)
        position += birth.barycentric[k] * Eigen::Vector3d(result[m][triangle[k]].cast<double>());
      result[m].push_back(position.cast<float>());
    }
  }
  return result;
}

/// The angle between the faces of an edge, radians; none if one is too thin.
std::optional<double> angle_across(const LipEdge& edge, const Mesh& mesh,
                                   const std::vector<Vec3f>& positions) {
  std::array<Eigen::Vector3d, 2> normals;
  const auto at = [&](std::uint32_t vertex) -> Eigen::Vector3d {
    return positions[vertex].cast<double>();
  };
  for (int side = 0; side < 2; ++side) {
    const Triangle& triangle = mesh.triangles[edge.triangles[side]];
    normals[side] = (at(triangle[1]) - at(triangle[0])).cross(at(triangle[2]) - at(triangle[0]));
    const double length = (at(edge.ends[side][1]) - at(edge.ends[side][0])).squaredNorm();
    if (!(normals[side].norm() > kLeastArea * length)) return {};
  }
  return std::atan2(normals[0].cross(normals[1]).norm(), normals[0].dot(normals[1]));
}

/// A torn rig and what is measured of it.
struct Torn {
  TornModel model;
  std::uint32_t operations = 0;
  double diagonal = 0;
  std::vector<ModelPose> poses;  ///< Of the clips; not fitted.
  std::vector<Positions> exact;  ///< Per pose.
  std::vector<LipEdge> lips;
};

WeightsOperation weights_of(WeightPolicy policy, std::uint32_t operations) {
  WeightsOperation wanted;
  wanted.operation_count = operations;
  wanted.weights = {policy, kLipInfluences};
  wanted.refit.poses.range_of_motion = true;
  return wanted;
}

std::optional<Torn> tear_rig(const std::shared_ptr<const Character>& character) {
  test::Random random(1);
  auto model = TornModel::create(character);
  if (!model) std::abort();
  Torn torn{std::move(*model), 0, 0, {}, {}, {}};
  const auto clips = static_cast<std::uint32_t>(character->clips.size());
  const auto pose_of = [&](std::uint32_t clip, double share) {
    auto pose = make_pose(
        *character, ClipPose{clip, share * static_cast<double>(character->clips[clip].duration)});
    if (!pose) std::abort();
    return std::move(*pose);
  };
  for (int attempt = 0; attempt < 60 && torn.operations < kLipTears; ++attempt) {
    const std::uint32_t clip = random.index(clips);
    const ModelPose pose = pose_of(clip, random.uniform(0, 1));
    const auto report = torn.model.tear(pose, test::random_stroke(*character, pose, random));
    if (report && report->runs > 0)
      ++torn.operations;
    else if (report)
      (void)torn.model.undo();
  }
  if (torn.operations == 0) return {};
  torn.lips = find_lips(*character, torn.model.character());
  if (torn.lips.empty()) return {};
  torn.diagonal = test::posed_diagonal(*character, *rest_pose(*character));
  for (std::uint32_t clip = 0; clip < std::min<std::size_t>(clips, kMostClips); ++clip)
    for (int i = 0; i < kPosesOfClip; ++i)
      torn.poses.push_back(pose_of(clip, (i + random.uniform(0, 1)) / kPosesOfClip));
  for (const ModelPose& pose : torn.poses)
    torn.exact.push_back(exact_positions(*character, torn.model, pose));
  return torn;
}

/// With the current weights; the gain is the error yet.
LipQuality measure(const Torn& torn) {
  LipQuality quality;
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < torn.poses.size(); ++i) {
    const Positions now = posed(torn.model.character(), torn.poses[i]);
    for (const LipEdge& edge : torn.lips) {
      const Mesh& mesh = torn.model.character().meshes[edge.mesh];
      const std::vector<Vec3f>& at = now[edge.mesh];
      for (int end = 0; end < 2; ++end)
        quality.crack =
            std::max(quality.crack,
                     static_cast<double>((at[edge.ends[0][end]] - at[edge.ends[1][end]]).norm()) /
                         torn.diagonal);
      const auto angle = angle_across(edge, mesh, at),
                 wanted = angle_across(edge, mesh, torn.exact[i][edge.mesh]);
      if (!angle || !wanted) continue;
      sum += (*angle - *wanted) * (*angle - *wanted);
      ++count;
    }
  }
  quality.normal_jump = count > 0 ? 57.295779513 * std::sqrt(sum / count) : 0;
  const auto errors = measure_weight_errors(torn.model, 0, torn.operations, torn.poses);
  if (!errors) std::abort();
  quality.gain = errors->metres.rms;
  return quality;
}

/// One row per way of weighting.
std::vector<LipQuality> measure_rig(Torn& torn) {
  struct Way {
    const char* name;
    WeightPolicy policy;
    double smoothness;  ///< Below 0: point by point.
  };
  constexpr Way kWays[] = {
    {"barycentric", WeightPolicy::barycentric, -1},
    {"refit", WeightPolicy::refit, -1},
#if SUNDER_BENCH_COUPLED_REFIT
    {"coupled, 0.01", WeightPolicy::refit, 0.01},
    {"coupled, 0.1", WeightPolicy::refit, 0.1},
    {"coupled, 1", WeightPolicy::refit, 1},
#endif
  };
  std::vector<LipQuality> rows;
  for (const Way& way : kWays) {
    WeightsOperation wanted = weights_of(way.policy, torn.operations);
    wanted.refit.is_coupled = way.smoothness >= 0;
    wanted.refit.smoothness = std::max(way.smoothness, 0.0);
    const auto start = std::chrono::steady_clock::now();
    const auto report = torn.model.reweigh(wanted);
    const std::chrono::duration<double, std::micro> time = std::chrono::steady_clock::now() - start;
    if (!report) std::abort();
    LipQuality& row = rows.emplace_back(measure(torn));
    row.name = way.name;
    row.microseconds = time.count() / static_cast<double>(std::max<std::size_t>(report->points, 1));
    if (!torn.model.undo()) std::abort();
  }
  const double barycentric = rows[0].gain;
  for (LipQuality& row : rows) row.gain = row.gain > 0 ? barycentric / row.gain : 1.0;
  return rows;
}

}  // namespace

std::vector<LipQuality> measure_lip_quality() {
#if SUNDER_BENCH_COUPLED_REFIT
  use_coupled_refit();
#endif
  std::vector<std::vector<LipQuality>> of_rigs;
  for (const BendingRig& rig : bending_rigs(40)) {
    auto torn = tear_rig(rig.character);
    if (torn) of_rigs.push_back(measure_rig(*torn));
  }
  std::vector<LipQuality> medians;
  for (std::size_t row = 0; !of_rigs.empty() && row < of_rigs[0].size(); ++row) {
    const auto median_of = [&](double LipQuality::*figure) {
      std::vector<double> values;
      for (const auto& rows : of_rigs) values.push_back(rows[row].*figure);
      return median(values);
    };
    LipQuality& of_all = medians.emplace_back(of_rigs[0][row]);
    of_all.gain = median_of(&LipQuality::gain);
    of_all.normal_jump = median_of(&LipQuality::normal_jump);
    of_all.microseconds = median_of(&LipQuality::microseconds);
    for (const auto& rows : of_rigs) of_all.crack = std::max(of_all.crack, rows[row].crack);
  }
  return medians;
}

}  // namespace sunder::bench
