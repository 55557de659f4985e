#include "pipeline/plan/clearance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <variant>

#include "pipeline/plan/posed_places.h"

namespace sunder::plan {
namespace {

constexpr double kPlaces = 4000;  ///< About so many places of faces, and vertices at most.
/// At so many samples and the first one distances are measured.
constexpr std::size_t kInstants = 64;
constexpr int kPlacesOfBlade = 6;   ///< At which it is looked whether it is outside.
constexpr std::size_t kBlock = 32;  ///< Places in a block.

/// Vertices, each as a corner of the first triangle that has it; of more than kPlaces every so
/// many.
std::vector<SurfaceAnchor> some_vertices(const Character& character) {
  std::vector<SurfaceAnchor> all;
  for (std::uint32_t mesh = 0; mesh < character.meshes.size(); ++mesh) {
    const Mesh& of = character.meshes[mesh];
    std::vector<bool> is_known(of.vertex_count());
    for (std::uint32_t i = 0; i < of.triangle_count(); ++i)
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const std::uint32_t vertex = of.triangles[i][corner];
        if (is_known[vertex]) continue;
        is_known[vertex] = true;
        all.push_back({mesh, {i, {0, 0, 0}}});
        all.back().birth.barycentric[corner] = 1;
      }
  }
  const std::size_t stride = all.size() / static_cast<std::size_t>(kPlaces) + 1;
  std::vector<SurfaceAnchor> some;
  for (std::size_t i = 0; i < all.size(); i += stride) some.push_back(all[i]);
  return some;
}

/// Places evenly distributed over the surface in a pose: each triangle gets its share by area, by
/// the R2 sequence (Roberts 2018).
Result<std::vector<SurfaceAnchor>> spread_places(const Character& character,
                                                 const ModelPose& pose) {
  std::vector<SurfaceAnchor> corners;
  for (std::uint32_t mesh = 0; mesh < character.meshes.size(); ++mesh)
    for (std::uint32_t i = 0; i < character.meshes[mesh].triangle_count(); ++i)
      for (std::size_t corner = 0; corner < 3; ++corner) {
        SurfaceAnchor anchor{mesh, {i, {0, 0, 0}}};
        anchor.birth.barycentric[corner] = 1;
        corners.push_back(anchor);
      }
  std::vector<Vec3d> posed(corners.size());
  if (const Status status = PosedPlaces(character, corners).pose(pose, posed, {}); !status)
    return status;
  const auto area_of = [&](std::size_t i) {
    return (posed[i + 1] - posed[i]).cross(posed[i + 2] - posed[i]).norm();
  };
  double area = 0;
  for (std::size_t i = 0; i < corners.size(); i += 3) area += area_of(i);
  std::vector<SurfaceAnchor> places = some_vertices(character);
  double due = 0;
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    due += area > 0 ? kPlaces * area_of(i) / area : 0;
    for (double k = 1; due >= 1; --due, ++k) {
      double u = std::fmod(0.5 + 0.7548776662466927 * k, 1.0);
      double v = std::fmod(0.5 + 0.5698402909980532 * k, 1.0);
      if (u + v > 1) {
        u = 1 - u;
        v = 1 - v;
      }
      places.push_back({corners[i].mesh, {corners[i].birth.triangle, {1 - u - v, u, v}}});
    }
  }
  return places;
}

/// Sorts places such that those that follow one another are near: halves along the longest side.
void sort_places(std::vector<std::pair<Vec3d, SurfaceAnchor>>& places, std::size_t first,
                 std::size_t end) {
  if (end - first <= kBlock) return;
  Vec3d low = places[first].first, high = low;
  for (std::size_t i = first; i < end; ++i) {
    low = low.cwiseMin(places[i].first);
    high = high.cwiseMax(places[i].first);
  }
  Eigen::Index axis = 0;
  (high - low).maxCoeff(&axis);
  // Whole blocks, so that none reaches over a cut.
  const std::size_t blocks = (end - first + kBlock - 1) / kBlock;
  const std::size_t middle = first + blocks / 2 * kBlock;
  const auto at = [&](std::size_t i) { return places.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(first), at(middle), at(end),
                   [&](const auto& a, const auto& b) { return a.first[axis] < b.first[axis]; });
  sort_places(places, first, middle);
  sort_places(places, middle, end);
}

