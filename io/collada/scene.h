#pragma once

#include <sunder/core/index.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace sunder::collada {

/// A skin where a node shows it.
struct SkinInstance {
  std::vector<std::string> joints;
  bool has_ids = false;                  ///< `joints` are ids; otherwise sids below the skeletons.
  std::vector<std::uint32_t> skeletons;  ///< Nodes; empty: the file names none.
};

struct Node {
  std::string id, sid, name;
  std::vector<std::uint32_t> children;  ///< Those written in the node, not instances of others.
  std::vector<SkinInstance> skins;
};

/// The visual scene that a COLLADA file shows.
struct Scene {
  std::vector<Node> nodes;  ///< In the file's order; the first is the visual scene itself.
};

/// @throws std::runtime_error if the text is no XML or has no visual scene.
[[nodiscard]] Scene read_scene(std::string_view text);

/// The node of each joint of a skin, by the rules of COLLADA: an id anywhere, or the first sid
/// below the skeletons, level by level. kNone: there is none.
[[nodiscard]] std::vector<std::uint32_t> find_joints(const Scene& scene, const SkinInstance& skin);

}  // namespace sunder::collada
