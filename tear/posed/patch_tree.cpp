#include "tear/posed/patch_tree.h"

#include <cmath>
#include <limits>

#include "core/internal/ordered.h"
#include "tear/geometry/tolerances.h"
#include "tear/posed/byte_lanes.h"
#include "tear/posed/hilbert_curve.h"

namespace sunder::tear {
namespace {

constexpr std::size_t kMaximumSlots = std::size_t{1} << 16;

/// A box as its low corner and its negated high corner, each with a fourth lane, so that both grow
/// by taking the minimum.
struct GrowingBox {
  std::array<float, 8> least;

  GrowingBox() { least.fill(std::numeric_limits<float>::infinity()); }
  explicit GrowingBox(const Vec3f& p) : least{p.x(), p.y(), p.z(), 0, -p.x(), -p.y(), -p.z(), 0} {}
  void extend(const GrowingBox& other) {
    const std::array<float, 8> a = other.least, b = least;  // copies are no aliases
    for (std::size_t i = 0; i < 8; ++i) least[i] = a[i] < b[i] ? a[i] : b[i];
  }
  [[nodiscard]] float low(std::size_t axis) const { return least[axis]; }
  [[nodiscard]] float high(std::size_t axis) const { return -least[4 + axis]; }
  [[nodiscard]] bool is_zero() const {
    return std::all_of(least.begin(), least.end(), [](float value) { return value == 0.0f; });
  }
  void widen() {
    for (float& value : least) value -= kNewVertexCoordinates * std::abs(value);
  }
};

/// The corners of a group of triangles, by their vertices, of which most are at several corners:
/// the influences of each are read once.
class GroupCorners {
 public:
  struct OfVertex {
    Index vertex;
    Index corners;         ///< How many corners are at it.
    GrowingBox triangles;  ///< Around the triangles of these corners.
  };

  void clear() {
    slots_.fill(kNone);
    vertices_.clear();
  }
  void add(Index vertex, const GrowingBox& triangle) {
    std::size_t at = vertex * 0x9E3779B1u >> (32 - kSlotBits);
    for (; slots_[at] != kNone; at = (at + 1) % kSlots)
      if (vertices_[slots_[at]].vertex == vertex) {
        OfVertex& known = vertices_[slots_[at]];
        ++known.corners;
        known.triangles.extend(triangle);
        return;
      }
    slots_[at] = static_cast<Index>(vertices_.size());
    vertices_.push_back({vertex, 1, triangle});
  }
  /// In the order in which they came.
  [[nodiscard]] std::span<const OfVertex> vertices() const { return vertices_; }

 private:
  static constexpr std::uint32_t kSlotBits = 8;
  static constexpr std::size_t kSlots = std::size_t{1} << kSlotBits;
  static_assert(kSlots > 3 * PatchTree::kGroupSize);

  std::array<Index, kSlots> slots_;  ///< Indices of vertices_, at the hashes of the vertices.
  std::vector<OfVertex> vertices_;
};

/// The triangles in the order of their centres along a Hilbert curve through bind space.
std::vector<Index> order_along_curve(const Mesh& mesh, std::span<const Triangle> triangles) {
  // TornModel refuses models with more triangles than fit into kIndexBits.
  constexpr std::uint32_t kIndexBits = 30, kDigitBits = HilbertCurve::kBits;
  std::vector<Vec3f> middles(triangles.size());
  GrowingBox box;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto& [a, b, c] = triangles[t];
    middles[t] = (1.0f / 3) * mesh.positions[a] + (1.0f / 3) * mesh.positions[b] +
                 (1.0f / 3) * mesh.positions[c];
    box.extend(GrowingBox(middles[t]));
  }
  double size = 0;
  for (std::size_t k = 0; k < 3; ++k)
    size = std::max(size, static_cast<double>(box.high(k)) - static_cast<double>(box.low(k)));
  constexpr std::uint32_t kCells = 1u << HilbertCurve::kBits;
  const double cells = size > 0 ? (kCells - 1) / size : 0;
  std::vector<std::uint64_t> keys(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    std::array<std::uint32_t, 3> cell;
    for (std::size_t k = 0; k < 3; ++k)
      cell[k] =
          static_cast<std::uint32_t>(cells * (static_cast<double>(middles[t][static_cast<int>(k)]) -
                                              static_cast<double>(box.low(k))));
    keys[t] = HilbertCurve::number_of(cell) << kIndexBits | t;
  }

