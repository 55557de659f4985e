#include "tools/open/opened_character.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "tools/open/bind_displacement.h"
#include "tools/open/weights_channel.h"

namespace sunder::tools {
namespace {

Result<std::vector<MorphTarget>> targets_of(const Character& torn, const Opening& opening) {
  if (opening.closed.size() != torn.meshes.size())
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "the opening is of %zu meshes, the character has %zu",
                           opening.closed.size(), torn.meshes.size());
  std::vector<MorphTarget> targets;
  for (std::uint32_t m = 0; m < torn.meshes.size(); ++m) {
    if (opening.closed[m].positions.size() != torn.meshes[m].positions.size())
      return Status::failure(StatusCode::size_mismatch, m,
                             "mesh %u: the opening is of %zu vertices, the mesh has %zu", m,
                             opening.closed[m].positions.size(), torn.meshes[m].positions.size());
    auto target = displacement_in_bind(torn, m, opening.pose, opening.closed[m], opening.open[m]);
    if (!target) return target.error();
    target->name = kOpenTarget;
    targets.push_back(std::move(*target));
  }
  return targets;
}

/// The weights of the meshes of one node.
struct NodeWeights {
  std::uint32_t old_first = 0, first = 0, count = 0;  ///< Of the old ones.
};

/// The nodes with a mesh that gapes, and room for the weights of each at the end of the rest
/// weights.
std::map<std::uint32_t, NodeWeights> make_room(Character& character,
                                               const std::vector<MorphTarget>& targets,
                                               std::span<const std::uint32_t> nodes) {
  std::map<std::uint32_t, NodeWeights> of_node;
  for (std::size_t m = 0; m < targets.size(); ++m)
    if (!targets[m].position_deltas.empty()) of_node.try_emplace(nodes[m]);
  for (std::size_t m = 0; m < targets.size(); ++m) {
    const auto found = of_node.find(nodes[m]);
    if (found == of_node.end()) continue;
    const Mesh& mesh = character.meshes[m];
    NodeWeights& weights = found->second;  // Some meshes of a node may lack some targets.
    weights.old_first = mesh.first_morph_weight;
    weights.count = std::max(weights.count, static_cast<std::uint32_t>(mesh.morph_targets.size()));
  }
  std::vector<float>& rest = character.rest_morph_weights;
  for (auto& [node, weights] : of_node) {
    weights.first = static_cast<std::uint32_t>(rest.size());
    for (std::uint32_t i = 0; i < weights.count; ++i)
      rest.push_back(float(rest[weights.old_first + i]));
    rest.push_back(1.0f);
  }
  return of_node;
}

/// Appends targets to the meshes of nodes that gape, and their weights.
std::vector<NodeWeights> append_targets(Character& character, std::vector<MorphTarget> targets,
                                        std::span<const std::uint32_t> nodes) {
  const std::map<std::uint32_t, NodeWeights> of_node = make_room(character, targets, nodes);
  for (std::size_t m = 0; m < targets.size(); ++m) {
    const auto found = of_node.find(nodes[m]);
    if (found == of_node.end()) continue;
    Mesh& mesh = character.meshes[m];
    mesh.first_morph_weight = found->second.first;
    mesh.morph_targets.resize(found->second.count);
    mesh.morph_targets.push_back(std::move(targets[m]));
  }
  std::vector<NodeWeights> weights;
  for (const auto& [node, of] : of_node) weights.push_back(of);
  return weights;
}

/// Extends the channels of a node's weights in a clip.
/// @param keys  null: the clip does not show the tear.
void extend_channels(const NodeWeights& weights, const std::vector<WeightKey>* keys,
                     const std::vector<float>& rest_weights, Clip& clip) {
  const std::span<const float> rest(rest_weights.data() + weights.first, weights.count);
  const WeightKey whole{0, 1};
  const std::span<const WeightKey> course =
      keys == nullptr ? std::span(&whole, 1) : std::span<const WeightKey>(*keys);
  bool is_driven = false;
  for (Channel& channel : clip.channels) {
    const bool is_of_node = channel.target == ChannelTarget::morph_weights &&
                            channel.index < weights.old_first + weights.count &&
                            weights.old_first < channel.index + channel.width;
    if (!is_of_node) continue;
    channel = with_weight(&channel, rest, weights.old_first, course, weights.first);
    is_driven = true;
  }
  if (!is_driven && keys != nullptr && course.size() > 1)
    clip.channels.push_back(with_weight(nullptr, rest, weights.old_first, course, weights.first));
}

}  // namespace

Result<Character> with_open_target(Character torn, const Opening& opening,
                                   std::span<const std::uint32_t> nodes,
                                   std::span<const ClipMoment> moments) {
  Result<std::vector<MorphTarget>> targets = targets_of(torn, opening);
  if (!targets) return targets.error();
  Character open = std::move(torn);
  const std::vector<NodeWeights> of_nodes = append_targets(open, std::move(*targets), nodes);
  for (std::uint32_t c = 0; c < open.clips.size(); ++c) {
    Clip& clip = open.clips[c];
    const ClipMoment* first = nullptr;
    for (const ClipMoment& moment : moments)
      if (moment.clip == c && (first == nullptr || moment.seconds < first->seconds))
        first = &moment;
    std::vector<WeightKey> keys;
    if (first != nullptr)
      keys = keys_of(opening, first->seconds, static_cast<double>(clip.duration), first->end);
    for (const NodeWeights& weights : of_nodes)
      extend_channels(weights, first != nullptr ? &keys : nullptr, open.rest_morph_weights, clip);
  }
  return open;
}

Result<Character> with_open_positions(Character torn, const Opening& opening) {
  const Result<std::vector<MorphTarget>> targets = targets_of(torn, opening);
  if (!targets) return targets.error();
  Character open = std::move(torn);
  const auto unit = [](const Vec3f& direction, const Vec3f& otherwise) {
    return direction.norm() > 0.0f ? Vec3f(direction.normalized()) : otherwise;
  };
  for (std::size_t m = 0; m < open.meshes.size(); ++m) {
    Mesh& mesh = open.meshes[m];
    const MorphTarget& target = (*targets)[m];
    for (std::size_t v = 0; v < target.position_deltas.size(); ++v)
      mesh.positions[v] += target.position_deltas[v];
    for (std::size_t v = 0; v < target.normal_deltas.size(); ++v)
      if (target.normal_deltas[v] != Vec3f::Zero())
        mesh.normals[v] = unit(mesh.normals[v] + target.normal_deltas[v], mesh.normals[v]);
    for (std::size_t v = 0; v < target.tangent_deltas.size(); ++v)
      if (const Vec3f old = mesh.tangents[v].head<3>(); target.tangent_deltas[v] != Vec3f::Zero())
        mesh.tangents[v].head<3>() = unit(old + target.tangent_deltas[v], old);
  }
  return open;
}

}  // namespace sunder::tools
