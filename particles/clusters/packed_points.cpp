#include "particles/clusters/packed_points.h"

#include <utility>

#include "particles/clusters/gradients.h"

namespace sunder::particles {
namespace {

/// An array without memory: clear() would keep it.
template <class T>
void release(std::vector<T>& values) {
  std::vector<T>().swap(values);
}

}  // namespace

PackedPoints::PackedPoints(Structure& structure, const Structure& shared)
    : point_count_(structure.points.count()),
      factors_(structure.authored.of_points, shared.authored.of_points),
      gradients_(structure.gradients->known(), shared.gradients->known()) {
  PointColumns::for_each_column(
      [](auto& packed, const auto& column, const auto& of_shared) {
        packed = {column, of_shared};
      },
      columns_, structure.points, shared.points);
  for (std::size_t m = 0; m < structure.vertex_points.of_mesh.size(); ++m)
    vertex_points_.emplace_back(structure.vertex_points.of_mesh[m],
                                shared.vertex_points.of_mesh[m]);
  // Nothing fails from here on.
  PointColumns::for_each_column([](auto& column) { release(column); }, structure.points);
  release(structure.authored.of_points);
  for (std::vector<Index>& of_mesh : structure.vertex_points.of_mesh) release(of_mesh);
  structure.gradients->release_rows();
  structure.scratch = {};
}

void PackedPoints::unpack(Structure& structure, const Structure& shared) const {
  PointColumns::for_each_column([](const auto& packed, auto& column,
                                   const auto& of_shared) { packed.unpack(of_shared, column); },
                                columns_, structure.points, shared.points);
  factors_.unpack(shared.authored.of_points, structure.authored.of_points);
  for (std::size_t m = 0; m < vertex_points_.size(); ++m)
    vertex_points_[m].unpack(shared.vertex_points.of_mesh[m], structure.vertex_points.of_mesh[m]);
  const std::vector<Change>& done = structure.tears.done;
  structure.gradients->restore_rows(
      [&](std::vector<ParticleGradients>& rows) {
        gradients_.unpack(shared.gradients->known(), rows);
      },
      done.empty() ? nullptr : &done.back());
  structure.make_room(structure.points.count() + 1);
  resume_log(structure);
}

std::size_t PackedPoints::memory_bytes() const {
  std::size_t bytes = sizeof(*this) + factors_.memory_bytes() + gradients_.memory_bytes() +
                      vertex_points_.capacity() * sizeof(vertex_points_[0]);
  PointColumns::for_each_column([&](const auto& packed) { bytes += packed.memory_bytes(); },
                                columns_);
  for (const PackedColumn<Index>& of_mesh : vertex_points_) bytes += of_mesh.memory_bytes();
  return bytes;
}

}  // namespace sunder::particles
