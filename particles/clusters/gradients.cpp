#include "particles/clusters/gradients.h"

#include <algorithm>
#include <utility>

#include "core/internal/ordered.h"
#include "core/internal/prefetch.h"
#include "particles/internal/tolerances.h"
#include "tear/internal/surface.h"

namespace sunder::particles {
namespace {

/// The gradients of some faces, weighted by area. On a smooth surface their mean is that of the
/// point. At a crease, as between a lip and its wall, each face knows only the part in its own
/// plane; there the gradient is the one whose parts in these planes agree best with the faces'.
class FaceGradients {
 public:
  void add_face(const Vec3d& normal, double area) {
    area_ += area;
    normals_ += area * normal;
    if (face_count_ == kFacesAtOnce) add_planes();
    faces_[face_count_++] = {normal, area};
  }
  /// What the faces around a point have of it: its weights times a vector.
  void add_point(const ParticleInfluences& influences, const Vec3d& per_weight) {
    const Vec4d by(per_weight.x(), per_weight.y(), per_weight.z(), 0);
    for (std::size_t i = 0; i < 4 && influences.weights[i] > 0; ++i)
      sums_[sum_of(influences.particles[i])] += static_cast<double>(influences.weights[i]) * by;
  }

  /// Of the four particles whose weights change most.
  /// @param own  those of the point.
  [[nodiscard]] ParticleGradients means(const ParticleInfluences& own) {
    ParticleGradients gradients;
    if (!(area_ > 0)) return gradients;
    const std::size_t kept = std::min<std::size_t>(count_, 4);
    const std::array<std::uint8_t, kMostParticles> order = order_by_size();
    share_the_rest(own, order, kept);
    const double length = norm(normals_);
    const bool is_creased = length < kCreaseCosine * area_ && length > 0;
    Mat3d solve = Mat3d::Identity();
    const bool is_solved = is_creased && invert_parts(length, solve);
    for (std::size_t i = 0; i < kept; ++i) {
      const Vec3d sum = sums_[order[i]].head<3>();
      const Vec3d of = is_solved ? Vec3d(multiply(solve, sum)) : Vec3d(sum / area_);
      gradients.particles[i] = particles_[order[i]];
      gradients.of_weights[i] = of.cast<float>();
    }
    return gradients;
  }

 private:
  struct Face {
    Vec3d normal;
    double area;
  };
  /// Of more particles around one point, the first ones count.
  static constexpr std::uint8_t kMostParticles = 64;
  static constexpr std::size_t kFacesAtOnce = 16;

  /// @return kMostParticles for one that does not count.
  std::uint8_t sum_of(Index particle) {
    for (std::uint8_t i = 0; i < count_; ++i)
      if (particles_[i] == particle) return i;
    if (count_ == kMostParticles) {
      sums_[kMostParticles].setZero();
      return kMostParticles;
    }
    particles_[count_] = particle;
    sums_[count_].setZero();
    return count_++;
  }

  /// The sums from the largest to the smallest, of equal ones the first. Four need no order.
  [[nodiscard]] std::array<std::uint8_t, kMostParticles> order_by_size() const {
    std::array<std::uint8_t, kMostParticles> order;
    std::array<double, kMostParticles> squares;
    for (std::uint8_t i = 0; i < count_; ++i) {
      const double square = count_ > 4 ? squared_norm(Vec3d(sums_[i].head<3>())) : 0;
      std::uint8_t at = i;
      for (; at > 0 && squares[at - 1] < square; --at) {
        squares[at] = squares[at - 1];
        order[at] = order[at - 1];
      }
      squares[at] = square;
      order[at] = i;
    }
    return order;
  }

  /// Weights sum to one, so that their gradients cancel, and particles that all move alike turn
  /// nothing: what is left out is given to those that are kept, by their weights at the point.
  void share_the_rest(const ParticleInfluences& own,
                      const std::array<std::uint8_t, kMostParticles>& order, std::size_t kept) {
    std::array<double, 4> shares = {};
    double whole = 0;
    Vec4d rest = Vec4d::Zero();
    for (std::size_t i = kept; i < count_; ++i) rest += sums_[order[i]];
    for (std::size_t i = 0; i < kept; ++i) {
      for (std::size_t k = 0; k < 4; ++k)
        if (own.particles[k] == particles_[order[i]] && own.weights[k] > 0)
          shares[i] = static_cast<double>(own.weights[k]);
      whole += shares[i];
    }
    for (std::size_t i = 0; i < kept; ++i)
      sums_[order[i]] += (whole > 0 ? shares[i] / whole : 1 / static_cast<double>(kept)) * rest;
  }

