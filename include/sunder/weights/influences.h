#pragma once

#include <sunder/core/api.h>
#include <sunder/core/math.h>
#include <sunder/core/skin.h>

#include <cstddef>
#include <cstdint>
#include <span>

namespace sunder {

/// Puts the largest influences of a vertex first; of equal ones, that of the lower slot. The result
/// does not depend on the order before, so duplicates of a surface point keep the same bones.
/// @return false for what are no weights: none at all, negative ones, ones that are not finite, or
/// only zeros. Nothing moves then. O(n log n), no allocation.
[[nodiscard]] SUNDER_API bool sort_influences(std::span<Influence> influences);

/// Keeps the `maximum` largest influences of a vertex: they come first, largest first, divided by
/// their sum in double, so that they sum to one within 2e-7 x their number. The dropped ones follow
/// as they were, largest first. Where no more than `maximum` are there, they are sorted and their
/// weights keep their bits; a maximum of 0 keeps all of them in their order.
///
/// @return how many are kept; 0 for what are no weights, see sort_influences(): nothing is written
/// then. O(n log n), no allocation.
[[nodiscard]] SUNDER_API std::size_t prune_influences(std::span<Influence> influences,
                                                      std::size_t maximum);

/// The share of the weights that goes where the first `kept` influences stay: sum of the others
/// over the sum of all, in double. Influences as they are before pruning, sorted. 0 where nothing
/// is dropped or nothing has weight.
[[nodiscard]] SUNDER_API double dropped_mass(std::span<const Influence> influences,
                                             std::size_t kept);

/// How far pruning to the first `kept` influences moves a posed vertex, pruned - unpruned, in
/// metres:
///   dropped_mass (mean of kept - mean of dropped),   means of M_i p, weighted with w_i.
/// This is exact where the weights, pruned and unpruned, are divided by their sum in double. Stored
/// floats sum to one only within 2e-7 x their number; what is left or lacking scales a posed vertex
/// about the origin, pruned or not, and is not counted here.
///
/// @param bind_position    p: in bind space, morph targets added.
/// @param influences       as they are before pruning, sorted; slots of `model_from_bind`,
/// unchecked.
/// @param model_from_bind  M: one a slot of the mesh's skin.
/// @return zero where nothing is dropped, or nothing that has weight is kept. O(n), no allocation.
[[nodiscard]] SUNDER_API Vec3d pruning_displacement(const Vec3d& bind_position,
                                                    std::span<const Influence> influences,
                                                    std::size_t kept,
                                                    std::span<const Affine3d> model_from_bind);

/// A vertex' weights as integers that sum to exactly 255 or 65535, by the largest remainder: each
/// is rounded down, and the units that are left go to the largest remainders; of equal ones, to the
/// larger weight, then to the first. So each is less than one unit from its weight over the sum of
/// all, and a larger weight never gets fewer units than a smaller one. Weights below a unit may
/// become 0; where there are more influences than units, some do.
///
/// @param quantised  one an influence, written.
/// @return false, with nothing written, for spans of different lengths and for what are no weights:
/// none at all, negative ones,
///         ones that are not finite, or only zeros.
/// O(n^2) at worst, n being a few; no allocation. The weights need not sum to one.
[[nodiscard]] SUNDER_API bool quantise_weights(std::span<const Influence> influences,
                                               std::span<std::uint8_t> quantised);
[[nodiscard]] SUNDER_API bool quantise_weights(std::span<const Influence> influences,
                                               std::span<std::uint16_t> quantised);

}  // namespace sunder
