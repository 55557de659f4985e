#include "tools/picture/open_lips.h"

#include <sunder/tear/contact.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace sunder::tools {
namespace {

/// Range of the particles: a share of the wound's length, so that a wound has several along it,
/// within these fractions of the model's diagonal.
constexpr double kRangeOfLength = 0.25, kLeastRange = 0.02, kMostRange = 0.075;
/// How far the widest wound gapes: a share of its length, and of the body's thickness below it.
constexpr double kGapOfLength = 0.07, kGapOfThickness = 0.5;
/// Tension is lowered by this factor while a larger share of the moved surface than this is folded.
constexpr double kLess = 0.75, kFolded = 0.004;
constexpr double kFirstTension = 1.0;  ///< Newtons per metre, to begin the search with.
constexpr double kTaper = 0.4;         ///< Of a wound's length, at each end.
constexpr int kMostTrials = 6;
constexpr int kMostLipSteps = 180;
constexpr std::size_t kMostRays = 200;

struct TornSource {
  double greatest_length = 0;  ///< Of a wound, metres.
  double thickness = std::numeric_limits<double>::infinity();
  double diagonal = 1;
};

/// How thick the body is below a torn surface, at half of its lips at most.
Result<double> thickness_below(const TornModel& model, const ModelPose& pose,
                               const std::vector<std::uint32_t>& points,
                               const std::vector<DeformedMesh>& posed, double diagonal) {
  std::vector<double> found;
  auto query = SurfaceQuery::create(model);
  if (!query) return query.error();
  if (const Status status = query->set_pose(pose); !status) return status;
  const std::size_t step = 1 + points.size() / kMostRays;
  std::vector<bool> is_wanted;
  for (std::size_t i = 0; i < points.size(); i += step) {
    is_wanted.resize(std::max<std::size_t>(is_wanted.size(), points[i] + std::size_t{1}));
    is_wanted[points[i]] = true;
  }
  for (std::uint32_t m = 0; m < posed.size(); ++m) {
    const Mesh& mesh = model.character().meshes[m];
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t)
      for (std::uint32_t c = 0; c < 3 && !is_retired(mesh.triangles[t]); ++c) {
        const std::uint32_t point = model.point_at(m, t, c);
        if (point >= is_wanted.size() || !is_wanted[point]) continue;
        is_wanted[point] = false;
        const std::uint32_t v = mesh.triangles[t][c];
        const Vec3d inwards = -posed[m].normals[v].cast<double>();
        const double begin = 1e-3 * diagonal;
        const auto hit = query->cast_ray(
            {posed[m].positions[v].cast<double>() + begin * inwards, inwards, diagonal});
        if (!hit) return hit.error();
        if (*hit) found.push_back((*hit)->distance + begin);
      }
  }
  if (found.empty()) return std::numeric_limits<double>::infinity();
  const auto middle = found.begin() + static_cast<std::ptrdiff_t>(found.size() / 2);
  std::nth_element(found.begin(), middle, found.end());
  return *middle;
}

std::vector<std::uint32_t> points_of(const std::vector<ChangeRecord>& changes) {
  std::vector<std::uint32_t> points;
  for (const ChangeRecord& change : changes)
    for (const LipPair& pair : change.lips) points.push_back(pair.left);
  return points;
}

/// Tears a plain model to learn how long its wounds are, and how thick it is there.
Result<TornSource> measure(const std::shared_ptr<const Character>& character,
                           std::span<const Operation> history, const ModelPose& pose) {
  Result<TornModel> model = TornModel::create(character);
  if (!model) return model.error();
  TornSource found;
  std::vector<std::uint32_t> points;
  for (const Operation& operation : history) {
    std::vector<ChangeRecord> changes;
    const Result<TearReport> report = apply_operation(*model, operation, &changes);
    if (!report) return report.error();
    const std::vector<std::uint32_t> of_operation = points_of(changes);
    if (of_operation.empty() || std::holds_alternative<CutOperation>(operation)) continue;
    found.greatest_length = std::max(found.greatest_length, report->length_posed);
    points.insert(points.end(), of_operation.begin(), of_operation.end());
  }
  const Result<std::vector<DeformedMesh>> posed = pose_model(model->character(), pose);
  if (!posed) return posed.error();
  found.diagonal = bounds_of(model->character(), *posed).size().norm();
  const Result<double> thickness = thickness_below(*model, pose, points, *posed, found.diagonal);
  if (!thickness) return thickness.error();
  found.thickness = *thickness;
  return found;
}

