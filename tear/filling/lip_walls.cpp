#include "tear/filling/lip_walls.h"

#include <algorithm>

#include "tear/filling/lip_places.h"

namespace sunder::tear {
namespace {

/// The points of a wall below a place, or its vertices there.
template <class T>
using WallRows = std::array<T, LipWalls::kMostRows + 1>;

/// The cross-section of a wall: from the lip, for a lip that rolls outwards around a rim, and then
/// in an arc downwards and below the opposite lip.
struct Profile {
  struct Row {
    double under = 0, down = 0;  ///< Metres from the lip.
    bool is_of_rim = false;      ///< Its size does not depend on the room below.
  };

  explicit Profile(const LipWallOptions& options) {
    if (options.roll > 0)
      for (const auto& [under, down] : {std::pair{-0.35, -0.35}, {0.0, -0.6}, {0.25, -0.25}})
        rows[count++] = {under * options.roll, down * options.roll, true};
    for (const double t : {1.0 / 3, 2.0 / 3, 1.0})
      rows[count++] = {t * t * lean_of(options), t * options.depth};
  }

  /// The posed displacement of a row from the lip.
  [[nodiscard]] Vec3d offset(std::size_t row, const LipPlace& place) const {
    const Row& of = rows[row];
    const double size = of.is_of_rim ? place.taper : place.taper * place.room;
    return size * (of.under * place.lean * place.under + of.down * place.down);
  }

  WallRows<Row> rows = {};  ///< Row 0 is the lip.
  std::size_t count = 1;
};

/// Adds the walls of one rim.
class LipStrip {
 public:
  LipStrip(const Rim& rim, std::span<const LipPlace> places, const Profile& profile, double unit,
           LipWalls& walls, WallBuilder& builder)
      : rim_(rim),
        places_(places),
        profile_(profile),
        unit_(unit),
        walls_(walls),
        builder_(builder),
        points_(places.size(), WallRows<Index>{}, &builder.scratch()),
        firsts_(places.size(), WallRows<VertexRef>{}, &builder.scratch()),
        rows_(&builder.scratch()),
        areas_(&builder.scratch()) {
    find_seam();
  }

  /// Adds strips along all edges whose ends are ready. @return their number.
  Index add() {
    ScratchVector<Index> borders(&builder_.scratch());
    Index strips = 0;
    for (std::size_t i = 0; i < count(); ++i) {
      if (!has_wall(i)) continue;
      borders.push_back(rim_.half_edges[i]);
      strips += i == 0 || !has_wall(i - 1) ? 1 : 0;
      for (const std::size_t at : {i, i + 1}) add_known(places_[at], borders);
    }
    if (borders.empty()) return 0;
    const bool is_built = builder_.add(borders, [&] { build(); });
    if (!is_built) {
      refuse();
      return 0;
    }
    keep_ends();
    return strips;
  }

 private:
  struct Column {
    WallRows<WallCorner> corners = {};
    bool is_smooth = false;  ///< Whether the next edge goes on with it.
  };

  [[nodiscard]] std::size_t count() const { return rim_.half_edges.size(); }
  [[nodiscard]] bool has_wall(std::size_t edge) const { return places_[edge].begins_wall; }

  void refuse() {
    for (std::size_t i = 0; i < count(); ++i)
      if (has_wall(i)) walls_.refused.push_back(rim_.half_edges[i]);
    std::sort(walls_.refused.begin(), walls_.refused.end());
  }

  /// The borders at the end of an earlier wall, where this one goes on.
  void add_known(const LipPlace& place, ScratchVector<Index>& borders) const {
    if (place.end == kNone) return;
    const LipWalls::End& end = walls_.ends[place.end];
    Index above = end.point;
    for (Index r = 0; r < end.row_count; ++r) {
      borders.push_back(find_border(builder_.surface(), above, end.rows[r]));
      above = end.rows[r];
    }
  }

  /// Texture coordinates run from the first tip along both lips, and meet at the other tip.
  void find_seam() {
    const std::size_t last = count();
    const Index first_end = places_[0].end, last_end = places_[last].end;
    if (first_end != kNone) first_along_ = walls_.ends[first_end].along;
    seam_ = last_end != kNone && first_end == kNone ? 0 : last;
    last_along_ = first_along_ + places_[last].along;
    const bool comes_back = rim_.is_closed || (first_end != kNone && last_end != kNone);
    if (rim_.is_closed) last_along_ = 0;
    if (last_end != kNone) last_along_ = walls_.ends[last_end].along;
    if (!comes_back) return;
    for (std::size_t i = 1; i < last; ++i)
      if (places_[i].is_tip()) {
        seam_ = i;
        return;
      }
    if (rim_.is_closed) last_along_ = first_along_ + places_[last].along;
  }
  [[nodiscard]] double along(std::size_t edge, std::size_t place) const {
    return edge < seam_ ? first_along_ + places_[place].along
                        : last_along_ + places_[place].along - places_[count()].along;
  }

