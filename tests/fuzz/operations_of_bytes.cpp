#include "fuzz/operations_of_bytes.h"

#include <sunder/skinning/pose.h>

#include <cmath>
#include <cstdlib>
#include <utility>

#include "support/models/rigs.h"

namespace sunder::fuzz {
namespace {

constexpr double kGrid = 1.0 / 16;

/// Yields zeros after the last byte.
class Bytes {
 public:
  explicit Bytes(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  [[nodiscard]] bool is_at_end() const { return bytes_.empty(); }
  std::uint8_t next() {
    if (bytes_.empty()) return 0;
    const std::uint8_t byte = bytes_.front();
    bytes_ = bytes_.subspan(1);
    return byte;
  }
  double on_grid() { return kGrid * static_cast<std::int8_t>(next()); }
  Vec3d place() {
    const double x = on_grid(), y = on_grid(), z = on_grid();
    return {x, y, z};
  }
  /// On the grid or 1e-1 to 1e-17 off it.
  Vec3d place_off_grid() {
    const Vec3d at = place();
    const std::uint8_t byte = next();
    return byte < 0x80 ? at : Vec3d(at + std::pow(10.0, -1 - byte % 17) * Vec3d(1, -2, 3));
  }
  /// 0 for half of the bytes, otherwise a length on the grid.
  double length() {
    const std::uint8_t byte = next();
    return byte % 2 == 0 ? 0.0 : kGrid * (byte / 2);
  }

 private:
  std::span<const std::uint8_t> bytes_;
};

/// The three bones of a tube, which lie along y, and a mesh of loose triangles.
Character character_of(Bytes& bytes) {
  Character character = test::make_tube(2, 3, 3);
  Mesh mesh;
  mesh.submeshes = {{"one", kNone}, {"other", kNone}};
  const std::uint32_t bones = 1 + bytes.next() % 3, vertices = 3 + bytes.next() % 14,
                      triangles = 1 + bytes.next() % 24;
  for (std::uint32_t v = 0; v < vertices; ++v) {
    mesh.positions.push_back(bytes.place().cast<float>());
    const std::uint8_t byte = bytes.next();
    const std::uint32_t first = byte % bones, second = (byte / 3) % bones;
    const float weight = 0.125f * static_cast<float>(byte / 16 % 8);
    if (first == second || weight == 0.0f)
      mesh.weights.append(std::vector<Influence>{{first, 1.0f}});
    else
      mesh.weights.append(std::vector<Influence>{{std::min(first, second), 1.0f - weight},
                                                 {std::max(first, second), weight}});
  }
  for (std::uint32_t t = 0; t < triangles; ++t) {
    const std::uint32_t a = bytes.next() % vertices, b = bytes.next() % vertices,
                        c = bytes.next() % vertices;
    mesh.triangles.push_back({a, b, c});
    mesh.triangle_submesh.push_back(t % 2);
  }
  character.meshes = {std::move(mesh)};
  return character;
}

/// One byte per bone: at bind, turned by a quarter about an axis, moved, mirrored, flat, nothing,
/// sheared or made larger.
ModelPose pose_of(const Character& character, Bytes& bytes) {
  auto pose = bind_pose(character);
  if (!pose) std::abort();
  for (Affine3d& bone : pose->model_from_bone) {
    const std::uint8_t byte = bytes.next();
    const int axis = byte / 8 % 3, other = (axis + 1 + byte / 24 % 2) % 3;
    Mat3d change = Mat3d::Identity();
    switch (byte % 8) {
      case 1:
        change.col(axis) = Vec3d::Unit(other);
        change.col(other) = -Vec3d::Unit(axis);
        break;
      case 2: bone.translation()[axis] += kGrid * (byte / 24); break;
      case 3: change(axis, axis) = -1; break;
      case 4: change(axis, axis) = 0; break;
      case 5:
        if (byte < 0x80) change.setZero();
        break;
      case 6: change(axis, other) = kGrid * (byte / 24); break;
      case 7: change *= 1 + kGrid * (byte / 24); break;
      default: break;
    }
    bone.linear() = (bone.linear() * change).eval();
  }
  return std::move(*pose);
}

TearOperation tear_of(ModelPose pose, Bytes& bytes) {
  TearOperation tear;
  tear.pose = std::move(pose);
  const std::uint8_t kind = bytes.next();
  for (int blades = 2 + kind % 5; blades > 0; --blades) {
    const Vec3d base = bytes.place_off_grid(), tip = bytes.place();
    tear.stroke.push_back({base, tip});
  }
  if (kind & 0x20) tear.options.layers = Layers::all;
  if (kind & 0x40) tear.options.width = bytes.length();
  if (kind & 0x80) tear.options.wall_depth = bytes.length();
  return tear;
}

CutOperation cut_of(ModelPose pose, Bytes& bytes) {
  CutOperation operation;
  operation.pose = std::move(pose);
  PlaneCut& cut = operation.cut;
  const std::uint8_t kind = bytes.next();
  cut.point = bytes.place_off_grid();
  cut.normal = bytes.place_off_grid();
  cut.caps = kind % 2 == 1;
  if (kind & 0x40)
    for (int corners = 3; corners > 0; --corners) cut.bounds.push_back(bytes.place());
  return operation;
}

DrillOperation drill_of(ModelPose pose, Bytes& bytes) {
  DrillOperation operation;
  operation.pose = std::move(pose);
  Bore& bore = operation.bore;
  bore.wall = bytes.next() % 2 == 1;
  bore.origin = bytes.place_off_grid();
  bore.direction = bytes.place();
  bore.radius = kGrid * (1 + bytes.next() % 32);
  bore.depth = kGrid * (1 + bytes.next());
  bore.chord_tolerance = 0.1 * bore.radius;  // Few corners, so that a trial is quick.
  return operation;
}

}  // namespace

Trial trial_of(std::span<const std::uint8_t> input) {
  Bytes bytes(input);
  Trial trial;
  trial.character = character_of(bytes);
  while (!bytes.is_at_end() && trial.operations.size() < 4) {
    const std::uint8_t kind = bytes.next();
    ModelPose pose = pose_of(trial.character, bytes);
    switch (kind % 4) {
      case 0: trial.operations.emplace_back(cut_of(std::move(pose), bytes)); break;
      case 1: trial.operations.emplace_back(drill_of(std::move(pose), bytes)); break;
      default: trial.operations.emplace_back(tear_of(std::move(pose), bytes)); break;
    }
  }
  return trial;
}

}  // namespace sunder::fuzz
