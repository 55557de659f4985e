#pragma once

#include <sunder/core/character.h>
#include <sunder/core/status.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace sunder {

/// A bone of a model, and the bone of a rig that is to move its vertices. By name.
struct BonePair {
  std::string model, rig;

  bool operator==(const BonePair&) const = default;
};

/// Where a model stands when it is attached to a rig. The model stands in its bind pose.
struct BindingPlace {
  /// The rig's pose: one invertible matrix per bone, bone space to the rig's model space. Empty:
  /// rest_pose().
  std::vector<Affine3d> rig_from_bone;
  /// The model's space to that of the rig; invertible, may scale and mirror.
  Affine3d rig_from_model = Affine3d::Identity();
};

struct MappingOptions {
  BindingPlace place;
  /// Refuses bones with weight that are not mapped; otherwise their nearest mapped ancestor takes
  /// their weight.
  bool refuse_unmapped = false;
};

/// A model attached to a rig: its meshes, and the rig's skeleton.
struct Binding {
  /// Skeleton and clips are the rig's, without morph weights. Meshes, their bind positions and
  /// their rest morph weights are the model's, bit for bit but for weights and skin.
  Character character;
  /// The largest distance of a vertex, in the pose of the binding, from its place in the model's
  /// bind pose; rig space. More than rounding only where skins of the model bind a bone
  /// differently.
  double largest_shape_error = 0;
  std::uint32_t clips_left_out = 0;  ///< Clips of the model, which move another skeleton.
};

struct MappedBinding : Binding {
  std::uint32_t mapped_bones = 0;           ///< Bones of the model with weight that have a pair.
  std::vector<BonePair> taken_by_ancestor;  ///< Bones with weight without a pair, and who took it.
  std::vector<std::string> unused;          ///< Bones of the map that move no vertex.
  /// The pair whose joints are farthest apart in the pose of the binding, and by how much; rig
  /// space. Joints apart mean that the surface turns about another place than it did.
  BonePair farthest_pair;
  double farthest_distance = 0;
};

/// Attaches a skinned model to another skeleton. The bones of the model, by the names of `pairs`
/// and otherwise by equal names, hand their weight to bones of the rig; several may hand it to one.
///
/// @param model  satisfies validate_character(); so does the rig, whose meshes are ignored.
/// @param pairs  each bone of the model at most once.
/// @return the first fault of a character; invalid_argument for a place that is not invertible, or
///         a bone mapped twice; size_mismatch of the pose; not_found for a name, with the nearest
///         ones, and for a bone with weight without a mapped ancestor; limit_exceeded, out of
///         memory. O(vertices), allocates. Reentrant.
[[nodiscard]] SUNDER_API Result<MappedBinding> bind_by_mapping(const Character& model,
                                                               const Character& rig,
                                                               std::span<const BonePair> pairs,
                                                               const MappingOptions& options = {});

struct HeatOptions {
  BindingPlace place;
  /// Names of the rig's bones that may get weight. Empty: those with weight in the rig's own
  /// meshes; all if there are none.
  std::vector<std::string> bones;
  /// How fast a bone heats the surface, relative to the heat's flow along it; > 0. More makes
  /// narrower transitions. 1 is the choice of the paper.
  double heat = 1.0;
  std::uint32_t maximum_influences = 4;  ///< Per vertex; 0: all.
};

struct HeatBinding : Binding {
  std::uint32_t points = 0;         ///< Solved once each: vertices at one place are one point.
  std::uint32_t heated_points = 0;  ///< Points that see their nearest bone.
  std::uint32_t components = 0;     ///< Connected parts of the surface.
  /// Parts no point of which sees its nearest bone: each point is heated by it all the same.
  std::uint32_t components_without_sight = 0;
  std::uint32_t lone_points = 0;  ///< Without a triangle: they follow their nearest bone.
  std::uint32_t edges = 0;
  std::uint32_t clamped_edges = 0;    ///< With a negative, tiny or huge cotangent weight.
  double largest_dropped_weight = 0;  ///< Of a point, by the limit of influences.
  std::vector<std::string> bones_without_weight;  ///< Of those that might have got some.
};

/// Attaches a model, skinned or not, to a skeleton by automatic weights: each bone heats the
/// surface that is nearest to it and sees it, and heat flows along the surface until it is at rest.
/// The weights of a bone are its share in the heat. Vertices at one place and of one tear side get
/// the same weights, bit for bit.
///
/// Results do not depend on unit, place, or the order of vertices and triangles.
/// Source: Baran, Popovic, Automatic rigging and animation of 3D characters, SIGGRAPH 2007
/// [baran2007automatic]; docs/binding.md.
/// @param model  satisfies validate_character(); so does the rig, which may have no mesh.
/// @return as bind_by_mapping(); invalid_argument for an option; empty_input without a bone that
///         may get weight. O(points x bones) and the factorisation of a sparse matrix of the
///         points; allocates. Reentrant.
[[nodiscard]] SUNDER_API Result<HeatBinding> bind_by_heat(const Character& model,
                                                          const Character& rig,
                                                          const HeatOptions& options = {});

/// The rotation, translation and uniform scale that bring the joints of the model, in its bind
/// pose, nearest to those of the rig with which they are paired, by least squares. The pairs are
/// those of bind_by_mapping(). Source: Umeyama 1991 [umeyama1991least].
/// @param place  the rig's pose; the rest is ignored.
/// @return as bind_by_mapping(); invalid_argument if the joints do not fix a place: fewer than
///         three, or all on a line.
[[nodiscard]] SUNDER_API Result<Affine3d> fit_place(const Character& model, const Character& rig,
                                                    std::span<const BonePair> pairs,
                                                    const BindingPlace& place = {});

}  // namespace sunder