  [[nodiscard]] Vec3d direction(std::size_t edge) const {
    return unit_or(Vec3d(places_[edge + 1].at - places_[edge].at), Vec3d::Zero());
  }
  /// The other edge at a place; count() if there is none.
  [[nodiscard]] std::size_t beside(std::size_t edge, std::size_t place) const {
    if (place == edge) return edge > 0 ? edge - 1 : rim_.is_closed ? count() - 1 : count();
    return edge + 1 < count() ? edge + 1 : rim_.is_closed ? 0 : count();
  }

  void make_points(std::size_t at) {
    const LipPlace& place = places_[at];
    WallRows<Index>& points = points_[at];
    if (points[1] != 0) return;
    const std::size_t twin = rim_.is_closed && at == count() ? 0 : at;
    if (twin != at && points_[twin][1] != 0) {
      points = points_[twin];
      return;
    }
    points[0] = place.point;
    for (std::size_t r = 1; r < profile_.count; ++r) {
      if (place.is_tip()) {
        points[r] = place.point;
      } else if (place.end != kNone) {
        points[r] = walls_.ends[place.end].rows[r - 1];
        const Index corner = builder_.surface().point_corner[points[r]];
        firsts_[at][r] = {builder_.mesh_of(corner), builder_.work().editor.vertex_at(corner)};
      } else {
        points[r] = builder_.add_point(place.at + profile_.offset(r, place));
      }
    }
    if (rim_.is_closed && at == 0) points_[count()] = points;
  }

  /// The vertices below a place, for the wall of an edge.
  Column make_column(std::size_t edge, std::size_t at) {
    const LipPlace& place = places_[at];
    const Index h = rim_.half_edges[edge], mesh = builder_.mesh_of(h);
    make_points(at);
    Column column;
    column.corners[0] = builder_.add_top(mesh, at == edge ? h : Surface::next(h));
    for (std::size_t r = 1; r < profile_.count; ++r) {
      const Index point = points_[at][r];
      if (place.is_tip()) {
        column.corners[r] = column.corners[0];
      } else if (VertexRef& first = firsts_[at][r]; first.vertex != kNone) {
        column.corners[r] = builder_.add_copy(mesh, point, first);
      } else {
        column.corners[r] =
            builder_.add_bottom(mesh, column.corners[0], point, profile_.offset(r, place));
        first = {mesh, column.corners[r].vertex};
        if (rim_.is_closed && (at == 0 || at == count())) firsts_[count() - at][r] = first;
      }
    }
    shade(edge, at, mesh, column);
    return column;
  }

  /// The posed position of a row.
  [[nodiscard]] const Vec3d& at_row(std::size_t at, std::size_t row) const {
    return rows_[at][row];
  }
  /// The normals of the two triangles below a row of an edge, times twice their areas.
  using DoubledAreas = std::array<Vec3d, 2>;
  [[nodiscard]] const DoubledAreas& doubled_areas(std::size_t edge, std::size_t row) const {
    return areas_[edge][row];
  }
  /// Computes them for the edges that get walls.
  void measure() {
    rows_.resize(places_.size());
    areas_.resize(count());
    for (std::size_t i = 0; i < count(); ++i) {
      if (!has_wall(i)) continue;
      if (i == 0 || !has_wall(i - 1)) place_rows(i);
      place_rows(i + 1);
      for (std::size_t row = 0; row + 1 < profile_.count; ++row) {
        const Vec3d from = rows_[i + 1][row], below = rows_[i][row + 1] - from;
        areas_[i][row] = {Vec3d(rows_[i][row] - from).cross(below),
                          below.cross(Vec3d(rows_[i + 1][row + 1] - from))};
      }
    }
  }
  void place_rows(std::size_t at) {
    const LipPlace& place = places_[at];
    for (std::size_t row = 0; row < profile_.count; ++row)
      rows_[at][row] = row > 0 && place.end != kNone
                           ? builder_.position(walls_.ends[place.end].rows[row - 1])
                           : Vec3d(place.at + profile_.offset(row, place));
  }
  /// The mean normal, by area, of the triangles of an edge around a row; around all rows at a tip.
  [[nodiscard]] Vec3d normal(std::size_t edge, std::size_t row, bool is_tip) const {
    Vec3d sum = Vec3d::Zero();
    for (std::size_t r = 0; r + 1 < profile_.count; ++r)
      if (is_tip || r == row || r + 1 == row)
        for (const Vec3d& of : doubled_areas(edge, r)) sum += of;
    return sum;
  }
  /// Whether a normal looks to the front of all these triangles.
  [[nodiscard]] bool fits(const Vec3d& normal, std::size_t edge, std::size_t row) const {
    for (std::size_t r = row > 0 ? row - 1 : 0; r <= row && r + 1 < profile_.count; ++r)
      for (const Vec3d& of : doubled_areas(edge, r))
        if (!(dot(normal, of) >= 0)) return false;
    return true;
  }

