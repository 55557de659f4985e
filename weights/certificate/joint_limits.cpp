// Joint ranges from the rest pose and the clips of a character, measured from bind.

#include <sunder/certificate/certificate.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <new>

#include <Eigen/LU>

#include "core/internal/ordered.h"
#include "weights/certificate/polar.h"

namespace sunder {
namespace certificate {
namespace {

constexpr double kFloatTurn = 2e-6;       // radians that sampling in float may add
constexpr double kFloatShare = 1e-6;      // of a length
constexpr double kRegular = 1e-4;         // bind matrices are rounded to float
constexpr double kSplineAccuracy = 2e-3;  // radians
constexpr int kSplineDepth = 16;

using ControlPoints = std::array<Vec4d, 4>;

/// Transforms of a bone in rest and clips, relative to its parent.
struct LocalRange {
  std::vector<Vec3d> translations;  // their convex hull holds all translations
  Vec3d scale_lower, scale_upper;
  bool is_rotated = false;  // by a clip
};

/// A joint's motion for local rotations R: about its centre it is (U R W) D, a rotation after a
/// stretch. `at_bind` is the local rotation for which U R W is the identity.
struct JointFrame {
  bool is_regular = false;
  Quatd at_bind = Quatd::Identity();
  double slack = 0.0;  // radians that the rounding of bind matrices may add
  double scale_lower = 0.0, scale_upper = 0.0;
};

/// The value at key `key`; part 0, 1, 2: in-tangent, value, out-tangent of a cubic spline.
Vec4d key_value(const Channel& channel, std::size_t key, std::size_t part) {
  const bool is_spline = channel.interpolation == Interpolation::cubic_spline;
  const std::size_t first = (is_spline ? 3 * key + part : key) * channel.width;
  Vec4d value = Vec4d::Zero();
  for (std::uint32_t i = 0; i < std::min(channel.width, 4u); ++i)
    value[i] = static_cast<double>(channel.values[first + i]);
  return value;
}

/// Bezier points of the spline after a key.
ControlPoints spline_after(const Channel& channel, std::size_t key) {
  const double third =
      (static_cast<double>(channel.times[key + 1]) - static_cast<double>(channel.times[key])) / 3.0;
  const Vec4d from = key_value(channel, key, 1), to = key_value(channel, key + 1, 1);
  return {from, from + third * key_value(channel, key, 2),
          to - third * key_value(channel, key + 1, 0), to};
}

/// Calls visit(point) with points whose convex hull holds all values of a channel.
template <class Visit>
void visit_hull(const Channel& channel, const Visit& visit) {
  for (std::size_t key = 0; key < channel.times.size(); ++key) {
    visit(key_value(channel, key, 1));
    if (channel.interpolation != Interpolation::cubic_spline || key + 1 == channel.times.size())
      continue;
    const ControlPoints points = spline_after(channel, key);
    visit(points[1]);
    visit(points[2]);
  }
}

/// Angle between the rotations of two quaternions, of which the second has unit length.
double angle_between(const Vec4d& q, const Vec4d& unit) {
  const double along = dot(q, unit);
  return 2.0 * std::atan2(norm(Vec4d(q - along * unit)), std::abs(along));
}

/// Largest angle along slerp, the shorter way. The cosine of half the angle is a sinusoid of the
/// time, which is concave where it is positive: its least value is at a key, or it passes zero.
double largest_angle_of_slerp(const Vec4d& from, const Vec4d& to, const Vec4d& bind) {
  const double side = dot(from, to) < 0 ? -1.0 : 1.0;
  if (dot(from, bind) * dot(to, bind) * side < 0) return std::numbers::pi;
  return std::max(angle_between(from, bind), angle_between(to, bind));
}

/// Largest angle along a spline that is normalised afterwards, from above: a cone around `bind`
/// that holds the control points holds the curve.
double largest_angle_of_spline(const ControlPoints& points, const Vec4d& bind, double reached,
                               int depth) {
  double hull = 0;
  const double side = dot(points[0], bind) < 0 ? -1.0 : 1.0;
  for (const Vec4d& point : points)
    hull =
        std::max(hull, dot(point, bind) * side > 0 ? angle_between(point, bind) : std::numbers::pi);
  reached = std::max({reached, angle_between(points[0], bind), angle_between(points[3], bind)});
  if (hull <= reached + kSplineAccuracy || depth == 0) return std::max(hull, reached);
  const Vec4d a = 0.5 * (points[0] + points[1]), b = 0.5 * (points[1] + points[2]),
              c = 0.5 * (points[2] + points[3]), ab = 0.5 * (a + b), bc = 0.5 * (b + c),
              middle = 0.5 * (ab + bc);
  reached = largest_angle_of_spline({points[0], a, ab, middle}, bind, reached, depth - 1);
  return largest_angle_of_spline({middle, bc, c, points[3]}, bind, reached, depth - 1);
}

double largest_angle(const Channel& channel, const Vec4d& bind) {
  double angle = 0;
  for (std::size_t key = 0; key < channel.times.size(); ++key) {
    angle = std::max(angle, angle_between(key_value(channel, key, 1), bind));
    if (key + 1 == channel.times.size()) continue;
    if (channel.interpolation == Interpolation::linear)
      angle = std::max(angle, largest_angle_of_slerp(key_value(channel, key, 1),
                                                     key_value(channel, key + 1, 1), bind));
    if (channel.interpolation == Interpolation::cubic_spline)
      angle = largest_angle_of_spline(spline_after(channel, key), bind, angle, kSplineDepth);
  }
  return angle;
}

std::vector<LocalRange> local_ranges(const Character& character) {
  std::vector<LocalRange> ranges;
  for (const Bone& bone : character.skeleton.bones) {
    const Vec3d scale = bone.rest.scale.cast<double>();
    ranges.push_back({{bone.rest.translation.cast<double>()}, scale, scale, false});
  }
  for (const Clip& clip : character.clips)
    for (const Channel& channel : clip.channels) {
      if (channel.target == ChannelTarget::morph_weights) continue;
      LocalRange& range = ranges[channel.index];
      if (channel.target == ChannelTarget::rotation) range.is_rotated = true;
      if (channel.target == ChannelTarget::translation)
        visit_hull(channel, [&](const Vec4d& at) { range.translations.push_back(at.head<3>()); });
      if (channel.target == ChannelTarget::scale)
        visit_hull(channel, [&](const Vec4d& at) {
          range.scale_lower = range.scale_lower.cwiseMin(at.head<3>());
          range.scale_upper = range.scale_upper.cwiseMax(at.head<3>());
        });
    }
  return ranges;
}

/// Takes the stretch from the rows of the matrix that the local scale multiplies; false if its axes
/// are not those of the local scale, or a scale changes its sign.
bool stretch_of_rows(const Mat3d& scaled, const LocalRange& range, JointFrame& frame,
                     Mat3d& rotation, double& skew) {
  frame.scale_lower = std::numeric_limits<double>::infinity();
  frame.scale_upper = 0;
  Mat3d rows;
  for (int i = 0; i < 3; ++i) {
    if (!(range.scale_lower[i] * range.scale_upper[i] > 0)) return false;
    const Vec3d row = scaled.row(i).transpose();
    const double length = norm(row), a = std::abs(range.scale_lower[i]),
                 b = std::abs(range.scale_upper[i]);
    frame.scale_lower = std::min(frame.scale_lower, length * std::min(a, b));
    frame.scale_upper = std::max(frame.scale_upper, length * std::max(a, b));
    rows.row(i) = row.transpose() / std::copysign(length, range.scale_lower[i]);
  }
  skew = norm(Mat3d(rows * rows.transpose() - Mat3d::Identity())) * frame.scale_upper /
         frame.scale_lower;
  rotation = polar(rows).rotation;
  return skew <= kRegular;
}

/// Bounds the stretch of (parent R scale bone^-1) for all rotations R, by the singular values of
/// its factors. Where it may mirror, the lower bound is 0.
void set_any_stretch(const Polar& parent, const Polar& bone_inverse, const LocalRange& range,
                     bool keeps_side, JointFrame& frame) {
  const Vec3d a = range.scale_lower.cwiseAbs(), b = range.scale_upper.cwiseAbs();
  frame.scale_upper =
      (1 + kFloatShare) * parent.largest * a.cwiseMax(b).maxCoeff() * bone_inverse.largest;
  frame.scale_lower = 0;
  if (keeps_side && (range.scale_lower.array() * range.scale_upper.array() > 0).all())
    frame.scale_lower =
        (1 - kFloatShare) * parent.least * a.cwiseMin(b).minCoeff() * bone_inverse.least;
}

JointFrame joint_frame(const Mat3d& parent, const Mat3d& bone, const LocalRange& range) {
  JointFrame frame;
  const Mat3d square = parent.transpose() * parent;
  const double size = std::sqrt(trace(square) / 3);
  double skew = norm(Mat3d(square / (size * size) - Mat3d::Identity()));
  const Mat3d scaled = size * Mat3d(bone.inverse());
  Mat3d rotation = Mat3d::Identity();
  bool is_regular = skew <= kRegular;
  if (range.scale_lower == range.scale_upper) {
    const Polar stretch = polar(Mat3d(range.scale_lower.asDiagonal() * scaled));
    frame.scale_lower = stretch.least;
    frame.scale_upper = stretch.largest;
    rotation = stretch.rotation;
    is_regular = is_regular && stretch.least > 0;
  } else {
    double of_rows = 0;
    is_regular = stretch_of_rows(scaled, range, frame, rotation, of_rows) && is_regular;
    skew += of_rows;
  }
  const Mat3d at_bind = Mat3d(polar(parent).rotation.transpose()) * rotation.transpose();
  frame.is_regular = is_regular && determinant(at_bind) > 0;
  if (frame.is_regular) {
    frame.at_bind = normalized(Quatd(at_bind));
    frame.slack = 2 * skew + kFloatTurn;
    frame.scale_lower *= 1 - 2 * skew - kFloatShare;
    frame.scale_upper *= 1 + 2 * skew + kFloatShare;
    return frame;
  }
  const bool keeps_side = determinant(parent) * determinant(bone) * range.scale_lower.prod() > 0;
  set_any_stretch(polar(parent), polar(Mat3d(bone.inverse())), range, keeps_side, frame);
  return frame;
}

/// A bone that no clip turns or scales, below a parent whose axes are not at right angles.
void set_constant_motion(const Mat3d& motion, JointRange& joint) {
  const Polar parts = polar(motion);
  if (!(determinant(parts.rotation) > 0)) return;
  joint.angle = 2 * std::acos(std::min(1.0, std::abs(Quatd(parts.rotation).w()))) + kFloatTurn;
  joint.scale_lower = parts.least * (1 - kFloatShare);
  joint.scale_upper = parts.largest * (1 + kFloatShare);
}

/// The ball around the bone's places, in the axes of its frame at bind.
void set_slide(const Affine3d& model_from_parent, const Affine3d& model_from_bone,
               const LocalRange& range, JointRange& joint) {
  Vec3d low = Vec3d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  std::vector<Vec3d> slides;
  double reach = norm(Vec3d(model_from_bone.translation()));
  for (const Vec3d& translation : range.translations) {
    const Vec3d place = transform(model_from_parent, translation);
    slides.push_back(place - model_from_bone.translation());
    low = low.cwiseMin(slides.back());
    high = high.cwiseMax(slides.back());
    reach = std::max(reach, norm(place));
  }
  const Vec3d middle = 0.5 * (low + high);
  for (const Vec3d& slide : slides)
    joint.slide_radius = std::max(joint.slide_radius, norm(Vec3d(slide - middle)));
  if (slides.size() > 1) joint.slide_radius += kFloatShare * reach;
  Mat3d axes;
  for (int i = 0; i < 3; ++i) axes.col(i) = normalized(Vec3d(model_from_bone.linear().col(i)));
  joint.slide_from = joint.slide_to = multiply(inverse(axes), middle);
}

Status check_bind(const Character& character, const ModelPose& bind) {
  const std::size_t count = character.skeleton.bones.size();
  if (bind.model_from_bone.size() != count)
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "the bind pose has %zu bones, the skeleton %zu",
                           bind.model_from_bone.size(), count);
  for (std::uint32_t bone = 0; bone < count; ++bone) {
    const Mat3d linear = bind.model_from_bone[bone].linear();
    if (!bind.model_from_bone[bone].matrix().allFinite())
      return Status::failure(StatusCode::non_finite_value, bone,
                             "the bind pose of bone %u is not finite", bone);
    if (!(polar(linear).least > 1e-9 * polar(linear).largest))
      return Status::failure(StatusCode::invalid_argument, bone, "the bind pose of bone %u is flat",
                             bone);
  }
  return {};
}

struct LimitMaker {
  const Character& character;
  const ModelPose& bind;
  double margin = 0.0;
  bool is_free = false;
  std::vector<LocalRange> ranges = local_ranges(character);
  std::vector<JointFrame> frames = {};

