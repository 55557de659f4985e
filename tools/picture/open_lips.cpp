#include "tools/picture/open_lips.h"

#include <sunder/tear/contact.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "tools/picture/wound_tensions.h"

namespace sunder::tools {
namespace {

/// Range of the particles: a share of the wound's length, so that a wound has several along it,
/// within these fractions of the model's diagonal.
constexpr double kRangeOfLength = 0.25, kLeastRange = 0.02, kMostRange = 0.075;
constexpr double kFirstTension = 1.0;  ///< Newtons per metre, to begin the search with.
constexpr int kMostLipSteps = 180;
constexpr std::size_t kMostRays = 200, kFewestRays = 16;  ///< Of all wounds, and of each of them.

constexpr double kUnknownThickness = std::numeric_limits<double>::infinity();

struct TornSource {
  double greatest_length = 0;  ///< Of a wound, metres.
  /// Of the body below each wound, or kUnknownThickness; of all operations that left lips.
  std::vector<double> thicknesses;
  double diagonal = 1;
};

/// Rays from the lips of wounds to the surface below them.
class Thicknesses {
 public:
  /// @param points  per wound: some of its lips.
  Thicknesses(const std::vector<std::vector<std::uint32_t>>& points, double diagonal)
      : diagonal_(diagonal), found_(points.size()) {
    for (std::uint32_t w = 0; w < points.size(); ++w) {
      const std::size_t most = std::max(kMostRays / points.size(), kFewestRays);
      const std::size_t step = 1 + points[w].size() / most;
      for (std::size_t i = 0; i < points[w].size(); i += step) {
        wound_of_.resize(std::max<std::size_t>(wound_of_.size(), points[w][i] + std::size_t{1}),
                         kNone);
        wound_of_[points[w][i]] = w;
      }
    }
  }

  Status measure(const TornModel& model, const ModelPose& pose,
                 const std::vector<DeformedMesh>& posed) {
    auto query = SurfaceQuery::create(model);
    if (!query) return query.error();
    if (const Status status = query->set_pose(pose); !status) return status;
    for (std::uint32_t m = 0; m < posed.size(); ++m) {
      const Mesh& mesh = model.character().meshes[m];
      for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t)
        for (std::uint32_t c = 0; c < 3 && !is_retired(mesh.triangles[t]); ++c) {
          const std::uint32_t point = model.point_at(m, t, c);
          if (point >= wound_of_.size() || wound_of_[point] == kNone) continue;
          const std::uint32_t wound = std::exchange(wound_of_[point], kNone);
          if (const Status status = cast(*query, posed[m], mesh.triangles[t][c], wound); !status)
            return status;
        }
    }
    return {};
  }

  /// The median per wound.
  std::vector<double> finish() {
    std::vector<double> medians;
    for (std::vector<double>& of : found_) {
      const auto middle = of.begin() + static_cast<std::ptrdiff_t>(of.size() / 2);
      if (!of.empty()) std::nth_element(of.begin(), middle, of.end());
      medians.push_back(of.empty() ? kUnknownThickness : *middle);
    }
    return medians;
  }

 private:
  Status cast(SurfaceQuery& query, const DeformedMesh& posed, std::uint32_t vertex,
              std::uint32_t wound) {
    const Vec3d inwards = -posed.normals[vertex].cast<double>();
    const double begin = 1e-3 * diagonal_;
    const auto hit = query.cast_ray(
        {posed.positions[vertex].cast<double>() + begin * inwards, inwards, diagonal_});
    if (!hit) return hit.error();
    if (*hit) found_[wound].push_back((*hit)->distance + begin);
    return {};
  }

  double diagonal_;
  std::vector<std::uint32_t> wound_of_;  ///< Per point; kNone: no ray begins there.
  std::vector<std::vector<double>> found_;
};

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
  std::vector<std::vector<std::uint32_t>> points;
  for (const Operation& operation : history) {
    std::vector<ChangeRecord> changes;
    const Result<TearReport> report = apply_operation(*model, operation, &changes);
    if (!report) return report.error();
    std::vector<std::uint32_t> of_operation = points_of(changes);
    if (of_operation.empty()) continue;
    if (std::holds_alternative<CutOperation>(operation))
      of_operation.clear();  // Its lips gape as they will.
    else
      found.greatest_length = std::max(found.greatest_length, report->length_posed);
    points.push_back(std::move(of_operation));
  }
  const Result<std::vector<DeformedMesh>> posed = pose_model(model->character(), pose);
  if (!posed) return posed.error();
  found.diagonal = bounds_of(model->character(), *posed).size().norm();
  Thicknesses thicknesses(points, found.diagonal);
  if (const Status status = thicknesses.measure(*model, pose, *posed); !status) return status;
  found.thicknesses = thicknesses.finish();
  return found;
}

