#pragma once

#include <sunder/skinning/skinned_mesh.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <vector>

namespace samples {

/// A long strip on a chain of bones.
inline sunder::Mesh make_strip(std::uint32_t along, std::uint32_t across, std::uint32_t bones) {
  sunder::Mesh mesh;
  for (std::uint32_t i = 0; i < along; ++i)
    for (std::uint32_t j = 0; j < across; ++j) {
      const float at =
          static_cast<float>(i) * static_cast<float>(bones - 1) / static_cast<float>(along);
      const auto bone = static_cast<std::uint32_t>(at);
      mesh.positions.emplace_back(0.1f * at, 0.0f, 0.001f * static_cast<float>(j));
      mesh.normals.emplace_back(0.0f, 1.0f, 0.0f);
      const float later = at - static_cast<float>(bone);
      const sunder::Influence both[] = {{bone, 1.0f - later}, {bone + 1, later}};
      mesh.weights.append({both, later > 0.0f ? 2u : 1u});
    }
  return mesh;
}

/// Turns each bone a little about the end of its parent.
inline std::vector<sunder::Affine3f> wave(std::uint32_t bones, float time) {
  std::vector<sunder::Affine3f> matrices;
  sunder::Affine3f model_from_bone = sunder::Affine3f::Identity();
  for (std::uint32_t i = 0; i < bones; ++i) {
    const float angle = 0.05f * std::sin(time + 0.5f * static_cast<float>(i));
    model_from_bone = model_from_bone * Eigen::AngleAxisf(angle, Eigen::Vector3f::UnitZ());
    matrices.push_back(model_from_bone * Eigen::Translation3f(-0.1f * static_cast<float>(i), 0, 0));
    model_from_bone = model_from_bone * Eigen::Translation3f(0.1f, 0, 0);
  }
  return matrices;
}

/// Poses the waving strip for some frames, on this thread and through a hook, and compares the
/// bits.
/// @return the program's exit code.
inline int wave_by(const char* name, const sunder::ParallelFor& parallel_for) {
  constexpr std::uint32_t kBones = 64;
  const sunder::Mesh mesh = make_strip(4000, 50, kBones);
  const auto skinned = sunder::SkinnedMesh::create(sunder::source_of(mesh), kBones);
  if (!skinned) return std::printf("%s\n", skinned.error().text().data()), 1;

  const std::uint32_t count = mesh.vertex_count();
  std::vector<sunder::Vec3f> alone(2 * count), together(2 * count);  // positions, then normals
  const auto target = [&](std::vector<sunder::Vec3f>& to) {
    return sunder::VertexTarget{count, {to[0].data()}, {to[count].data()}, {}};
  };
  sunder::PosedBuffer of_one(target(alone)), of_all(target(together));
  sunder::BonePalette palette = *sunder::BonePalette::create(kBones, 0);
  std::vector<sunder::Affine3f> pose = wave(kBones, 0);
  for (int frame = 0; frame < 60; ++frame) {
    if (frame % 3 == 0) pose = wave(kBones, 0.1f * static_cast<float>(frame));
    if (frame % 3 == 1)
      pose[kBones / 2].translation().z() +=
          0.01f;  // one bone moves; in every third frame none does
    if (!palette.set(pose, {})) return 1;
    if (!skinned->deform(palette, of_one) || !skinned->deform(palette, of_all, parallel_for))
      return 1;
    std::uint32_t written = 0;
    for (const sunder::IndexRange& range : of_all.dirty_vertices()) written += range.count;
    if (frame < 3)
      std::printf("frame %d: %6u of %u vertices written, in %zu ranges\n", frame, written, count,
                  of_all.dirty_vertices().size());
  }
  const bool same =
      std::memcmp(alone.data(), together.data(), alone.size() * sizeof(alone[0])) == 0;
  std::printf("%s, %u threads: %s\n", name, parallel_for.threads,
              same ? "the same bits as on one" : "OTHER bits than on one");
  return same ? 0 : 1;
}

}  // namespace samples
