#include "tear/pieces/piece_search.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/internal/ordered.h"
#include "core/internal/prefetch.h"
#include "tear/internal/surface.h"

namespace sunder::tear {
namespace {

ChangedCells& up_to_date(ChangedCells& cells) {
  cells.update();
  return cells;
}

}  // namespace

PieceSearch::PieceSearch(Index front_count, const SurfaceEditor& editor)
    : editor_(editor),
      surface_(editor.surface()),
      changed_cells_(up_to_date(editor.changed_cells)),
      cells_(changed_cells_.cells()),
      scratch_(editor.scratch()),
      sets_(front_count, scratch_),
      groups_(front_count, scratch_),
      fronts_(&scratch_),
      marked_nodes_(&scratch_),
      cell_marks_(&scratch_),
      appended_marks_(surface_.appended.size(), kNone, &scratch_),
      active_(&scratch_) {
  fronts_.reserve(front_count);
  for (Index i = 0; i < front_count; ++i) fronts_.emplace_back(scratch_).least = i;
  active_.reserve(front_count);
}

PieceSearch::~PieceSearch() {
  for (const Index node : marked_nodes_) changed_cells_.marks()[node] = kNone;
}

Index PieceSearch::first_mark_of(Index cell) {
  Index& first = changed_cells_.marks()[cell];
  if (first != kNone) return first;
  marked_nodes_.push_back(cell);
  const auto count = static_cast<Index>(cell_marks_.size());
  const std::size_t face_count = cells_.faces(cell).size();
  cell_marks_.resize(count + 1 + face_count, kNone);
  cell_marks_[count] = static_cast<Index>(face_count);
  area_of_faces_ += cells_.area(cell);
  fetch_faces(cell);  // most of them will be visited next
  return first = count;
}

void PieceSearch::fetch_faces(Index cell) const {
  for (const Index face : cells_.faces(cell)) prefetch(&surface_.twin[3 * std::size_t{face}]);
}

void PieceSearch::bound_area_of(Index appended) {
  const TriangleRef& ref = surface_.appended[appended];
  const Index origin = surface_.first_triangle[ref.mesh] + ref.source_triangle;
  if (origin < surface_.first_triangle[ref.mesh + 1])
    static_cast<void>(first_mark_of(cells_.cell_of(origin)));  // its area bounds the face's
  else
    area_of_faces_ = std::numeric_limits<double>::infinity();
}

void PieceSearch::reach_face(Index front, Index face) {
  const Index source_count = surface_.first_triangle.back();
  if (face >= source_count) {
    Index& mark = appended_marks_[face - source_count];
    if (mark == kNone) bound_area_of(face - source_count);
    visit_face(front, face, mark);
    return;
  }
  const Index cell = cells_.cell_of(face);
  if (changed_cells_.is_clean(cell))
    reach_node(front, changed_cells_.top_clean(cell));
  else
    visit_face(front, face, cell_marks_[first_mark_of(cell) + 1 + cells_.place_of(face)]);
}

/// @param mark  of the face: the front that visited it.
void PieceSearch::visit_face(Index front, Index face, Index& mark) {
  if (mark == front) return;
  if (mark != kNone) {
    join(front, mark);
    return;
  }
  const Index owner = sets_.find(front);
  Front& of_owner = fronts_[owner];
  of_owner.open.push_back(face);
  of_owner.faces.push_back(face);
  ++of_owner.triangles;
  mark = owner;
}

void PieceSearch::reach_node(Index front, Index node) {
  Index& mark = changed_cells_.marks()[node];
  if (mark == front) return;
  const Index owner = sets_.find(front);
  if (mark != kNone) {
    join(owner, mark);
    return;
  }
  marked_nodes_.push_back(node);
  mark = owner;
  Front& of_owner = fronts_[owner];
  of_owner.open.push_back(kNode | node);
  of_owner.triangles += cells_.face_count(node);
  of_owner.area += cells_.area(node);
}

/// Appends the smaller set to the larger one, so that a face is moved rarely.
void PieceSearch::join(Index a, Index b) {
  a = sets_.find(a);
  b = sets_.find(b);
  if (a == b) return;
  const auto size = [&](Index front) {
    const Front& of = fronts_[front];
    return of.faces.size() + of.open.size() + of.at_change.size();
  };
  if (size(a) < size(b)) std::swap(a, b);
  sets_.unite(a, b);
  groups_.unite(groups_.find(a), groups_.find(b));
  Front &into = fronts_[a], &from = fronts_[b];
  if (from.measured > 0) {
    measure(from);
    measure(into);
  }
  into.faces.insert(into.faces.end(), from.faces.begin(), from.faces.end());
  into.open.insert(into.open.end(), from.open.begin(), from.open.end());
  into.at_change.insert(into.at_change.end(), from.at_change.begin(), from.at_change.end());
  if (from.measured > 0) into.measured = into.faces.size();
  into.triangles += from.triangles;
  into.area += from.area;
  into.least = std::min(into.least, from.least);
  from.faces.clear();
  from.open.clear();
  from.at_change.clear();
}

/// Changed cells are entered from clean nodes last: by then most of them need not be.
void PieceSearch::step(Index front) {
  Front& of_front = fronts_[front];
  if (of_front.open.empty()) {
    const Index node = of_front.at_change.back();
    of_front.at_change.pop_back();
    enter_changed_cells(front, node);
    return;
  }
  const Index newest = of_front.open.back();
  of_front.open.pop_back();
  if ((newest & kNode) != 0)
    leave_node(front, newest & ~kNode);
  else
    leave_face(front, newest);
}

/// Most faces next to one were visited by the same front: this finds out in a few steps.
bool PieceSearch::has_visited(Index front, Index face) const {
  const Index source_count = surface_.first_triangle.back();
  if (face >= source_count) return appended_marks_[face - source_count] == front;
  const Index cell = cells_.cell_of(face);
  if (changed_cells_.is_clean(cell)) return false;
  const Index first = changed_cells_.marks()[cell];
  return first != kNone && cell_marks_[first + 1 + cells_.place_of(face)] == front;
}

void PieceSearch::leave_face(Index front, Index face) {
  for (Index h = 3 * face; h < 3 * face + 3; ++h) {
    const Index twin = surface_.twin[h];
    if (twin != kNone && !has_visited(front, twin / 3)) reach_face(front, twin / 3);
  }
  if (face < surface_.first_triangle.back())
    --cell_marks_[changed_cells_.marks()[cells_.cell_of(face)]];
}

void PieceSearch::leave_node(Index front, Index node) {
  bool is_at_change = false;
  for (const Index other : cells_.neighbours(node)) {
    if (changed_cells_.is_clean(other))
      reach_node(front, changed_cells_.top_clean(other));
    else
      is_at_change = true;
  }
  if (is_at_change) fronts_[sets_.find(front)].at_change.push_back(node);
}

/// Crosses from a clean node to its neighbours that hold changes.
void PieceSearch::enter_changed_cells(Index front, Index node) {
  if (!cells_.is_of_faces(node)) {
    for (const Index child : cells_.children(node)) {
      bool is_at_change = false;
      for (const Index other : cells_.neighbours(child)) {
        if (cells_.parent(other) == node) continue;
        if (changed_cells_.is_clean(other))
          reach_node(front, changed_cells_.top_clean(other));
        else
          is_at_change = true;
      }
      if (is_at_change) enter_changed_cells(front, child);
    }
    return;
  }
  if (are_neighbours_left(node)) return;
  fetch_faces(node);
  for (const Index face : cells_.faces(node))
    for (Index h = 3 * face; h < 3 * face + 3; ++h) {
      const Index twin = surface_.twin[h];
      if (twin != kNone && !changed_cells_.is_clean(cells_.cell_of(twin / 3)))
        reach_face(front, twin / 3);
    }
}

bool PieceSearch::are_neighbours_left(Index cell) const {
  const std::span<const Index> others = cells_.neighbours(cell);
  return std::all_of(others.begin(), others.end(), [&](Index other) {
    if (changed_cells_.is_clean(other)) return true;
    const Index first = changed_cells_.marks()[other];
    return first != kNone && cell_marks_[first] == 0;
  });
}

void PieceSearch::find_active() {
  for (Index& front : active_) front = sets_.find(front);
  std::sort(active_.begin(), active_.end());
  active_.erase(std::unique(active_.begin(), active_.end()), active_.end());
  active_.erase(std::remove_if(active_.begin(), active_.end(),
                               [&](Index front) { return !is_active(front); }),
                active_.end());
}

void PieceSearch::grow() {
  for (Index front = 0; front < fronts_.size(); ++front) active_.push_back(front);
  for (find_active(); active_.size() > 1; find_active())
    for (const Index front : active_)
      for (std::size_t turn = 0; turn < kStepsATurn && is_active(front); ++turn) step(front);
}

double PieceSearch::area_of(Index face) const {
  const TriangleRef ref = surface_.triangle(face);
  const auto& [a, b, c] = editor_.character().meshes[ref.mesh].triangles[ref.triangle];
  const auto place = [&](Index vertex) -> Vec3d {
    return editor_.births.position(ref.mesh, vertex).cast<double>();
  };
  const Vec3d at = place(a), ab = place(b) - at, ac = place(c) - at;
  return 0.5 * norm(Vec3d(ab.cross(ac)));
}

void PieceSearch::measure(Front& front, std::size_t most_faces) {
  const std::size_t unmeasured = front.faces.size() - front.measured;
  const std::size_t end = front.measured + std::min(most_faces, unmeasured);
  for (; front.measured < end; ++front.measured) front.area += area_of(front.faces[front.measured]);
}

Index PieceSearch::largest_of(std::span<const Index> parts) const {
  Index best = parts[0];
  for (const Index part : parts.subspan(1))
    if (fronts_[part].area > fronts_[best].area) best = part;
  return best;
}

/// Measures the faces of parts, those of the largest part first, until one is the largest whatever
/// the areas of the others. @return that one; of equal ones the first.
Index PieceSearch::measure_until_clear(std::span<const Index> parts) {
  // Their rounded areas may exceed the bound by less than this.
  constexpr double kSafety = 1.001;
  double rest = kSafety * area_of_faces_;
  const auto has_rest = [&](Index part) {
    return fronts_[part].measured < fronts_[part].faces.size();
  };
  for (;;) {
    const Index best = largest_of(parts);
    const bool is_clear = std::all_of(parts.begin(), parts.end(), [&](Index part) {
      const Front& of = fronts_[part];
      return part == best || of.area + (has_rest(part) ? rest : 0) < fronts_[best].area;
    });
    const auto unmeasured = has_rest(best) ? std::find(parts.begin(), parts.end(), best)
                                           : std::find_if(parts.begin(), parts.end(), has_rest);
    if (is_clear || unmeasured == parts.end()) return best;
    Front& front = fronts_[*unmeasured];
    const double before = front.area;
    measure(front, kFacesAtATime);
    rest = std::max(0.0, rest - (front.area - before));
  }
}

/// @param parts  of one former component, ascending by their least fronts.
Index PieceSearch::find_body(std::span<const Index> parts) {
  // A part that is not known completely is larger than what is known of it.
  const auto incomplete =
      std::find_if(parts.begin(), parts.end(), [&](Index part) { return is_active(part); });
  if (const Index best = measure_until_clear(parts);
      incomplete == parts.end() || *incomplete == best)
    return best;
  for (;;) {
    for (const Index part : parts) measure(fronts_[part]);
    const Index best = largest_of(parts);
    if (*incomplete == best || !is_active(*incomplete)) return best;
    for (std::size_t turn = 0; turn < kStepsATurn && is_active(*incomplete); ++turn)
      step(*incomplete);
  }
}

ScratchVector<PieceSearch::Part> PieceSearch::separated() {
  ScratchVector<std::array<Index, 3>> by_group(&scratch_);  // group, least front, front
  by_group.reserve(fronts_.size());
  for (Index front = 0; front < fronts_.size(); ++front)
    if (sets_.find(front) == front)
      by_group.push_back({groups_.find(front), fronts_[front].least, front});
  std::sort(by_group.begin(), by_group.end());
  ScratchVector<Part> parts(&scratch_);
  parts.reserve(by_group.size());
  ScratchVector<Index> of_group(&scratch_);
  of_group.reserve(by_group.size());
  Index component = 0;
  for (std::size_t begin = 0, end = 0; begin < by_group.size(); begin = end) {
    of_group.clear();
    for (; end < by_group.size() && by_group[end][0] == by_group[begin][0]; ++end)
      of_group.push_back(by_group[end][2]);
    if (of_group.size() < 2) continue;
    const Index body = find_body(of_group);
    for (const Index part : of_group)
      parts.push_back({fronts_[part].least, component,
                       is_active(part) ? kNone : fronts_[part].triangles, part == body});
    ++component;
  }
  std::sort(parts.begin(), parts.end(),
            [](const Part& a, const Part& b) { return a.front < b.front; });
  return parts;
}

}  // namespace sunder::tear
