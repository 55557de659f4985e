// Displacement of posed vertices. Included after kernel-inl.h, by the same files. No include guard.
//
// What a vertex needs of its particles is summed as four numbers at once; normals and tangents of
// kLanes vertices are then turned side by side. Each vertex has the same operations in the same
// order wherever it is stored and in each vector extension, so that coincident vertices with equal
// displacements stay coincident.

using Four = Eigen::Array4f;  // compilers vectorise loops over three numbers poorly
using FourOf = Eigen::Map<const Four>;

/// sum_k w_k of four numbers each.
SUNDER_INLINE Four mean_of(const ParticleInfluences& by, const float* a, const float* b,
                           const float* c, const float* d) {
  return by.weights[0] * FourOf(a) + by.weights[1] * FourOf(b) + by.weights[2] * FourOf(c) +
         by.weights[3] * FourOf(d);
}

SUNDER_INLINE void append_lane(const VertexDisplacements& displacements, std::uint32_t row,
                               std::uint32_t vertex, DisplacedLanes& lanes) {
  const ParticleInfluences& by = displacements.influences[row];
  const ParticleGradients& stored = displacements.gradients[row];
  const std::uint32_t lane = lanes.count++;
  lanes.vertices[lane] = vertex;

  const Mat3f* matrices = displacements.model_from_gradient.data();
  const float *a = matrices[by.particles[0]].data(), *b = matrices[by.particles[1]].data(),
              *c = matrices[by.particles[2]].data(), *d = matrices[by.particles[3]].data();
  const Vec4f* of = displacements.displacements.data();
  const float *p = of[stored.particles[0]].data(), *q = of[stored.particles[1]].data(),
              *r = of[stored.particles[2]].data(), *t = of[stored.particles[3]].data();
  const float* s = stored.of_weights[0].data();  // twelve numbers
#if SUNDER_WIDE_SUMS
  sum_nine(by.weights.data(), a, b, c, d, lanes.mean_first + 4 * lane, lanes.mean_second + 4 * lane,
           lanes.mean_last + lane);
  sum_columns(s, p, q, r, t, lanes.stretch[0] + 4 * lane, lanes.stretch[1] + 4 * lane,
              lanes.stretch[2] + 4 * lane);
#else
  Eigen::Map<Four>(lanes.mean_first + 4 * lane) = mean_of(by, a, b, c, d);
  Eigen::Map<Four>(lanes.mean_second + 4 * lane) = mean_of(by, a + 4, b + 4, c + 4, d + 4);
  lanes.mean_last[lane] =
      by.weights[0] * a[8] + by.weights[1] * b[8] + by.weights[2] * c[8] + by.weights[3] * d[8];
  for (std::uint32_t j = 0; j < 3; ++j)
    Eigen::Map<Four>(lanes.stretch[j] + 4 * lane) =
        s[j] * FourOf(p) + s[3 + j] * FourOf(q) + s[6 + j] * FourOf(r) + s[9 + j] * FourOf(t);
#endif
}

SUNDER_INLINE Vector cross(const Vector& a, const Vector& b) {
  return {sub(mul(a.y, b.z), mul(a.z, b.y)), sub(mul(a.z, b.x), mul(a.x, b.z)),
          sub(mul(a.x, b.y), mul(a.y, b.x))};
}
SUNDER_INLINE V dot(const Vector& a, const Vector& b) {
  return add_product(a.z, b.z, add_product(a.y, b.y, mul(a.x, b.x)));
}
SUNDER_INLINE Vector times(V factor, const Vector& v) {
  return {mul(factor, v.x), mul(factor, v.y), mul(factor, v.z)};
}
SUNDER_INLINE V largest_of(const Vector& v) { return max(max(abs(v.x), abs(v.y)), abs(v.z)); }

/// at_length() of vectors whose squares underflow or overflow.
SUNDER_INLINE Vector at_any_length(const Vector& v, const Vector& old, bool unit_length) {
  const V least = set(1e-37f), most = set(3e38f), one = set(1.0f);
  const Vector unit = unit_or(v, old);
  if (unit_length) return unit;
  const V largest = largest_of(old);
  const Vector scaled = times(div(one, largest), old);
  const V length =
      if_between(least, largest, most, mul(largest, sqrt(dot(scaled, scaled))), zero());
  const V found = largest_of(v);
  return {if_between(least, found, most, mul(length, unit.x), old.x),
          if_between(least, found, most, mul(length, unit.y), old.y),
          if_between(least, found, most, mul(length, unit.z), old.z)};
}

