#include "tear/patch_tree.h"

#include <cmath>
#include <limits>

#include "tear/hilbert_curve.h"

namespace sunder::tear {
namespace {

constexpr double kWeightParts = 65000;  // less than 2^16: weights may be a little above 1
constexpr double kBoxParts = 255;
constexpr std::size_t kMaximumSlots = std::size_t{1} << 16;

/// What stored positions and weights of new vertices may lie beside their origin's: each is rounded to float once, and a wall that
/// grows on a wall rounds again.
constexpr float kRounding = 0x1p-20f;

/// Low corner and negated high corner, each with a fourth lane, so that both grow by taking the lesser.
struct GrowingBox {
  std::array<float, 8> least;

  GrowingBox() { least.fill(std::numeric_limits<float>::infinity()); }
  explicit GrowingBox(const Vec3f& p) : least{p.x(), p.y(), p.z(), 0, -p.x(), -p.y(), -p.z(), 0} {}
  void extend(const GrowingBox& other) {
    for (std::size_t i = 0; i < 8; ++i) least[i] = other.least[i] < least[i] ? other.least[i] : least[i];
  }
  [[nodiscard]] float low(std::size_t axis) const { return least[axis]; }
  [[nodiscard]] float high(std::size_t axis) const { return -least[4 + axis]; }
  [[nodiscard]] bool is_zero() const {
    return std::all_of(least.begin(), least.end(), [](float value) { return value == 0.0f; });
  }
  void widen() {
    for (float& value : least) value -= kRounding * std::abs(value);
  }
};

/// Triangles of a mesh in the order in which a Hilbert curve through bind space comes to their middles.
std::vector<Index> order_along_curve(const Mesh& mesh, std::span<const Triangle> triangles) {
  constexpr std::uint32_t kIndexBits = 30, kDigitBits = HilbertCurve::kBits;  // TornModel refuses more triangles than that
  std::vector<Vec3f> middles(triangles.size());
  GrowingBox box;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto& [a, b, c] = triangles[t];
    middles[t] = (1.0f / 3) * mesh.positions[a] + (1.0f / 3) * mesh.positions[b] + (1.0f / 3) * mesh.positions[c];
    box.extend(GrowingBox(middles[t]));
  }
  double size = 0;
  for (std::size_t k = 0; k < 3; ++k) size = std::max(size, static_cast<double>(box.high(k)) - static_cast<double>(box.low(k)));
  constexpr std::uint32_t kCells = 1u << HilbertCurve::kBits;
  const double cells = size > 0 ? (kCells - 1) / size : 0;
  std::vector<std::uint64_t> keys(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    std::array<std::uint32_t, 3> cell;
    for (std::size_t k = 0; k < 3; ++k)
      cell[k] = static_cast<std::uint32_t>(
          cells * (static_cast<double>(middles[t][static_cast<int>(k)]) - static_cast<double>(box.low(k))));
    keys[t] = HilbertCurve::number_of(cell) << kIndexBits | t;
  }

  if (keys.size() < 4096) {
    std::sort(keys.begin(), keys.end());
  } else {  // least digit first: stable, so that the numbers at the keys' end stay in order
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
  for (std::size_t i = 0; i < keys.size(); ++i) order[i] = static_cast<Index>(keys[i] & ((std::uint64_t{1} << kIndexBits) - 1));
  return order;
}

}  // namespace

/// Describes nodes one after the other.
class PatchTree::Builder {
 public:
  Builder(const Mesh& mesh, PatchTree& tree) : mesh_(mesh), tree_(tree) {
    for (Index j = 0; j < mesh.morph_targets.size(); ++j)
      if (!mesh.morph_targets[j].position_deltas.empty()) targets_.push_back(j);
  }

