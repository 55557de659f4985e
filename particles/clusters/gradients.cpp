#include "particles/clusters/gradients.h"

#include <algorithm>

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
    for (Eigen::Index k = 0; k < 3; ++k) planes_.col(k) -= area * normal[k] * normal;
  }
  /// The part of a corner of a face: its weights times a vector.
  void add_corner(const ParticleInfluences& corner, const Vec3d& per_weight) {
    for (std::size_t i = 0; i < 4 && corner.weights[i] > 0; ++i)
      if (Vec3d* sum = sum_of(corner.particles[i]))
        *sum += static_cast<double>(corner.weights[i]) * per_weight;
  }

  /// Of the four particles whose weights change most.
  /// @param own  those of the point.
  [[nodiscard]] ParticleGradients means(const ParticleInfluences& own) {
    ParticleGradients gradients;
    if (!(area_ > 0)) return gradients;
    const std::size_t kept = keep_largest();
    share_the_rest(own, kept);
    const double length = norm(normals_);
    const bool is_creased = length < kCreaseCosine * area_ && length > 0;
    Mat3d parts = planes_ + area_ * Mat3d::Identity();
    for (Eigen::Index k = 0; k < 3; ++k)
      parts.col(k) += kAcrossCrease * area_ * (normals_[k] / (length * length)) * normals_;
    for (std::size_t i = 0; i < kept; ++i) {
      Vec3d of = sums_[i].gradient / area_;
      if (is_creased && determinant(parts) > kFlatDeterminant * area_ * area_ * area_)
        of = multiply(inverse(parts), sums_[i].gradient);
      gradients.particles[i] = sums_[i].particle;
      gradients.of_weights[i] = of.cast<float>();
    }
    return gradients;
  }

 private:
  struct Sum {
    Index particle;
    Vec3d gradient;
  };
  /// Of more particles around one point, the first ones count.
  static constexpr std::size_t kMostParticles = 64;

  Vec3d* sum_of(Index particle) {
    for (std::size_t i = 0; i < count_; ++i)
      if (sums_[i].particle == particle) return &sums_[i].gradient;
    if (count_ == kMostParticles) return nullptr;
    sums_[count_] = {particle, Vec3d::Zero()};
    return &sums_[count_++].gradient;
  }

  /// Moves the four largest to the front; of equal ones the first.
  std::size_t keep_largest() {
    if (count_ <= 4) return count_;
    const auto end = sums_.begin() + static_cast<std::ptrdiff_t>(count_);
    std::stable_sort(sums_.begin(), end, [](const Sum& a, const Sum& b) {
      return dot(a.gradient, a.gradient) > dot(b.gradient, b.gradient);
    });
    return 4;
  }

  /// Weights sum to one, so that their gradients cancel, and particles that all move alike turn
  /// nothing: what is left out is given to those that are kept, by their weights at the point.
  void share_the_rest(const ParticleInfluences& own, std::size_t kept) {
    std::array<double, 4> shares = {};
    double whole = 0;
    Vec3d rest = Vec3d::Zero();
    for (std::size_t i = kept; i < count_; ++i) rest += sums_[i].gradient;
    for (std::size_t i = 0; i < kept; ++i) {
      for (std::size_t k = 0; k < 4; ++k)
        if (own.particles[k] == sums_[i].particle && own.weights[k] > 0)
          shares[i] = static_cast<double>(own.weights[k]);
      whole += shares[i];
    }
    for (std::size_t i = 0; i < kept; ++i)
      sums_[i].gradient += (whole > 0 ? shares[i] / whole : 1 / static_cast<double>(kept)) * rest;
  }

  double area_ = 0;
  Vec3d normals_ = Vec3d::Zero();
  Mat3d planes_ = Mat3d::Zero();  ///< The sum of area (projection to the plane - identity).
  std::array<Sum, kMostParticles> sums_;
  std::size_t count_ = 0;
};

ParticleGradients gradients_at(const Surface& surface, const Structure& structure, Index point) {
  if (surface.point_corner[point] == kNone) return {};
  const std::vector<ParticleInfluences>& influences = structure.points.influences;
  FaceGradients faces;
  surface.for_each_in_fan(surface.point_corner[point], [&](Index corner) {
    const Index b = surface.corner_point[Surface::next(corner)],
                c = surface.corner_point[Surface::previous(corner)];
    const Vec3d at = structure.points.positions[point].cast<double>();
    const Vec3d to_b = structure.points.positions[b].cast<double>() - at,
                to_c = structure.points.positions[c].cast<double>() - at;
    const Vec3d twice = to_b.cross(to_c);
    const double length = norm(twice);
    if (!(length > 0)) return;
    const Vec3d normal = twice / length;
    faces.add_face(normal, length);
    // normal x (rise_c to_b - rise_b to_c), times twice the area, corner by corner.
    faces.add_corner(influences[point], normal.cross(to_c - to_b));
    faces.add_corner(influences[b], -normal.cross(to_c));
    faces.add_corner(influences[c], normal.cross(to_b));
  });
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
    surface.for_each_in_fan(surface.point_corner[point], [&](Index corner) {
      forget(surface.corner_point[Surface::next(corner)], change);
      forget(surface.corner_point[Surface::previous(corner)], change);
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