/// `v` scaled to the length of `old`, or to unit length; or `old` if v has no length.
SUNDER_INLINE Vector at_length(const Vector& v, const Vector& old, bool unit_length) {
  // Between these neither the squares nor their quotient leaves the range of floats.
  const V least = set(1e-18f), most = set(1e18f), one = set(1.0f);
  const V square = dot(v, v), wanted = unit_length ? one : dot(old, old);
  const V is_common =
      if_between(least, square, most, if_between(least, wanted, most, one, zero()), zero());
  const Vector scaled = times(sqrt(div(wanted, square)), v);
  if (are_all_positive(is_common)) return scaled;
  // Each lane chooses for itself, so that its bits do not depend on its neighbours.
  const Vector other = at_any_length(v, old, unit_length);
  const V two = set(2.0f);
  return {if_between(zero(), is_common, two, scaled.x, other.x),
          if_between(zero(), is_common, two, scaled.y, other.y),
          if_between(zero(), is_common, two, scaled.z, other.z)};
}

/// The map of the displaced surface around the vertices from `part` on.
SUNDER_INLINE Linear map_around(const DisplacedLanes& lanes, std::uint32_t part) {
  const auto column = [&](std::uint32_t j) {
    V x, y, z, rest;
    load_interleaved4(lanes.stretch[j] + 4 * part, x, y, z, rest);
    return Vector{x, y, z};
  };
  const Vector kx = column(0), ky = column(1), kz = column(2);
  const Linear stretch = {kx.x, kx.y, kx.z, ky.x, ky.y, ky.z, kz.x, kz.y, kz.z};
  V xx, xy, xz, yx, yy, yz, zx, zy;
  load_interleaved4(lanes.mean_first + 4 * part, xx, xy, xz, yx);
  load_interleaved4(lanes.mean_second + 4 * part, yy, yz, zx, zy);
  const V zz = load(lanes.mean_last + part), one = set(1.0f);
  const Vector x = transform(stretch, Vector{xx, yx, zx}), y = transform(stretch, {xy, yy, zy}),
               z = transform(stretch, {xz, yz, zz});
  return {add(one, x.x), x.y, x.z, y.x, add(one, y.y), y.z, z.x, z.y, add(one, z.z)};
}

SUNDER_INLINE void store_vector(const Vector& v, float* numbers) {
  store(v.x, numbers);
  store(v.y, numbers + kLanes);
  store(v.z, numbers + 2 * kLanes);
}

inline float* floats_at(const StridedFloats<float>& array, std::uint32_t vertex) {
  return reinterpret_cast<float*>(reinterpret_cast<unsigned char*>(array.data) +
                                  array.stride * vertex);
}

/// How the directions of the vertices in the lanes are read and written: as a whole where vertices
/// and numbers follow one another, or one by one.
struct LaneAccess {
  bool normals_together = false, tangents_together = false;
};

inline LaneAccess access_of(const VertexTarget& target, const DisplacedLanes& lanes) {
  bool are_consecutive = lanes.count == kLanes;
  for (std::uint32_t lane = 1; lane < kLanes; ++lane)
    are_consecutive &= lanes.vertices[lane] == lanes.vertices[0] + lane;
  return {are_consecutive && target.normals.stride == 3 * sizeof(float),
          are_consecutive && target.tangents.stride == 4 * sizeof(float)};
}

/// Turns the normals and tangents of the vertices from `part` on.
///
/// Normals are mapped by the cofactors of the map: exact, however far the surface is displaced.
SUNDER_INLINE void turn_part(const VertexTarget& target, std::uint32_t part, LaneAccess access,
                             DisplacedLanes& lanes) {
  const Linear map = map_around(lanes, part);
  Vector normal = {zero(), zero(), zero()};
  if (target.normals.data != nullptr) {
    const Vector x = {map.xx, map.xy, map.xz}, y = {map.yx, map.yy, map.yz},
                 z = {map.zx, map.zy, map.zz};
    const Vector yz = cross(y, z), zx = cross(z, x), xy = cross(x, y);
    float* const together = floats_at(target.normals, lanes.vertices[part]);
    Vector old;
    if (access.normals_together)
      load_interleaved(together, old.x, old.y, old.z);
    else
      old = load_vector(lanes.normals + part);
    const Linear cofactors = {yz.x, yz.y, yz.z, zx.x, zx.y, zx.z, xy.x, xy.y, xy.z};
    normal = at_length(transform(cofactors, old), old, target.unit_length);
    if (access.normals_together)
      store_interleaved<false>(normal.x, normal.y, normal.z, together);
    else
      store_vector(normal, lanes.normals + part);
  }
  if (target.tangents.data == nullptr) return;
  float* const together = floats_at(target.tangents, lanes.vertices[part]);
  Vector old;
  V sign = zero();
  if (access.tangents_together)
    load_interleaved4(together, old.x, old.y, old.z, sign);
  else
    old = load_vector(lanes.tangents + part);
  Vector tangent = transform(map, old);
  const V square = dot(normal, normal);
  const V along = if_between(zero(), square, set(3e38f), div(dot(normal, tangent), square), zero());
  tangent = {sub(tangent.x, mul(along, normal.x)), sub(tangent.y, mul(along, normal.y)),
             sub(tangent.z, mul(along, normal.z))};
  tangent = at_length(tangent, old, target.unit_length);
  if (access.tangents_together)
    store_interleaved4(tangent.x, tangent.y, tangent.z, sign, together);
  else
    store_vector(tangent, lanes.tangents + part);
}

