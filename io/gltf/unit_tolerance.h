#pragma once

namespace sunder::gltf {

/// How far from 1 the length of a normal or tangent may be: what the Khronos validator accepts. In
/// the bytes of KHR_mesh_quantization nearly all unit vectors are nearer to unit length; the worst
/// are off by 0.0068.
inline constexpr double kUnitTolerance = 0.00674;

}  // namespace sunder::gltf
