#include <sunder/robot/robot.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "core/internal/ordered.h"
#include "core/internal/out_of_memory.h"
#include "io/robot/internal/planar_axes.h"

namespace sunder {
namespace robot {
namespace {

/// The rotation of a joint about its axis a, as `constant + cosine cos(q) + sine sin(q)`:
/// O a aᵀ, O (I - a aᵀ) and O [a]×, where O is the rotation of parent_from_joint. Columns, three
/// numbers each.
struct Turn {
  double constant[9], cosine[9], sine[9];
};

/// Rotation and translation, columns of three numbers each.
using Frame = double[12];

struct PreparedJoint {
  RobotJointType type = RobotJointType::fixed;
  std::uint32_t parent = 0;  ///< Link.
  std::uint32_t first_value = 0;
  double multiplier = 1.0, offset = 0.0;
  Turn turn;           ///< Of revolute, continuous and planar joints.
  Frame at_zero;       ///< parent_from_joint; of a fixed joint, parent_from_link.
  double slide[2][3];  ///< In the parent's frame: of a prismatic joint, and of a planar one both.
};

void store(const Mat3d& matrix, double* columns) {
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row) columns[3 * column + row] = matrix(row, column);
}

Turn turn_of(const Mat3d& rotation, const Vec3d& axis) {
  Mat3d along, cross;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) along(row, column) = axis[row] * axis[column];
  cross << 0, -axis.z(), axis.y(), axis.z(), 0, -axis.x(), -axis.y(), axis.x(), 0;
  Turn turn;
  store(multiply(rotation, along), turn.constant);
  store(multiply(rotation, Mat3d(Mat3d::Identity() - along)), turn.cosine);
  store(multiply(rotation, cross), turn.sine);
  return turn;
}

inline void turn_by(const Turn& turn, double angle, double* rotation) {
  const double cosine = std::cos(angle), sine = std::sin(angle);
  for (int i = 0; i < 9; ++i)
    rotation[i] = turn.constant[i] + turn.cosine[i] * cosine + turn.sine[i] * sine;
}

/// The rotation of a quaternion x y z w of any length; the identity if it has none.
Mat3d rotation_of(const double* xyzw) {
  double largest = 0;
  for (int i = 0; i < 4; ++i) largest = std::max(largest, std::abs(xyzw[i]));
  if (largest == 0) return Mat3d::Identity();
  double unit[4], square = 0;
  for (int i = 0; i < 4; ++i) unit[i] = xyzw[i] / largest;  // squares of tiny numbers vanish
  for (int i = 0; i < 4; ++i) square += unit[i] * unit[i];
  const double length = std::sqrt(square);
  for (double& number : unit) number /= length;
  return Quatd(unit[3], unit[0], unit[1], unit[2]).toRotationMatrix();
}

/// out = first * second.
inline void compose(const double* first, const double* second, double* out) {
  for (int column = 0; column < 4; ++column) {
    const double* const by = second + 3 * column;
    double* const to = out + 3 * column;
    for (int row = 0; row < 3; ++row)
      to[row] = first[row] * by[0] + first[3 + row] * by[1] + first[6 + row] * by[2];
  }
  for (int row = 0; row < 3; ++row) out[9 + row] += first[9 + row];
}

void place_planar(const PreparedJoint& joint, const double* values, double* parent_from_link) {
  turn_by(joint.turn, values[2], parent_from_link);
  for (int row = 0; row < 3; ++row)
    parent_from_link[9 + row] =
        joint.at_zero[9 + row] + joint.slide[0][row] * values[0] + joint.slide[1][row] * values[1];
}

void place_floating(const PreparedJoint& joint, const double* values, double* parent_from_link) {
  Frame joint_from_link;
  store(rotation_of(values + 3), joint_from_link);
  for (int row = 0; row < 3; ++row) joint_from_link[9 + row] = values[row];
  compose(joint.at_zero, joint_from_link, parent_from_link);
}

inline void place(const PreparedJoint& joint, const double* values, double* parent_from_link) {
  switch (joint.type) {
    case RobotJointType::revolute:
    case RobotJointType::continuous:
      turn_by(joint.turn, joint.multiplier * values[joint.first_value] + joint.offset,
              parent_from_link);
      for (int row = 9; row < 12; ++row) parent_from_link[row] = joint.at_zero[row];
      return;
    case RobotJointType::prismatic: {
      const double position = joint.multiplier * values[joint.first_value] + joint.offset;
      for (int i = 0; i < 9; ++i) parent_from_link[i] = joint.at_zero[i];
      for (int row = 0; row < 3; ++row)
        parent_from_link[9 + row] = joint.at_zero[9 + row] + joint.slide[0][row] * position;
      return;
    }
    case RobotJointType::planar:
      return place_planar(joint, values + joint.first_value, parent_from_link);
    case RobotJointType::floating:
      return place_floating(joint, values + joint.first_value, parent_from_link);
    case RobotJointType::fixed: break;
  }
  for (int i = 0; i < 12; ++i) parent_from_link[i] = joint.at_zero[i];
}

/// A joint that has no value stands at its offset from now on.
void freeze(PreparedJoint& joint) {
  joint.first_value = 0;
  joint.multiplier = 0.0;
  if (joint.type == RobotJointType::planar || joint.type == RobotJointType::floating) {
    joint.type = RobotJointType::fixed;
    return;
  }
  Frame frozen;
  const double none = 0.0;
  place(joint, &none, frozen);
  std::copy(std::begin(frozen), std::end(frozen), joint.at_zero);
  joint.type = RobotJointType::fixed;
}

PreparedJoint prepare(const RobotJoint& joint, std::uint32_t parent) {
  PreparedJoint prepared;
  prepared.type = joint.type;
  prepared.parent = parent;
  prepared.first_value = joint.first_value;
  prepared.multiplier = joint.multiplier;
  prepared.offset = joint.offset;
  const Mat3d rotation = joint.parent_from_joint.linear();
  store(rotation, prepared.at_zero);
  for (int row = 0; row < 3; ++row)
    prepared.at_zero[9 + row] = joint.parent_from_joint.translation()[row];
  prepared.turn = turn_of(rotation, joint.axis);
  const bool is_planar = joint.type == RobotJointType::planar;
  const PlanarAxes axes = is_planar ? planar_axes(joint.axis) : PlanarAxes{joint.axis, joint.axis};
  const Vec3d first = multiply(rotation, axes.x), second = multiply(rotation, axes.y);
  for (int row = 0; row < 3; ++row) {
    prepared.slide[0][row] = first[row];
    prepared.slide[1][row] = second[row];
  }
  if (joint.first_value == kNone && joint.type != RobotJointType::fixed) freeze(prepared);
  return prepared;
}

}  // namespace
}  // namespace robot

