#include "tools/picture/torn_picture.h"

#include <sunder/skinning/pose.h>
#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <string>
#include <vector>

#include "tools/messages/progress_bar.h"
#include "tools/model/history.h"
#include "tools/model/posed_model.h"
#include "tools/picture/open_lips.h"
#include "tools/picture/rims.h"
#include "tools/picture/sewn_threads.h"
#include "tools/picture/taper_wounds.h"
#include "tools/picture/torn_scene.h"
#include "tools/picture/view.h"
#include "tools/picture/wound_view.h"
#include "tools/render/trace.h"

namespace sunder::tools {
namespace {

constexpr PictureSize kSize = {1280, 960};
// As a fraction of the diagonal of the model.
constexpr double kThickness = 0.006;  ///< Of the flesh.
constexpr double kApart = 0.05;       ///< Distance by which the pieces of a cut are moved.
constexpr double kNearWound = 0.4;    ///< Of parts of a robot that the picture shows.

/// Whether an operation leaves a wound: it does not only change weights or take off a piece.
bool is_visible(const Operation& operation) {
  return !std::holds_alternative<WeightsOperation>(operation) &&
         !std::holds_alternative<DetachOperation>(operation);
}

/// The most recent operation that is visible.
const Operation& newest_of(std::span<const Operation> history) {
  const auto newest = std::find_if(history.rbegin(), history.rend(), is_visible);
  return newest == history.rend() ? history.back() : *newest;
}

/// A view from the side of the operation, a little from above and from the right. A cut is seen
/// along its plane.
ViewFrame view_of(const Operation& operation, const Bounds& bounds) {
  ViewFrame frame = choose_view(bounds);
  Vec3d from = frame.towards_eye;
  if (const auto* tear = std::get_if<TearOperation>(&operation)) {
    from = Vec3d::Zero();
    for (const Blade& blade : tear->stroke) from += (blade.base - blade.tip).normalized();
  } else if (const auto* drill = std::get_if<DrillOperation>(&operation)) {
    from = -drill->bore.direction;
  } else if (const auto* cut = std::get_if<CutOperation>(&operation)) {
    const Vec3d normal = cut->cut.normal.normalized();
    from -= 0.8 * normal.dot(from) * normal;
  }
  if (!(from.norm() > 0)) return frame;
  from.normalize();
  const Vec3d upright = std::abs(from.y()) < 0.9 ? Vec3d(Vec3d::UnitY()) : Vec3d(Vec3d::UnitZ());
  frame.towards_eye = (from + 0.35 * upright.cross(from).normalized() + 0.2 * upright).normalized();
  frame.right = upright.cross(frame.towards_eye).normalized();
  frame.up = frame.towards_eye.cross(frame.right);
  return frame;
}

/// A robot that holds the blade stands between the eye and the wound: the view goes to its side.
ViewFrame view_beside(const ViewFrame& frame) {
  return view_from(0.45 * frame.towards_eye + 0.85 * frame.right + 0.35 * frame.up);
}

/// Adds the places of a robot that are near the wound.
void add_places_of_robot(const std::vector<Mesh>& surfaces, double diagonal,
                         std::vector<Vec3d>& places) {
  if (places.empty()) return;
  Vec3d centre = Vec3d::Zero();
  for (const Vec3d& place : places) centre += place / static_cast<double>(places.size());
  for (const Vec3d& place : places_near(surfaces, centre, kNearWound * diagonal))
    places.push_back(place);
}

/// The places of rims, walls and caps.
std::vector<Vec3d> wound_places(const TornModel& torn, const std::vector<RimEdge>& rims,
                                const std::vector<DeformedMesh>& posed) {
  std::vector<Vec3d> places;
  for (const RimEdge& edge : rims)
    places.emplace_back(posed[edge.mesh].positions[edge.a].cast<double>());
  for (std::uint32_t m = 0; m < torn.character().meshes.size(); ++m) {
    const Mesh& mesh = torn.character().meshes[m];
    for (std::uint32_t t = torn.source().meshes[m].triangle_count(); t < mesh.triangle_count(); ++t)
      if (!is_retired(mesh.triangles[t]) &&
          torn.source_triangle(m, t) >= torn.source().meshes[m].triangle_count())
        places.emplace_back(posed[m].positions[mesh.triangles[t][0]].cast<double>());
  }
  return places;
}

/// The picture of a cut shows its pieces, that of a bore its surroundings.
double surroundings_of(const Operation& operation) {
  if (std::holds_alternative<CutOperation>(operation)) return 3.1;
  return std::holds_alternative<DrillOperation>(operation) ? 2.4 : 1.45;
}

/// Shows the wound in the middle, with its surroundings; at most the whole model.
Camera aim(const ViewFrame& frame, const std::vector<Vec3d>& wound, const Bounds& bounds,
           double surroundings) {
  Camera camera;
  camera.up = frame.up;
  camera.focal_point = bounds.centre();
  double radius = 0.5 * bounds.size().norm();
  if (!wound.empty()) {
    Bounds of_wound;
    for (const Vec3d& place : wound) {
      of_wound.least = of_wound.least.cwiseMin(place);
      of_wound.greatest = of_wound.greatest.cwiseMax(place);
    }
    double beside = 0;
    for (const Vec3d& place : wound) {
      const Vec3d offset = place - of_wound.centre();
      beside =
          std::max({beside, std::abs(offset.dot(frame.right)), std::abs(offset.dot(frame.up))});
    }
    camera.focal_point = of_wound.centre();
    radius = std::min(radius, surroundings * beside);
  }
  camera.eye =
      camera.focal_point +
      radius / std::tan(camera.view_angle_degrees / 2 * std::numbers::pi / 180) * frame.towards_eye;
  return camera;
}

/// The pieces of an operation that no later one has taken off.
Result<std::vector<PieceDescription>> pieces_left(const TornModel& torn, const TearReport& report) {
  std::vector<PieceDescription> pieces;
  for (const TornPiece& piece : report.pieces) {
    Result<PieceDescription> description = torn.describe_piece(piece);
    if (description)
      pieces.push_back(std::move(*description));
    else if (description.error().code() != StatusCode::not_found)
      return description.error();
  }
  return pieces;
}

/// Moves the pieces of a cut away from its plane, to both sides.
void move_apart(const Character& character, const PlaneCut& cut,
                const std::vector<PieceDescription>& pieces, double distance,
                std::vector<DeformedMesh>& posed) {
  const Vec3d normal = cut.normal.normalized();
  for (const PieceDescription& piece : pieces) {
    const double side = (piece.centroid_posed - cut.point).dot(normal) < 0 ? -1.0 : 1.0;
    for (const PieceDescription::Triangles& part : piece.meshes) {
      std::vector<std::uint32_t> vertices;
      for (const std::uint32_t t : part.triangles)
        for (const std::uint32_t vertex : character.meshes[part.mesh].triangles[t])
          vertices.push_back(vertex);
      std::sort(vertices.begin(), vertices.end());
      vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
      for (const std::uint32_t vertex : vertices)
        posed[part.mesh].positions[vertex] += Vec3d(side * distance * normal).cast<float>();
    }
  }
}

Result<BloodCovers> blood_of(const TornModel& torn, const ModelPose& pose,
                             std::span<const Wound> wounds, const ModelLooks& looks) {
  double length = 0;
  for (const Wound& wound : wounds) length += wound.length;
  return BloodCovers::create(torn, pose, looks, length);
}

/// The view of a wound; says if there is none that shows it.
ViewFrame seen_wound(const RenderScene& scene, const ViewFrame& preferred,
                     const std::filesystem::path& png, const Messages& messages) {
  const WoundView seen = see_wound(scene, preferred);
  if (seen.is_covered)
    messages.warn(png.string() +
                  ": the picture does not show the wound: other surfaces cover it from all sides");
  return seen.frame;
}

}  // namespace

Status draw_torn(const LoadedCharacter& loaded, std::span<const Operation> history,
                 const std::filesystem::path& png, const Messages& messages, Budget& budget,
                 const PosedRobot* robot, const AuthoredTissue& authored) {
  ProgressBar progress(4);
  progress.begin_step(0, "drawing: tearing soft tissue");
  const Operation& newest = newest_of(history);
  const Result<ModelPose> pose = make_pose(*loaded.character, last_pose_of(newest));
  if (!pose) return pose.error();
  Result<GapingModel> model = make_gaping_model(loaded.character, history, *pose, authored);
  if (!model) return model.error();
  CharacterInstance& instance = model->instance;
  const TornModel& torn = *instance.model();
  Result<std::vector<PieceDescription>> pieces = std::vector<PieceDescription>();
  for (std::size_t i = 0; i < history.size(); ++i) {
    if (!is_visible(history[i])) continue;
    pieces = pieces_left(torn, model->reports[i]);
    if (!pieces) return pieces.error();
  }
  const Result<std::vector<DeformedMesh>> closed = pose_model(torn.character(), *pose);
  if (!closed) return closed.error();

  const Bounds bounds = bounds_of(torn.character(), *closed);
  const double diagonal = bounds.size().norm();
  std::vector<DeformedMesh> open = *closed;
  progress.begin_step(1, "drawing: opening lips");
  if (const Status status = open_lips(instance, *pose); !status) return status;
  displace(instance, open);
  std::vector<Wound> wounds = model->wounds;
  std::erase_if(wounds, [](const Wound& wound) { return !(wound.length > 0); });
  taper_wounds(instance, wounds, *closed, open);
  const auto* const cut = std::get_if<CutOperation>(&newest);
  if (cut != nullptr) move_apart(torn.character(), cut->cut, *pieces, kApart * diagonal, open);

  ViewFrame frame = view_of(newest, bounds);
  Result<std::vector<Mesh>> beside =
      robot == nullptr ? std::vector<Mesh>() : robot_surfaces(*robot);
  if (!beside) return beside.error();
  if (robot != nullptr) frame = view_beside(frame);
  progress.begin_step(2, "drawing: reading images");
  const Result<ModelLooks> looks = ModelLooks::create(loaded.source.get());
  if (!looks) return looks.error();
  if (const std::string missing = looks->missing_textures(); !missing.empty())
    messages.warn(png.string() + ": " + missing);
  const Result<BloodCovers> blood = blood_of(torn, *pose, wounds, *looks);
  if (!blood) return blood.error();
  RenderScene scene =
      make_torn_scene({torn, *closed, open, wounds, *blood}, *looks, kThickness * diagonal);
  add_threads(thread_tubes(torn, open, thread_loads(*instance.body()), kThickness * diagonal),
              scene);
  add_surfaces(*beside, *looks, scene);
  if (cut == nullptr)
    frame = seen_wound(scene, frame, png, messages);  // A cut is seen along its plane.
  std::vector<Vec3d> shown = wound_places(torn, find_rims(torn), open);
  if (robot != nullptr) add_places_of_robot(*beside, diagonal, shown);
  const Camera camera = aim(frame, shown, bounds, robot == nullptr ? surroundings_of(newest) : 1.1);
  progress.begin_step(3, "drawing");
  const Picture picture = trace(scene, camera, kSize);
  const Budget::Writing writing(budget);
  return write_png(png, picture);
}

}  // namespace sunder::tools
