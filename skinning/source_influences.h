#pragma once

#include <sunder/skinning/vertex_arrays.h>

namespace sunder::skinning {

/// The numbers of an attribute of a vertex.
template <class Float>
Float* at(const StridedFloats<Float>& array, std::uint32_t vertex, std::size_t components) {
  const std::size_t stride = array.stride != 0 ? array.stride : components * sizeof(float);
  using Byte = std::conditional_t<std::is_const_v<Float>, const unsigned char, unsigned char>;
  return reinterpret_cast<Float*>(reinterpret_cast<Byte*>(array.data) + stride * vertex);
}

/// Calls visit(slot, weight) for each influence of a vertex with a non-zero weight, in the order of
/// the source.
template <class Visit>
void for_each_influence(const VertexSource& source, std::uint32_t vertex, Visit visit) {
  if (source.weights != nullptr) {
    for (const Influence& influence : source.weights->of(vertex))
      visit(influence.slot, influence.weight);
    return;
  }
  const InfluenceArrays& arrays = source.influences;
  const auto row = [vertex](const auto* data, std::size_t stride, std::size_t packed) {
    return reinterpret_cast<decltype(data)>(reinterpret_cast<const unsigned char*>(data) +
                                            (stride != 0 ? stride : packed) * vertex);
  };
  const std::uint16_t* slots =
      row(arrays.slots, arrays.slot_stride, arrays.per_vertex * sizeof(std::uint16_t));
  for (std::size_t k = 0; k < arrays.per_vertex; ++k) {
    const float weight =
        arrays.weights != nullptr
            ? row(arrays.weights, arrays.weight_stride, arrays.per_vertex * sizeof(float))[k]
            : static_cast<float>(
                  row(arrays.weights16, arrays.weight_stride, arrays.per_vertex * 2)[k]) /
                  65535.0f;
    if (weight != 0.0f) visit(static_cast<std::uint32_t>(slots[k]), weight);
  }
}

}  // namespace sunder::skinning
