// Forward kinematics against KDL, on a tree that is built from urdfdom's own reading of the file:
// neither our reader nor our kinematics takes part in the expected values.

#include <sunder/io/robot_file.h>

#include <filesystem>
#include <fstream>
#include <kdl/frames.hpp>
#include <kdl/jntarray.hpp>
#include <kdl/tree.hpp>
#include <kdl/treefksolverpos_recursive.hpp>
#include <map>
#include <sstream>
#include <string>
#include <urdf_parser/urdf_parser.h>
#include <vector>

#include <gtest/gtest.h>

#include "support/machine/temporary_folder.h"
#include "support/models/random_robot.h"
#include "support/models/shared_models.h"

namespace sunder::test {
namespace {

constexpr double kAgreement = 1e-6;

/// The origins of joints by name, read from the text: urdfdom turns angles into quaternions.
std::map<std::string, KDL::Frame> origins_of(const std::filesystem::path& file) {
  std::map<std::string, KDL::Frame> origins;
  TiXmlDocument document(file.string());
  EXPECT_TRUE(document.LoadFile());
  const TiXmlElement* const root = document.RootElement();
  for (const auto* joint = root->FirstChildElement("joint"); joint != nullptr;
       joint = joint->NextSiblingElement("joint")) {
    double xyz[3] = {0, 0, 0}, rpy[3] = {0, 0, 0};
    const auto read = [&](const char* name, double* numbers) {
      const TiXmlElement* const origin = joint->FirstChildElement("origin");
      if (origin == nullptr || origin->Attribute(name) == nullptr) return;
      std::istringstream text(origin->Attribute(name));
      text >> numbers[0] >> numbers[1] >> numbers[2];
    };
    read("xyz", xyz);
    read("rpy", rpy);
    origins[joint->Attribute("name")] = {KDL::Rotation::RPY(rpy[0], rpy[1], rpy[2]),
                                         KDL::Vector(xyz[0], xyz[1], xyz[2])};
  }
  return origins;
}

/// The same robot as a tree of KDL. Joints with several values become several joints of KDL, on
/// segments of their own.
class KdlRobot {
 public:
  KdlRobot(const urdf::ModelInterface& model, std::map<std::string, KDL::Frame> origins)
      : model_(model), origins_(std::move(origins)), tree_(model.getRoot()->name) {
    std::vector<std::string> open = {model.getRoot()->name};
    while (!open.empty()) {
      const auto link = model.getLink(open.back());
      open.pop_back();
      for (const auto& joint : link->child_joints) {
        add(*joint);
        open.push_back(joint->child_link_name);
      }
    }
    // A copy numbers the joints anew, depth first, and a solver works on a copy.
    const KDL::Tree renumbered(tree_);
    tree_ = renumbered;
  }

  /// Frames of the links, from the values of joints by name ("joint" or "joint.part").
  std::map<std::string, KDL::Frame> evaluate(const std::map<std::string, double>& values) {
    KDL::JntArray positions(tree_.getNrOfJoints());
    for (const auto& [name, segment] : tree_.getSegments()) {
      const KDL::Joint& joint = segment.segment.getJoint();
      if (joint.getType() != KDL::Joint::None)
        positions(segment.q_nr) = position_of(joint.getName(), values);
    }
    KDL::TreeFkSolverPos_recursive solver(tree_);
    std::map<std::string, KDL::Frame> frames;
    for (const auto& [name, link] : model_.links_) {
      if (name == model_.getRoot()->name) continue;
      EXPECT_EQ(solver.JntToCart(positions, frames[name], name), 0) << name;
    }
    return frames;
  }

 private:
  void add_segment(const std::string& parent, const std::string& name, const KDL::Joint& joint,
                   const KDL::Frame& tip) {
    ASSERT_TRUE(tree_.addSegment(KDL::Segment(name, joint, tip), parent)) << name;
  }

  void add(const urdf::Joint& joint) {
    const KDL::Frame origin = origins_.at(joint.name);
    const KDL::Vector axis = origin.M * KDL::Vector(joint.axis.x, joint.axis.y, joint.axis.z);
    const std::string &parent = joint.parent_link_name, &child = joint.child_link_name;
    switch (joint.type) {
      case urdf::Joint::REVOLUTE:
      case urdf::Joint::CONTINUOUS:
        return add_segment(parent, child,
                           KDL::Joint(joint.name, origin.p, axis, KDL::Joint::RotAxis), origin);
      case urdf::Joint::PRISMATIC:
        return add_segment(parent, child,
                           KDL::Joint(joint.name, origin.p, axis, KDL::Joint::TransAxis), origin);
      case urdf::Joint::PLANAR: return add_planar(joint, origin);
      case urdf::Joint::FLOATING: return add_floating(joint, origin);
      default: return add_segment(parent, child, KDL::Joint(joint.name, KDL::Joint::None), origin);
    }
  }

  void add_planar(const urdf::Joint& joint, const KDL::Frame& origin) {
    const KDL::Vector normal(joint.axis.x, joint.axis.y, joint.axis.z);
    const KDL::Vector z(0, 0, 1), about = z * normal;
    // The shortest turn from z to the normal; half a turn about x if they are opposite.
    const double angle = std::atan2(about.Norm(), KDL::dot(z, normal));
    const KDL::Rotation turn = about.Norm() > 1e-12 ? KDL::Rotation::Rot(about, angle)
                               : normal.z() < 0     ? KDL::Rotation::RotX(M_PI)
                                                    : KDL::Rotation::Identity();
    const std::string &child = joint.child_link_name, &name = joint.name;
    add_segment(joint.parent_link_name, child + "#o", KDL::Joint(name + "#o", KDL::Joint::None),
                origin);
    const auto axis = [&](const KDL::Vector& of, KDL::Joint::JointType type, const char* part) {
      return KDL::Joint(name + part, KDL::Vector::Zero(), of, type);
    };
    add_segment(child + "#o", child + "#x", axis(turn.UnitX(), KDL::Joint::TransAxis, ".x"), {});
    add_segment(child + "#x", child + "#y", axis(turn.UnitY(), KDL::Joint::TransAxis, ".y"), {});
    add_segment(child + "#y", child, axis(normal, KDL::Joint::RotAxis, ".angle"), {});
  }

