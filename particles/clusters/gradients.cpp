#include "particles/clusters/gradients.h"

#include <algorithm>

#include "core/internal/ordered.h"
#include "core/internal/prefetch.h"
#include "particles/internal/tolerances.h"
#include "tear/internal/surface.h"

namespace sunder::particles {
namespace {

float weight_of(const ParticleInfluences& influences, Index particle) {
  for (std::size_t i = 0; i < 4; ++i)
    if (influences.particles[i] == particle && influences.weights[i] > 0)
      return influences.weights[i];
  return 0.0f;
}

/// The gradients of some faces, weighted by area. On a smooth surface their mean is that of the
/// point. At a crease, as between a lip and its wall, each face knows only the part in its own
/// plane; there the gradient is the one whose parts in these planes agree best with the faces'.
class FaceGradients {
 public:
  FaceGradients() { sums_.fill(Vec3d::Zero()); }

  void add_face(const Vec3d& normal, double area) {
    area_ += area;
    normals_ += area * normal;
    for (Eigen::Index k = 0; k < 3; ++k) planes_.col(k) -= area * normal[k] * normal;
  }
  void add(std::size_t i, const Vec3d& gradient_times_area) { sums_[i] += gradient_times_area; }

  [[nodiscard]] ParticleGradients means() const {
    ParticleGradients gradients;
    if (!(area_ > 0)) return gradients;
    const double length = norm(normals_);
    const bool is_creased = length < kCreaseCosine * area_ && length > 0;
    Mat3d parts = planes_ + area_ * Mat3d::Identity();
    for (Eigen::Index k = 0; k < 3; ++k)
      parts.col(k) += kAcrossCrease * area_ * (normals_[k] / (length * length)) * normals_;
    for (std::size_t i = 0; i < 4; ++i) {
      Vec3d of = sums_[i] / area_;
      if (is_creased && determinant(parts) > kFlatDeterminant * area_ * area_ * area_)
        of = multiply(inverse(parts), sums_[i]);
      gradients.of_weights[i] = of.cast<float>();
    }
    return gradients;
  }

 private:
  double area_ = 0;
  Vec3d normals_ = Vec3d::Zero();
  Mat3d planes_ = Mat3d::Zero();  ///< The sum of area (projection to the plane - identity).
  std::array<Vec3d, 4> sums_;
};

ParticleGradients gradients_at(const Surface& surface, const Structure& structure, Index point) {
  if (surface.point_corner[point] == kNone) return {};
  const ParticleInfluences& own = structure.points.influences[point];
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
    for (std::size_t i = 0; i < 4 && own.weights[i] > 0; ++i) {
      const double rise_b =
          weight_of(structure.points.influences[b], own.particles[i]) - own.weights[i];
      const double rise_c =
          weight_of(structure.points.influences[c], own.particles[i]) - own.weights[i];
      faces.add(i, normal.cross(rise_c * to_b - rise_b * to_c));  // times twice the area
    }
  });
  return faces.means();
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
