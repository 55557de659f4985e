#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/torn_weights.h>

#include <algorithm>
#include <cmath>
#include <new>

#include "core/internal/ordered.h"
#include "core/internal/out_of_memory.h"
#include "skinning/internal/character_pose.h"
#include "tear/model/model_state.h"

namespace sunder {
namespace {

/// Statistics of some errors; the values are reordered.
WeightErrors::Statistics statistics_of(std::vector<double>& values) {
  WeightErrors::Statistics result;
  if (values.empty()) return result;
  double sum = 0;
  for (const double value : values) sum += value * value;
  result.rms = std::sqrt(sum / static_cast<double>(values.size()));
  result.maximum = *std::max_element(values.begin(), values.end());
  const auto at = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) * 95 / 100);
  std::nth_element(values.begin(), at, values.end());
  result.percentile95 = *at;
  return result;
}

/// Posed position of a vertex of policy `exact`, from its stored floats.
Vec3d exact_position(const tear::SurfaceEditor& editor, const tear::VertexRef& at,
                     std::span<const Affine3d> palette, std::span<const float> morph_weights) {
  const InfluencePositions& exact = editor.exact.of(at.mesh);
  const Mesh& mesh = editor.character().meshes[at.mesh];
  std::size_t place = editor.exact.place(at.mesh, at.vertex);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Influence& influence : mesh.weights.of(at.vertex)) {
    Eigen::Vector3d q = exact.positions[place].cast<double>();
    for (std::size_t j = 0; j < exact.morph_targets.size(); ++j)
      if (!exact.morph_targets[j].positions.empty())
        q += static_cast<double>(morph_weights[mesh.first_morph_weight + j]) *
             exact.morph_targets[j].positions[place].cast<double>();
    const Affine3d& bone = palette[influence.slot];
    sum += multiply(bone.linear(), q) +
           static_cast<double>(influence.weight) * Eigen::Vector3d(bone.translation());
    ++place;
  }
  return sum;
}

/// Mean edge of the triangle in which a point was created, in the rest pose.
double mean_edge(const tear::SurfaceEditor& editor, const tear::VertexRef& at,
                 const CharacterPose& rest) {
  const Mesh& mesh = editor.character().meshes[at.mesh];
  std::array<Vec3d, 3> corners;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t corner =
        editor.fillings.origin_triangle(at.mesh, editor.births.at(at.mesh, at.vertex).triangle)[k];
    corners[k] = rest.position(mesh, corner, editor.births.position(at.mesh, corner),
                               editor.births.influences(at.mesh, corner));
  }
  return (norm(corners[0] - corners[1]) + norm(corners[1] - corners[2]) +
          norm(corners[2] - corners[0])) /
         3;
}

/// Position of a point in a pose minus the position of the untorn surface there.
Vec3d error_of(const tear::SurfaceEditor& editor, const tear::VertexRef& at,
               const CharacterPose& pose, AnimationPoint& exact) {
  const Mesh& mesh = editor.character().meshes[at.mesh];
  const std::vector<Affine3d>& palette = pose.palette(mesh.skin);
  editor.births.describe_exactly(at, pose.morph_weights(), exact);
  const Vec3d position = editor.births.policy(at.mesh, at.vertex) == WeightPolicy::exact
                             ? exact_position(editor, at, palette, pose.morph_weights())
                             : pose.position(mesh, at.vertex);
  return position - exact.posed(palette);
}

/// Diagonal of the bounding box of a source in its rest pose.
double diagonal_of(const Character& source, const CharacterPose& rest) {
  Eigen::AlignedBox3d box;
  for (const Mesh& mesh : source.meshes)
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v)
      box.extend(Eigen::Vector3d(
          deform_position_reference(mesh, v, rest.palette(mesh.skin), source.rest_morph_weights)));
  return box.isEmpty() ? 0.0 : norm(box.diagonal());
}

}  // namespace

Result<WeightErrors> measure_weight_errors(const TornModel& model, std::uint32_t first_operation,
                                           std::uint32_t operation_count,
                                           std::span<const ModelPose> poses) {
  if (Status status = model.unpack(); !status) return status;
  const TornModel::State& state = *model.state_;
  const tear::SurfaceEditor& editor = state.editor;
  WeightsOperation operations;
  operations.first_operation = first_operation;
  operations.operation_count = operation_count;
  if (Status status = state.resolve(operations); !status) return status;
  for (const ModelPose& pose : poses)
    if (Status status = CharacterPose::check(state.character, pose); !status) return status;
  try {
    const auto points = tear::interpolated_points(state.vertices_of(operations), editor);
    WeightErrors errors;
    errors.poses = static_cast<std::uint32_t>(poses.size());
    CharacterPose stand;
    const auto rest = make_pose(*state.source, RestPose{});
    if (!rest) return rest.error();
    if (Status status = stand.set(state.character, *rest); !status) return status;
    const double diagonal = diagonal_of(*state.source, stand);
    for (const auto& at : points)
      errors.points.push_back({at.mesh, at.vertex, 0, 0, mean_edge(editor, at, stand)});
    std::vector<double> metres, of_edge;
    AnimationPoint exact;
    for (const ModelPose& pose : poses) {
      if (Status status = stand.set(state.character, pose); !status) return status;
      for (std::size_t i = 0; i < points.size(); ++i) {
        const double error = norm(error_of(editor, points[i], stand, exact));
        WeightErrors::OfPoint& of = errors.points[i];
        of.rms += error * error / static_cast<double>(poses.size());
        of.maximum = std::max(of.maximum, error);
        metres.push_back(error);
        of_edge.push_back(of.edge > 0 ? error / of.edge : 0.0);
      }
    }
    for (WeightErrors::OfPoint& of : errors.points) of.rms = std::sqrt(of.rms);
    errors.metres = statistics_of(metres);
    errors.of_edge = statistics_of(of_edge);
    errors.of_diagonal = errors.metres;
    for (double* value :
         {&errors.of_diagonal.rms, &errors.of_diagonal.percentile95, &errors.of_diagonal.maximum})
      *value = diagonal > 0 ? *value / diagonal : 0.0;
    return errors;
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

}  // namespace sunder
