#include <sunder/tear/torn_model.h>

#include <bit>

namespace sunder {
namespace {

/// FNV-1a (Fowler, Noll, Vo) over 32-bit words instead of bytes, so that the result does not depend
/// on byte order.
class Digest {
 public:
  void add(std::uint32_t word) { value_ = (value_ ^ word) * 0x100000001B3u; }
  void add(float value) { add(std::bit_cast<std::uint32_t>(value)); }
  void add(double value) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    add(static_cast<std::uint32_t>(bits));
    add(static_cast<std::uint32_t>(bits >> 32));
  }
  template <int N>
  void add(const Eigen::Matrix<float, N, 1, Eigen::DontAlign>& vector) {
    for (int i = 0; i < N; ++i) add(vector[i]);
  }
  void add(const Triangle& triangle) {
    for (const std::uint32_t vertex : triangle) add(vertex);
  }
  void add(const Influence& influence) {
    add(influence.slot);
    add(influence.weight);
  }
  template <class T>
  void add(const std::vector<T>& values) {
    add(static_cast<std::uint32_t>(values.size()));
    for (const T& value : values) add(value);
  }
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xCBF29CE484222325u;
};

}  // namespace

std::uint64_t TornModel::digest() const {
  Digest digest;
  for (std::uint32_t m = 0; m < character().meshes.size(); ++m) {
    const Mesh& mesh = character().meshes[m];
    digest.add(mesh.positions);
    digest.add(mesh.normals);
    digest.add(mesh.tangents);
    digest.add(mesh.uv_sets);
    digest.add(mesh.color_sets);
    for (const CustomAttribute& attribute : mesh.custom_attributes) digest.add(attribute.values);
    digest.add(mesh.weights.first);
    digest.add(mesh.weights.influences);
    for (const MorphTarget& target : mesh.morph_targets) {
      digest.add(target.position_deltas);
      digest.add(target.normal_deltas);
      digest.add(target.tangent_deltas);
    }
    digest.add(mesh.triangles);
    digest.add(mesh.triangle_submesh);
    for (std::uint32_t vertex = source().meshes[m].vertex_count(); vertex < mesh.vertex_count();
         ++vertex) {
      const Birth born = birth(m, vertex);
      digest.add(born.triangle);
      for (const double coordinate : born.barycentric) digest.add(coordinate);
      // The mesh arrays of exact vertices equal those of interpolated ones.
      if (weight_policy(m, vertex) == WeightPolicy::exact) digest.add(vertex);
    }
  }
  return digest.value();
}

}  // namespace sunder
