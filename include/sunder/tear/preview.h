#pragma once

#include <sunder/tear/torn_model.h>

#include <span>
#include <vector>

namespace sunder {

/// The effect that an operation would have.
struct OperationPreview {
  /// The report that the operation would return, number for number. `runs` is 0 if it would miss.
  /// Triangles of pieces have the indices that they would get.
  TearReport report;
  /// Length of the tear or cut in bind space, metres. With a width or a bore: half of all rims.
  double length_bind = 0.0;
  /// The most surfaces that one of the blades, or the axis of the bore, passes from outside to
  /// inside. 0 for a cut.
  std::uint32_t layers = 0;
  /// If it would miss: the least distance between what the blade sweeps, or the axis of the bore,
  /// and the surface, metres; infinity for a cut.
  double miss_distance = 0.0;
  std::vector<double> piece_areas;  ///< Of report.pieces, in the pose, square metres.
  // Those of the triangles that would change. Ascending, without repetition.
  std::vector<std::uint32_t> meshes;
  std::vector<std::uint32_t> materials;
  std::vector<std::uint32_t> bones;  ///< In the skeleton: those that move a vertex.
};

/// Performs an operation and takes it back: afterwards the model is as before, bit for bit, with
/// its history, redo stack and change numbers. No other call may use the model meanwhile.
/// @return as the operation's own call, with the same errors; capacity_exceeded where it would find
///         no room. Costs what the operation costs, and O(triangles of
///         its pieces). With a fixed capacity it uses none of it up; a
///         model that grows as needed keeps the memory as room for the operation, and further
///         previews of it need no more.
[[nodiscard]] SUNDER_API Result<OperationPreview> preview_tear(const TornModel& model,
                                                               const ModelPose& pose,
                                                               std::span<const Blade> stroke,
                                                               const TearOptions& options = {});
[[nodiscard]] SUNDER_API Result<OperationPreview> preview_cut(const TornModel& model,
                                                              const ModelPose& pose,
                                                              const PlaneCut& cut);
[[nodiscard]] SUNDER_API Result<OperationPreview> preview_drill(const TornModel& model,
                                                                const ModelPose& pose,
                                                                const Bore& bore);

}  // namespace sunder
