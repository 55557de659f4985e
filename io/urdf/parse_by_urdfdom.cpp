#include "io/urdf/parse_by_urdfdom.h"

#include <console_bridge/console.h>
#include <exception>
#include <mutex>
#include <new>
#include <string>
#include <urdf_parser/urdf_parser.h>
#include <utility>

#include "io/urdf/canonical_text.h"

namespace sunder::urdf {
namespace {

/// Keeps what urdfdom says while it lives, in place of the program's own handler. There is one
/// handler per process, so objects exclude one another.
class Messages : public console_bridge::OutputHandler {
 public:
  Messages() : lock_(mutex()), before_(console_bridge::getOutputHandler()) {
    console_bridge::useOutputHandler(this);
  }
  ~Messages() override { console_bridge::useOutputHandler(before_); }
  Messages(const Messages&) = delete;
  Messages& operator=(const Messages&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR && errors_.size() < 400)
      errors_ += (errors_.empty() ? "" : "; ") + text;
  }

  [[nodiscard]] const std::string& errors() const { return errors_; }

 private:
  static std::mutex& mutex() {
    static std::mutex only;
    return only;
  }

  std::lock_guard<std::mutex> lock_;
  console_bridge::OutputHandler* before_;
  std::string errors_;
};

Affine3d transform_of(const ::urdf::Pose& pose) {
  const Quatd rotation(pose.rotation.w, pose.rotation.x, pose.rotation.y, pose.rotation.z);
  Affine3d transform = Affine3d::Identity();
  transform.linear() = rotation.normalized().toRotationMatrix();
  transform.translation() = Vec3d(pose.position.x, pose.position.y, pose.position.z);
  return transform;
}

/// Links own their children, so that a long chain would be destroyed by recursion.
void untie(::urdf::ModelInterface& model) {
  for (auto& [name, link] : model.links_) {
    link->child_links.clear();
    link->child_joints.clear();
  }
}

template <class Shapes>
std::vector<Affine3d> origins_of(const Shapes& shapes) {
  std::vector<Affine3d> origins;
  for (const auto& shape : shapes) origins.push_back(transform_of(shape->origin));
  return origins;
}

/// Throws std::out_of_range if a part that was written is missing.
ParsedRobot converted(const RobotTags& tags, const ::urdf::ModelInterface& model) {
  ParsedRobot robot;
  for (std::size_t i = 0; i < tags.links.size(); ++i) {
    const auto& link = model.links_.at("l" + std::to_string(i));
    robot.links.push_back({origins_of(link->visual_array), origins_of(link->collision_array)});
  }
  for (std::size_t i = 0; i < tags.joints.size(); ++i) {
    const auto& joint = model.joints_.at("j" + std::to_string(i));
    ParsedRobot::Joint parsed;
    parsed.parent_from_joint = transform_of(joint->parent_to_joint_origin_transform);
    const Vec3d axis(joint->axis.x, joint->axis.y, joint->axis.z);
    if (axis.squaredNorm() > 0) parsed.axis = axis.normalized();
    if (joint->limits) {
      parsed.lower = joint->limits->lower;
      parsed.upper = joint->limits->upper;
      parsed.effort = joint->limits->effort;
      parsed.velocity = joint->limits->velocity;
    }
    robot.joints.push_back(parsed);
  }
  return robot;
}

}  // namespace

std::optional<ParsedRobot> parse_by_urdfdom(const RobotTags& tags, Findings& findings) {
  const std::string text = canonical_text(tags);
  std::string why;
  {
    const Messages messages;
    try {
      if (const ::urdf::ModelInterfaceSharedPtr model = ::urdf::parseURDF(text)) {
        ParsedRobot robot = converted(tags, *model);
        untie(*model);
        return robot;
      }
      why = messages.errors();
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception& error) {
      why = error.what();
    }
  }
  findings.add("urdfdom_refused", {}, "urdfdom: " + why);
  return std::nullopt;
}

}  // namespace sunder::urdf