Result<CharacterInstance> make_soft_instance(std::shared_ptr<const Character> character,
                                             double range, const AuthoredTissue& authored) {
  CharacterAssetOptions options;
  options.unit_length = true;
  options.soft.emplace();
  options.soft->decomposition.range = range;
  options.soft->tension = {kFirstTension, {}};
  options.soft->authored = authored;
  Result<CharacterInstance> instance = CharacterInstance::create(std::move(character), options);
  if (!instance) return instance;
  if (const Status status = instance->prepare_to_tear(); !status) return status;
  return instance;
}

/// The part of a history before the sutures at its end.
std::span<const Operation> without_last_sutures(std::span<const Operation> history) {
  while (!history.empty() && std::holds_alternative<SutureOperation>(history.back()))
    history = history.first(history.size() - 1);
  return history;
}

Status apply_to(GapingModel& model, std::span<const Operation> operations) {
  for (const Operation& operation : operations) {
    std::vector<ChangeRecord> changes;
    Result<TearReport> report = model.instance.apply(operation, &changes);
    if (!report) return report.error();
    Wound wound = wound_of(changes);
    if (!std::holds_alternative<CutOperation>(operation)) wound.length = report->length_posed;
    if (!wound.lips.empty()) model.wounds.push_back(std::move(wound));
    model.reports.push_back(std::move(*report));
  }
  return {};
}

/// Makes a model anew of authored tissue, under the tension that was chosen for uniform tissue: a
/// choice on authored tissue would undo what its author wants to see.
Status author(std::shared_ptr<const Character> character, double range,
              const AuthoredTissue& authored, std::span<const Operation> tears,
              GapingModel& model) {
  Result<CharacterInstance> instance = make_soft_instance(std::move(character), range, authored);
  if (!instance) return instance.error();
  GapingModel made{std::move(*instance), {}, {}, model.tension};
  if (const Status status = apply_to(made, tears); !status) return status;
  if (const Status status = made.instance.body()->set_tension(made.tension); !status) return status;
  model = std::move(made);
  return {};
}

}  // namespace

Result<GapingModel> make_gaping_model(std::shared_ptr<const Character> character,
                                      std::span<const Operation> history, const ModelPose& pose,
                                      const AuthoredTissue& authored) {
  const Result<TornSource> source = measure(character, history, pose);
  if (!source) return source.error();
  double range = kMostRange;
  if (source->greatest_length > 0)
    range = std::clamp(kRangeOfLength * source->greatest_length / source->diagonal, kLeastRange,
                       kMostRange);
  Result<CharacterInstance> instance = make_soft_instance(character, range, {});
  if (!instance) return instance.error();
  GapingModel model{std::move(*instance), {}, {}, {kFirstTension, {}}};
  // Threads hold wounds that would gape as wide as others: the tension is that without them.
  const std::span<const Operation> tears = without_last_sutures(history);
  if (const Status status = apply_to(model, tears); !status) return status;
  if (const Status status = choose_tensions(model, pose, source->thicknesses); !status)
    return status;
  if (!authored.empty())
    if (const Status status = author(std::move(character), range, authored, tears, model); !status)
      return status;
  if (const Status status = apply_to(model, history.subspan(tears.size())); !status) return status;
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

void displace(CharacterInstance& instance, std::vector<DeformedMesh>& posed) {
  for (std::uint32_t m = 0; m < posed.size(); ++m) {
    const PosedMesh mesh = instance.mesh(m);
    posed[m].positions.assign(mesh.positions.begin(), mesh.positions.end());
    if (!mesh.normals.empty()) posed[m].normals.assign(mesh.normals.begin(), mesh.normals.end());
  }
  mend_normals(instance.character(), posed);
}

}  // namespace sunder::tools