  if (keys.size() < 4096) {
    std::sort(keys.begin(), keys.end());
  } else {  // least digit first; stable, so that the indices at the end of the keys stay ordered
    std::vector<std::uint64_t> sorted(keys.size());
    for (std::uint32_t digit = 0; digit < 3; ++digit) {
      const std::uint32_t shift = kIndexBits + digit * kDigitBits;
      std::array<Index, std::size_t{1} << kDigitBits> begin{};
      for (const std::uint64_t key : keys) ++begin[(key >> shift) % begin.size()];
      Index sum = 0;
      for (Index& first : begin) {
        const Index count = first;
        first = sum;
        sum += count;
      }
      for (const std::uint64_t key : keys) sorted[begin[(key >> shift) % begin.size()]++] = key;
      keys.swap(sorted);
    }
  }
  std::vector<Index> order(keys.size());
  for (std::size_t i = 0; i < keys.size(); ++i)
    order[i] = static_cast<Index>(keys[i] & ((std::uint64_t{1} << kIndexBits) - 1));
  return order;
}

}  // namespace

/// Builds the nodes one after the other.
class PatchTree::Builder {
 public:
  Builder(const Mesh& mesh, PatchTree& tree) : mesh_(mesh), tree_(tree) {
    for (Index j = 0; j < mesh.morph_targets.size(); ++j)
      if (!mesh.morph_targets[j].position_deltas.empty()) targets_.push_back(j);
  }

  void add_group(std::span<const Triangle> triangles, std::span<const Index> order) {
    box_ = {};
    std::array<GrowingBox, kPatchesPerGroup> patches;
    corners_.clear();
    for (std::size_t i = 0; i < order.size(); ++i) {
      const Triangle& triangle = triangles[order[i]];
      GrowingBox of_triangle(mesh_.positions[triangle[0]]);
      of_triangle.extend(GrowingBox(mesh_.positions[triangle[1]]));
      of_triangle.extend(GrowingBox(mesh_.positions[triangle[2]]));
      patches[i / kPatchSize].extend(of_triangle);
      for (const Index vertex : triangle) corners_.add(vertex, of_triangle);
    }
    std::size_t most_influences = 0;
    for (const GroupCorners::OfVertex& of : corners_.vertices()) {
      const auto influences = mesh_.weights.of(of.vertex);
      most_influences = std::max(most_influences, influences.size());
      for (const Influence& influence : influences) {
        Moved& moved = moved_by(influence.slot);
        moved.corners += of.corners;
        moved.least = std::min(moved.least, influence.weight);
        moved.greatest = std::max(moved.greatest, influence.weight);
        moved.box.extend(of.triangles);
      }
    }
    const double slack = kWeightSumPerInfluence * static_cast<double>(most_influences + 1);
    tree_.weight_slack_ = std::max(tree_.weight_slack_, static_cast<float>(slack));
    const std::size_t patch_count = (order.size() + kPatchSize - 1) / kPatchSize;
    for (GrowingBox& patch : std::span(patches).first(patch_count)) {
      patch.widen();
      box_.extend(patch);
    }
    for (const GrowingBox& patch : std::span(patches).first(patch_count))
      tree_.patches_.push_back(within_box(patch));
    for (Moved& moved : moved_) {
      moved.box.widen();
      const double least =
          moved.corners < 3 * order.size() ? 0.0 : static_cast<double>(moved.least);
      moved.least_parts =
          static_cast<std::uint16_t>(least * (1 - 4 * slack) * double{kWeightParts});
      moved.greatest_parts = static_cast<std::uint16_t>(std::min(
          65535.0,
          std::ceil(static_cast<double>(moved.greatest) * (1 + 4 * slack) * double{kWeightParts})));
    }
    for (const Index j : targets_) {
      GrowingBox displacement;
      for (const Index t : order)
        for (const Index vertex : triangles[t])
          displacement.extend(GrowingBox(mesh_.morph_targets[j].position_deltas[vertex]));
      displacement.widen();
      if (!displacement.is_zero()) tree_.morphs_.push_back({j, stored(displacement)});
    }
    finish_node();
  }

