#include "tools/tear/miss.h"

#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <memory>
#include <utility>
#include <variant>
#include <vector>

#include "tools/messages/printed.h"
#include "tools/tear/reach.h"

namespace sunder::tools {
namespace {

/// The posed faces that all attempts together may test, and those that a miss is measured with:
/// each about a third of a second.
constexpr std::size_t kMostPosedFaces = 1'000'000;
constexpr std::size_t kMostMissedPoses = 32;
constexpr std::size_t kTimesPerClip = 8;

/// A unit other than metres: factors that turn a number into metres, or metres into the unit.
struct OtherUnit {
  double factor;
  const char* advice;
};
constexpr OtherUnit kOtherUnits[] = {
    {0.01, "scaled by 0.01 it would meet: are its numbers centimetres? Operations are in metres"},
    {0.001, "scaled by 0.001 it would meet: are its numbers millimetres? Operations are in metres"},
    {100,
     "scaled by 100 it would meet: is the model in centimetres? `sunder info` shows its bounds"},
    {1000,
     "scaled by 1000 it would meet: is the model in millimetres? `sunder info` shows its bounds"},
};

double diagonal(const Bounds& bounds) { return bounds.size().norm(); }

/// The factors by which a stroke that is too small is enlarged.
constexpr double kEnlargements[] = {4, 16, 64};

using Source = std::shared_ptr<const Character>;

bool one_meets(const PosedSurface& surface, const Operation& operation) {
  return std::ranges::any_of(reaches_of(operation),
                             [&](const Reach& reach) { return meets(surface, reach); });
}

/// Whether an operation opens the surface of the source. What passes near it, or ends on it, does
/// not always.
bool is_hit(const Operation& operation, const Source& source) {
  Result<TornModel> model = TornModel::create(source);
  if (!model) return false;
  const Result<TearReport> report = apply_operation(*model, operation);
  return report && report->runs > 0;
}

/// Evidence of another unit: the scaled operation meets, and the unscaled one is farther away than
/// the model is large, or much smaller than it.
std::string unit_advice(const Operation& operation, const PosedSurface& surface, double distance,
                        const Source& source) {
  const std::vector<Reach> reaches = reaches_of(operation);
  Bounds reached;
  for (const Reach& reach : reaches) {
    const Bounds bounds = bounds_of(reach);
    reached.least = reached.least.cwiseMin(bounds.least);
    reached.greatest = reached.greatest.cwiseMax(bounds.greatest);
  }
  const double size = diagonal(surface.bounds);
  for (const OtherUnit& unit : kOtherUnits) {
    const bool is_plausible = unit.factor < 1 ? distance > size : diagonal(reached) < 0.2 * size;
    const Operation corrected = scaled(operation, unit.factor);
    if (is_plausible && one_meets(surface, corrected) && is_hit(corrected, source))
      return unit.advice;
  }
  return {};
}

/// Evidence that the blades or the axis are too short or point away.
std::string direction_advice(const Operation& operation, const PosedSurface& surface,
                             double distance, const Source& source) {
  const bool is_bore = std::holds_alternative<DrillOperation>(operation);
  if (!is_bore && !std::holds_alternative<TearOperation>(operation)) return {};
  Bounds reached = bounds_of(reaches_of(operation).front());
  const double length = distance + diagonal(reached) + 2 * diagonal(surface.bounds);
  const auto would_meet = [&](const Operation& corrected) {
    return one_meets(surface, corrected) && is_hit(corrected, source);
  };
  if (would_meet(lengthened(operation, length)))
    return is_bore ? "the bore is not deep enough to reach it"
                   : "the blade is too short to reach it";
  if (would_meet(lengthened(turned_round(operation), length)))
    return is_bore ? "the bore points away from it: is its direction reversed?"
                   : "the blade points away from it: are base and tip swapped?";
  return {};
}

/// Evidence that a stroke on the surface is too small to be torn into the faces there.
std::string size_advice(const Operation& operation, const Source& source) {
  if (!std::holds_alternative<TearOperation>(operation)) return {};
  for (const double factor : kEnlargements)
    if (is_hit(enlarged(operation, factor), source))
      return printed("it is too small for the faces there: %g times as long it would meet", factor);
  return {};
}

/// A pose in which an operation may have been meant.
struct OtherPose {
  PoseSpec pose;
  std::string name;
};

void add_times(const Clip& clip, std::uint32_t index, std::vector<OtherPose>& poses) {
  const double duration = static_cast<double>(clip.duration);
  for (std::size_t i = 0; i < kTimesPerClip; ++i) {
    // The time that is tried is the one that is printed.
    const std::string text =
        printed("%.4g", duration * static_cast<double>(i) / (kTimesPerClip - 1));
    poses.push_back({ClipPose{index, std::strtod(text.c_str(), nullptr)},
                     "at " + text + " s of clip '" + clip.name + "'"});
  }
}

/// The rest and the bind pose, the times of the operation's own clip, and those of the others.
std::vector<OtherPose> other_poses(const PoseSpec& own, const Character& character) {
  std::vector<OtherPose> poses;
  if (!std::holds_alternative<RestPose>(own)) poses.push_back({RestPose{}, "in the rest pose"});
  if (!std::holds_alternative<BindPose>(own)) poses.push_back({BindPose{}, "in the bind pose"});
  const auto* const clip_pose = std::get_if<ClipPose>(&own);
  const auto is_own = [&](std::uint32_t i) {
    if (clip_pose == nullptr) return false;
    const auto* const name = std::get_if<std::string>(&clip_pose->clip);
    return name != nullptr ? *name == character.clips[i].name
                           : std::get<std::uint32_t>(clip_pose->clip) == i;
  };
  for (const bool wanted : {true, false})
    for (std::uint32_t i = 0; i < character.clips.size() && poses.size() < kMostMissedPoses; ++i)
      if (is_own(i) == wanted) add_times(character.clips[i], i, poses);
  return poses;
}

/// Evidence of another pose.
Result<std::string> pose_advice(const Operation& operation, const Character& character,
                                const PosedSurface& surface, const Source& source) {
  const std::vector<Reach> reaches = reaches_of(operation);
  std::vector<OtherPose> poses = other_poses(reaches.front().pose, character);
  const std::size_t faces = surface.triangles.size() * reaches.front().shape.size() + 1;
  poses.resize(std::min(poses.size(), std::max<std::size_t>(4, kMostPosedFaces / faces)));
  for (const OtherPose& other : poses) {
    const Result<ModelPose> pose = make_pose(character, other.pose);
    if (!pose) return pose.error();
    const Result<PosedSurface> posed = pose_surface(character, *pose);
    if (!posed) return posed.error();
    if (one_meets(*posed, operation) && is_hit(in_pose(operation, other.pose), source))
      return other.name + " it would meet: is its pose right?";
  }
  return std::string();
}

bool has_retired(const TornModel& model) {
  for (std::size_t m = 0; m < model.source().meshes.size(); ++m) {
    const auto& triangles = model.character().meshes[m].triangles;
    if (std::ranges::any_of(triangles, is_retired)) return true;
  }
  return false;
}

std::size_t face_count(const Character& character) {
  std::size_t count = 0;
  for (const Mesh& mesh : character.meshes) count += mesh.triangles.size();
  return count;
}

/// Finds where an operation comes nearest to the surface, one of its poses after the other.
class MissMeasure {
 public:
  MissMeasure(const TornModel& model, PosedSource& source)
      : model_(model), source_(source), is_whole_(!has_retired(model)) {
    miss_.distance = std::numeric_limits<double>::infinity();
  }

