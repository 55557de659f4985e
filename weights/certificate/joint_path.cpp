#include "weights/certificate/joint_path.h"

#include <algorithm>
#include <queue>

namespace sunder::certificate {

std::vector<PathJoint> make_path(const JointTree::State& tree, std::span<const SkinTerm> terms) {
  std::priority_queue<std::uint32_t> open;  // the largest node first
  for (const SkinTerm& term : terms) open.push(tree.node_of_bone[term.bone]);
  std::vector<PathJoint> path;
  while (!open.empty()) {
    const std::uint32_t node = open.top();
    while (!open.empty() && open.top() == node) open.pop();
    path.push_back({node, 0, 0.0, Vec3d::Zero()});
    if (!open.empty()) open.push(tree.nodes[node].parent);
  }
  const auto find = [&](std::uint32_t node) {
    const auto found = std::lower_bound(
        path.begin(), path.end(), node,
        [](const PathJoint& joint, std::uint32_t wanted) { return joint.node > wanted; });
    return static_cast<std::uint32_t>(found - path.begin());
  };
  for (std::size_t i = 0; i + 1 < path.size(); ++i)
    path[i].parent = find(tree.nodes[path[i].node].parent);
  if (!path.empty()) path.back().parent = static_cast<std::uint32_t>(path.size() - 1);
  for (const SkinTerm& term : terms) {
    PathJoint& joint = path[find(tree.node_of_bone[term.bone])];
    joint.m += term.m;
    joint.x += term.x;
  }
  return path;
}

Way way_between(const JointTree::State& tree, std::uint32_t a, std::uint32_t b) {
  std::uint32_t meet_a = a, meet_b = b;
  while (meet_a != meet_b)
    (meet_a > meet_b ? meet_a : meet_b) = tree.nodes[std::max(meet_a, meet_b)].parent;
  Way way;
  for (std::uint32_t node : {a, b})
    for (; node != meet_a; node = tree.nodes[node].parent) {
      way.angle += tree.nodes[node].largest_turn;
      way.strain += tree.nodes[node].strain;
    }
  return way;
}

bool find_gap(const JointTree::State& tree, std::span<const SkinTerm> terms, PathGap& gap) {
  if (terms.empty()) return false;
  double sum = 0;
  for (const SkinTerm& term : terms) sum += term.m;
  gap = {};
  if (!(std::abs(sum) <= kSumTolerance)) return true;
  std::vector<PathJoint> path = make_path(tree, terms);
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const PreparedJoint& joint = tree.nodes[path[i].node];
    const std::uint32_t bone = path[i].node - 1;
    if (!joint.has_scale_range) {
      gap = {CertificateGap::Reason::no_scale_range, bone};
      return true;
    }
    if (!joint.has_slide_range && std::abs(path[i].m) > kSumTolerance) {
      gap = {CertificateGap::Reason::no_slide_range, bone};
      return true;
    }
    path[path[i].parent].m += path[i].m;
  }
  gap = {CertificateGap::Reason::no_scale_range, tree.nodes[path.back().node].unscaled_bone};
  return gap.bone != kNone;
}

Status check_rows(const JointTree::State& tree, const SkinDifferences& rows) {
  if (rows.first.empty() || rows.first.front() != 0 || rows.first.back() != rows.terms.size())
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "offsets of points must begin with 0 and end with %zu, the terms",
                           rows.terms.size());
  for (std::uint32_t point = 0; point + 1 < rows.first.size(); ++point) {
    if (rows.first[point] > rows.first[point + 1])
      return Status::failure(StatusCode::invalid_argument, point,
                             "point %u: its terms end before they begin", point);
    for (std::uint32_t i = rows.first[point]; i < rows.first[point + 1]; ++i) {
      const SkinTerm& term = rows.terms[i];
      if (term.bone >= tree.node_of_bone.size())
        return Status::failure(StatusCode::index_out_of_range, point,
                               "point %u: bone %u, the skeleton has %zu", point, term.bone,
                               tree.node_of_bone.size());
      if (!std::isfinite(term.m) || !term.x.allFinite())
        return Status::failure(StatusCode::non_finite_value, point,
                               "point %u: the term of bone %u is not finite", point, term.bone);
    }
  }
  return {};
}

}  // namespace sunder::certificate
