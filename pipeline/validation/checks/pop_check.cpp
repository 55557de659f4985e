#include "pipeline/validation/checks/pop_check.h"

#include <sunder/skinning/pose.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <limits>
#include <span>
#include <type_traits>

#include "core/internal/or_throw.h"
#include "core/internal/ordered.h"
#include "core/operation/internal/names.h"
#include "pipeline/validation/match/bind_surface.h"
#include "pipeline/validation/match/closest_on_triangle.h"
#include "pipeline/validation/match/position_table.h"
#include "skinning/internal/reference.h"

namespace sunder::validation {
namespace {

/// The vertices of a torn model in a pose.
class PosedModel {
 public:
  PosedModel(const TornModel& model, ModelPose pose)
      : model_(model), palettes_(bind_palettes(model.character(), pose)), pose_(std::move(pose)) {}

  [[nodiscard]] Vec3d place(Index mesh, Index vertex) const {
    const Mesh& of = model_.character().meshes[mesh];
    const std::vector<Affine3d>& palette = palettes_[of.skin];
    const Index entry = model_.influence_place(mesh, vertex);
    return entry == kNone ? deform_position_reference(of, vertex, palette, pose_.morph_weights)
                          : exact_place(of, model_.influence_positions(mesh), vertex, entry);
  }

 private:
  /// A vertex of the policy `exact` has one bind position per influence.
  [[nodiscard]] Vec3d exact_place(const Mesh& mesh, const InfluencePositions& exact, Index vertex,
                                  std::size_t entry) const {
    Vec3d sum = Vec3d::Zero();
    for (const Influence& influence : mesh.weights.of(vertex)) {
      Vec3d position = exact.positions[entry].cast<double>();
      for (std::size_t i = 0; i < exact.morph_targets.size(); ++i)
        if (!exact.morph_targets[i].positions.empty())
          position += static_cast<double>(pose_.morph_weights[mesh.first_morph_weight + i]) *
                      exact.morph_targets[i].positions[entry].cast<double>();
      const Affine3d& bone = palettes_[mesh.skin][influence.slot];
      sum += multiply(bone.linear(), position) +
             static_cast<double>(influence.weight) * Vec3d(bone.translation());
      ++entry;
    }
    return sum;
  }

  const TornModel& model_;
  std::vector<std::vector<Affine3d>> palettes_;
  ModelPose pose_;
};

/// The place on the source's mesh where a vertex was made, which no policy moves. Nothing for a
/// vertex of a wall or cap.
std::optional<Vec3d> origin_of(const TornModel& model, Index mesh, Index vertex) {
  const Mesh& source = model.source().meshes[mesh];
  if (vertex < source.vertex_count()) return source.positions[vertex].cast<double>();
  const Birth birth = model.birth(mesh, vertex);
  if (birth.triangle >= source.triangle_count()) return {};
  Vec3d place = Vec3d::Zero();
  for (std::size_t k = 0; k < 3; ++k)
    place +=
        birth.barycentric[k] * source.positions[source.triangles[birth.triangle][k]].cast<double>();
  return place;
}

/// The part of a mesh that a step of an operation changed, as it was before.
class SurfaceBefore {
 public:
  SurfaceBefore(const TornModel& model, const MeshChange& change)
      : model_(model), mesh_(change.mesh), corners_(3 * change.rewritten.size()) {
    const Mesh& source = model.source().meshes[mesh_];
    for (const RewrittenTriangle& rewritten : change.rewritten) {
      if (rewritten.triangle >= change.first_triangle || is_retired(rewritten.before)) continue;
      const Index origin = model.source_triangle(mesh_, rewritten.triangle);
      if (origin < source.triangle_count()) add(origin, rewritten.before);
    }
    std::ranges::stable_sort(faces_, {}, &Face::source_triangle);
  }

