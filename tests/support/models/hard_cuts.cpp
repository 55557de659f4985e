#include "support/models/hard_cuts.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

namespace sunder::test {
namespace {

using Ring = std::vector<std::uint32_t>;

struct Body {
  const char* name = "";
  Solid solid;
  std::vector<Ring> rings;  ///< Around the body, without its ends.
};

void add_quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d, bool is_turned,
              Solid& to) {
  if (is_turned) {
    to.triangles.push_back({a, b, d});
    to.triangles.push_back({b, c, d});
  } else {
    to.triangles.push_back({a, b, c});
    to.triangles.push_back({a, c, d});
  }
}

/// Rings of vertices around z, from the lowest on. @return the first vertex of each.
std::vector<std::uint32_t> add_rings(const std::vector<Vec2d>& radii_and_heights,
                                     std::uint32_t sides, Solid& to) {
  std::vector<std::uint32_t> firsts;
  for (const Vec2d& ring : radii_and_heights) {
    firsts.push_back(static_cast<std::uint32_t>(to.positions.size()));
    for (std::uint32_t i = 0; i < sides; ++i) {
      const double angle = 2 * std::numbers::pi * i / sides;
      to.positions.emplace_back(ring.x() * std::cos(angle), ring.x() * std::sin(angle), ring.y());
    }
  }
  return firsts;
}

/// Faces between two rings that look away from the axis if the first is the lower one.
void join_rings(std::uint32_t lower, std::uint32_t upper, std::uint32_t sides, Random& random,
                Solid& to) {
  for (std::uint32_t i = 0; i < sides; ++i) {
    const std::uint32_t j = (i + 1) % sides;
    add_quad(lower + i, lower + j, upper + j, upper + i, random.index(2) == 0, to);
  }
}

Ring ring_from(std::uint32_t first, std::uint32_t sides) {
  Ring ring(sides);
  for (std::uint32_t i = 0; i < sides; ++i) ring[i] = first + i;
  return ring;
}

std::vector<Vec2d> random_profile(double low, double high, std::uint32_t rings, bool is_straight,
                                  double height, Random& random) {
  std::vector<Vec2d> profile;
  const double first = random.uniform(low, high);
  for (std::uint32_t i = 0; i < rings; ++i)
    profile.emplace_back(is_straight ? first : random.uniform(low, high),
                         height * i / (rings - 1) - 0.5 * height);
  return profile;
}

Body make_prism(Random& random) {
  Body body{"prism", {}, {}};
  const std::uint32_t sides = 3 + random.index(12), rings = 2 + random.index(3);
  const bool is_straight = random.index(2) == 0;
  const auto profile = random_profile(0.3, 0.8, rings, is_straight, random.uniform(0.4, 2), random);
  const auto firsts = add_rings(profile, sides, body.solid);
  for (std::uint32_t i = 0; i + 1 < rings; ++i)
    join_rings(firsts[i], firsts[i + 1], sides, random, body.solid);
  for (std::uint32_t i = 1; i + 1 < sides; ++i) {
    body.solid.triangles.push_back({firsts[0], firsts[0] + i + 1, firsts[0] + i});
    body.solid.triangles.push_back({firsts.back(), firsts.back() + i, firsts.back() + i + 1});
  }
  for (std::uint32_t i = 1; i + 1 < rings; ++i) body.rings.push_back(ring_from(firsts[i], sides));
  return body;
}

Body make_tube(Random& random) {
  Body body{"tube", {}, {}};
  const std::uint32_t sides = 3 + random.index(22), rings = 2 + random.index(4);
  const bool is_straight = random.index(2) == 0;
  const double height = random.uniform(0.4, 2);
  const auto outer =
      add_rings(random_profile(0.6, 0.9, rings, is_straight, height, random), sides, body.solid);
  const auto inner =
      add_rings(random_profile(0.1, 0.3, rings, is_straight, height, random), sides, body.solid);
  for (std::uint32_t i = 0; i + 1 < rings; ++i) {
    join_rings(outer[i], outer[i + 1], sides, random, body.solid);
    join_rings(inner[i + 1], inner[i], sides, random, body.solid);
  }
  join_rings(inner[0], outer[0], sides, random, body.solid);
  join_rings(outer.back(), inner.back(), sides, random, body.solid);
  for (std::uint32_t i = 1; i + 1 < rings; ++i) {
    body.rings.push_back(ring_from(outer[i], sides));
    body.rings.push_back(ring_from(inner[i], sides));
  }
  return body;
}

Body make_globe(Random& random) {
  Body body{"ball", {}, {}};
  const std::uint32_t sides = 4 + random.index(12), rings = 1 + random.index(6);
  std::vector<Vec2d> profile;
  for (std::uint32_t i = 1; i <= rings; ++i) {
    const double angle = std::numbers::pi * i / (rings + 1);
    profile.emplace_back(0.8 * std::sin(angle), -0.8 * std::cos(angle));
  }
  const auto firsts = add_rings(profile, sides, body.solid);
  const auto pole = static_cast<std::uint32_t>(body.solid.positions.size());
  body.solid.positions.emplace_back(0.0, 0.0, -0.8);
  body.solid.positions.emplace_back(0.0, 0.0, 0.8);
  for (std::uint32_t i = 0; i < sides; ++i) {
    const std::uint32_t j = (i + 1) % sides;
    body.solid.triangles.push_back({pole, firsts[0] + j, firsts[0] + i});
    body.solid.triangles.push_back({pole + 1, firsts.back() + i, firsts.back() + j});
  }
  for (std::uint32_t i = 0; i + 1 < rings; ++i)
    join_rings(firsts[i], firsts[i + 1], sides, random, body.solid);
  for (const std::uint32_t first : firsts) body.rings.push_back(ring_from(first, sides));
  return body;
}

/// Of points on an ellipsoid, each triple of which is tried.
Body make_hull(Random& random) {
  Body body{"hull", {}, {}};
  const std::uint32_t count = 4 + random.index(14);
  const Vec3d radii{random.uniform(0.4, 1), random.uniform(0.4, 1), random.uniform(0.4, 1)};
  for (std::uint32_t i = 0; i < count; ++i)
    body.solid.positions.push_back(random.direction().cwiseProduct(radii));
  const auto& at = body.solid.positions;
  for (std::uint32_t a = 0; a < count; ++a)
    for (std::uint32_t b = a + 1; b < count; ++b)
      for (std::uint32_t c = a + 1; c < count; ++c) {
        if (c == b) continue;
        const Vec3d normal = (at[b] - at[a]).cross(at[c] - at[a]);
        bool is_outside = true;
        for (std::uint32_t d = 0; d < count && is_outside; ++d)
          is_outside = d == a || d == b || d == c || normal.dot(at[d] - at[a]) < 0;
        if (is_outside) body.solid.triangles.push_back({a, b, c});
      }
  return body;
}

/// Cells of a grid of 3 x 3 x 3 with random spacings.
class Cells {
 public:
  static constexpr int kSize = 3;

