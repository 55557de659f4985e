#pragma once

#include <sunder/core/character.h>
#include <sunder/skinning/skinned_mesh.h>

#include <array>
#include <memory>
#include <vector>

namespace sunder::bench {

/// An array of floats that begins at a cache line.
class LineFloats {
 public:
  explicit LineFloats(std::size_t count);
  [[nodiscard]] float* data() const { return data_.get(); }

 private:
  struct Free {
    void operator()(float* data) const { ::operator delete(data, std::align_val_t(64)); }
  };
  std::unique_ptr<float, Free> data_;
};

/// The subdivided bunny on 64 bones, up to four influences per vertex, and poses in which every
/// bone moved.
struct SkinningScene {
  ///
  /// @param ordered  whether its vertices are in order_for_skinning(); otherwise in the file's
  ///         order.
  SkinningScene(int divisions, bool ordered);

  [[nodiscard]] const Mesh& mesh() const { return character.meshes[0]; }
  [[nodiscard]] std::uint32_t vertex_count() const { return mesh().vertex_count(); }
  /// Two poses, so that each frame differs from the previous one in all bones.
  static constexpr std::size_t kPoses = 2;

  Character character;
  std::array<ModelPose, kPoses> poses;
  std::array<std::vector<Affine3f>, kPoses> matrices;
};

/// One character of a crowd, with arrays of its own for our code, for Eigen and for the memory
/// baseline.
struct CrowdMember {
  CrowdMember(const SkinningScene& scene, SkinningMethod method = SkinningMethod::linear);

  void pose_by_eigen(const SkinningScene& scene, std::size_t pose);
  /// Everything changes: the pose belongs to another palette.
  void pose_by_ours(std::size_t pose, PosedBuffer& buffer, const ParallelFor& parallel_for = {});

  std::uint32_t vertices;
  SkinnedMesh mesh;
  std::vector<BonePalette> palettes;  ///< One per pose of the scene.
  LineFloats in, positions, normals, tangents, interleaved, bind_positions, bind_normals;
  std::vector<std::uint16_t> slots;
  std::vector<float> weights;
  PosedBuffer buffer;  ///< Positions and normals, packed.
};

/// Maximum error against double, for a character of 2 m: in metres, and of unit normals.
struct SkinningError {
  double position = 0, normal = 0;
};
[[nodiscard]] SkinningError error_of(const SkinningScene& scene, std::size_t pose,
                                     const float* positions, const float* normals);

}  // namespace sunder::bench