  /// How far a new vertex, posed at `at`, is from its place on this surface. Nothing if the surface
  /// does not have the place.
  [[nodiscard]] std::optional<double> distance(Index vertex, const Vec3d& at,
                                               const PosedModel& posed) const {
    const std::optional<Vec3d> origin = origin_of(model_, mesh_, vertex);
    if (!origin) return {};
    std::optional<double> least;
    corners_.find(*origin, [&](Index corner) {
      const double distance = norm(at - posed.place(mesh_, corner));
      least = least ? std::min(*least, distance) : distance;
      return false;
    });
    if (least) return least;
    const Index triangle = model_.birth(mesh_, vertex).triangle;
    std::span<const Face> faces(
        std::ranges::lower_bound(faces_, triangle, {}, &Face::source_triangle),
        std::ranges::upper_bound(faces_, triangle, {}, &Face::source_triangle));
    if (faces.empty()) faces = faces_;
    const Face* nearest = nullptr;
    PlaceOnTriangle place;
    place.distance = std::numeric_limits<double>::infinity();
    for (const Face& face : faces) {
      const auto& [a, b, c] = face.origins;
      const PlaceOnTriangle on_face = closest_on_triangle(*origin, a, b, c);
      if (on_face.distance >= place.distance) continue;
      place = on_face;
      nearest = &face;
    }
    if (nearest == nullptr) return {};
    Vec3d before = Vec3d::Zero();
    for (std::size_t k = 0; k < 3; ++k)
      before += place.barycentric[k] * posed.place(mesh_, nearest->vertices[k]);
    return norm(at - before);
  }

 private:
  struct Face {
    Index source_triangle = 0;
    Triangle vertices = {};
    std::array<Vec3d, 3> origins;
  };

  void add(Index source_triangle, const Triangle& vertices) {
    Face face{source_triangle, vertices, {}};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::optional<Vec3d> origin = origin_of(model_, mesh_, vertices[k]);
      if (!origin) return;
      face.origins[k] = *origin;
    }
    for (std::size_t k = 0; k < 3; ++k) corners_.insert(face.origins[k], vertices[k]);
    faces_.push_back(face);
  }

  const TornModel& model_;
  Index mesh_;
  PositionTable corners_;    // vertices by the places where they were made
  std::vector<Face> faces_;  // ascending by source triangle
};

/// The poses of an operation, one per record of its changes.
std::vector<const PoseSpec*> poses_of(const Operation& operation, std::size_t records) {
  std::vector<const PoseSpec*> poses;
  if (const auto* const cut = std::get_if<CutOperation>(&operation))
    poses.assign(records, &cut->pose);
  if (const auto* const drill = std::get_if<DrillOperation>(&operation))
    poses.assign(records, &drill->pose);
  const auto* const tear = std::get_if<TearOperation>(&operation);
  if (tear == nullptr) return poses;
  // The record i is of the segment that ends with blade i + 1; the last one closes the tear.
  std::size_t next = 0;
  poses.assign(records, &tear->pose);
  for (std::size_t record = 0; record < records; ++record) {
    while (next < tear->pose_changes.size() && tear->pose_changes[next].blade <= record + 1) ++next;
    if (next > 0) poses[record] = &tear->pose_changes[next - 1].pose;
  }
  return poses;
}

/// Plays operations and measures each.
class PopMeter {
 public:
  explicit PopMeter(TornModel& model) : model_(model) {}

  /// @return the vertex that moved farthest; a value of 0 if none did.
  Result<FindingPlace> apply(const Operation& operation) {
    if (const auto* const weights = std::get_if<WeightsOperation>(&operation))
      return reweigh(operation, weights->pose);
    std::vector<ChangeRecord> changes;
    const Result<TearReport> report = apply_operation(model_, operation, &changes);
    if (!report) return report.error();
    FindingPlace worst;
    const std::vector<const PoseSpec*> poses = poses_of(operation, changes.size());
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const Result<ModelPose> pose = make_pose(model_.character(), *poses[i]);
      if (!pose) return pose.error();
      compare(changes[i], PosedModel(model_, *pose), worst);
    }
    return worst;
  }

 private:
  static void keep_worst(Index mesh, Index vertex, double value, FindingPlace& worst) {
    if (!(value > worst.value)) return;
    worst.mesh = mesh;
    worst.vertex = vertex;
    worst.value = value;
  }

  void compare(const ChangeRecord& change, const PosedModel& posed, FindingPlace& worst) const {
    for (const MeshChange& of : change.meshes) {
      const SurfaceBefore before(model_, of);
      const Index end = std::min(of.first_vertex + of.vertex_count,
                                 model_.character().meshes[of.mesh].vertex_count());
      for (Index v = of.first_vertex; v < end; ++v)
        if (const auto distance = before.distance(v, posed.place(of.mesh, v), posed))
          keep_worst(of.mesh, v, *distance, worst);
    }
  }