/// The same places, those that are near in a pose beside one another.
Result<std::vector<SurfaceAnchor>> sorted_places(const Character& character,
                                                 const std::vector<SurfaceAnchor>& anchors,
                                                 const ModelPose& pose) {
  std::vector<Vec3d> posed(anchors.size());
  if (const Status status = PosedPlaces(character, anchors).pose(pose, posed, {}); !status)
    return status;
  std::vector<std::pair<Vec3d, SurfaceAnchor>> places;
  for (std::size_t i = 0; i < anchors.size(); ++i) places.emplace_back(posed[i], anchors[i]);
  sort_places(places, 0, places.size());
  std::vector<SurfaceAnchor> sorted;
  for (const auto& [place, anchor] : places) sorted.push_back(anchor);
  return sorted;
}

}  // namespace

Result<Clearance> Clearance::create(const Character& character, const PlanTool& tool,
                                    const PlanTiming& timing,
                                    std::span<const TargetSample> samples) {
  Clearance clearance(tool);
  for (std::size_t i = 0; i < tool.shapes.size(); ++i)
    if (tool.shapes[i].bone != tool.blade.link) clearance.shapes_.push_back(i);
  for (std::size_t i = 0; i <= kInstants; ++i) {
    Instant instant;
    instant.sample = i * (samples.size() - 1) / kInstants;
    instant.time = samples[instant.sample].time;
    clearance.instants_.push_back(std::move(instant));
  }
  if (!clearance.is_needed()) return clearance;
  clearance.pairs_ = LinkPairs(tool);
  Result<ModelPose> pose = pose_at(character, timing, 0);
  if (!pose) return pose.error();
  Result<std::vector<SurfaceAnchor>> anchors = spread_places(character, *pose);
  if (anchors) anchors = sorted_places(character, *anchors, *pose);
  if (!anchors) return anchors.error();
  const PosedPlaces places(character, *anchors);
  for (Instant& instant : clearance.instants_) {
    instant.places.resize(places.size());
    instant.normals.resize(places.size());
    if (timing.clip_speed > 0) pose = pose_at(character, timing, instant.time);
    if (!pose) return pose.error();
    if (const Status status = places.pose(*pose, instant.places, instant.normals); !status)
      return status;
    clearance.add_blocks(instant);
  }
  clearance.measure_spacing();
  return clearance;
}

void Clearance::add_blocks(Instant& instant) const {
  for (std::size_t first = 0; first < instant.places.size(); first += kBlock) {
    const std::size_t end = std::min(first + kBlock, instant.places.size());
    Block block;
    for (std::size_t i = first; i < end; ++i) block.centre += instant.places[i];
    block.centre /= static_cast<double>(end - first);
    for (std::size_t i = first; i < end; ++i)
      block.radius = std::max(block.radius, (instant.places[i] - block.centre).norm());
    instant.blocks.push_back(block);
  }
}

void Clearance::measure_spacing() {
  const std::vector<Block>& blocks = instants_.front().blocks;
  for (const Block& block : blocks)
    spacing_ += 2 * block.radius / std::sqrt(static_cast<double>(kBlock)) /
                static_cast<double>(blocks.size());
}

NearPlace Clearance::nearest_at(const Instant& instant, std::size_t shape, const Collider& posed,
                                double margin) const {
  NearPlace nearest{instant.time, shape, Vec3d::Zero(), margin, Vec3d::Zero()};
  if (instant.places.empty()) return nearest;
  const double radius = radius_of(posed) + margin;
  double to_centre = std::numeric_limits<double>::infinity();
  std::size_t at_centre = 0;
  for (std::size_t block = 0; block < instant.blocks.size(); ++block) {
    const Block& of = instant.blocks[block];
    const double away = (of.centre - posed.place).norm() - of.radius;
    if (away > radius && away > 0 && away * away > to_centre) continue;
    const std::size_t end = std::min((block + 1) * kBlock, instant.places.size());
    for (std::size_t i = block * kBlock; i < end; ++i) {
      const Vec3d& place = instant.places[i];
      const double square = (place - posed.place).squaredNorm();
      if (square < to_centre) {
        to_centre = square;
        at_centre = i;
      }
      if (square > radius * radius) continue;
      const double distance = distance_to(posed, place).distance;
      if (distance >= nearest.distance) continue;
      nearest.distance = distance;
      nearest.place = place;
    }
  }
  // The middle of the shape is below the surface, which may pass outside of the shape.
  const double above = (posed.place - instant.places[at_centre]).dot(instant.normals[at_centre]);
  if (above < -0.5 * std::sqrt(to_centre) && nearest.distance > above) {
    nearest.distance = above;
    nearest.place = instant.places[at_centre];
    nearest.normal = instant.normals[at_centre];
  }
  return nearest;
}