  void shade(std::size_t edge, std::size_t at, Index mesh, Column& column) {
    const LipPlace& place = places_[at];
    const std::size_t other = beside(edge, at);
    Vec3d along_rim = direction(edge);
    column.is_smooth = !place.is_tip() && other != count() && has_wall(other) &&
                       dot(along_rim, direction(other)) > kSmoothWallCosine;
    for (std::size_t r = 0; column.is_smooth && r < profile_.count; ++r) {
      const Vec3d mean = normal(edge, r, false) + normal(other, r, false);
      column.is_smooth = fits(mean, edge, r) && fits(mean, other, r);
    }
    if (column.is_smooth) along_rim = unit_or(Vec3d(along_rim + direction(other)), along_rim);
    const double u = along(edge, at) / unit_;
    double v = 0;
    for (std::size_t r = 0; r < profile_.count; ++r) {
      if (place.is_tip() && r > 0) break;
      if (r > 0) v += norm(Vec3d(at_row(at, r) - at_row(at, r - 1))) / unit_;
      Vec3d mean = normal(edge, r, place.is_tip());
      if (column.is_smooth) mean += normal(other, r, false);
      builder_.shade(mesh, column.corners[r], unit_or(mean, place.down.unitOrthogonal()), along_rim,
                     {u, v});
    }
  }

  void build() {
    measure();
    Column last;
    Index mesh = kNone;
    for (std::size_t i = 0; i < count(); ++i) {
      if (!has_wall(i)) {
        mesh = kNone;
        continue;
      }
      const bool goes_on = mesh == builder_.mesh_of(rim_.half_edges[i]) && last.is_smooth &&
                           along(i, i) == along(i - 1, i);
      mesh = builder_.mesh_of(rim_.half_edges[i]);
      const Column first = goes_on ? last : make_column(i, i);
      last = make_column(i, i + 1);
      for (std::size_t r = 0; r + 1 < profile_.count; ++r) {
        if (!places_[i].is_tip())
          builder_.add_triangle(mesh, rim_.half_edges[i], last.corners[r], first.corners[r],
                                first.corners[r + 1]);
        if (!places_[i + 1].is_tip())
          builder_.add_triangle(mesh, rim_.half_edges[i], last.corners[r], first.corners[r + 1],
                                last.corners[r + 1]);
      }
    }
  }

  /// Remembers where walls end that may go on later, and forgets where they went on.
  void keep_ends() {
    for (std::size_t i = 0; i < places_.size(); ++i)
      if (places_[i].end != kNone && ((i > 0 && has_wall(i - 1)) || (i < count() && has_wall(i))))
        walls_.ends[places_[i].end].point = kNone;
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const LipPlace& place = places_[i];
      const bool is_before = i > 0 && has_wall(i - 1), is_after = i < count() && has_wall(i);
      if (is_before == is_after || place.is_tip() || place.end != kNone) continue;
      if (rim_.is_closed && (i == 0 || i == count()) && has_wall(0) && has_wall(count() - 1))
        continue;
      LipWalls::End end{place.point,
                        along(is_before ? i - 1 : i, i),
                        place.to_tip,
                        static_cast<Index>(profile_.count - 1),
                        {}};
      std::copy_n(points_[i].begin() + 1, end.row_count, end.rows.begin());
      walls_.ends.push_back(end);
    }
    std::erase_if(walls_.ends, [](const LipWalls::End& end) { return end.point == kNone; });
  }

  const Rim& rim_;
  std::span<const LipPlace> places_;
  const Profile& profile_;
  double unit_;
  LipWalls& walls_;
  WallBuilder& builder_;
  ScratchVector<WallRows<Index>> points_;  ///< Per place; made when the first vertex needs them.
  /// Per place: the first vertices of these points. The others are copies, so that they are at the
  /// same place, bit for bit.
  ScratchVector<WallRows<VertexRef>> firsts_;
  ScratchVector<WallRows<Vec3d>> rows_;          ///< Per place: posed.
  ScratchVector<WallRows<DoubledAreas>> areas_;  ///< Per edge.
  std::size_t seam_ = 0;  ///< The first edge that counts from the end of the rim.
  double first_along_ = 0, last_along_ = 0;
};

}  // namespace

Index add_lip_walls(std::span<const Index> half_edges, const Stroke& stroke,
                    const LipWallOptions& options, LipWalls& walls, const Workpiece& work) {
  WallBuilder builder(work, options.material);
  builder.filling().use(walls.submeshes);
  if (!(options.hold > 0)) walls.refused.clear();
  const Profile profile(options);
  Index count = 0;
  for (Rim& rim : chain_rims(half_edges, work.editor.surface(), work.editor.scratch())) {
    const auto places = lip_places(rim, stroke, options, walls, builder);
    count += LipStrip(rim, places, profile, options.depth, walls, builder).add();
  }
  const auto submeshes = builder.filling().submeshes();
  walls.submeshes.assign(submeshes.begin(), submeshes.end());
  return count;
}

}  // namespace sunder::tear