  void add_patch(std::span<const Triangle> triangles, std::span<const Index> order) {
    box_ = {};
    std::uint32_t stamp = 0;
    std::size_t most_influences = 0;
    for (const Index t : order) {
      const Triangle& triangle = triangles[t];
      GrowingBox of_triangle(mesh_.positions[triangle[0]]);
      of_triangle.extend(GrowingBox(mesh_.positions[triangle[1]]));
      of_triangle.extend(GrowingBox(mesh_.positions[triangle[2]]));
      box_.extend(of_triangle);
      ++stamp;
      for (const Index vertex : triangle) {
        const auto influences = mesh_.weights.of(vertex);
        most_influences = std::max(most_influences, influences.size());
        for (const Influence& influence : influences) {
          Moved& moved = moved_by(influence.slot);
          ++moved.corners;
          moved.least = std::min(moved.least, influence.weight);
          moved.greatest = std::max(moved.greatest, influence.weight);
          if (moved.stamp == stamp) continue;
          moved.stamp = stamp;
          moved.box.extend(of_triangle);
        }
      }
    }
    const double slack = 2e-7 * static_cast<double>(most_influences + 1);
    tree_.weight_slack_ = std::max(tree_.weight_slack_, slack);
    box_.widen();
    for (Moved& moved : moved_) {
      moved.box.widen();
      const double least = moved.corners < 3 * order.size() ? 0.0 : static_cast<double>(moved.least);
      moved.least_parts = static_cast<std::uint16_t>(least * (1 - 4 * slack) * kWeightParts);
      moved.greatest_parts = static_cast<std::uint16_t>(
          std::min(65535.0, std::ceil(static_cast<double>(moved.greatest) * (1 + 4 * slack) * kWeightParts)));
    }
    for (const Index j : targets_) {
      GrowingBox displacement;
      for (const Index t : order)
        for (const Index vertex : triangles[t]) displacement.extend(GrowingBox(mesh_.morph_targets[j].position_deltas[vertex]));
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
            std::span(tree_.morphs_).subspan(tree_.first_morph_[child], tree_.first_morph_[child + 1] - tree_.first_morph_[child]);
        const auto found =
            std::find_if(of_child.begin(), of_child.end(), [&](const NodeMorph& morph) { return morph.target == j; });
        displacement.extend(found == of_child.end() ? GrowingBox(Vec3f::Zero()) : grown(found->displacement));
      }
      if (!displacement.is_zero()) tree_.morphs_.push_back({j, stored(displacement)});
    }
    finish_node();
  }

  /// Begins the next node. Once more after the last.
  void begin_node() {
    tree_.nodes_.push_back({{}, static_cast<Index>(tree_.bones_.size())});
    if (!targets_.empty()) tree_.first_morph_.push_back(static_cast<Index>(tree_.morphs_.size()));
  }

