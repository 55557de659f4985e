#pragma once

#include <sunder/operation/operation.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/refit_job.h>

#include <atomic>
#include <memory>
#include <span>
#include <vector>

#include "tear/weights/assign_weights.h"
#include "weights/internal/coupled_refit.h"

namespace sunder::tear {

class RefitCertificate;

/// The fit of a point.
struct PointFit {
  std::size_t point = 0;  ///< In RefitTask::points.
  bool is_taken = false;  ///< If false, the point keeps its barycentric weights.
  std::vector<Influence> influences;
  Vec3d position = Vec3d::Zero();  ///< As it is stored, in float, with the morph displacement.
  double certified = 0;            ///< The bound of RefitCertificate with these weights, metres.
};

/// A refit that runs in the background: a copy of its input, and its result. Other threads may
/// access only `state` and `is_cancelled` while it runs.
struct RefitTask {
  /// A point to fit.
  struct Point {
    AnimationPoint exact;
    Vec3d position = Vec3d::Zero();  ///< Bind position with the rest morph displacement.
    Vec3d morph = Vec3d::Zero();     ///< The rest morph displacement.
    Index skin = 0;
    Index operation = 0;  ///< In `operations`.
    /// How far the bind position may move, metres in bind space: if no point moves farther, no face
    /// is turned over and no point leaves the faces around it.
    double reach = 0;
    double certified = 0;  ///< The bound of RefitCertificate with barycentric weights, metres.

    /// The nearest bind position that can be stored.
    [[nodiscard]] Vec3d stored(const Vec3d& of) const {
      return Vec3d((of - morph).cast<float>().cast<double>()) + morph;
    }
  };
  /// An operation that created points.
  struct OfOperation {
    std::uint64_t serial = 0;
    std::vector<ModelPose> poses;  ///< In which it was made; of a long stroke, some of them.
  };

  /// @param assignment  barycentric weights of points of the editor's model.
  /// @param since       where the first of their operations began.
  RefitTask(std::shared_ptr<const Character> source, WeightsOperation operation,
            WeightAssignment assignment, const EditLog::Mark& since, const SurfaceEditor& editor);

  /// Adds an operation of the history, oldest first.
  /// @param first_vertices  the vertex counts of the meshes when it began.
  void add_operation(const Operation& of, std::uint64_t serial,
                     std::span<const Index> first_vertices);
  void run();
  void cancel();
  /// The influences with which a point started. Until the fits are stored.
  [[nodiscard]] std::span<const Influence> barycentric(std::size_t point) const;

  std::shared_ptr<const Character> source;
  WeightsOperation operation;   ///< Resolved.
  WeightAssignment assignment;  ///< In: barycentric. Out: fitted.
  WeightReport report;
  std::vector<Point> points;
  std::vector<RefitNeighbours> neighbours;  ///< If the points are fitted together.
  std::vector<OfOperation> operations;
  Status failure;
  std::atomic<RefitJob::State> state = RefitJob::State::waiting;
  std::atomic<bool> is_cancelled = false;

 private:
  void certify(RefitCertificate& certificate);
  [[nodiscard]] Result<std::vector<PointFit>> fit(Index skin, RefitCertificate& certificate) const;
  void store(const std::vector<PointFit>& fits);
};

}  // namespace sunder::tear
