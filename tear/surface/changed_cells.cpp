#include "tear/surface/changed_cells.h"

#include "core/internal/ordered.h"

namespace sunder::tear {
namespace {

/// The area of each source triangle in bind space.
std::vector<float> areas_of(const Character& source) {
  std::vector<float> areas;
  for (const Mesh& mesh : source.meshes)
    for (const auto& [a, b, c] : mesh.triangles) {
      const Vec3d at = mesh.positions[a].cast<double>();
      const Vec3d ab = mesh.positions[b].cast<double>() - at,
                  ac = mesh.positions[c].cast<double>() - at;
      areas.push_back(static_cast<float>(0.5 * norm(Vec3d(ab.cross(ac)))));
    }
  return areas;
}

}  // namespace

std::shared_ptr<const SurfaceCells> make_cells(const Surface& surface, const Character& source) {
  return std::make_shared<const SurfaceCells>(surface.twin, areas_of(source));
}

void ChangedCells::share(std::shared_ptr<const SurfaceCells> cells) {
  std::vector<Index> changed(cells->node_count(), 0), marks(cells->node_count(), kNone);
  cells_ = std::move(cells);
  changed_ = std::move(changed);
  marks_ = std::move(marks);
  seen_ = 0;
}

std::shared_ptr<const SurfaceCells> ChangedCells::build() const {
  // The surface as it was before any operation: its first change tells the twins of a triangle.
  const Surface& surface = columns_.surface;
  const auto end = static_cast<std::ptrdiff_t>(3 * std::size_t{surface.first_triangle.back()});
  std::vector<Index> twin(surface.twin.begin(), surface.twin.begin() + end);
  for (const TriangleChange& change : columns_.triangle_changes)
    if (is_first_of_source(change))
      for (std::size_t k = 0; k < 3; ++k)
        twin[3 * std::size_t{change.triangle} + k] = change.twins[k];
  return std::make_shared<const SurfaceCells>(twin, areas_of(source_));
}

void ChangedCells::update() {
  if (!cells_) share(build());
  const auto& changes = columns_.triangle_changes;
  for (; seen_ < changes.size(); ++seen_)
    if (is_first_of_source(changes[seen_])) count(changes[seen_].triangle);
}

void ChangedCells::forget_from(Index change) noexcept {
  for (; seen_ > change; --seen_)
    if (is_first_of_source(columns_.triangle_changes[seen_ - 1]))
      discount(columns_.triangle_changes[seen_ - 1].triangle);
}

void ChangedCells::count(Index face) {
  for (Index node = cells_->cell_of(face); node != kNone && changed_[node]++ == 0;
       node = cells_->parent(node)) {
  }
}

void ChangedCells::discount(Index face) noexcept {
  for (Index node = cells_->cell_of(face); node != kNone && --changed_[node] == 0;
       node = cells_->parent(node)) {
  }
}

std::size_t ChangedCells::bytes() const {
  const bool is_own = cells_.use_count() == 1;  // otherwise the asset counts them
  return (changed_.capacity() + marks_.capacity()) * sizeof(Index) + (is_own ? cells_->bytes() : 0);
}

}  // namespace sunder::tear