 private:
  struct Moved {
    Index slot = 0;
    Index corners = 0;  ///< That the bone moves; of a parent, children.
    std::uint32_t stamp = 0;
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
    return {{{box.low(0), box.low(1), box.low(2)}, {box.high(0), box.high(1), box.high(2)}}};
  }
  static GrowingBox grown(const FloatBox& box) {
    GrowingBox result(Vec3f(box[0][0], box[0][1], box[0][2]));
    result.extend(GrowingBox(Vec3f(box[1][0], box[1][1], box[1][2])));
    return result;
  }
  /// Rounded outward.
  static GrowingBox box_of(const NodeBone& bone, const FloatBox& within) {
    FloatBox box;
    for (std::size_t k = 0; k < 3; ++k) {
      const double low = static_cast<double>(within[0][k]), high = static_cast<double>(within[1][k]);
      const double part = (high - low) / kBoxParts;
      constexpr float kInfinity = std::numeric_limits<float>::infinity();
      box[0][k] = std::nextafter(static_cast<float>(low + bone.low[k] * part), -kInfinity);
      box[1][k] = std::nextafter(static_cast<float>(high - bone.high[k] * part), kInfinity);
    }
    return grown(box);
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
      NodeBone bone{static_cast<std::uint16_t>(moved.slot), moved.least_parts, moved.greatest_parts, {}, {}};
      for (std::size_t k = 0; k < 3; ++k) {
        const double low = static_cast<double>(box_.low(k)), high = static_cast<double>(box_.high(k));
        const double parts = high > low ? kBoxParts / (high - low) : 0;
        const auto whole = [&](double distance) { return static_cast<std::uint8_t>(std::clamp(distance * parts, 0.0, kBoxParts)); };
        bone.low[k] = whole(static_cast<double>(moved.box.low(k)) - low);
        bone.high[k] = whole(high - static_cast<double>(moved.box.high(k)));
      }
      tree_.bones_.push_back(bone);
      const auto weight = [&](const Moved& of) { return int{of.least_parts} + int{of.greatest_parts}; };
      if (weight(moved) > weight(moved_[main])) main = i;
    }
    if (!moved_.empty()) std::swap(tree_.bones_[first], tree_.bones_[first + main]);
    moved_.clear();
  }

  const Mesh& mesh_;
  PatchTree& tree_;
  std::vector<Index> targets_;        ///< That displace positions.
  GrowingBox box_;                    ///< Of the node.
  std::vector<Moved> moved_;          ///< By each bone that moves the node.
  std::vector<Index> place_of_slot_;  ///< In moved_.
};

PatchTree::PatchTree(const Mesh& mesh, std::span<const Triangle> triangles, Index first_origin)
    : origins_(order_along_curve(mesh, triangles)) {
  const auto parts_of = [](Index count, Index size) { return (count + size - 1) / size; };
  const Index patch_count = parts_of(static_cast<Index>(triangles.size()), kPatchSize);
  first_of_level_ = {0, patch_count};
  for (Index count = patch_count; count > 1; first_of_level_.push_back(first_of_level_.back() + count))
    count = parts_of(count, kFanOut);
  nodes_.reserve(first_of_level_.back() + std::size_t{1});

  Builder builder(mesh, *this);
  for (Index patch = 0; patch < patch_count; ++patch) {
    builder.begin_node();
    builder.add_patch(triangles, origins(patch));
  }
  for (Index level = 1; level < level_count(); ++level)
    for (Index number = 0; number < node_count(level); ++number) {
      builder.begin_node();
      const Index first = kFanOut * number;
      builder.add_parent(first_of_level_[level - 1] + first, std::min(kFanOut, node_count(level - 1) - first));
    }
  builder.begin_node();
  bones_.shrink_to_fit();
  posed_.resize(nodes_.size() - 1);
  posed_since_.resize(nodes_.size() - 1, 0);
  for (Index& origin : origins_) origin += first_origin;
}

std::size_t PatchTree::bytes() const {
  return origins_.capacity() * sizeof(Index) + nodes_.capacity() * sizeof(Node) + bones_.capacity() * sizeof(NodeBone) +
         morphs_.capacity() * sizeof(NodeMorph) + first_morph_.capacity() * sizeof(Index) + posed_.capacity() * sizeof(Box) +
         posed_since_.capacity() * sizeof(std::uint32_t);
}

