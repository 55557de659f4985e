#pragma once

#include <sunder/skinning/skinned_mesh.h>

#include <cstring>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace sunder::test {

/// Arrays for posed vertices between guard margins, filled with numbers that no pose produces.
class PosedArrays {
 public:
  /// @param padding  floats between vertices.
  PosedArrays(const Mesh& mesh, std::size_t padding = 0, bool unit_length = false)
      : count_(mesh.vertex_count()),
        padding_(padding),
        has_normals_(!mesh.normals.empty()),
        has_tangents_(!mesh.tangents.empty()) {
    positions_.assign(count_ * (3 + padding) + 2 * kMargin, kUntouched);
    normals_.assign(count_ * (3 + padding) + 2 * kMargin, kUntouched);
    tangents_.assign(count_ * (4 + padding) + 2 * kMargin, kUntouched);
    target_.vertex_count = count_;
    target_.positions = {positions_.data() + kMargin, 4 * (3 + padding)};
    if (has_normals_) target_.normals = {normals_.data() + kMargin, 4 * (3 + padding)};
    if (has_tangents_) target_.tangents = {tangents_.data() + kMargin, 4 * (4 + padding)};
    target_.unit_length = unit_length;
  }
  PosedArrays(const PosedArrays&) = delete;
  PosedArrays& operator=(const PosedArrays&) = delete;

  [[nodiscard]] const VertexTarget& target() const { return target_; }
  [[nodiscard]] Vec3f position(std::uint32_t v) const { return at(positions_, v, 3); }
  [[nodiscard]] Vec3f normal(std::uint32_t v) const { return at(normals_, v, 3); }
  [[nodiscard]] Vec4f tangent(std::uint32_t v) const {
    const float* t = tangents_.data() + kMargin + v * (4 + padding_);
    return {t[0], t[1], t[2], t[3]};
  }

  /// Whether vertex `v` has the same bits as vertex `w` of other arrays.
  [[nodiscard]] bool is_same(std::uint32_t v, const PosedArrays& others, std::uint32_t w) const {
    const auto same = [](const auto& a, const auto& b) {
      return std::memcmp(a.data(), b.data(), sizeof(a)) == 0;
    };
    return same(position(v), others.position(w)) &&
           (!has_normals_ || same(normal(v), others.normal(w))) &&
           (!has_tangents_ || same(tangent(v), others.tangent(w)));
  }

  /// The first vertex that differs, or kNone.
  [[nodiscard]] std::uint32_t first_difference(const PosedArrays& others) const {
    for (std::uint32_t v = 0; v < count_; ++v)
      if (!is_same(v, others, v)) return v;
    return kNone;
  }

  /// Whether nothing was written outside the vertices.
  [[nodiscard]] bool margins_are_untouched() const {
    return untouched_beside(positions_, 3) && untouched_beside(normals_, 3) &&
           untouched_beside(tangents_, 4);
  }
  [[nodiscard]] bool is_untouched(std::uint32_t v) const { return position(v).x() == kUntouched; }
  void erase() {
    for (auto* array : {&positions_, &normals_, &tangents_})
      std::fill(array->begin(), array->end(), kUntouched);
  }

 private:
  static constexpr float kUntouched = -12345.5f;
  static constexpr std::size_t kMargin = 64;

  [[nodiscard]] Vec3f at(const std::vector<float>& array, std::uint32_t v,
                         std::size_t components) const {
    const float* p = array.data() + kMargin + v * (components + padding_);
    return {p[0], p[1], p[2]};
  }
  [[nodiscard]] bool untouched_beside(const std::vector<float>& array,
                                      std::size_t components) const {
    for (std::size_t i = 0; i < array.size(); ++i) {
      const bool is_margin = i < kMargin || i >= array.size() - kMargin;
      if ((is_margin || (i - kMargin) % (components + padding_) >= components) &&
          array[i] != kUntouched)
        return false;
    }
    return true;
  }

  std::uint32_t count_;
  std::size_t padding_;
  bool has_normals_, has_tangents_;
  std::vector<float> positions_, normals_, tangents_;
  VertexTarget target_;
};

}  // namespace sunder::test
