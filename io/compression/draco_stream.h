#pragma once

#include <sunder/core/mesh.h>
#include <sunder/core/status.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace draco {
class Mesh;
}

namespace sunder::compression {

/// The largest sizes that a Draco stream may claim. Its decoder allocates from these numbers before
/// it reads the data that they describe.
struct DracoLimits {
  std::uint64_t triangles = 0;
  std::uint64_t points = 0;
  std::uint64_t bytes = 0;  ///< Of the decoded triangles and attributes together.
};

/// A decoded Draco mesh: triangles over points, and attributes by their unique ids.
class DracoMesh {
 public:
  /// @return malformed_file; limit_exceeded; unsupported_feature for point clouds and for versions
  ///         of the bitstream other than 2.2, which glTF requires.
  [[nodiscard]] static Result<DracoMesh> decode(std::span<const std::byte> stream,
                                                const DracoLimits& limits);

  DracoMesh(DracoMesh&&) noexcept;
  DracoMesh& operator=(DracoMesh&&) noexcept;
  ~DracoMesh();

  [[nodiscard]] std::uint32_t point_count() const;
  /// All vertices are below point_count().
  [[nodiscard]] std::vector<Triangle> triangles() const;
  /// Numbers per point of an attribute; 0 if there is none with this unique id.
  [[nodiscard]] std::uint32_t components(std::uint32_t unique_id) const;

  /// The values of an attribute as T (integers of 8, 16 and 32 bits, float), converted if they are
  /// stored as another type.
  /// @param out  point_count() x components().
  /// @return false if a value does not fit T.
  template <class T>
  [[nodiscard]] bool read(std::uint32_t unique_id, std::span<T> out) const;

 private:
  explicit DracoMesh(std::unique_ptr<draco::Mesh> mesh);

  std::unique_ptr<draco::Mesh> mesh_;
};

}  // namespace sunder::compression