  bool& at(int x, int y, int z) {
    return is_full_[static_cast<std::size_t>((x * kSize + y) * kSize + z)];
  }
  [[nodiscard]] bool is_full(int x, int y, int z) const {
    const auto is_in = [](int i) { return i >= 0 && i < kSize; };
    return is_in(x) && is_in(y) && is_in(z) &&
           is_full_[static_cast<std::size_t>((x * kSize + y) * kSize + z)];
  }

  /// Whether around each grid point the full cells are connected across faces, and the empty ones.
  [[nodiscard]] bool is_manifold() const {
    for (int x = 0; x <= kSize; ++x)
      for (int y = 0; y <= kSize; ++y)
        for (int z = 0; z <= kSize; ++z)
          if (!is_connected_around(x, y, z, true) || !is_connected_around(x, y, z, false))
            return false;
    return true;
  }

 private:
  [[nodiscard]] bool is_connected_around(int x, int y, int z, bool full) const {
    const auto belongs = [&](unsigned i) {
      return is_full(x - static_cast<int>(i & 1), y - static_cast<int>(i >> 1 & 1),
                     z - static_cast<int>(i >> 2 & 1)) == full;
    };
    unsigned all = 0, reached = 0;
    for (unsigned i = 0; i < 8; ++i) all |= belongs(i) ? 1u << i : 0;
    if (all == 0) return true;
    reached = all & (~all + 1);
    for (int pass = 0; pass < 8; ++pass)
      for (unsigned i = 0; i < 8; ++i)
        for (unsigned axis = 0; axis < 3; ++axis)
          if ((reached >> i & 1) != 0 && (all >> (i ^ 1u << axis) & 1) != 0)
            reached |= 1u << (i ^ 1u << axis);
    return reached == all;
  }