  /// @param first, count  of its children, in nodes_.
  void add_parent(Index first, Index count) {
    box_ = {};
    for (Index child = first; child < first + count; ++child) {
      box_.extend(grown(tree_.nodes_[child].bind));
      for (Index i = first_bone(child); i < first_bone(child + 1); ++i) {
        const NodeBone& bone = tree_.bones_[i];
        Moved& moved = moved_by(bone.slot);
        if (moved.corners++ == 0) moved.least_parts = bone.least_weight;
        moved.least_parts = std::min(moved.least_parts, bone.least_weight);
        moved.greatest_parts = std::max(moved.greatest_parts, bone.greatest_weight);
        moved.box.extend(box_of(bone, tree_.nodes_[child].bind));
      }
    }
    for (Moved& moved : moved_)
      if (moved.corners < count) moved.least_parts = 0;
    for (const Index j : targets_) {
      GrowingBox displacement;
      for (Index child = first; child < first + count; ++child) {
        const auto of_child =
            std::span(tree_.morphs_)
                .subspan(tree_.first_morph_[child],
                         tree_.first_morph_[child + 1] - tree_.first_morph_[child]);
        const auto found = std::find_if(of_child.begin(), of_child.end(),
                                        [&](const NodeMorph& morph) { return morph.target == j; });
        displacement.extend(found == of_child.end() ? GrowingBox(Vec3f::Zero())
                                                    : grown(found->displacement));
      }
      if (!displacement.is_zero()) tree_.morphs_.push_back({j, stored(displacement)});
    }
    finish_node();
  }

  /// Begins the next node. Called once more after the last one.
  void begin_node() {
    tree_.nodes_.push_back({{}, static_cast<Index>(tree_.bones_.size())});
    if (!targets_.empty()) tree_.first_morph_.push_back(static_cast<Index>(tree_.morphs_.size()));
  }

 private:
  struct Moved {
    Index slot = 0;
    Index corners = 0;  ///< Number of corners that the bone moves; of a parent, number of children.
    float least = std::numeric_limits<float>::infinity(), greatest = 0;
    std::uint16_t least_parts = 0, greatest_parts = 0;
    GrowingBox box;
  };

  Moved& moved_by(Index slot) {
    if (slot >= place_of_slot_.size()) place_of_slot_.resize(slot + std::size_t{1}, kNone);
    Index& place = place_of_slot_[slot];
    if (place == kNone) {
      place = static_cast<Index>(moved_.size());
      moved_.emplace_back().slot = slot;
    }
    return moved_[place];
  }

  [[nodiscard]] Index first_bone(Index node) const { return tree_.nodes_[node].first_bone; }

  static FloatBox stored(const GrowingBox& box) {
    return {{box.low(0), box.low(1), box.low(2), 0}, {box.high(0), box.high(1), box.high(2), 0}};
  }
  static GrowingBox grown(const FloatBox& box) {
    GrowingBox result(Vec3f(box.low[0], box.low[1], box.low[2]));
    result.extend(GrowingBox(Vec3f(box.high[0], box.high[1], box.high[2])));
    return result;
  }
  /// Rounded outward.
  static GrowingBox box_of(const NodeBone& bone, const FloatBox& within) {
    FloatBox box;
    for (std::size_t k = 0; k < 3; ++k) {
      const double low = static_cast<double>(within.low[k]),
                   high = static_cast<double>(within.high[k]);
      const double part = (high - low) / double{kBoxParts};
      constexpr float kInfinity = std::numeric_limits<float>::infinity();
      box.low[k] = std::nextafter(static_cast<float>(low + bone.box.low[k] * part), -kInfinity);
      box.high[k] = std::nextafter(static_cast<float>(high - bone.box.high[k] * part), kInfinity);
    }
    return grown(box);
  }

  /// Rounded outward, within the node's box.
  [[nodiscard]] InnerBox within_box(const GrowingBox& inner) const {
    InnerBox result{};
    for (std::size_t k = 0; k < 3; ++k) {
      const double low = static_cast<double>(box_.low(k)), high = static_cast<double>(box_.high(k));
      const double parts = high > low ? double{kBoxParts} / (high - low) : 0;
      const auto whole = [&](double distance) {
        return static_cast<std::uint8_t>(std::clamp(distance * parts, 0.0, double{kBoxParts}));
      };
      result.low[k] = whole(static_cast<double>(inner.low(k)) - low);
      result.high[k] = whole(high - static_cast<double>(inner.high(k)));
    }
    return result;
  }

  void finish_node() {
    Node& node = tree_.nodes_.back();
    node.bind = stored(box_);
    const std::size_t first = tree_.bones_.size();
    std::size_t main = 0;
    for (std::size_t i = 0; i < moved_.size(); ++i) {
      const Moved& moved = moved_[i];
      place_of_slot_[moved.slot] = kNone;
      tree_.is_bounded_ = tree_.is_bounded_ && moved.slot < kMaximumSlots;
      tree_.bones_.push_back({static_cast<std::uint16_t>(moved.slot), moved.least_parts,
                              moved.greatest_parts, within_box(moved.box)});
      const auto weight = [&](const Moved& of) {
        return int{of.least_parts} + int{of.greatest_parts};
      };
      if (weight(moved) > weight(moved_[main])) main = i;
    }
    if (!moved_.empty()) std::swap(tree_.bones_[first], tree_.bones_[first + main]);
    moved_.clear();
  }

