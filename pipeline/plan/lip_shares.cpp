#include "pipeline/plan/lip_shares.h"

#include <algorithm>
#include <limits>
#include <unordered_set>

#include "pipeline/plan/gape_profile.h"
#include "pipeline/plan/posed_places.h"

namespace sunder::plan {
namespace {

/// A corner of a triangle of a torn model as a place in the source.
SurfaceAnchor source_place(const TornModel& model, std::uint32_t mesh, std::uint32_t triangle,
                           std::uint32_t corner) {
  const std::uint32_t vertex = model.character().meshes[mesh].triangles[triangle][corner];
  const Mesh& source = model.source().meshes[mesh];
  if (vertex >= source.vertex_count()) return {mesh, model.birth(mesh, vertex)};
  Birth birth{model.source_triangle(mesh, triangle), {0, 0, 0}};
  for (std::size_t i = 0; i < 3; ++i)
    birth.barycentric[i] = source.triangles[birth.triangle][i] == vertex ? 1 : 0;
  return {mesh, birth};
}

/// Points of lips, and one place of each.
struct LipPlaces {
  std::vector<std::uint32_t> points;
  std::vector<SurfaceAnchor> places;
};

LipPlaces places_of_lips(const TornModel& model, std::span<const ChangeRecord> changes) {
  std::unordered_set<std::uint32_t> wanted;
  for (const ChangeRecord& change : changes)
    for (const LipPair& pair : change.lips) wanted.insert({pair.left, pair.right});
  LipPlaces found;
  const Character& torn = model.character();
  for (std::uint32_t mesh = 0; mesh < torn.meshes.size(); ++mesh)
    for (std::uint32_t triangle = 0; triangle < torn.meshes[mesh].triangle_count(); ++triangle) {
      if (is_retired(torn.meshes[mesh].triangles[triangle])) continue;
      for (std::uint32_t corner = 0; corner < 3; ++corner) {
        const std::uint32_t point = model.point_at(mesh, triangle, corner);
        if (wanted.erase(point) == 0) continue;
        found.points.push_back(point);
        found.places.push_back(source_place(model, mesh, triangle, corner));
      }
    }
  return found;
}

double share_nearest_to(const Vec3d& place, std::span<const Vec3d> curve,
                        std::span<const double> along) {
  double least = std::numeric_limits<double>::infinity(), nearest = 0;
  for (std::size_t i = 1; i < curve.size(); ++i) {
    const Vec3d chord = curve[i] - curve[i - 1];
    const double square = chord.squaredNorm();
    const double part =
        square > 0 ? std::clamp((place - curve[i - 1]).dot(chord) / square, 0.0, 1.0) : 0;
    const double distance = (curve[i - 1] + part * chord - place).norm();
    if (distance >= least) continue;
    least = distance;
    nearest = (1 - part) * along[i - 1] + part * along[i];
  }
  return nearest;
}

}  // namespace

Result<std::unordered_map<std::uint32_t, double>> lip_shares(const TornModel& model,
                                                             std::span<const ChangeRecord> changes,
                                                             const TargetPath& path,
                                                             const ModelPose& pose) {
  const LipPlaces lips = places_of_lips(model, changes);
  std::unordered_map<std::uint32_t, double> shares;
  std::vector<Vec3d> posed(lips.places.size());
  PosedPath curve;
  if (const Status status = path.pose(pose, curve); !status) return status;
  if (const Status status = PosedPlaces(model.source(), lips.places).pose(pose, posed, {}); !status)
    return status;
  for (std::size_t i = 0; i < posed.size(); ++i)
    shares.emplace(lips.points[i], share_nearest_to(posed[i], curve.places, path.shares()));
  return shares;
}

std::vector<float> shares_of_points(const std::unordered_map<std::uint32_t, double>& lips,
                                    std::span<const double> nodes) {
  std::uint32_t last = 0;
  for (const auto& [point, share] : lips) last = std::max(last, point);
  std::vector<float> shares(lips.empty() ? 0 : last + std::size_t{1}, 1.0f);
  for (const auto& [point, share] : lips)
    shares[point] = static_cast<float>(std::clamp(profile_at_share(nodes, share), 0.0, 1.0));
  return shares;
}

}  // namespace sunder::plan
