#include "bench/plan/frame_ik.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace sunder::bench {
namespace {

class FrameSolver {
 public:
  explicit FrameSolver(const PlanTool& tool)
      : tool_(tool),
        kinematics_(*RobotKinematics::create(tool.robot)),
        frames_(tool.robot.links.size()) {}

  void solve(const plan::TargetSample& sample, std::vector<double>& values) {
    const auto count = static_cast<Eigen::Index>(values.size());
    for (int round = 0; round < 20; ++round) {
      const Eigen::VectorXd errors = errors_at(sample, values);
      Eigen::MatrixXd rates(6, count);
      for (Eigen::Index i = 0; i < count; ++i) {
        std::vector<double> moved = values;
        moved[static_cast<std::size_t>(i)] += 1e-6;
        rates.col(i) = (errors_at(sample, moved) - errors) / 1e-6;
      }
      const Eigen::MatrixXd normal =
          rates.transpose() * rates + 1e-6 * Eigen::MatrixXd::Identity(count, count);
      const Eigen::VectorXd change = normal.ldlt().solve(-rates.transpose() * errors);
      for (Eigen::Index i = 0; i < count; ++i) {
        const RobotValue& value = tool_.robot.values[static_cast<std::size_t>(i)];
        double& of = values[static_cast<std::size_t>(i)];
        of = std::clamp(of + std::clamp(change[i], -0.3, 0.3), value.lower, value.upper);
      }
    }
  }

 private:
  /// Place of the tip, metres, and direction of the blade.
  Eigen::VectorXd errors_at(const plan::TargetSample& sample, const std::vector<double>& values) {
    if (!kinematics_.evaluate(values, frames_, tool_.world_from_root))
      return Eigen::VectorXd::Zero(6);
    const Vec3d base = frames_[tool_.blade.link] * tool_.blade.base;
    const Vec3d tip = frames_[tool_.blade.link] * tool_.blade.tip;
    const double length = (base - tip).norm();
    const double back = sample.depth / std::max(0.2, sample.handle.dot(sample.normal));
    Eigen::VectorXd errors(6);
    errors.head<3>() = tip - (sample.place - back * sample.handle);
    errors.tail<3>() = 0.1 * length * ((base - tip) / length - sample.handle);
    return errors;
  }

  const PlanTool& tool_;
  RobotKinematics kinematics_;
  std::vector<Affine3d> frames_;
};

}  // namespace

RobotTrajectory frame_ik(const PlanTool& tool, const std::vector<plan::TargetSample>& samples,
                         const std::vector<double>& middle) {
  FrameSolver solver(tool);
  std::vector<std::vector<double>> track(samples.size(), middle);
  const std::size_t half = samples.size() / 2;
  solver.solve(samples[half], track[half]);
  for (std::size_t i = half + 1; i < samples.size(); ++i) {
    track[i] = track[i - 1];
    solver.solve(samples[i], track[i]);
  }
  for (std::size_t i = half; i-- > 0;) {
    track[i] = track[i + 1];
    solver.solve(samples[i], track[i]);
  }
  RobotTrajectory trajectory;
  for (const RobotValue& value : tool.robot.values) trajectory.names.push_back(value.name);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    trajectory.times.push_back(samples[i].time);
    trajectory.values.insert(trajectory.values.end(), track[i].begin(), track[i].end());
  }
  return trajectory;
}

}  // namespace sunder::bench