  const Mesh& mesh_;
  PatchTree& tree_;
  std::vector<Index> targets_;        ///< The targets that displace positions.
  GrowingBox box_;                    ///< Of the node.
  GroupCorners corners_;              ///< Of the group.
  std::vector<Moved> moved_;          ///< One per bone that moves the node.
  std::vector<Index> place_of_slot_;  ///< Index into moved_.
};

PatchTree::PatchTree(const Mesh& mesh, std::span<const Triangle> triangles, Index first_origin)
    : origins_(order_along_curve(mesh, triangles)) {
  const auto parts_of = [](Index count, Index size) { return (count + size - 1) / size; };
  const auto triangle_count = static_cast<Index>(triangles.size());
  const Index group_count = parts_of(triangle_count, kGroupSize);
  first_of_level_ = {0, group_count};
  for (Index count = group_count; count > 1;
       first_of_level_.push_back(first_of_level_.back() + count))
    count = parts_of(count, kFanOut);
  nodes_.reserve(first_of_level_.back() + std::size_t{1});
  patches_.reserve(parts_of(triangle_count, kPatchSize));

  Builder builder(mesh, *this);
  for (Index group = 0; group < group_count; ++group) {
    builder.begin_node();
    builder.add_group(triangles, part_of(origins_, group, kGroupSize));
  }
  for (Index level = 1; level < level_count(); ++level)
    for (Index number = 0; number < node_count(level); ++number) {
      builder.begin_node();
      const Index first = kFanOut * number;
      builder.add_parent(first_of_level_[level - 1] + first,
                         std::min(kFanOut, node_count(level - 1) - first));
    }
  builder.begin_node();
  bones_.shrink_to_fit();
  morphs_.shrink_to_fit();
  first_morph_.shrink_to_fit();
  for (Index& origin : origins_) origin += first_origin;
}

std::size_t PatchTree::bytes() const {
  const auto bytes_of = [](const auto& values) { return values.capacity() * sizeof(values[0]); };
  return bytes_of(origins_) + bytes_of(patches_) + bytes_of(nodes_) + bytes_of(bones_) +
         bytes_of(morphs_) + bytes_of(first_morph_);
}

/// Bounds of the posed boxes of a node.
class PatchTree::Bound {
 public:
  Bound(const PatchTree& tree, Index node, const MeshPose& pose)
      : tree_(tree),
        bones_(tree.bones_of(node)),
        reach_(static_cast<float>(pose.bones.frame().reach())) {
    const Eigen::Map<const Lanes> low(tree.nodes_[node].bind.low.data()),
        high(tree.nodes_[node].bind.high.data());
    half_part_ = (0.5f / kBoxParts) * (high - low);
    largest_ = low.abs().max(high.abs());
    whole_ = {0.5f * low + 0.5f * high, 0.5f * (high - low)};
    if (!tree.first_morph_.empty()) add_morphs(node, pose);
    is_bounded_ = is_bounded_ && largest_.maxCoeff() < kLargestPosedMetres;
    whole_.half += kFloatSumCoordinates * largest_;
  }

  using Lanes = PosedBones::Lanes;
  struct BindBox {
    Lanes middle, half;
  };
  [[nodiscard]] EIGEN_ALWAYS_INLINE BindBox bind_box(const InnerBox& inner) const {
    const Lanes low = lanes_of(inner.low), high = lanes_of(inner.high);
    return {whole_.middle + half_part_ * (low - high), whole_.half - half_part_ * (low + high)};
  }

  struct Interval {
    Lanes low, high;
  };
  /// M_i B_i, in the axes of the given bone.
  EIGEN_ALWAYS_INLINE static Interval posed(const PosedBones::Bone& bone, const BindBox& box) {
    const Lanes middle =
        bone.translation + bone.x * box.middle[0] + bone.y * box.middle[1] + bone.z * box.middle[2];
    const Lanes half = bone.rounding + bone.size_of_x * box.half[0] + bone.size_of_y * box.half[1] +
                       bone.size_of_z * box.half[2];
    return {middle - half, middle + half};
  }