  /// @return whether it comes nearer than in the poses before.
  Result<bool> look(const Reach& reach) {
    const Result<ModelPose> pose = make_pose(model_.source(), reach.pose);
    if (!pose) return pose.error();
    PosedSurface torn;
    if (!is_whole_) {
      Result<PosedSurface> surface = pose_surface(model_.character(), *pose);
      if (!surface) return surface.error();
      torn = std::move(*surface);
    }
    const Result<const PosedSurface*> whole = is_whole_ ? source_.in(*pose) : &torn;
    if (!whole) return whole.error();
    const Nearest nearest = nearest_of(**whole, reach);
    const bool is_nearer = nearest.distance < miss_.distance;
    if (!is_nearer && !miss_.bounds.is_empty()) return false;
    miss_.bounds = (*whole)->bounds;
    if (!is_nearer) return false;
    miss_.distance = nearest.distance;
    miss_.blade = reach.first_blade + static_cast<std::uint32_t>(nearest.part / 2);
    miss_.place.reset();
    if (reach.plane || nearest.distance == 0) return true;
    const NearestPlaces places =
        nearest_places(reach.shape[nearest.part], (*whole)->triangles[nearest.triangle]);
    miss_.place = places.of_first;
    miss_.way = places.of_second - places.of_first;
    return true;
  }

