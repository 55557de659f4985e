#include "io/urdf/link_tree.h"

#include <map>
#include <string>
#include <string_view>

namespace sunder::urdf {
namespace {

constexpr std::size_t kMostListed = 4;

/// "'a', 'b' and 3 more".
std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size() && i < kMostListed; ++i)
    text += (i == 0 ? "'" : ", '") + names[i].substr(0, 60) + "'";
  if (names.size() > kMostListed)
    text += " and " + std::to_string(names.size() - kMostListed) + " more";
  return text;
}

class TreeMaker {
 public:
  TreeMaker(const RobotTags& tags, Findings& findings) : tags_(tags), findings_(findings) {}

  LinkTree make() {
    if (tags_.links.empty()) findings_.add("no_link", {}, "the robot has no link");
    index_links();
    check_joint_names();
    if (!findings_.status()) return {};
    connect();
    if (!findings_.status()) return {};
    const std::uint32_t root = find_root();
    if (!findings_.status()) return {};
    return ordered_from(root);
  }

 private:
  void index_links() {
    for (std::uint32_t i = 0; i < tags_.links.size(); ++i) {
      const LinkTag& link = tags_.links[i];
      if (link.name.empty())
        findings_.add("name_missing", {"link", link.line}, "it has no name");
      else if (const auto [first, is_new] = link_of_name_.try_emplace(link.name, i); !is_new)
        findings_.add("duplicate_name", place_of(link),
                      "another link, in line " + std::to_string(tags_.links[first->second].line) +
                          ", has the same name");
    }
  }

  void check_joint_names() {
    std::map<std::string_view, std::uint32_t> lines;
    for (const JointTag& joint : tags_.joints) {
      if (joint.name.empty())
        findings_.add("name_missing", {"joint", joint.line}, "it has no name");
      else if (const auto [first, is_new] = lines.try_emplace(joint.name, joint.line); !is_new)
        findings_.add(
            "duplicate_name", place_of(joint),
            "another joint, in line " + std::to_string(first->second) + ", has the same name");
    }
  }

  /// The link that a joint names; kNone with a finding if there is none.
  std::uint32_t link_named(const JointTag& joint, const std::string& name, const char* role) {
    if (name.empty()) {
      findings_.add("joint_incomplete", place_of(joint),
                    std::string("it has no ") + role + " link");
      return kNone;
    }
    const auto found = link_of_name_.find(name);
    if (found != link_of_name_.end()) return found->second;
    findings_.add("link_missing", place_of(joint),
                  std::string("its ") + role + " link '" + name.substr(0, 80) + "' does not exist");
    return kNone;
  }

  void connect() {
    children_.resize(tags_.links.size());
    joint_to_.assign(tags_.links.size(), kNone);
    parent_of_.assign(tags_.links.size(), kNone);
    for (std::uint32_t i = 0; i < tags_.joints.size(); ++i) {
      const JointTag& joint = tags_.joints[i];
      const std::uint32_t parent = link_named(joint, joint.parent, "parent");
      const std::uint32_t child = link_named(joint, joint.child, "child");
      if (parent == kNone || child == kNone) continue;
      if (joint_to_[child] != kNone) {
        findings_.add("two_parents", place_of(tags_.links[child]),
                      "joints '" + tags_.joints[joint_to_[child]].name.substr(0, 60) + "' and '" +
                          joint.name.substr(0, 60) + "' both lead to it; a robot has to be a tree");
        continue;
      }
      joint_to_[child] = i;
      parent_of_[child] = parent;
      children_[parent].push_back(child);
    }
  }

  /// Every link has at most one parent here, so a walk upwards ends at a root or runs in a circle.
  std::uint32_t find_root() {
    std::vector<std::uint32_t> roots, walk_of(tags_.links.size(), kNone);
    for (std::uint32_t start = 0; start < walk_of.size(); ++start) {
      std::uint32_t link = start;
      while (link != kNone && walk_of[link] == kNone) {
        walk_of[link] = start;
        if (parent_of_[link] == kNone) roots.push_back(link);
        link = parent_of_[link];
      }
      if (link != kNone && walk_of[link] == start) report_circle(link);
    }
    if (roots.size() > 1) report_roots(roots);
    return roots.empty() ? kNone : roots.front();
  }

  void report_circle(std::uint32_t start) {
    std::vector<std::string> names;
    std::uint32_t link = start;
    do {
      names.push_back(tags_.joints[joint_to_[link]].name);
      link = parent_of_[link];
    } while (link != start);
    findings_.add("circle", place_of(tags_.links[start]),
                  "the joints " + listed(names) + " run in a circle; a robot has to be a tree");
  }

  void report_roots(const std::vector<std::uint32_t>& roots) {
    std::vector<std::string> names;
    for (const std::uint32_t root : roots) names.push_back(tags_.links[root].name);
    findings_.add("several_roots", {"", tags_.links[roots[1]].line},
                  "no joint leads to the links " + listed(names) + "; only one may be the root");
  }

  [[nodiscard]] LinkTree ordered_from(std::uint32_t root) const {
    LinkTree tree;
    std::vector<std::uint32_t> open = {root}, place(tags_.links.size(), kNone);
    while (!open.empty()) {
      const std::uint32_t link = open.back();
      open.pop_back();
      place[link] = static_cast<std::uint32_t>(tree.links.size());
      tree.links.push_back(link);
      if (link != root) tree.joints.push_back(joint_to_[link]);
      tree.parents.push_back(link == root ? kNone : place[parent_of_[link]]);
      open.insert(open.end(), children_[link].rbegin(), children_[link].rend());
    }
    return tree;
  }

  const RobotTags& tags_;
  Findings& findings_;
  std::map<std::string_view, std::uint32_t> link_of_name_;
  std::vector<std::uint32_t> joint_to_, parent_of_;  ///< Per link; kNone: no joint leads to it.
  std::vector<std::vector<std::uint32_t>> children_;
};

}  // namespace

LinkTree make_link_tree(const RobotTags& tags, Findings& findings) {
  return TreeMaker(tags, findings).make();
}

}  // namespace sunder::urdf