  /// Bounds of a weighted mean of points, each from one of several intervals.
  struct Mean {
    Interval main, hull, sum;

    EIGEN_ALWAYS_INLINE void begin(const Interval& interval) { main = hull = sum = interval; }
    EIGEN_ALWAYS_INLINE void add(const Interval& interval) {
      hull.low = hull.low.min(interval.low);
      hull.high = hull.high.max(interval.high);
    }
    EIGEN_ALWAYS_INLINE void add(const Interval& interval, const NodeBone& bone) {
      add(interval);
      // w_main = 1 - sum of the others: each other bone moves the mean from the main bone's image
      // towards its own.
      const float least = bone.least_weight * (1 / kWeightParts),
                  greatest = bone.greatest_weight * (1 / kWeightParts);
      const Lanes down = interval.low - main.low, up = interval.high - main.high;
      sum.low += (least * down).min(greatest * down);
      sum.high += (least * up).max(greatest * up);
    }
  };
  /// The bound; everything if numbers may have overflowed.
  [[nodiscard]] Interval result(const Mean& mean) const {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    const Lanes largest = mean.hull.low.abs().max(mean.hull.high.abs());
    if (!is_bounded_ || largest.maxCoeff() > 0.1f * PosedBones::kEverywhere)
      return {Lanes::Constant(-kInfinity), Lanes::Constant(kInfinity)};
    const auto terms = static_cast<float>(bones_.size() + 4);
    const Lanes slack = tree_.weight_slack_ * (largest + reach_) +
                        terms * kFloatTerms * (largest + terms * (mean.hull.high - mean.hull.low));
    return {mean.hull.low.max(mean.sum.low) - slack, mean.hull.high.min(mean.sum.high) + slack};
  }

  [[nodiscard]] std::span<const NodeBone> bones() const { return bones_; }
  /// Largest absolute coordinates of the box of the node.
  [[nodiscard]] const Lanes& largest() const { return largest_; }

  /// The bounds of the patches of the node, which is a group. @param bone_of  returns the bone of a
  /// slot.
  template <class BoneOf>
  Index gather_patches(Index group, BoneOf bone_of,
                       std::array<Mean, kPatchesPerGroup>& means) const {
    const Index first = kPatchesPerGroup * group,
                count = std::min(kPatchesPerGroup, tree_.patch_count() - first);
    std::array<BindBox, kPatchesPerGroup> boxes;
    for (Index i = 0; i < count; ++i) boxes[i] = bind_box(tree_.patches_[first + i]);
    const PosedBones::Bone& main = bone_of(bones_[0].slot);
    for (Index i = 0; i < count; ++i) means[i].begin(posed(main, boxes[i]));
    for (const NodeBone& moved : bones_.subspan(1)) {
      const PosedBones::Bone& bone = bone_of(moved.slot);
      for (Index i = 0; i < count; ++i) means[i].add(posed(bone, boxes[i]), moved);
    }
    return count;
  }

  static FrameBox box(const Interval& interval) {
    return {interval.low.head<3>().cast<double>(), interval.high.head<3>().cast<double>()};
  }

 private:
  void add_morphs(Index node, const MeshPose& pose) {
    std::array<double, 3> middle{}, half{}, largest{};
    for (Index i = tree_.first_morph_[node]; i < tree_.first_morph_[node + 1]; ++i) {
      const double weight = static_cast<double>(pose.morph_weights[tree_.morphs_[i].target]);
      for (std::size_t k = 0; k < 3; ++k) {
        const double a = weight * static_cast<double>(tree_.morphs_[i].displacement.low[k]);
        const double b = weight * static_cast<double>(tree_.morphs_[i].displacement.high[k]);
        middle[k] += 0.5 * (a + b);
        half[k] += 0.5 * std::abs(a - b);
        largest[k] += std::max(std::abs(a), std::abs(b));
      }
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const auto lane = static_cast<Eigen::Index>(k);
      largest_[lane] += static_cast<float>(std::min(largest[k], kLargestMorphMetres));
      if (!(largest[k] < kLargestMorphMetres)) continue;
      whole_.middle[lane] += static_cast<float>(middle[k]);
      whole_.half[lane] += static_cast<float>(half[k]);
    }
  }

  const PatchTree& tree_;
  std::span<const NodeBone> bones_;
  float reach_;
  BindBox whole_;    ///< The box of the node, morph displacements included.
  Lanes half_part_;  ///< Half of the unit of inner boxes.
  Lanes largest_;    ///< Largest absolute coordinates of the node.
  bool is_bounded_ = tree_.is_bounded_;
};