  void add_planes() {
    for (std::size_t i = 0; i < face_count_; ++i) {
      const auto& [normal, area] = faces_[i];
      for (Eigen::Index k = 0; k < 3; ++k) planes_.col(k) -= area * normal[k] * normal;
    }
    face_count_ = 0;
  }
  /// Inverts the map from a gradient to the sum of its parts in the planes of the faces.
  /// @return false if that does not tell the gradient.
  [[nodiscard]] bool invert_parts(double length, Mat3d& inverted) {
    add_planes();
    Mat3d parts = planes_ + area_ * Mat3d::Identity();
    for (Eigen::Index k = 0; k < 3; ++k)
      parts.col(k) += kAcrossCrease * area_ * (normals_[k] / (length * length)) * normals_;
    if (!(determinant(parts) > kFlatDeterminant * area_ * area_ * area_)) return false;
    inverted = inverse(parts);
    return true;
  }

  double area_ = 0;
  Vec3d normals_ = Vec3d::Zero();
  Mat3d planes_ = Mat3d::Zero();          ///< The sum of area (projection to the plane - identity).
  std::array<Face, kFacesAtOnce> faces_;  ///< Those that `planes_` lacks.
  std::size_t face_count_ = 0;
  /// Of their four numbers three count; four are added faster. The last sum takes what does not
  /// count.
  std::array<Vec4d, kMostParticles + 1> sums_;
  std::array<Index, kMostParticles> particles_;
  std::uint8_t count_ = 0;
};

/// The other end of an edge of the point.
struct Neighbour {
  Index point = kNone;
  Vec3d edge;
  Vec3d per_weight;        ///< Summed over the faces beside the edge.
  bool is_needed = false;  ///< Whether one of them has an area.
};

ParticleGradients gradients_at(const Surface& surface, const Structure& structure, Index point) {
  if (surface.point_corner[point] == kNone) return {};
  const std::vector<ParticleInfluences>& influences = structure.points.influences;
  const Vec3d at = structure.points.positions[point].cast<double>();
  FaceGradients faces;
  Vec3d own = Vec3d::Zero();
  const auto go_to = [&](Index of, Neighbour& neighbour) {
    if (neighbour.is_needed) faces.add_point(influences[neighbour.point], neighbour.per_weight);
    neighbour = {of, structure.points.positions[of].cast<double>() - at, Vec3d::Zero(), false};
  };
  Neighbour one, other;
  Neighbour *b = &one, *c = &other;
  surface.for_each_in_fan(surface.point_corner[point], [&](Index corner) {
    // The last point of a face is the first one of the next.
    const Index first = surface.corner_point[Surface::next(corner)];
    std::swap(b, c);
    if (b->point != first) go_to(first, *b);
    go_to(surface.corner_point[Surface::previous(corner)], *c);
    const Vec3d twice = b->edge.cross(c->edge);
    const double length = norm(twice);
    if (!(length > 0)) return;
    const Vec3d normal = twice / length;
    faces.add_face(normal, length);
    // normal x (rise_c to_b - rise_b to_c), times twice the area, corner by corner.
    const Vec3d by_c = normal.cross(b->edge), by_b = normal.cross(c->edge);
    own += by_b - by_c;
    b->per_weight -= by_b;
    c->per_weight += by_c;
    b->is_needed = c->is_needed = true;
  });
  for (const Neighbour* const last : {b, c})
    if (last->is_needed) faces.add_point(influences[last->point], last->per_weight);
  faces.add_point(influences[point], own);
  return faces.means(influences[point]);
}

}  // namespace

void Gradients::begin_change(Change& change) {
  change.changed_gradients.reset();
  if (!is_wanted_) return;
  change.changed_gradients.emplace();
  logged_.begin(change.points);
  // Points of earlier operations may not have been asked for yet.
  for (auto point = static_cast<Index>(is_known_.size()); point < change.points; ++point)
    unknown_.push_back(point);
  is_known_.resize(std::max<std::size_t>(is_known_.size(), change.points), false);
  reserve_eighth(gradients_, is_known_.size());
  gradients_.resize(is_known_.size());
}

void Gradients::forget(Index point, Change* change) {
  if (point >= is_known_.size()) return;
  if (change != nullptr && change->changed_gradients && point < change->points &&
      logged_.mark(point))
    change->changed_gradients->push_back({point, is_known_[point], gradients_[point]});
  if (!is_known_[point]) return;
  is_known_[point] = false;
  unknown_.push_back(point);
}

void Gradients::forget(const Surface& surface, std::span<const Index> points, Change* change) {
  if (!is_wanted_) return;
  for (const Index point : points) {
    if (point >= surface.point_count()) continue;
    forget(point, change);
    if (surface.point_corner[point] == kNone) continue;
    Index last = kNone;  // of a face, which is the first of the next one
    surface.for_each_in_fan(surface.point_corner[point], [&](Index corner) {
      const Index first = surface.corner_point[Surface::next(corner)];
      if (first != last) forget(first, change);
      last = surface.corner_point[Surface::previous(corner)];
      forget(last, change);
    });
  }
}

bool Gradients::exchange(Change& change) {
  if (!change.changed_gradients) return false;
  std::vector<Change::OfGradients>& changed = *change.changed_gradients;
  // The points of an undone operation are gone, and new when they return.
  const std::size_t stay = std::min<std::size_t>(change.points, is_known_.size());
  is_known_.resize(stay);
  gradients_.resize(stay);
  for (std::size_t i = 0; i < changed.size(); ++i) {
    constexpr std::size_t kAhead = 12;
    if (i + kAhead < changed.size()) prefetch(&gradients_[changed[i + kAhead].point]);
    Change::OfGradients& of = changed[i];
    const bool was_known = is_known_[of.point];
    is_known_[of.point] = of.is_known;
    std::swap(gradients_[of.point], of.gradients);
    if (!of.is_known) unknown_.push_back(of.point);
    of.is_known = was_known;
  }
  return true;
}

void Gradients::forget(const TornModel& model, const Structure& structure,
                       const MeshChange& of_mesh, Change* change) {
  const std::vector<Index>& points = structure.vertex_points.of_mesh[of_mesh.mesh];
  const Mesh& mesh = model.character().meshes[of_mesh.mesh];
  const auto forget_corners = [&](const Triangle& triangle) {
    for (const Index vertex : triangle)
      if (vertex < points.size() && points[vertex] != kNone) forget(points[vertex], change);
  };
  for (const RewrittenTriangle& rewritten : of_mesh.rewritten) {
    forget_corners(rewritten.before);
    if (rewritten.triangle < mesh.triangle_count())
      forget_corners(mesh.triangles[rewritten.triangle]);
  }
  for (Index t = of_mesh.first_triangle; t < mesh.triangle_count(); ++t)
    forget_corners(mesh.triangles[t]);
}

void Gradients::forget(const TornModel& model, const Structure& structure,
                       std::span<const ChangeRecord> changes, Change* change) {
  if (!is_wanted_) return;
  for (const ChangeRecord& record : changes)
    for (const MeshChange& of_mesh : record.meshes) forget(model, structure, of_mesh, change);
}

void Gradients::release_rows() {
  std::vector<ParticleGradients>().swap(gradients_);
  std::vector<Index>().swap(unknown_);
  logged_ = {};
}

std::span<const ParticleGradients> Gradients::of(const Surface& surface,
                                                 const Structure& structure) {
  const Index count = structure.points.count();
  const auto known = static_cast<Index>(is_known_.size());
  // Nothing is written then, because a copy may be made on another thread.
  if (is_up_to_date(count)) return gradients_;
  const std::size_t come = count > known ? count - known : 0;
  // All memory is allocated first, so that forget() needs none.
  reserve_eighth(gradients_, count);
  reserve_eighth(unknown_, std::max<std::size_t>(unknown_.size() + come, count));
  is_known_.resize(count, false);
  for (Index point = known; point < count; ++point) unknown_.push_back(point);
  is_wanted_ = true;
  gradients_.resize(count);
  for (const Index point : unknown_) {
    if (point >= count || is_known_[point]) continue;
    gradients_[point] = gradients_at(surface, structure, point);
    is_known_[point] = true;
  }
  unknown_.clear();
  return gradients_;
}

}  // namespace sunder::particles