  std::array<bool, kSize* kSize* kSize> is_full_ = {};
};

Cells random_cells(Random& random) {
  constexpr int kSize = Cells::kSize;
  for (;;) {
    Cells cells;
    cells.at(1, 1, 1) = true;
    const std::uint32_t count = 1 + random.index(12);
    for (std::uint32_t n = 0; n < count;) {
      const int x = static_cast<int>(random.index(kSize)),
                y = static_cast<int>(random.index(kSize)),
                z = static_cast<int>(random.index(kSize));
      if (cells.is_full(x - 1, y, z) || cells.is_full(x + 1, y, z) || cells.is_full(x, y - 1, z) ||
          cells.is_full(x, y + 1, z) || cells.is_full(x, y, z - 1) || cells.is_full(x, y, z + 1)) {
        cells.at(x, y, z) = true;
        ++n;
      }
    }
    if (cells.is_manifold()) return cells;
  }
}

/// Two triangles per side of a cell that is on the surface.
Body make_union(Random& random) {
  constexpr int kSize = Cells::kSize;
  Body body{"union", {}, {}};
  const Cells cells = random_cells(random);
  std::array<std::array<double, kSize + 1>, 3> places = {};
  for (auto& axis : places) {
    axis[0] = -0.6;
    for (std::size_t i = 1; i < axis.size(); ++i) axis[i] = axis[i - 1] + random.uniform(0.2, 0.6);
  }
  std::map<std::array<int, 3>, std::uint32_t> vertices;
  const auto vertex = [&](const std::array<int, 3>& at) {
    const auto [known, is_new] =
        vertices.try_emplace(at, static_cast<std::uint32_t>(body.solid.positions.size()));
    if (is_new)
      body.solid.positions.emplace_back(places[0][static_cast<std::size_t>(at[0])],
                                        places[1][static_cast<std::size_t>(at[1])],
                                        places[2][static_cast<std::size_t>(at[2])]);
    return known->second;
  };
  for (int x = 0; x < kSize; ++x)
    for (int y = 0; y < kSize; ++y)
      for (int z = 0; z < kSize; ++z)
        for (std::size_t axis = 0; axis < 3 && cells.is_full(x, y, z); ++axis)
          for (const int side : {0, 1}) {
            std::array<int, 3> beyond = {x, y, z};
            beyond[axis] += side == 1 ? 1 : -1;
            if (cells.is_full(beyond[0], beyond[1], beyond[2])) continue;
            const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
            std::array<int, 3> a = {x, y, z};
            a[axis] += side;
            std::array<int, 3> b = a, c = a, d = a;
            b[u] += 1;
            c[u] += 1;
            c[v] += 1;
            d[v] += 1;
            if (side == 0) std::swap(b, d);
            const std::uint32_t va = vertex(a), vb = vertex(b), vc = vertex(c), vd = vertex(d);
            add_quad(va, vb, vc, vd, random.index(2) == 0, body.solid);
          }
  return body;
}

Body make_cuboid(Random& random) {
  const Vec3d size{random.uniform(0.3, 1.5), random.uniform(0.3, 1.5), random.uniform(0.3, 1.5)};
  return {"box", make_box(size), {}};
}

Body random_body(PlaneFamily family, Random& random) {
  if (family == PlaneFamily::through_ring)
    for (;;) {
      const std::uint32_t kind = random.index(3);
      Body body = kind == 0   ? make_prism(random)
                  : kind == 1 ? make_tube(random)
                              : make_globe(random);
      if (!body.rings.empty()) return body;
    }
  switch (random.index(6)) {
    case 0: return make_cuboid(random);
    case 1: return make_prism(random);
    case 2: return make_tube(random);
    case 3: return make_globe(random);
    case 4: return make_hull(random);
    default: return make_union(random);
  }
}

/// Turned at random, moved by up to a size, and rounded to float.
void place(Solid& solid, Random& random) {
  const Vec3d axis = random.direction();
  const double angle = random.uniform(0, 2 * std::numbers::pi);
  const Eigen::AngleAxisd turn(angle, axis);
  const Vec3d way{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
  for (Vec3d& at : solid.positions) at = (turn * at + way).cast<float>().cast<double>();
}

Vec3d unit_normal(const Vec3d& a, const Vec3d& b, const Vec3d& c, bool in_float) {
  if (!in_float) return (b - a).cross(c - a).normalized();
  const Vec3f ab = b.cast<float>() - a.cast<float>(), ac = c.cast<float>() - a.cast<float>();
  return ab.cross(ac).normalized().cast<double>();
}

}  // namespace

const char* name_of(PlaneFamily family) {
  switch (family) {
    case PlaneFamily::anywhere: return "anywhere";
    case PlaneFamily::near_vertex: return "near a vertex";
    case PlaneFamily::through_vertex: return "through a vertex";
    case PlaneFamily::along_edge: return "along an edge";
    case PlaneFamily::through_ring: return "through a ring";
    case PlaneFamily::in_face: return "in a face";
  }
  return "";
}

HardCut random_hard_cut(PlaneFamily family, Random& random) {
  Body body = random_body(family, random);
  place(body.solid, random);
  HardCut cut{body.name, std::move(body.solid), Vec3d::Zero(), random.direction()};
  const auto& positions = cut.body.positions;
  const auto any_vertex = [&] {
    return positions[random.index(static_cast<std::uint32_t>(positions.size()))];
  };
  const Triangle& face =
      cut.body.triangles[random.index(static_cast<std::uint32_t>(cut.body.triangles.size()))];
  const Vec3d a = positions[face[0]], b = positions[face[1]], c = positions[face[2]];
  const bool in_float = random.index(2) == 0;
  switch (family) {
    case PlaneFamily::anywhere: {
      const double part = random.uniform(0.1, 0.9);
      const Vec3d from = any_vertex(), to = any_vertex();
      cut.point = part * from + (1 - part) * to;
      break;
    }
    case PlaneFamily::near_vertex: {
      const double off = std::pow(10.0, random.uniform(-9, -3));
      cut.point = any_vertex() + off * cut.normal;
      break;
    }
    case PlaneFamily::through_vertex: cut.point = any_vertex(); break;
    case PlaneFamily::along_edge:
      cut.point = a;
      cut.normal = unit_normal(a, b, a + cut.normal, in_float);
      break;
    case PlaneFamily::through_ring: {
      const Ring& ring = body.rings[random.index(static_cast<std::uint32_t>(body.rings.size()))];
      const auto sides = static_cast<std::uint32_t>(ring.size());
      const std::uint32_t first = random.index(sides), step = 1 + random.index((sides - 1) / 2);
      cut.point = positions[ring[first]];
      cut.normal = unit_normal(cut.point, positions[ring[(first + step) % sides]],
                               positions[ring[(first + 2 * step) % sides]], in_float);
      break;
    }
    case PlaneFamily::in_face:
      cut.point = a;
      cut.normal = unit_normal(a, b, c, in_float);
      break;
  }
  if (random.index(2) == 0) cut.normal = -cut.normal;
  return cut;
}

}  // namespace sunder::test