PatchTree::FloatBox PatchTree::compute_posed_box(Index node, const MeshPose& pose) const {
  const Bound bound(*this, node, pose);
  Bound::Mean mean;
  const std::span<const NodeBone> bones = bound.bones();
  mean.begin(Bound::posed(pose.bones.at(bones[0].slot), bound.bind_box(bones[0].box)));
  if (bones.size() <= kFewBones) {
    for (const NodeBone& bone : bones.subspan(1))
      mean.add(Bound::posed(pose.bones.at(bone.slot), bound.bind_box(bone.box)), bone);
  } else {
    for (const NodeBone& bone : bones.subspan(1))
      mean.add(Bound::posed(pose.bones.at(bone.slot), bound.bind_box(bone.box)));
    mean.sum = mean.hull;
  }
  const Bound::Interval interval = bound.result(mean);
  FloatBox box;
  Eigen::Map<Bound::Lanes>(box.low.data()) = interval.low;
  Eigen::Map<Bound::Lanes>(box.high.data()) = interval.high;
  return box;
}

Index PatchTree::compute_posed_patches(Index group, const MeshPose& pose,
                                       std::array<FrameBox, kPatchesPerGroup>& boxes) const {
  std::array<Bound::Mean, kPatchesPerGroup> means;
  const Bound bound(*this, group, pose);
  const auto bone_of = [&](Index slot) -> const PosedBones::Bone& { return pose.bones.at(slot); };
  const Index count = bound.gather_patches(group, bone_of, means);
  for (Index i = 0; i < count; ++i) boxes[i] = Bound::box(bound.result(means[i]));
  return count;
}

Index PatchTree::compute_posed_patches(Index group, const MeshPose& pose,
                                       std::array<Shadow, kPatchesPerGroup>& shadows) const {
  // The parallels follow the projected edges of the group's box, rotated by its main bone.
  const Bound bound(*this, group, pose);
  const PosedBones::Bone& main = pose.bones.at(bound.bones()[0].slot);
  std::array<Vec2f, 3> normal;
  const std::array<const Bound::Lanes*, 3> edges = {&main.x, &main.y, &main.z};
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec2f across(-(*edges[k])[2], (*edges[k])[1]);
    const float length = norm(across);
    normal[k] = length > kShortestSideMetres && length < kLongestSideMetres
                    ? Vec2f(across / length)
                    : Vec2f(k == 0 ? 1 : 0, k == 0 ? 0 : 1);
  }
  const Bound::Lanes along(1, 0, 0, 0), second(0, normal[0].x(), normal[1].x(), normal[2].x()),
      third(0, normal[0].y(), normal[1].y(), normal[2].y());
  PosedBones::Bone seen;
  const auto see = [&](const Bound::Lanes& from) -> Bound::Lanes {
    return along * from[0] + second * from[1] + third * from[2];
  };
  const auto bone_of = [&](Index slot) -> const PosedBones::Bone& {
    const PosedBones::Bone& bone = pose.bones.at(slot);
    seen.x = see(bone.x);
    seen.y = see(bone.y);
    seen.z = see(bone.z);
    seen.translation = see(bone.translation);
    seen.size_of_x = seen.x.abs();
    seen.size_of_y = seen.y.abs();
    seen.size_of_z = seen.z.abs();
    // A rotated number inherits the errors of the numbers that it was computed from.
    const Bound::Lanes reach = bone.translation.abs() + bone.size_of_x * bound.largest()[0] +
                               bone.size_of_y * bound.largest()[1] +
                               bone.size_of_z * bound.largest()[2];
    seen.rounding.setConstant(2 * bone.rounding.maxCoeff() +
                              kFloatCoordinates * reach.head<3>().sum());
    return seen;
  };
  std::array<Bound::Mean, kPatchesPerGroup> means;
  const Index count = bound.gather_patches(group, bone_of, means);
  for (Index i = 0; i < count; ++i) {
    const Eigen::Array4d low = bound.result(means[i]).low.cast<double>(),
                         high = bound.result(means[i]).high.cast<double>();
    Shadow& shadow = shadows[i];
    shadow.low = low[0];
    shadow.high = high[0];
    shadow.from = {low[1], low[2], low[3]};
    shadow.to = {high[1], high[2], high[3]};
    for (std::size_t k = 0; k < 3; ++k) shadow.normal[k] = normal[k].cast<double>();
  }
  return count;
}

}  // namespace sunder::tear