/// How often wider the widest wound may be.
double room(const GapingModel& model, double thickness) {
  double room = std::numeric_limits<double>::infinity();
  for (const Wound& wound : model.wounds) {
    const double gap = widest_gap(model.instance, wound);
    const double wanted = std::min(kGapOfLength * wound.length, kGapOfThickness * thickness);
    if (gap > 0 && wound.length > 0) room = std::min(room, wanted / gap);
  }
  return room;
}

/// Whether the surface beside wide open lips turned over: the share of its area that did.
double folded_share(CharacterInstance& instance, const std::vector<DeformedMesh>& closed) {
  const std::vector<DeformedMesh> open = drawn(instance);
  double folded = 0, moved = 0;
  for (std::size_t m = 0; m < open.size(); ++m)
    for (const Triangle& triangle : instance.character().meshes[m].triangles) {
      const auto doubled_area = [&triangle](const DeformedMesh& mesh) {
        const Vec3f& a = mesh.positions[triangle[0]];
        return Vec3f((mesh.positions[triangle[1]] - a).cross(mesh.positions[triangle[2]] - a));
      };
      const Vec3f before = doubled_area(closed[m]), after = doubled_area(open[m]);
      if ((before - after).norm() < 0.01f * before.norm()) continue;
      moved += static_cast<double>(before.norm());
      if (before.dot(after) < 0) folded += static_cast<double>(before.norm());
    }
  return moved > 0 ? folded / moved : 0;
}

/// Chooses the tension, by how far the tissue opens under others, and closes the lips again.
Status choose_tension(GapingModel& model, const ModelPose& pose, double thickness) {
  const Result<CharacterInstance::TissueState> closed = model.instance.tissue();
  if (!closed) return closed.error();
  const Result<std::vector<DeformedMesh>> posed = deform_model(model.instance.character(), pose);
  if (!posed) return posed.error();
  double widest = std::numeric_limits<double>::infinity();  // Tension without folds.
  for (int i = 0; i < kMostTrials; ++i) {
    if (const Status status = open_lips(model.instance, pose); !status) return status;
    double factor = room(model, thickness);
    const double tension = model.tension.newtons_per_metre;
    if (folded_share(model.instance, *posed) > kFolded) widest = kLess * tension;
    factor = std::min(factor, widest / tension);
    if (const Status status = model.instance.restore_tissue(*closed); !status) return status;
    const bool is_enough =
        factor == std::numeric_limits<double>::infinity() || (factor > 0.97 && factor < 1.03);
    if (!is_enough) model.tension.newtons_per_metre *= factor;
    if (const Status status = model.instance.body()->set_tension(model.tension); !status)
      return status;
    if (is_enough) break;
  }
  return {};
}

Result<CharacterInstance> make_soft_instance(std::shared_ptr<const Character> character,
                                             double range) {
  CharacterAssetOptions options;
  options.unit_length = true;
  options.soft.emplace();
  options.soft->decomposition.range = range;
  options.soft->tension = {kFirstTension, {}};
  Result<CharacterInstance> instance = CharacterInstance::create(std::move(character), options);
  if (!instance) return instance;
  if (const Status status = instance->prepare_to_tear(); !status) return status;
  return instance;
}

}  // namespace

Result<GapingModel> make_gaping_model(std::shared_ptr<const Character> character,
                                      std::span<const Operation> history, const ModelPose& pose) {
  const Result<TornSource> source = measure(character, history, pose);
  if (!source) return source.error();
  double range = kMostRange;
  if (source->greatest_length > 0)
    range = std::clamp(kRangeOfLength * source->greatest_length / source->diagonal, kLeastRange,
                       kMostRange);
  Result<CharacterInstance> instance = make_soft_instance(std::move(character), range);
  if (!instance) return instance.error();
  GapingModel model{std::move(*instance), {}, {}, {kFirstTension, {}}};
  for (const Operation& operation : history) {
    std::vector<ChangeRecord> changes;
    Result<TearReport> report = model.instance.apply(operation, &changes);
    if (!report) return report.error();
    Wound wound = wound_of(changes);
    if (!std::holds_alternative<CutOperation>(operation)) wound.length = report->length_posed;
    if (!wound.lips.empty()) model.wounds.push_back(std::move(wound));
    model.reports.push_back(std::move(*report));
  }
  if (const Status status = choose_tension(model, pose, source->thickness); !status) return status;
  return model;
}

Wound wound_of(std::span<const ChangeRecord> changes) {
  Wound wound;
  for (const ChangeRecord& change : changes)
    wound.lips.insert(wound.lips.end(), change.lips.begin(), change.lips.end());
  return wound;
}

Status open_lips(CharacterInstance& instance, const ModelPose& pose) {
  for (int i = 0; i < kMostLipSteps; ++i) {
    if (const Status status = instance.advance(pose, kPictureStep); !status) return status;
    if (instance.body()->awake_count() == 0) break;
  }
  return instance.draw();
}