SUNDER_INLINE void gather_lanes(const StridedFloats<float>& from, const DisplacedLanes& lanes,
                                float* numbers) {
  for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
    // Lanes without a vertex repeat the first one.
    const float* v = floats_at(from, lanes.vertices[lane < lanes.count ? lane : 0]);
    for (std::uint32_t i = 0; i < 3; ++i) numbers[kLanes * i + lane] = v[i];
  }
}

SUNDER_INLINE void scatter_lanes(const float* numbers, const DisplacedLanes& lanes,
                                 const StridedFloats<float>& to) {
  for (std::uint32_t lane = 0; lane < lanes.count; ++lane) {
    float* v = floats_at(to, lanes.vertices[lane]);
    for (std::uint32_t i = 0; i < 3; ++i) v[i] = numbers[kLanes * i + lane];
  }
}

/// Turns the directions of the vertices that were appended, and empties `lanes`.
inline void turn_lanes(const VertexTarget& target, DisplacedLanes& lanes) {
  if (lanes.count == 0) return;
  const LaneAccess access = access_of(target, lanes);
  const bool has_normals = target.normals.data != nullptr && !access.normals_together,
             has_tangents = target.tangents.data != nullptr && !access.tangents_together;
  if (has_normals) gather_lanes(target.normals, lanes, lanes.normals);
  if (has_tangents) gather_lanes(target.tangents, lanes, lanes.tangents);
  for (std::uint32_t part = 0; part < lanes.count; part += kVectorLanes)
    turn_part(target, part, access, lanes);
  if (has_normals) scatter_lanes(lanes.normals, lanes, target.normals);
  if (has_tangents) scatter_lanes(lanes.tangents, lanes, target.tangents);
  lanes.count = 0;
}

SUNDER_INLINE void displace_position(const VertexDisplacements& displacements,
                                     const ParticleInfluences& by, float* position) {
  const Vec4f* of = displacements.displacements.data();
  const Four sum = mean_of(by, of[by.particles[0]].data(), of[by.particles[1]].data(),
                           of[by.particles[2]].data(), of[by.particles[3]].data());
  for (int i = 0; i < 3; ++i) position[i] += sum[i];
}

inline void run_displacements(const VertexDisplacements& displacements, const VertexTarget& target,
                              std::uint32_t first, std::uint32_t end, DisplacedLanes& lanes) {
  // Copies on the stack, because compilers assume that a store of a float changes a span.
  const VertexDisplacements of = displacements;
  const VertexTarget to = target;
  const bool turns =
      !of.gradients.empty() && (to.normals.data != nullptr || to.tangents.data != nullptr);
  // Rows of points are read ahead: those of neighbouring vertices need not be neighbours.
  const auto expect = [&](std::uint32_t row) {
    if (row >= of.influences.size()) return;
    prefetch(&of.influences[row]);
    if (turns) prefetch(&of.gradients[row]);
  };
  constexpr std::uint32_t kAhead = 16;
  for (std::uint32_t v = first; v < end; ++v) {
    if (end - v > kAhead) expect(of.vertex_rows[v + kAhead]);
    const std::uint32_t row = of.vertex_rows[v];
    if (row >= of.influences.size() || !(of.influences[row].weights[0] > 0.0f)) continue;
    displace_position(of, of.influences[row], floats_at(to.positions, v));
    if (!turns) continue;
    append_lane(of, row, v, lanes);
    if (lanes.count == kLanes) turn_lanes(to, lanes);
  }
}