Box PatchTree::compute_posed_box(Index node, const MeshPose& pose) const {
  using Lanes = Eigen::Array<double, 4, 1>;  // x, y, z and one that nobody asks for
  struct Matrix {
    Lanes x, y, z, translation;
    explicit Matrix(const Affine3d& from)
        : x(Lanes::Map(from.data())),
          y(Lanes::Map(from.data() + 3)),
          z(Lanes::Map(from.data() + 6)),
          translation(from.data()[9], from.data()[10], from.data()[11], 0.0) {}
    Matrix(const Matrix& a, const Matrix& b)
        : x(a.x - b.x), y(a.y - b.y), z(a.z - b.z), translation(a.translation - b.translation) {}
    [[nodiscard]] Lanes at(const std::array<double, 3>& p) const { return translation + x * p[0] + y * p[1] + z * p[2]; }
    [[nodiscard]] Lanes spread(const std::array<double, 3>& half) const {
      return x.abs() * half[0] + y.abs() * half[1] + z.abs() * half[2];
    }
  };
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr double kDoubleRounding = 1e-13;  // of sums of products, many times over

  // The box in bind space, morphs included, and what rounding is measured by.
  std::array<double, 3> low, high, part, largest;
  for (std::size_t k = 0; k < 3; ++k) {
    low[k] = static_cast<double>(nodes_[node].bind[0][k]);
    high[k] = static_cast<double>(nodes_[node].bind[1][k]);
    part[k] = (high[k] - low[k]) / kBoxParts;
    largest[k] = std::max(std::abs(low[k]), std::abs(high[k]));
  }
  if (!first_morph_.empty())
    for (Index i = first_morph_[node]; i < first_morph_[node + 1]; ++i) {
      const double weight = static_cast<double>(pose.morph_weights[morphs_[i].target]);
      for (std::size_t k = 0; k < 3; ++k) {
        const double a = weight * static_cast<double>(morphs_[i].displacement[0][k]);
        const double b = weight * static_cast<double>(morphs_[i].displacement[1][k]);
        low[k] += std::min(a, b);
        high[k] += std::max(a, b);
        largest[k] += std::max(std::abs(a), std::abs(b));
      }
    }
  const auto middle_and_half = [&](double from, double to, std::size_t k, std::array<double, 3>& middle,
                                   std::array<double, 3>& half) {
    middle[k] = 0.5 * (from + to);
    half[k] = 0.5 * (to - from) + kDoubleRounding * largest[k];
  };

  const std::span<const NodeBone> bones = bones_of(node);
  const Matrix main(pose.palette[bones[0].slot]);
  std::array<double, 3> middle, half;
  for (std::size_t k = 0; k < 3; ++k) middle_and_half(low[k], high[k], k, middle, half);
  Lanes at = main.at(middle), spread = main.spread(half);
  Lanes sum_low = at - spread, sum_high = at + spread;  // of intervals
  Lanes hull_low = Lanes::Constant(kInfinity), hull_high = Lanes::Constant(-kInfinity);
  Lanes slack = weight_slack_ * sum_low.abs().max(sum_high.abs());
  Lanes magnitude = Lanes::Zero();
  for (std::size_t i = 0; i < bones.size(); ++i) {
    const NodeBone& bone = bones[i];
    for (std::size_t k = 0; k < 3; ++k)
      middle_and_half(low[k] + bone.low[k] * part[k], high[k] - bone.high[k] * part[k], k, middle, half);
    const Matrix matrix(pose.palette[bone.slot]);
    at = matrix.at(middle);
    spread = matrix.spread(half);
    hull_low = hull_low.min(at - spread);
    hull_high = hull_high.max(at + spread);
    magnitude = magnitude.max(matrix.spread(largest) + matrix.translation.abs());
    if (i == 0) continue;
    const Matrix beside(matrix, main);
    at = beside.at(middle);
    spread = beside.spread(half);
    const double least = bone.least_weight / kWeightParts, greatest = bone.greatest_weight / kWeightParts;
    const Lanes from = at - spread, to = at + spread;
    sum_low += (least * from).min(greatest * from);
    sum_high += (least * to).max(greatest * to);
  }
  slack = slack.max(weight_slack_ * hull_low.abs().max(hull_high.abs())) + kDoubleRounding * magnitude;
  hull_low = hull_low.max(sum_low) - slack;
  hull_high = hull_high.min(sum_high) + slack;
  Box box{hull_low.head<3>(), hull_high.head<3>()};
  if (!is_bounded_ || !box.low.allFinite() || !box.high.allFinite())
    box = {Vec3d::Constant(-kInfinity), Vec3d::Constant(kInfinity)};
  return box;
}

}  // namespace sunder::tear