  /// Calls visit(mesh, vertex) for all vertices that operations made.
  template <class Visit>
  void for_each_new_vertex(const Visit& visit) const {
    for (Index mesh = 0; mesh < model_.character().meshes.size(); ++mesh)
      for (Index v = model_.source().meshes[mesh].vertex_count();
           v < model_.character().meshes[mesh].vertex_count(); ++v)
        visit(mesh, v);
  }

  Result<FindingPlace> reweigh(const Operation& operation, const PoseSpec& spec) {
    Result<ModelPose> pose = make_pose(model_.character(), spec);
    if (!pose) return pose.error();
    std::vector<Vec3d> before;
    const PosedModel posed(model_, *pose);
    for_each_new_vertex([&](Index mesh, Index v) { before.push_back(posed.place(mesh, v)); });
    const Result<TearReport> report = apply_operation(model_, operation);
    if (!report) return report.error();
    FindingPlace worst;
    std::size_t i = 0;
    for_each_new_vertex([&](Index mesh, Index v) {
      keep_worst(mesh, v, norm(posed.place(mesh, v) - before[i++]), worst);
    });
    return worst;
  }

  TornModel& model_;
};

const char* name_of(const Operation& operation) {
  return std::visit([](const auto& of) { return kOpName<std::remove_cvref_t<decltype(of)>>; },
                    operation);
}

/// An operation and the vertex that it moves farthest.
struct Pop {
  std::size_t operation = 0;
  FindingPlace place;
};

std::string text_of(std::vector<Pop> pops, std::span<const Operation> operations) {
  constexpr std::size_t kMost = 8;
  std::string text = "Over " + std::to_string(operations.size()) + " operations";
  std::ranges::stable_sort(pops, std::ranges::greater(),
                           [](const Pop& pop) { return pop.place.value; });
  for (std::size_t i = 0; i < std::min(pops.size(), kMost); ++i) {
    char part[64];
    std::snprintf(part, sizeof part, "%s %zu (%s) %.3g m", i == 0 ? "; operation" : ",",
                  pops[i].operation, name_of(operations[pops[i].operation]), pops[i].place.value);
    text += part;
  }
  return text + ".";
}

/// Describes a place of the replayed model as one of the target, as far as the target has it.
void locate(const TornModel& model, const Character& target, FindingPlace& place) {
  ModelPose bind = or_throw(bind_pose(model.character()));
  std::ranges::fill(bind.morph_weights, 0.0f);
  const Mesh& mesh = model.character().meshes[place.mesh];
  const bool is_left = place.vertex < mesh.vertex_count();
  if (is_left)
    place.position = deform_position_reference(
        mesh, place.vertex, bind_palettes(model.character(), bind)[mesh.skin], bind.morph_weights);
  const bool has_mesh = place.mesh < target.meshes.size();
  const bool has_vertex =
      is_left && has_mesh && place.vertex < target.meshes[place.mesh].vertex_count() &&
      target.meshes[place.mesh].positions[place.vertex] == mesh.positions[place.vertex];
  if (!has_vertex) place.vertex = kNone;
  if (!has_mesh) place.mesh = kNone;
}

}  // namespace

std::optional<TornModel> check_pops(const std::shared_ptr<const Character>& source,
                                    const Character& target, std::span<const Operation> operations,
                                    double diagonal, FindingList& findings) {
  if (operations.empty()) {
    findings.not_tested(Code::pop, "no operation log was given");
    return {};
  }
  Result<TornModel> model = TornModel::create(source);
  if (!model) {
    findings.not_tested(Code::pop, std::string(model.error().text()));
    return {};
  }
  const double least = kind_of(Code::pop).threshold * diagonal;
  std::vector<Pop> pops;
  PopMeter meter(*model);
  for (std::size_t i = 0; i < operations.size(); ++i) {
    const Result<FindingPlace> worst = meter.apply(operations[i]);
    if (!worst) {
      findings.not_tested(
          Code::pop, "operation " + std::to_string(i) + ": " + std::string(worst.error().text()));
      return {};
    }
    if (worst->value > least) pops.push_back({i, *worst});
  }
  Places places;
  for (Pop& pop : pops) {
    locate(*model, target, pop.place);
    places.push_back(pop.place);
  }
  findings.add(Code::pop, std::move(places), text_of(pops, operations), Evidence::exact);
  return std::move(*model);
}

}  // namespace sunder::validation
