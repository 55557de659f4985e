#include "tools/picture/wound_tensions.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace sunder::tools {
namespace {

/// How far a wound gapes: a share of its length, and of the body's thickness below it.
constexpr double kGapOfLength = 0.07, kGapOfThickness = 0.5;
/// Tension is lowered by this factor while a larger share of the moved surface than this is folded.
constexpr double kLess = 0.75, kFolded = 0.004;
constexpr int kMostTensionTrials = 6;
/// Wounds pull at each other: from the second trial on none of several changes by more than this.
constexpr double kMostChange = 2.5;
/// A gap is near enough to what is wanted: of one wound, and of several.
constexpr double kNearEnough = 0.03, kNearEnoughOfSeveral = 0.1;

constexpr double kUnlimited = std::numeric_limits<double>::infinity();

double doubled_area(const Triangle& triangle, const std::vector<Vec3f>& positions, Vec3f& normal) {
  const Vec3f& a = positions[triangle[0]];
  normal = (positions[triangle[1]] - a).cross(positions[triangle[2]] - a);
  return static_cast<double>(normal.norm());
}

/// The wound that is nearest to a place.
class NearestWound {
 public:
  NearestWound(const GapingModel& model, const std::vector<DeformedMesh>& closed) {
    const TornModel& torn = *model.instance.model();
    std::vector<std::uint32_t> wound_of;
    for (std::uint32_t w = 0; w < model.wounds.size(); ++w)
      for (const LipPair& pair : model.wounds[w].lips) {
        wound_of.resize(std::max<std::size_t>(wound_of.size(), pair.left + std::size_t{1}), kNone);
        wound_of[pair.left] = w;
      }
    lips_.resize(model.wounds.size());
    for (std::uint32_t m = 0; m < closed.size() && lips_.size() > 1; ++m) {
      const Mesh& mesh = torn.character().meshes[m];
      for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t)
        for (std::uint32_t c = 0; c < 3 && !is_retired(mesh.triangles[t]); ++c) {
          const std::uint32_t point = torn.point_at(m, t, c);
          if (point >= wound_of.size() || wound_of[point] == kNone) continue;
          lips_[wound_of[point]].push_back(closed[m].positions[mesh.triangles[t][c]]);
          wound_of[point] = kNone;
        }
    }
    for (const auto& lips : lips_) {
      Vec3f least = Vec3f::Constant(std::numeric_limits<float>::max()), greatest = -least;
      for (const Vec3f& place : lips) {
        least = least.cwiseMin(place);
        greatest = greatest.cwiseMax(place);
      }
      boxes_.emplace_back(least, greatest);
    }
  }

  [[nodiscard]] std::uint32_t to(const Vec3f& place) const {
    std::uint32_t nearest = 0;
    float least = std::numeric_limits<float>::max();
    for (std::uint32_t w = 0; w < lips_.size() && lips_.size() > 1; ++w) {
      const auto& [low, high] = boxes_[w];
      const Vec3f beyond = (low - place).cwiseMax(place - high).cwiseMax(0.0f);
      if (lips_[w].empty() || beyond.squaredNorm() >= least) continue;
      for (const Vec3f& lip : lips_[w])
        if (const float squared_distance = (lip - place).squaredNorm(); squared_distance < least) {
          least = squared_distance;
          nearest = w;
        }
    }
    return nearest;
  }

 private:
  std::vector<std::vector<Vec3f>> lips_;        ///< Per wound.
  std::vector<std::pair<Vec3f, Vec3f>> boxes_;  ///< Per wound: the least and greatest corner.
};

/// Finds wounds whose lips turned the surface beside them over.
class Folds {
 public:
  Folds(const GapingModel& model, std::vector<DeformedMesh> closed)
      : closed_(std::move(closed)), nearest_(model, closed_), count_(model.wounds.size()) {
    for (const Mesh& mesh : model.instance.character().meshes)
      wounds_.emplace_back(mesh.triangles.size(), kNone);
  }

  /// Per wound: the share of the area that it moved which is folded.
  [[nodiscard]] std::vector<double> shares(CharacterInstance& instance) {
    const std::vector<DeformedMesh> open = drawn(instance);
    std::vector<double> folded(count_, 0), moved(count_, 0);
    for (std::size_t m = 0; m < open.size(); ++m) {
      const std::vector<Triangle>& triangles = instance.character().meshes[m].triangles;
      for (std::size_t t = 0; t < triangles.size(); ++t) {
        Vec3f before, after;
        const double area = doubled_area(triangles[t], closed_[m].positions, before);
        (void)doubled_area(triangles[t], open[m].positions, after);
        if ((before - after).norm() < 0.01f * before.norm()) continue;
        std::uint32_t& wound = wounds_[m][t];
        if (wound == kNone) wound = nearest_.to(closed_[m].positions[triangles[t][0]]);
        moved[wound] += area;
        if (before.dot(after) < 0) folded[wound] += area;
      }
    }
    for (std::size_t w = 0; w < count_; ++w) folded[w] = moved[w] > 0 ? folded[w] / moved[w] : 0;
    return folded;
  }

