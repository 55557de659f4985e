#pragma once

#include <sunder/core/api.h>
#include <sunder/core/math.h>
#include <sunder/core/skin.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace sunder {

/// Sorts the influences of a vertex by descending weight; equal weights are ordered by ascending
/// slot. The result does not depend on the order of the input, so all duplicates of a surface point
/// keep the same bones.
/// @return false if the weights are invalid: none, a negative or non-finite one, or only zeros. The
/// influences are unchanged then. O(n log n), no allocation. Reentrant.
[[nodiscard]] SUNDER_API bool sort_influences(std::span<Influence> influences);

/// Keeps the `maximum` largest influences of a vertex. They come first, by descending weight, and
/// are divided by their sum in double, so that they sum to one within 2e-7 x their number. The
/// dropped influences follow unchanged, by descending weight. If there are at most `maximum`
/// influences, they are sorted and their weights keep their bits. A maximum of 0 keeps all
/// influences in their order.
/// @return the number of influences kept; 0 for invalid weights, see sort_influences(): nothing is
/// written then. O(n log n), no allocation. Reentrant.
[[nodiscard]] SUNDER_API std::size_t prune_influences(std::span<Influence> influences,
                                                      std::size_t maximum);

/// The share of the total weight that pruning to the first `kept` influences drops: the sum of the
/// dropped weights over the sum of all, in double.
/// @param influences  as before pruning, sorted.
/// @return 0 if nothing is dropped or all weights are zero. O(n), no allocation. Reentrant.
[[nodiscard]] SUNDER_API double dropped_mass(std::span<const Influence> influences,
                                             std::size_t kept);

/// How far pruning to the first `kept` influences moves a posed vertex: pruned - unpruned, in
/// metres,
///   dropped_mass (mean of kept M_i p - mean of dropped M_i p), each mean weighted by w_i.
/// This is exact if both sets of weights are divided by their sum in double. The rounding of stored
/// weights is not included; see docs/weights.md.
/// @param bind_position    p, in bind space, with morph displacements.
/// @param influences       as before pruning, sorted; their slots are unchecked.
/// @param model_from_bind  M, one matrix per slot of the mesh's skin.
/// @return zero if nothing is dropped, or no kept influence has weight. O(n), no allocation.
/// Reentrant.
[[nodiscard]] SUNDER_API Vec3d pruning_displacement(const Vec3d& bind_position,
                                                    std::span<const Influence> influences,
                                                    std::size_t kept,
                                                    std::span<const Affine3d> model_from_bind);

/// Converts the weights of a vertex to integers that sum to exactly 255 or 65535, by the largest
/// remainder: each weight is rounded down, and the remaining units go to the largest remainders,
/// then to the larger weight, then to the first influence. Each result is less than one unit from
/// the normalised weight, and a larger weight never gets fewer units than a smaller one. Small
/// weights may become 0.
/// @param influences  need not sum to one.
/// @param quantised   one integer per influence, written.
/// @return false for spans of different lengths and for invalid weights, see sort_influences();
/// nothing is written then. O(n^2) at worst, no allocation. Reentrant.
[[nodiscard]] SUNDER_API bool quantise_weights(std::span<const Influence> influences,
                                               std::span<std::uint8_t> quantised);
[[nodiscard]] SUNDER_API bool quantise_weights(std::span<const Influence> influences,
                                               std::span<std::uint16_t> quantised);

/// How a file stores the weights of influences. Integers are normalised as in glTF; those of a
/// vertex sum to exactly 65535 or 255 over all its WEIGHTS_n, each less than one unit from its
/// weight.
enum class WeightFormat : std::uint8_t { float32, unorm16, unorm8 };

/// The influences of a mesh exactly as its file stores them, before anything was repaired: any
/// weight, any slot, with the unused entries of weight zero.
struct StoredInfluences {
  WeightFormat format = WeightFormat::float32;
  std::uint32_t per_vertex = 0;      ///< Entries per vertex; 0: the file stores none for this mesh.
  std::vector<std::uint32_t> slots;  ///< V x per_vertex, in Skin::bones.
  std::vector<float> weights;        ///< V x per_vertex; integers divided by 65535 or 255.
  std::string place;                 ///< JSON pointer of the mesh's first primitive in the file.
};

}  // namespace sunder