  [[nodiscard]] const Miss& miss() const { return miss_; }

 private:
  static Nearest nearest_of(const PosedSurface& surface, const Reach& reach) {
    if (reach.plane) return {distance_between(surface, reach), 0, 0};
    return find_nearest(surface, reach.shape);
  }

  const TornModel& model_;
  PosedSource& source_;
  bool is_whole_;
  Miss miss_;
};

const char* what_passes(const Operation& operation) {
  if (std::holds_alternative<TearOperation>(operation)) return "the blade passes";
  if (const auto* const cut = std::get_if<CutOperation>(&operation))
    return cut->cut.bounds.empty() ? "the plane passes" : "the plane, within its bounds, passes";
  return "the axis of the bore passes";
}

}  // namespace

Result<Miss> measure_miss(const Operation& operation, const TornModel& model, PosedSource& source) {
  const std::vector<Reach> reaches = reaches_of(operation);
  MissMeasure measure(model, source);
  // A blade that moves while a clip runs has a pose for each of its places, up to thousands. They
  // are tried in steps, and all of them around the nearest.
  const std::size_t affordable =
      std::max<std::size_t>(8, kMostPosedFaces / 2 / (face_count(model.source()) + 1));
  const std::size_t step = 1 + reaches.size() / affordable;
  std::size_t nearest = 0;
  for (std::size_t i = 0; i < reaches.size(); i += step) {
    const Result<bool> is_nearer = measure.look(reaches[i]);
    if (!is_nearer) return is_nearer.error();
    if (*is_nearer) nearest = i;
  }
  const std::size_t around = std::min(step, affordable / 2);
  for (std::size_t i = nearest - std::min(nearest, around - 1);
       i < std::min(reaches.size(), nearest + around); ++i)
    if (const Result<bool> is_nearer = measure.look(reaches[i]); !is_nearer)
      return is_nearer.error();
  return measure.miss();
}

Result<std::string> cause_of_miss(const Operation& operation, const Miss& miss,
                                  const TornModel& model, const Source& source) {
  if (std::holds_alternative<WeldOperation>(operation))
    return std::string(
        "no lips lie on one another; those of gaps and bores, and of a file that was torn before, "
        "cannot be welded");
  if (std::holds_alternative<SutureOperation>(operation))
    return std::string(
        "no lips lie on one another; those of gaps and bores, and of a file that was torn before, "
        "cannot be sewn");
  if (miss.bounds.is_empty()) return std::string("the model has no surface left");
  if (miss.distance == 0) return size_advice(operation, source);
  const Character& character = model.character();
  const Result<ModelPose> pose = make_pose(character, reaches_of(operation).front().pose);
  if (!pose) return pose.error();
  const Result<PosedSurface> surface = pose_surface(character, *pose);
  if (!surface) return surface.error();
  std::string cause = unit_advice(operation, *surface, miss.distance, source);
  if (!cause.empty()) return cause;
  Result<std::string> other_pose = pose_advice(operation, character, *surface, source);
  if (!other_pose || !other_pose->empty()) return other_pose;
  return direction_advice(operation, *surface, miss.distance, source);
}

std::string miss_text(const Operation& operation, const Miss& miss) {
  if (miss.bounds.is_empty()) return miss.cause;
  std::string text = std::string(what_passes(operation));
  text += miss.distance > 0 ? printed(" %.4g m from the surface", miss.distance)
                            : std::string(", without opening a face, along the surface");
  text += ", which spans " + point_text(miss.bounds.least) + " to " +
          point_text(miss.bounds.greatest) + " in this pose";
  if (miss.place)
    text += "; it comes nearest at " + point_text(*miss.place) + ", and moved by " +
            point_text(miss.way) + " it would touch it";
  return miss.cause.empty() ? text : text + "; " + miss.cause;
}

Json to_json(const Miss& miss) {
  Json json = Json::object();
  json["cause"] = miss.cause.empty() ? Json() : Json(miss.cause);
  if (miss.bounds.is_empty()) return json;
  json["distance"] = miss.distance;
  if (miss.place) {
    json["place"] = vector_json(*miss.place);
    json["way"] = vector_json(miss.way);
  }
  json["bounds"] = {{"min", vector_json(miss.bounds.least)},
                    {"max", vector_json(miss.bounds.greatest)}};
  return json;
}

}  // namespace sunder::tools