 private:
  std::vector<DeformedMesh> closed_;
  NearestWound nearest_;
  std::size_t count_;
  std::vector<std::vector<std::uint32_t>> wounds_;  ///< Per triangle, once it is known.
};

/// The tension of one wound while it is searched for.
struct WoundTension {
  double newtons_per_metre = 0;
  double widest = kUnlimited;  ///< The greatest without folds.
  bool has_wish = false;       ///< A cut gapes as the others let it.
};

/// The factor by which a wound may be pulled more.
double room(const GapingModel& model, std::size_t wound, double thickness) {
  const Wound& of = model.wounds[wound];
  const double gap = widest_gap(model.instance, of);
  const double wanted = std::min(kGapOfLength * of.length, kGapOfThickness * thickness);
  return gap > 0 && of.length > 0 ? wanted / gap : kUnlimited;
}

/// Cuts are pulled as the wound that is pulled least.
void follow_others(std::vector<WoundTension>& tensions) {
  double least = kUnlimited;
  for (const WoundTension& of : tensions)
    if (of.has_wish) least = std::min(least, of.newtons_per_metre);
  for (WoundTension& of : tensions)
    if (!of.has_wish && least < kUnlimited) of.newtons_per_metre = std::min(least, of.widest);
}

/// One tension for all, with the share of each wound.
void set_shares(const std::vector<WoundTension>& tensions, GapingModel& model) {
  double greatest = 0;
  for (const WoundTension& of : tensions) greatest = std::max(greatest, of.newtons_per_metre);
  if (!(greatest > 0)) return;
  model.tension.newtons_per_metre = greatest;
  std::vector<float>& shares = model.tension.shares;
  shares.clear();
  for (std::size_t w = 0; w < tensions.size(); ++w) {
    const auto share = static_cast<float>(tensions[w].newtons_per_metre / greatest);
    if (share == 1) continue;
    for (const LipPair& pair : model.wounds[w].lips)
      for (const std::uint32_t point : {pair.left, pair.right}) {
        shares.resize(std::max<std::size_t>(shares.size(), point + std::size_t{1}), 1.0f);
        shares[point] = std::min(shares[point], share);
      }
  }
}

/// One step of the search. @return whether all wounds gape as they are wanted to.
bool adjust(const GapingModel& model, std::span<const double> thicknesses,
            const std::vector<double>& folded, bool is_first, std::vector<WoundTension>& tensions) {
  const bool is_one = tensions.size() == 1;
  const double near = is_one ? kNearEnough : kNearEnoughOfSeveral;
  bool is_enough = true;
  for (std::size_t w = 0; w < tensions.size(); ++w) {
    WoundTension& of = tensions[w];
    double factor = room(model, w, thicknesses[w]);
    of.has_wish = factor != kUnlimited;
    if (!of.has_wish) factor = 1;
    if (!is_one && !is_first) factor = std::clamp(factor, 1 / kMostChange, kMostChange);
    if (folded[w] > kFolded) of.widest = kLess * of.newtons_per_metre;
    factor = std::min(factor, of.widest / of.newtons_per_metre);
    if (factor > 1 - near && factor < 1 + near) continue;
    is_enough = false;
    of.newtons_per_metre *= factor;
  }
  return is_enough;
}

}  // namespace

Status choose_tensions(GapingModel& model, const ModelPose& pose,
                       std::span<const double> thicknesses) {
  const Result<CharacterInstance::TissueState> closed = model.instance.tissue();
  if (!closed) return closed.error();
  Result<std::vector<DeformedMesh>> posed = deform_model(model.instance.character(), pose);
  if (!posed) return posed.error();
  Folds folds(model, std::move(*posed));
  std::vector<WoundTension> tensions(model.wounds.size(), {model.tension.newtons_per_metre});
  for (int i = 0; i < kMostTensionTrials && !tensions.empty(); ++i) {
    if (const Status status = open_lips(model.instance, pose); !status) return status;
    const bool is_enough =
        adjust(model, thicknesses, folds.shares(model.instance), i == 0, tensions);
    if (const Status status = model.instance.restore_tissue(*closed); !status) return status;
    if (!is_enough) {
      follow_others(tensions);
      set_shares(tensions, model);
    }
    if (const Status status = model.instance.body()->set_tension(model.tension); !status)
      return status;
    if (is_enough) break;
  }
  return {};
}

}  // namespace sunder::tools
