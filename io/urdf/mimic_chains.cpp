#include "io/urdf/mimic_chains.h"

#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "io/urdf/joint_checks.h"

namespace sunder::urdf {
namespace {

class Resolver {
 public:
  Resolver(const RobotTags& tags, Findings& findings)
      : tags_(tags), findings_(findings), chains_(tags.joints.size()) {
    for (std::uint32_t i = 0; i < tags.joints.size(); ++i) {
      joint_of_name_.try_emplace(tags.joints[i].name, i);
      types_.push_back(joint_type_named(tags.joints[i].type).value_or(RobotJointType::fixed));
    }
  }

  std::vector<MimicChain> resolve() {
    for (std::uint32_t i = 0; i < chains_.size(); ++i) chains_[i].mimicked = target_of(i);
    cut_circles();
    for (std::uint32_t i = 0; i < chains_.size(); ++i) follow(i);
    for (std::uint32_t i = 0; i < chains_.size(); ++i) report_chain(i);
    return std::move(chains_);
  }

 private:
  /// The joint that a joint mimics; kNone if there is none or it cannot be followed.
  std::uint32_t target_of(std::uint32_t joint) {
    const JointTag& tag = tags_.joints[joint];
    if (!tag.mimic || types_[joint] == RobotJointType::fixed) return kNone;
    const auto refuse = [&](const char* code, const std::string& text) {
      findings_.add(code, place_of(tag), text + "; it moves on its own");
      return kNone;
    };
    const std::string name = "'" + tag.mimic->joint.substr(0, 80) + "'";
    if (tag.mimic->joint == tag.name) return refuse("mimic_self", "it mimics itself");
    const auto found = joint_of_name_.find(tag.mimic->joint);
    if (found == joint_of_name_.end())
      return refuse("mimic_broken_reference", "it mimics joint " + name + ", which does not exist");
    if (value_count_of(types_[joint]) != 1)
      return refuse("mimic_unsupported", "a " + tag.type + " joint cannot mimic another one");
    if (value_count_of(types_[found->second]) > 1)
      return refuse("mimic_unsupported", "it mimics joint " + name + ", which has several values");
    return found->second;
  }

  void cut_circles() {
    std::vector<std::uint32_t> walk_of(chains_.size(), kNone);
    for (std::uint32_t start = 0; start < chains_.size(); ++start) {
      std::uint32_t joint = start;
      while (joint != kNone && walk_of[joint] == kNone) {
        walk_of[joint] = start;
        joint = chains_[joint].mimicked;
      }
      if (joint != kNone && walk_of[joint] == start) cut_circle(joint);
    }
  }

  void cut_circle(std::uint32_t joint) {
    while (chains_[joint].mimicked != kNone) {
      const std::uint32_t next = chains_[joint].mimicked;
      findings_.add("mimic_chain", place_of(tags_.joints[joint]),
                    "it mimics joint '" + tags_.joints[next].name.substr(0, 80) +
                        "', which mimics it in turn, directly or through others; it moves on its "
                        "own");
      chains_[joint].mimicked = kNone;
      joint = next;
    }
  }

  /// Takes the steps of a chain together, from its end; the chains have no circles any more.
  void follow(std::uint32_t start) {
    std::vector<std::uint32_t> path;
    for (std::uint32_t joint = start; chains_[joint].mimicked != kNone && !is_done(joint);
         joint = chains_[joint].mimicked)
      path.push_back(joint);
    for (; !path.empty(); path.pop_back()) extend(path.back());
  }

  [[nodiscard]] bool is_done(std::uint32_t joint) const {
    return chains_[joint].driving != kNone || chains_[joint].stands_still;
  }

  void extend(std::uint32_t joint) {
    MimicChain& chain = chains_[joint];
    const MimicTag& mimic = *tags_.joints[joint].mimic;
    const MimicChain& next = chains_[chain.mimicked];
    const bool is_last = next.mimicked == kNone;
    chain.stands_still =
        next.stands_still || (is_last && types_[chain.mimicked] == RobotJointType::fixed);
    chain.driving = chain.stands_still ? kNone : is_last ? chain.mimicked : next.driving;
    const double multiplier = mimic.multiplier * (is_last ? 1.0 : next.multiplier);
    const double offset = mimic.multiplier * (is_last ? 0.0 : next.offset) + mimic.offset;
    chain.multiplier = chain.stands_still ? 0.0 : multiplier;
    chain.offset = offset;
    if (std::isfinite(multiplier) && std::isfinite(offset)) return;
    findings_.add("number_not_finite", place_of(tags_.joints[joint]),
                  "its multipliers and offsets, taken together, are beyond the range of numbers");
  }

  void report_chain(std::uint32_t joint) {
    const MimicChain& chain = chains_[joint];
    if (chain.mimicked == kNone) return;
    const std::string name = tags_.joints[chain.mimicked].name.substr(0, 80);
    char text[64];
    std::snprintf(text, sizeof text, "%g", chain.offset);
    if (chain.stands_still)
      findings_.add("mimic_fixed_target", place_of(tags_.joints[joint]),
                    "it mimics joint '" + name + "', which is fixed; it stands still at " + text);
    else if (chain.driving != chain.mimicked)
      findings_.add("mimic_chain_resolved", place_of(tags_.joints[joint]),
                    "it mimics joint '" + name + "', which mimics another one; joint '" +
                        tags_.joints[chain.driving].name.substr(0, 80) + "' drives it");
  }

  const RobotTags& tags_;
  Findings& findings_;
  std::vector<MimicChain> chains_;
  std::map<std::string_view, std::uint32_t> joint_of_name_;
  std::vector<RobotJointType> types_;
};

}  // namespace

std::vector<MimicChain> resolve_mimics(const RobotTags& tags, Findings& findings) {
  return Resolver(tags, findings).resolve();
}

}  // namespace sunder::urdf