double widest_gap(const CharacterInstance& instance, const Wound& wound) {
  const SoftBody& body = *instance.body();
  double widest = 0;
  for (const LipPair& pair : wound.lips)
    widest = std::max(
        widest, (body.point_displacement(pair.left) - body.point_displacement(pair.right)).norm());
  return widest;
}

std::vector<DeformedMesh> drawn(CharacterInstance& instance) {
  std::vector<DeformedMesh> meshes(instance.character().meshes.size());
  for (std::uint32_t m = 0; m < meshes.size(); ++m) {
    const PosedMesh mesh = instance.mesh(m);
    meshes[m].positions.assign(mesh.positions.begin(), mesh.positions.end());
    meshes[m].normals.assign(mesh.normals.begin(), mesh.normals.end());
    meshes[m].tangents.assign(mesh.tangents.begin(), mesh.tangents.end());
  }
  return meshes;
}

namespace {

/// The vertices of each point of some wounds.
using VerticesOfPoint = std::map<std::uint32_t, std::vector<std::array<std::uint32_t, 2>>>;

VerticesOfPoint vertices_of(const CharacterInstance& instance, std::span<const Wound> wounds) {
  VerticesOfPoint vertices;
  for (const Wound& wound : wounds)
    for (const LipPair& pair : wound.lips) {
      vertices[pair.left];
      vertices[pair.right];
    }
  for (std::uint32_t m = 0; m < instance.character().meshes.size(); ++m) {
    const std::span<const std::uint32_t> points = instance.particles()->vertex_points(m);
    for (std::uint32_t v = 0; v < points.size(); ++v)
      if (const auto found = vertices.find(points[v]); found != vertices.end())
        found->second.push_back({m, v});
  }
  return vertices;
}

/// The share of its greatest width that a wound may have at a distance from one of its ends.
double taper(double from_end, double length) {
  const double t = 1 - std::min(1.0, from_end / (kTaper * length));
  return std::sqrt(std::max(0.0, 1 - t * t));
}

}  // namespace

void taper_wounds(const CharacterInstance& instance, std::span<const Wound> wounds,
                  const std::vector<DeformedMesh>& closed, std::vector<DeformedMesh>& open) {
  const VerticesOfPoint vertices = vertices_of(instance, wounds);
  const auto place = [&vertices](const std::vector<DeformedMesh>& meshes, std::uint32_t point) {
    const auto& of = vertices.at(point);
    return of.empty() ? Vec3f(Vec3f::Zero()) : meshes[of[0][0]].positions[of[0][1]];
  };
  for (const Wound& wound : wounds) {
    std::vector<double> along;
    double length = 0, widest = 0;
    for (std::size_t i = 0; i < wound.lips.size(); ++i) {
      const Vec3f here = place(closed, wound.lips[i].left);
      if (i > 0)
        length += static_cast<double>((here - place(closed, wound.lips[i - 1].left)).norm());
      along.push_back(length);
      const Vec3f gap = place(open, wound.lips[i].left) - place(open, wound.lips[i].right);
      widest = std::max(widest, static_cast<double>(gap.norm()));
    }
    if (!(length > 0) || !(widest > 0)) continue;
    const double step = length / static_cast<double>(wound.lips.size());  // Beyond the last pairs.
    for (std::size_t i = 0; i < wound.lips.size(); ++i) {
      const LipPair& pair = wound.lips[i];
      const Vec3f gap = place(open, pair.right) - place(open, pair.left);
      const double from_end = std::min(along[i], length - along[i]) + step / 2;
      const double width = static_cast<double>(gap.norm()),
                   allowed = widest * taper(from_end, length + step);
      if (width <= allowed) continue;
      const Vec3f move = static_cast<float>((width - allowed) / (2 * width)) * gap;
      for (const auto& [mesh, vertex] : vertices.at(pair.left))
        open[mesh].positions[vertex] += move;
      for (const auto& [mesh, vertex] : vertices.at(pair.right))
        open[mesh].positions[vertex] -= move;
    }
  }
}

void displace(CharacterInstance& instance, std::vector<DeformedMesh>& posed) {
  for (std::uint32_t m = 0; m < posed.size(); ++m) {
    const PosedMesh mesh = instance.mesh(m);
    posed[m].positions.assign(mesh.positions.begin(), mesh.positions.end());
    if (!mesh.normals.empty()) posed[m].normals.assign(mesh.normals.begin(), mesh.normals.end());
  }
  mend_normals(instance.character(), posed);
}

}  // namespace sunder::tools
