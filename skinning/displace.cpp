#include "skinning/displace.h"

namespace sunder::skinning {

Status check_displacements(const VertexDisplacements& displacements, std::uint32_t vertex_count) {
  if (displacements.moved.empty()) return {};
  if (displacements.vertex_rows.size() != vertex_count)
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "vertex_rows has %zu entries; the mesh has %u vertices",
                           displacements.vertex_rows.size(), vertex_count);
  if (!displacements.gradients.empty() &&
      displacements.gradients.size() != displacements.influences.size())
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "gradients has %zu entries, influences has %zu",
                           displacements.gradients.size(), displacements.influences.size());
  if (!displacements.gradients.empty() &&
      displacements.model_from_gradient.size() != displacements.displacements.size())
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "displacements has %zu entries, model_from_gradient has %zu",
                           displacements.displacements.size(),
                           displacements.model_from_gradient.size());
  std::uint64_t end = 0;
  for (std::size_t i = 0; i < displacements.moved.size(); ++i) {
    const IndexRange& range = displacements.moved[i];
    const std::uint64_t next = std::uint64_t{range.first} + range.count;
    if (range.first < end || next > vertex_count)
      return Status::failure(StatusCode::index_out_of_range, static_cast<std::uint32_t>(i),
                             "moved vertices [%u, %llu): ranges must ascend (the previous one ends "
                             "at %llu), and the mesh has %u vertices",
                             range.first, static_cast<unsigned long long>(next),
                             static_cast<unsigned long long>(end), vertex_count);
    end = next;
  }
  return {};
}

}  // namespace sunder::skinning