  void add_floating(const urdf::Joint& joint, const KDL::Frame& origin) {
    const std::string &child = joint.child_link_name, &name = joint.name;
    add_segment(joint.parent_link_name, child + "#o", KDL::Joint(name + "#o", KDL::Joint::None),
                origin);
    add_segment(child + "#o", child + "#x", KDL::Joint(name + ".x", KDL::Joint::TransX), {});
    add_segment(child + "#x", child + "#y", KDL::Joint(name + ".y", KDL::Joint::TransY), {});
    add_segment(child + "#y", child + "#z", KDL::Joint(name + ".z", KDL::Joint::TransZ), {});
    add_segment(child + "#z", child + "#w", KDL::Joint(name + ".yaw", KDL::Joint::RotZ), {});
    add_segment(child + "#w", child + "#p", KDL::Joint(name + ".pitch", KDL::Joint::RotY), {});
    add_segment(child + "#p", child, KDL::Joint(name + ".roll", KDL::Joint::RotX), {});
  }

  /// The value of a joint of KDL: mimic joints follow their chain, angles of a floating joint come
  /// from its quaternion.
  double position_of(const std::string& name, const std::map<std::string, double>& values) const {
    if (const auto joint = model_.joints_.find(name);
        joint != model_.joints_.end() && joint->second->mimic) {
      const urdf::JointMimic& mimic = *joint->second->mimic;
      return mimic.multiplier * position_of(mimic.joint_name, values) + mimic.offset;
    }
    if (const auto given = values.find(name); given != values.end()) return given->second;
    const std::string of = name.substr(0, name.rfind('.'));
    double x = values.at(of + ".qx"), y = values.at(of + ".qy"), z = values.at(of + ".qz"),
           w = values.at(of + ".qw");
    const double length = std::sqrt(x * x + y * y + z * z + w * w);
    double roll = 0, pitch = 0, yaw = 0;
    KDL::Rotation::Quaternion(x / length, y / length, z / length, w / length)
        .GetRPY(roll, pitch, yaw);
    return name.ends_with(".roll") ? roll : name.ends_with(".pitch") ? pitch : yaw;
  }

  const urdf::ModelInterface& model_;
  std::map<std::string, KDL::Frame> origins_;
  KDL::Tree tree_;
};

double difference(const Affine3d& ours, const KDL::Frame& theirs) {
  double largest = 0;
  for (int row = 0; row < 3; ++row) {
    largest = std::max(largest, std::abs(ours.translation()[row] - theirs.p(row)));
    for (int column = 0; column < 3; ++column)
      largest = std::max(largest, std::abs(ours.linear()(row, column) - theirs.M(row, column)));
  }
  return largest;
}

/// The largest difference over all links and `rounds` random values.
double compare(const std::filesystem::path& file, Random& random, int rounds) {
  RobotLoadOptions options;
  options.shapes = RobotShapes::none;
  const auto loaded = load_robot(file, options);
  EXPECT_TRUE(loaded) << file << ": " << loaded.error().text();
  const auto model = urdf::parseURDFFile(file.string());
  EXPECT_TRUE(model) << file;
  if (!loaded || !model) return 1e9;
  const Robot& robot = loaded->robot;
  EXPECT_EQ(robot.links.size(), model->links_.size());
  KdlRobot kdl(*model, origins_of(file));
  const auto kinematics = RobotKinematics::create(robot);
  std::vector<Affine3d> frames(robot.links.size());
  double largest = 0;
  for (int round = 0; round < rounds; ++round) {
    const std::vector<double> values = random_values(random, robot);
    std::map<std::string, double> by_name;
    for (std::size_t i = 0; i < values.size(); ++i) by_name[robot.values[i].name] = values[i];
    EXPECT_TRUE(kinematics->evaluate(values, frames));
    const auto expected = kdl.evaluate(by_name);
    for (std::size_t link = 1; link < frames.size(); ++link)
      largest = std::max(largest, difference(frames[link], expected.at(robot.links[link].name)));
  }
  return largest;
}

TEST(UrdfAgainstKdl, shared_robots_at_a_thousand_random_joint_vectors) {
  SUNDER_SKIP_WITHOUT_SHARED_MODELS();
  Random random(1);
  int count = 0;
  for (const auto& file : files_below(shared_models() / "urdf", {".urdf"})) {
    EXPECT_LT(compare(file, random, 1000), kAgreement) << file;
    ++count;
  }
  EXPECT_GT(count, 0);
}

TEST(UrdfAgainstKdl, generated_robots_of_all_joint_types) {
  const TemporaryFolder folder;
  Random random(2);
  double largest = 0;
  for (int i = 0; i < 60; ++i) {
    const double bushiness = i % 3 == 0 ? 0.0 : random.uniform(0, 1);
    const auto file =
        folder.write("robot.urdf", random_urdf(random, 2 + random.index(30), bushiness));
    largest = std::max(largest, compare(file, random, 20));
  }
  EXPECT_LT(largest, kAgreement);
}

}  // namespace
}  // namespace sunder::test
