#pragma once

#include <sunder/core/character.h>
#include <sunder/plan/plan.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/plan/blade_chain.h"
#include "pipeline/plan/link_pairs.h"
#include "pipeline/plan/target_path.h"

namespace sunder::plan {

/// A place of the character's surface that a link comes near.
struct NearPlace {
  double time = 0;
  std::size_t shape = 0;  ///< In PlanTool::shapes.
  Vec3d place = Vec3d::Zero();
  double distance = 0;  ///< Below 0: inside the shape.
  /// Of the surface, if the middle of the shape is below it; otherwise zero.
  Vec3d normal = Vec3d::Zero();
};

/// The distance of a robot's links from a character that moves, and from one another.
class Clearance {
 public:
  /// @param character, tool  kept by reference.
  static Result<Clearance> create(const Character& character, const PlanTool& tool,
                                  const PlanTiming& timing, std::span<const TargetSample> samples);

  [[nodiscard]] bool is_needed() const { return !shapes_.empty(); }
  /// Times at which distances are measured, ascending: at least two.
  [[nodiscard]] std::size_t instants() const { return instants_.size(); }
  [[nodiscard]] std::size_t sample_of(std::size_t instant) const {
    return instants_[instant].sample;
  }

  /// Links that could meet.
  [[nodiscard]] const LinkPairs& pairs() const { return pairs_; }

  /// The least distance of a link from the character at an instant, or from another link, at most
  /// `most`; below 0 inside.
  [[nodiscard]] double least_distance(BladeChain& chain, std::size_t instant, const Values& values,
                                      double most) const;

  /// Whether a blade is above the surface between its base and a place at which it enters it.
  [[nodiscard]] bool is_blade_outside(std::size_t instant, const Vec3d& base,
                                      const Vec3d& entry) const;

  /// Per instant and link the nearest place, if it is nearer than `margin`.
  /// @param values_at  of the joints that move the blade, at a time.
  [[nodiscard]] std::vector<NearPlace> find(BladeChain& chain,
                                            const std::function<Values(double)>& values_at,
                                            double margin) const;

 private:
  /// A ball around places that follow one another.
  struct Block {
    Vec3d centre = Vec3d::Zero();
    double radius = 0;
  };
  struct Instant {
    double time = 0;
    std::size_t sample = 0;
    std::vector<Vec3d> places, normals;
    std::vector<Block> blocks;
  };

  void add_blocks(Instant& instant) const;
  void measure_spacing();
  /// The place of the surface that is nearest to a point. There is at least one.
  /// @param guess  any place; a near one saves time.
  [[nodiscard]] static std::size_t nearest_to(const Instant& instant, const Vec3d& point,
                                              std::size_t guess);
  [[nodiscard]] NearPlace nearest_at(const Instant& instant, std::size_t shape,
                                     const Collider& posed, double margin) const;
  /// Corners of a box may be below the surface between its places.
  /// @param nearest  becomes the place above the deepest of them, if that is nearer.
  void find_below_corners(const Instant& instant, std::size_t shape, const Collider& posed,
                          NearPlace& nearest) const;

  /// The place near a point above whose plane it is highest; empty if none is near.
  [[nodiscard]] std::optional<std::size_t> highest_below(const Instant& instant,
                                                         const Vec3d& point) const;

  explicit Clearance(const PlanTool& tool) : tool_(&tool) {}

  const PlanTool* tool_;
  std::vector<std::size_t> shapes_;  ///< Those that count.
  LinkPairs pairs_;
  std::vector<Instant> instants_;
  double spacing_ = 0;  ///< About the distance of neighbouring places, metres.
};

}  // namespace sunder::plan