std::size_t Clearance::nearest_to(const Instant& instant, const Vec3d& point, std::size_t guess) {
  double least = (instant.places[guess] - point).squaredNorm();
  std::size_t nearest = guess;
  for (std::size_t block = 0; block < instant.blocks.size(); ++block) {
    const Block& of = instant.blocks[block];
    const double away = (of.centre - point).norm() - of.radius;
    if (away > 0 && away * away > least) continue;
    const std::size_t end = std::min((block + 1) * kBlock, instant.places.size());
    for (std::size_t i = block * kBlock; i < end; ++i) {
      const double square = (instant.places[i] - point).squaredNorm();
      if (square >= least) continue;
      least = square;
      nearest = i;
    }
  }
  return nearest;
}

bool Clearance::is_blade_outside(std::size_t instant, const Vec3d& base, const Vec3d& entry) const {
  const Instant& at = instants_[instant];
  if (at.places.empty()) return true;
  std::size_t nearest = 0;
  for (int i = 1; i <= kPlacesOfBlade; ++i) {
    const Vec3d point = entry + static_cast<double>(i) / kPlacesOfBlade * (base - entry);
    nearest = nearest_to(at, point, nearest);
    const Vec3d from = point - at.places[nearest];
    if (from.dot(at.normals[nearest]) < -0.5 * from.norm()) return false;
  }
  return true;
}

double Clearance::least_distance(BladeChain& chain, std::size_t instant, const Values& values,
                                 double most) const {
  double least = most;
  BladePlace blade;
  chain.place({values.data(), chain.size()}, blade, false);
  least = pairs_.nearest(chain.frames(), least).distance;
  for (const std::size_t shape : shapes_) {
    const BoneCollider& of_link = tool_->shapes[shape];
    const Collider posed = posed_collider(of_link, chain.frames()[of_link.bone]);
    least = std::min(least, nearest_at(instants_[instant], shape, posed, least).distance);
  }
  return least;
}

void Clearance::find_below_corners(const Instant& instant, std::size_t shape, const Collider& posed,
                                   NearPlace& nearest) const {
  const auto* const box = std::get_if<Collider::Box>(&posed.shape);
  if (box == nullptr) return;
  for (unsigned i = 0; i < 8; ++i) {
    const Vec3d sign((i & 1U) != 0 ? 1 : -1, (i & 2U) != 0 ? 1 : -1, (i & 4U) != 0 ? 1 : -1);
    const Vec3d corner = posed.place + posed.turn * Vec3d(sign.cwiseProduct(box->half_size));
    const std::optional<std::size_t> at = highest_below(instant, corner);
    if (!at) continue;
    const double above = (corner - instant.places[*at]).dot(instant.normals[*at]);
    if (above >= nearest.distance) continue;
    nearest = {instant.time, shape, corner - above * instant.normals[*at], above, Vec3d::Zero()};
  }
}

std::optional<std::size_t> Clearance::highest_below(const Instant& instant,
                                                    const Vec3d& point) const {
  // Beside a convex edge a point may be below the plane of one face, but not of both.
  const double near = 2 * spacing_;
  std::optional<std::size_t> highest;
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t block = 0; block < instant.blocks.size(); ++block) {
    const Block& of = instant.blocks[block];
    if ((of.centre - point).norm() - of.radius > near) continue;
    const std::size_t end = std::min((block + 1) * kBlock, instant.places.size());
    for (std::size_t i = block * kBlock; i < end; ++i) {
      const Vec3d from = point - instant.places[i];
      if (from.squaredNorm() > near * near) continue;
      const double above = from.dot(instant.normals[i]);
      if (above <= most) continue;
      most = above;
      highest = i;
    }
  }
  return highest;
}

std::vector<NearPlace> Clearance::find(BladeChain& chain,
                                       const std::function<Values(double)>& values_at,
                                       double margin) const {
  std::vector<NearPlace> found;
  BladePlace blade;
  for (const Instant& instant : instants_) {
    const Values values = values_at(instant.time);
    chain.place({values.data(), chain.size()}, blade, false);
    for (const std::size_t shape : shapes_) {
      const BoneCollider& of_link = tool_->shapes[shape];
      const Collider posed = posed_collider(of_link, chain.frames()[of_link.bone]);
      NearPlace nearest = nearest_at(instant, shape, posed, margin + spacing_);
      if (nearest.distance >= margin + spacing_) continue;
      find_below_corners(instant, shape, posed, nearest);
      if (nearest.distance < margin) found.push_back(nearest);
    }
  }
  return found;
}

}  // namespace sunder::plan
