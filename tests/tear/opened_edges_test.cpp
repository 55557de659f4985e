#include "tear/surface/opened_edges.h"

#include <cstdint>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "support/machine/random.h"
#include "support/machine/stress.h"

namespace sunder::tear {
namespace {

constexpr Index kHalfEdges = 300;

/// Half-edges without a surface around them: a half-edge is a border or not, of a face or of none.
class Edges {
 public:
  explicit Edges(std::uint64_t seed) : random_(seed), opened_(surface_) {
    surface_.twin.assign(kHalfEdges, 0);
    surface_.corner_point.assign(kHalfEdges, 0);
    opened_.begin(true);
  }

  void change_one() {
    const Index h = any(), other = any();
    switch (random_.index(6)) {
      case 0:
        opened_.add(h, other);
        tracked_.insert(h);
        tracked_.insert(other);
        surface_.twin[h] = surface_.twin[other] = kNone;
        break;
      case 1:
        opened_.move(h, other);
        if (tracked_.erase(h) > 0) tracked_.insert(other);
        break;
      case 2:
        opened_.split(h, other);
        if (tracked_.contains(h)) tracked_.insert(other);
        break;
      case 3: EXPECT_EQ(opened_.remove(h), tracked_.erase(h) > 0); break;
      case 4:
        surface_.twin[h] = other;  // a wall joins it
        break;
      default: surface_.corner_point[h] = kNone;  // its face is removed
    }
  }

  void check() {
    std::vector<Index> borders;
    for (const Index h : tracked_)
      if (surface_.twin[h] == kNone && surface_.corner_point[h] != kNone) borders.push_back(h);
    EXPECT_EQ(opened_.borders(), borders);
  }

  /// Some changes, taken back together with those of the surface.
  void try_in_vain() {
    const Surface surface = surface_;
    const std::set<Index> tracked = tracked_;
    const Index changes = opened_.change_count();
    for (std::uint32_t i = random_.index(20); i > 0; --i) change_one();
    if (random_.index(2) == 0) check();
    opened_.roll_back(changes);
    surface_ = surface;
    tracked_ = tracked;
  }

  [[nodiscard]] bool chance(std::uint32_t one_in) { return random_.index(one_in) == 0; }

 private:
  [[nodiscard]] Index any() { return random_.index(kHalfEdges); }

  test::Random random_;
  Surface surface_;
  OpenedEdges opened_;
  std::set<Index> tracked_;
};

TEST(OpenedEdges, returns_what_a_scan_of_all_would) {
  for (int seed = 0; seed < test::stressed(200, 50); ++seed) {
    SCOPED_TRACE(seed);
    Edges edges(static_cast<std::uint64_t>(seed));
    for (int i = 0; i < 400; ++i) {
      if (edges.chance(20)) {
        edges.try_in_vain();
      } else {
        edges.change_one();
      }
      if (edges.chance(8)) edges.check();
    }
    edges.check();
  }
}

}  // namespace
}  // namespace sunder::tear