struct RobotKinematics::State {
  std::vector<robot::PreparedJoint> joints;
  std::uint32_t value_count = 0;
};

RobotKinematics::RobotKinematics(std::shared_ptr<const State> state) : state_(std::move(state)) {}

Result<RobotKinematics> RobotKinematics::create(const Robot& robot) {
  return or_out_of_memory([&]() -> Result<RobotKinematics> {
    if (const Status status = validate_robot(robot); !status) return status;
    const auto state = std::make_shared<State>();
    state->value_count = static_cast<std::uint32_t>(robot.values.size());
    state->joints.reserve(robot.joints.size());
    for (std::size_t i = 0; i < robot.joints.size(); ++i)
      state->joints.push_back(robot::prepare(robot.joints[i], robot.links[i + 1].parent));
    return RobotKinematics(state);
  });
}

std::uint32_t RobotKinematics::link_count() const {
  return static_cast<std::uint32_t>(state_->joints.size() + 1);
}

std::uint32_t RobotKinematics::value_count() const { return state_->value_count; }

Status RobotKinematics::evaluate(std::span<const double> values,
                                 std::span<Affine3d> model_from_link,
                                 const Affine3d& model_from_root) const {
  if (values.size() != value_count() || model_from_link.size() != link_count())
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "the robot has %u values and %u links; given are %zu values and room "
                           "for %zu links",
                           value_count(), link_count(), values.size(), model_from_link.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!std::isfinite(values[i]))
      return Status::failure(StatusCode::non_finite_value, static_cast<std::uint32_t>(i),
                             "value %zu is not finite", i);
  model_from_link[0] = model_from_root;
  std::size_t link = 1;
  for (const robot::PreparedJoint& joint : state_->joints) {
    robot::Frame parent_from_link;
    robot::place(joint, values.data(), parent_from_link);
    robot::compose(model_from_link[joint.parent].data(), parent_from_link,
                   model_from_link[link].data());
    ++link;
  }
  return {};
}

}  // namespace sunder