  JointLimits make() {
    JointLimits limits;
    const auto& bones = character.skeleton.bones;
    for (std::uint32_t bone = 0; bone < bones.size(); ++bone) limits.of_bone.push_back(start(bone));
    if (is_free) return limits;
    for (const Clip& clip : character.clips)
      for (const Channel& channel : clip.channels)
        if (channel.target == ChannelTarget::rotation && frames[channel.index].is_regular)
          widen(largest_angle(channel, frames[channel.index].at_bind.coeffs()), channel.index,
                limits.of_bone[channel.index]);
    for (std::uint32_t bone = 0; bone < bones.size(); ++bone)
      if (ranges[bone].is_rotated)
        limits.of_bone[bone].angle =
            std::min(std::numbers::pi, limits.of_bone[bone].angle + margin);
    return limits;
  }

 private:
  void widen(double angle, std::uint32_t bone, JointRange& joint) const {
    joint.angle = std::min(std::numbers::pi, std::max(joint.angle, angle + frames[bone].slack));
  }

  JointRange start(std::uint32_t bone) {
    const Bone& of = character.skeleton.bones[bone];
    const Affine3d parent =
        of.parent == kNone ? Affine3d(Affine3d::Identity()) : bind.model_from_bone[of.parent];
    const Affine3d& model_from_bone = bind.model_from_bone[bone];
    const LocalRange& range = ranges[bone];
    frames.push_back(joint_frame(parent.linear(), model_from_bone.linear(), range));
    JointRange joint;
    joint.scale_lower = frames.back().scale_lower;
    joint.scale_upper = frames.back().scale_upper;
    set_slide(parent, model_from_bone, range, joint);
    if (is_free) {
      if (of.parent == kNone) joint.slide_radius = std::numeric_limits<double>::infinity();
      return joint;
    }
    if (frames.back().is_regular) {
      joint.angle = 0;
      widen(angle_between(of.rest.rotation.cast<double>().coeffs(), frames.back().at_bind.coeffs()),
            bone, joint);
    } else if (!range.is_rotated && range.scale_lower == range.scale_upper) {
      set_constant_motion(parent.linear() * of.rest.rotation.cast<double>().toRotationMatrix() *
                              range.scale_lower.asDiagonal() * model_from_bone.linear().inverse(),
                          joint);
    }
    return joint;
  }
};

Result<JointLimits> make_limits(const Character& character, const ModelPose& bind, double margin,
                                bool is_free) {
  try {
    if (const Status status = check_bind(character, bind); !status) return status;
    return LimitMaker{character, bind, margin, is_free}.make();
  } catch (const std::bad_alloc&) {
    return Status::failure(StatusCode::limit_exceeded, kNone, "out of memory");
  }
}

}  // namespace
}  // namespace certificate

Result<JointLimits> free_joint_limits(const Character& character, const ModelPose& bind) {
  return certificate::make_limits(character, bind, 0.0, true);
}

Result<JointLimits> joint_limits_of_clips(const Character& character, const ModelPose& bind,
                                          double margin) {
  if (!(margin >= 0) || !std::isfinite(margin))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the margin is %g radians; it must be finite and not negative", margin);
  return certificate::make_limits(character, bind, margin, false);
}

}  // namespace sunder
