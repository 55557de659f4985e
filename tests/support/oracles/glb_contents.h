#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace sunder::test {

/// The content of a GLB, read by nothing but the rules of its format, number by number.
class GlbContents {
 public:
  explicit GlbContents(const std::vector<std::byte>& glb);

  nlohmann::ordered_json json;
  std::vector<std::byte> binary;  ///< The BIN chunk; empty without one.

  /// All numbers of an accessor, without normalisation.
  [[nodiscard]] std::vector<double> numbers(std::size_t accessor) const;
  [[nodiscard]] std::vector<std::byte> bytes_of_view(std::size_t view) const;

  /// Accessors and buffer views to which core glTF or EXT_mesh_gpu_instancing refers.
  [[nodiscard]] std::set<std::size_t> referenced_accessors() const;
  [[nodiscard]] std::set<std::size_t> referenced_views() const;
  /// One flag per byte of the BIN chunk: an element of a referenced accessor, or the whole stride
  /// of one, or an image lies there.
  [[nodiscard]] std::vector<bool> referenced_bytes() const;
  /// Bytes of the longest run that nothing refers to.
  /// @param views  further views, all bytes of which count.
  [[nodiscard]] std::size_t longest_unreferenced_run(const std::set<std::size_t>& views = {}) const;
  /// Bytes of an element without a stride.
  [[nodiscard]] std::size_t element_bytes(std::size_t accessor) const;

 private:
  struct Layout {
    std::size_t view = 0, first = 0, stride = 0, element = 0, count = 0;
    bool has_stride = false;
  };
  [[nodiscard]] Layout layout(const nlohmann::ordered_json& at, std::size_t element,
                              std::size_t count) const;
  [[nodiscard]] double component(std::size_t place, int type) const;
};

}  // namespace sunder::test
