// The kernel. Included once per vector extension, by a file that defines V, kVectorLanes and
// operations on them. No include guard.
//
// The 16 vertices of a block are posed side by side, in parts of kVectorLanes. Every lane does the
// same operations in the same order, in each vector extension and kind of block: products and sums
// are rounded one by one, sums over slots start with zero and go by ascending slot. So the bits of
// a posed vertex do not depend on where it is stored, and coincident vertices stay coincident.

/// sum_k w_k M_k of several lanes, column by column.
struct Matrix {
  V xx, xy, xz, yx, yy, yz, zx, zy, zz, tx, ty, tz;
};

/// The same for normals, column by column.
struct Linear {
  V xx, xy, xz, yx, yy, yz, zx, zy, zz;
};

struct Vector {
  V x, y, z;
};

SUNDER_INLINE V add_product(V a, V b, V sum) { return add(sum, mul(a, b)); }

SUNDER_INLINE Matrix blend_slots(const float* weights, const std::uint16_t* slots,
                                 std::uint32_t count, const float* matrices) {
  const V z = zero();
  Matrix m = {z, z, z, z, z, z, z, z, z, z, z, z};
  for (std::uint32_t k = 0; k < count; ++k) {
    const V w = load(weights + kLanes * k);
    const float* of = matrices + 12 * static_cast<std::size_t>(slots[k]);
    m.xx = add_product(w, set(of[0]), m.xx);
    m.xy = add_product(w, set(of[1]), m.xy);
    m.xz = add_product(w, set(of[2]), m.xz);
    m.yx = add_product(w, set(of[3]), m.yx);
    m.yy = add_product(w, set(of[4]), m.yy);
    m.yz = add_product(w, set(of[5]), m.yz);
    m.zx = add_product(w, set(of[6]), m.zx);
    m.zy = add_product(w, set(of[7]), m.zy);
    m.zz = add_product(w, set(of[8]), m.zz);
    m.tx = add_product(w, set(of[9]), m.tx);
    m.ty = add_product(w, set(of[10]), m.ty);
    m.tz = add_product(w, set(of[11]), m.tz);
  }
  return m;
}

/// sum += weight * M, where nine numbers are M.
SUNDER_INLINE void add_linear(V weight, const float* of, Linear& sum) {
  sum.xx = add_product(weight, set(of[0]), sum.xx);
  sum.xy = add_product(weight, set(of[1]), sum.xy);
  sum.xz = add_product(weight, set(of[2]), sum.xz);
  sum.yx = add_product(weight, set(of[3]), sum.yx);
  sum.yy = add_product(weight, set(of[4]), sum.yy);
  sum.yz = add_product(weight, set(of[5]), sum.yz);
  sum.zx = add_product(weight, set(of[6]), sum.zx);
  sum.zy = add_product(weight, set(of[7]), sum.zy);
  sum.zz = add_product(weight, set(of[8]), sum.zz);
}

SUNDER_INLINE Linear blend_normal_matrices(const float* weights, const std::uint16_t* slots,
                                           std::uint32_t count, const float* matrices) {
  const V z = zero();
  Linear m = {z, z, z, z, z, z, z, z, z};
  for (std::uint32_t k = 0; k < count; ++k)
    add_linear(load(weights + kLanes * k), matrices + 9 * static_cast<std::size_t>(slots[k]), m);
  return m;
}

SUNDER_INLINE Linear linear_of(const Matrix& m) {
  return {m.xx, m.xy, m.xz, m.yx, m.yy, m.yz, m.zx, m.zy, m.zz};
}

/// A row of a matrix times a vector.
SUNDER_INLINE V row(V mx, V my, V mz, V x, V y, V z) {
  return add_product(mz, z, add_product(my, y, mul(mx, x)));
}

SUNDER_INLINE Vector transform(const Matrix& m, Vector v) {
  return {add(row(m.xx, m.yx, m.zx, v.x, v.y, v.z), m.tx),
          add(row(m.xy, m.yy, m.zy, v.x, v.y, v.z), m.ty),
          add(row(m.xz, m.yz, m.zz, v.x, v.y, v.z), m.tz)};
}

SUNDER_INLINE Vector transform(const Linear& m, Vector v) {
  return {row(m.xx, m.yx, m.zx, v.x, v.y, v.z), row(m.xy, m.yy, m.zy, v.x, v.y, v.z),
          row(m.xz, m.yz, m.zz, v.x, v.y, v.z)};
}

/// a * b.
SUNDER_INLINE Linear product(const Linear& a, const Linear& b) {
  const Vector x = transform(a, Vector{b.xx, b.xy, b.xz}),
               y = transform(a, Vector{b.yx, b.yy, b.yz}),
               z = transform(a, Vector{b.zx, b.zy, b.zz});
  return {x.x, x.y, x.z, y.x, y.y, y.z, z.x, z.y, z.z};
}

SUNDER_INLINE Linear sum(const Linear& a, const Linear& b) {
  return {add(a.xx, b.xx), add(a.xy, b.xy), add(a.xz, b.xz), add(a.yx, b.yx), add(a.yy, b.yy),
          add(a.yz, b.yz), add(a.zx, b.zx), add(a.zy, b.zy), add(a.zz, b.zz)};
}

/// `v` scaled to unit length, or `otherwise` if it has no length.
SUNDER_INLINE Vector unit_or(Vector v, Vector otherwise) {
  const V largest =
      max(max(abs(v.x), abs(v.y)), abs(v.z));  // squares of small numbers would underflow
  const V scale = div(set(1.0f), largest);
  const Vector s = {mul(v.x, scale), mul(v.y, scale), mul(v.z, scale)};
  const V factor =
      div(set(1.0f), sqrt(add_product(s.z, s.z, add_product(s.y, s.y, mul(s.x, s.x)))));
  const V least = set(1e-37f), most = set(3e38f);
  return {if_between(least, largest, most, mul(s.x, factor), otherwise.x),
          if_between(least, largest, most, mul(s.y, factor), otherwise.y),
          if_between(least, largest, most, mul(s.z, factor), otherwise.z)};
}

SUNDER_INLINE Vector load_vector(const float* numbers) {
  return {load(numbers), load(numbers + kLanes), load(numbers + 2 * kLanes)};
}

/// A bind attribute plus the displacements of the targets with a non-zero weight.
SUNDER_INLINE Vector load_morphed(const SkinWork& work, const Block& block, const float* numbers,
                                  std::size_t part) {
  Vector v = load_vector(numbers);
  if ((block.kind & kMorphed) == 0) return v;
  const Blocks& mesh = *work.mesh;
  const BlockExtra& extra = mesh.extras[block.extra];
  for (std::uint32_t i = extra.morphs; i < extra.morphs + extra.morph_count; ++i) {
    const float weight = work.morph_weights[mesh.morphs.parts[i].target];
    if (weight == 0.0f) continue;
    const Vector delta =
        load_vector(mesh.morphs.stream.data() + mesh.morphs.parts[i].numbers + part);
    const V w = set(weight);
    v = {add_product(w, delta.x, v.x), add_product(w, delta.y, v.y), add_product(w, delta.z, v.z)};
  }
  return v;
}

/// Whether any slot of a block has a flag.
inline bool moves_by(const SkinWork& work, const Block& block,
                     const std::vector<std::uint8_t>& flags) {
  const std::uint16_t* slots = work.mesh->slots.data() + block.slots;
  for (std::uint32_t k = 0; k < block.slot_count; ++k)
    if (flags[slots[k]] != 0) return true;
  return false;
}

// --- Blends that do not fit into registers or are rare: kLanes numbers each, in memory.

struct BlendedLanes {
  alignas(64) float matrix[12 * kLanes];
  alignas(64) float normal[9 * kLanes];
};

/// The matrices of a block whose weights are stored per influence.
inline void blend_lanes(const SkinWork& work, const Block& block, BlendedLanes& blended) {
  const Blocks& mesh = *work.mesh;
  const BlockExtra& extra = mesh.extras[block.extra];
  const PaletteData& palette = *work.palette;
  std::uint32_t i = 0;
  for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
    float matrix[12] = {}, normal[9] = {};
    for (; i < mesh.sparse.lane_ends[extra.lane_ends + lane]; ++i) {
      const Influence& influence = mesh.sparse.influences[extra.influences + i];
      const float* of = palette.matrices.data() + 12 * static_cast<std::size_t>(influence.slot);
      for (std::size_t e = 0; e < 12; ++e) matrix[e] += influence.weight * of[e];
      if (!palette.any_uneven) continue;
      const float* of_normals =
          palette.normal_matrices.data() + 9 * static_cast<std::size_t>(influence.slot);
      for (std::size_t e = 0; e < 9; ++e) normal[e] += influence.weight * of_normals[e];
    }
    for (std::size_t e = 0; e < 12; ++e) blended.matrix[kLanes * e + lane] = matrix[e];
    for (std::size_t e = 0; e < 9; ++e)
      blended.normal[kLanes * e + lane] = palette.any_uneven ? normal[e] : matrix[e];
  }
}

/// The weights of several lanes, slot by slot, for a block of either kind.
class SlotWeights {
 public:
  SlotWeights(const SkinWork& work, const Block& block, const float* numbers, std::uint32_t lane) {
    const Blocks& mesh = *work.mesh;
    if ((block.kind & kSparse) == 0) {
      dense_ = numbers + kLanes * mesh.layout.attribute_floats() + lane;
      return;
    }
    const BlockExtra& extra = mesh.extras[block.extra];
    influences_ = mesh.sparse.influences.data() + extra.influences;
    const std::uint32_t* ends = mesh.sparse.lane_ends.data() + extra.lane_ends;
    for (std::uint32_t i = 0; i < kVectorLanes; ++i) {
      next_[i] = lane + i == 0 ? 0 : ends[lane + i - 1];
      end_[i] = ends[lane + i];
    }
  }

  /// Call it for each slot of the block, in order.
  SUNDER_INLINE V of(std::uint32_t k, std::uint16_t slot) {
    if (dense_ != nullptr) return load(dense_ + kLanes * k);
    alignas(64) float weights[kLanes];
    for (std::uint32_t i = 0; i < kVectorLanes; ++i)
      weights[i] = next_[i] < end_[i] && influences_[next_[i]].slot == slot
                       ? influences_[next_[i]++].weight
                       : 0.0f;
    return load(weights);
  }

 private:
  const float* dense_ = nullptr;
  const Influence* influences_ = nullptr;
  std::uint32_t next_[kLanes] = {}, end_[kLanes] = {};
};

SUNDER_INLINE void store_linear(const Linear& m, float* numbers) {
  store(m.xx, numbers);
  store(m.xy, numbers + kLanes);
  store(m.xz, numbers + 2 * kLanes);
  store(m.yx, numbers + 3 * kLanes);
  store(m.yy, numbers + 4 * kLanes);
  store(m.yz, numbers + 5 * kLanes);
  store(m.zx, numbers + 6 * kLanes);
  store(m.zy, numbers + 7 * kLanes);
  store(m.zz, numbers + 8 * kLanes);
}

SUNDER_INLINE Linear load_linear(const float* numbers) {
  return {load(numbers),
          load(numbers + kLanes),
          load(numbers + 2 * kLanes),
          load(numbers + 3 * kLanes),
          load(numbers + 4 * kLanes),
          load(numbers + 5 * kLanes),
          load(numbers + 6 * kLanes),
          load(numbers + 7 * kLanes),
          load(numbers + 8 * kLanes)};
}

SUNDER_INLINE Matrix load_matrix(const float* numbers) {
  const Linear m = load_linear(numbers);
  return {m.xx,
          m.xy,
          m.xz,
          m.yx,
          m.yy,
          m.yz,
          m.zx,
          m.zy,
          m.zz,
          load(numbers + 9 * kLanes),
          load(numbers + 10 * kLanes),
          load(numbers + 11 * kLanes)};
}

/// The motion of the blended dual quaternions, applied after the blended stretch. Both signs of a
/// quaternion are the same rotation; each is taken with the sign that agrees with the sum so far,
/// which gives the shorter way. Source: Kavan, Collins, Zara, O'Sullivan, Geometric skinning with
/// approximate dual quaternion blending, TOG 2008 [kavan2008dual].
inline void blend_motions(const SkinWork& work, const Block& block, const float* numbers,
                          BlendedLanes& blended) {
  const PaletteData& palette = *work.palette;
  const std::uint16_t* slots = work.mesh->slots.data() + block.slots;
  const bool is_stretched = moves_by(work, block, palette.dual.is_stretched);
  for (std::uint32_t lane = 0; lane < kLanes; lane += kVectorLanes) {
    const V none = zero();
    V x = none, y = none, z = none, w = none, dx = none, dy = none, dz = none, dw = none;
    Linear stretch = {none, none, none, none, none, none, none, none, none},
           stretch_of_normals = stretch;
    SlotWeights weights(work, block, numbers, lane);
    for (std::uint32_t k = 0; k < block.slot_count; ++k) {
      const float* of = palette.dual.motions.data() + 8 * static_cast<std::size_t>(slots[k]);
      const V agreement =
          add_product(w, set(of[3]),
                      add_product(z, set(of[2]), add_product(y, set(of[1]), mul(x, set(of[0])))));
      const V positive = weights.of(k, slots[k]),
              weight = negate_where_negative(agreement, positive);
      x = add_product(weight, set(of[0]), x);
      y = add_product(weight, set(of[1]), y);
      z = add_product(weight, set(of[2]), z);
      w = add_product(weight, set(of[3]), w);
      dx = add_product(weight, set(of[4]), dx);
      dy = add_product(weight, set(of[5]), dy);
      dz = add_product(weight, set(of[6]), dz);
      dw = add_product(weight, set(of[7]), dw);
      if (!is_stretched) continue;
      add_linear(positive, palette.dual.stretches.data() + 18 * static_cast<std::size_t>(slots[k]),
                 stretch);
      add_linear(positive,
                 palette.dual.stretches.data() + 18 * static_cast<std::size_t>(slots[k]) + 9,
                 stretch_of_normals);
    }
    const V length = sqrt(add_product(w, w, add_product(z, z, add_product(y, y, mul(x, x)))));
    const V scale = div(set(1.0f), max(length, set(1e-30f)));  // unused lanes have length 0
    x = mul(x, scale), y = mul(y, scale), z = mul(z, scale), w = mul(w, scale);
    dx = mul(dx, scale), dy = mul(dy, scale), dz = mul(dz, scale), dw = mul(dw, scale);

    const V one = set(1.0f), two = set(2.0f);
    const V xx = mul(x, x), yy = mul(y, y), zz = mul(z, z);
    Linear turn;
    turn.xx = sub(one, mul(two, add(yy, zz)));
    turn.yy = sub(one, mul(two, add(xx, zz)));
    turn.zz = sub(one, mul(two, add(xx, yy)));
    turn.xy = mul(two, add(mul(x, y), mul(w, z)));
    turn.yx = mul(two, sub(mul(x, y), mul(w, z)));
    turn.xz = mul(two, sub(mul(x, z), mul(w, y)));
    turn.zx = mul(two, add(mul(x, z), mul(w, y)));
    turn.yz = mul(two, add(mul(y, z), mul(w, x)));
    turn.zy = mul(two, sub(mul(y, z), mul(w, x)));
    // Twice the dual part times the conjugate of the real part.
    const V tx = mul(two, add(sub(mul(dx, w), mul(dw, x)), sub(mul(dz, y), mul(dy, z))));
    const V ty = mul(two, add(sub(mul(dy, w), mul(dw, y)), sub(mul(dx, z), mul(dz, x))));
    const V tz = mul(two, add(sub(mul(dz, w), mul(dw, z)), sub(mul(dy, x), mul(dx, y))));

    Linear linear = turn, normal = turn;
    if (is_stretched) {  // adds zero for a vertex without stretched bones: the same bits as in
                         // other blocks
      linear = sum(turn, product(turn, stretch));
      normal = sum(turn, product(turn, stretch_of_normals));
    }
    store_linear(linear, blended.matrix + lane);
    store(tx, blended.matrix + 9 * kLanes + lane);
    store(ty, blended.matrix + 10 * kLanes + lane);
    store(tz, blended.matrix + 11 * kLanes + lane);
    store_linear(normal, blended.normal + lane);
  }
}

// --- Output.

SUNDER_INLINE bool is_packed(const StridedFloats<float>& array, std::size_t components) {
  return array.stride == components * sizeof(float);
}

/// The results of a block whose vertices are not packed one after another, before they are
/// scattered.
struct PosedLanes {
  alignas(64) float positions[3 * kLanes];
  alignas(64) float normals[3 * kLanes];
  alignas(64) float tangents[4 * kLanes];
};

inline void scatter(const StridedFloats<float>& to, const float* values, std::size_t components,
                    const std::uint32_t* places, std::uint32_t count) {
  unsigned char* bytes = reinterpret_cast<unsigned char*>(to.data);
  if (components == 3)
    for (std::uint32_t lane = 0; lane < count; ++lane)
      std::memcpy(bytes + to.stride * places[lane], values + 3 * lane, 12);
  else
    for (std::uint32_t lane = 0; lane < count; ++lane)
      std::memcpy(bytes + to.stride * places[lane], values + 4 * lane, 16);
}

// --- Vertices with a position per influence: few, so they are posed one by one, in double.

struct ExactSum {
  double x = 0, y = 0, z = 0;
};

/// Adds the part of an influence: the linear part of its matrix (9 numbers) times the influence's
/// own vector plus its morph displacements.
inline void add_part(const SkinWork& work, const ExactLane& lane, const float* linear,
                     std::uint32_t influence, std::size_t part, ExactSum& sum) {
  const Blocks& mesh = *work.mesh;
  const std::size_t one = mesh.layout.displacement_floats(), all = one * lane.influence_count;
  const float* own = mesh.exact.stream.data() + lane.numbers + one * influence + part;
  double v[3] = {own[0], own[1], own[2]};
  for (std::uint32_t j = 0; j < mesh.layout.morph_count; ++j) {
    const double weight = work.morph_weights[j];
    const float* delta = own + all * (j + 1);
    for (std::size_t c = 0; c < 3; ++c) v[c] += weight * delta[c];
  }
  sum.x += linear[0] * v[0] + linear[3] * v[1] + linear[6] * v[2];
  sum.y += linear[1] * v[0] + linear[4] * v[1] + linear[7] * v[2];
  sum.z += linear[2] * v[0] + linear[5] * v[1] + linear[8] * v[2];
}

inline void write_exact(const ExactSum& sum, bool unit_length, float* to) {
  double scale = 1;
  if (unit_length) {
    const double length = std::sqrt(sum.x * sum.x + sum.y * sum.y + sum.z * sum.z);
    if (!(length > 0)) return;  // the bind direction, which the block has written, stays
    scale = 1 / length;
  }
  to[0] = static_cast<float>(scale * sum.x);
  to[1] = static_cast<float>(scale * sum.y);
  to[2] = static_cast<float>(scale * sum.z);
}

inline void pose_exact_lanes(const SkinWork& work, const Block& block, PosedLanes& posed) {
  const Blocks& mesh = *work.mesh;
  const BlockExtra& extra = mesh.extras[block.extra];
  const std::size_t tangent_part = mesh.layout.has_normals ? 6 : 3;
  for (std::uint32_t i = extra.exact_lanes; i < extra.exact_lanes + extra.exact_count; ++i) {
    const ExactLane& lane = mesh.exact.lanes[i];
    ExactSum position, normal, tangent;
    for (std::uint32_t k = 0; k < lane.influence_count; ++k) {
      const Influence& influence = mesh.exact.influences[lane.influences + k];
      const float* matrix =
          work.palette->matrices.data() + 12 * static_cast<std::size_t>(influence.slot);
      const double weight = influence.weight;
      add_part(work, lane, matrix, k, 0, position);
      position.x += weight * matrix[9];
      position.y += weight * matrix[10];
      position.z += weight * matrix[11];
      if (work.target.normals.data != nullptr)
        add_part(
            work, lane,
            work.palette->normal_matrices.data() + 9 * static_cast<std::size_t>(influence.slot), k,
            3, normal);
      if (work.target.tangents.data != nullptr)
        add_part(work, lane, matrix, k, tangent_part, tangent);
    }
    write_exact(position, false, posed.positions + 3 * lane.lane);
    if (work.target.normals.data != nullptr)
      write_exact(normal, work.target.unit_length, posed.normals + 3 * lane.lane);
    if (work.target.tangents.data != nullptr)
      write_exact(tangent, work.target.unit_length, posed.tangents + 4 * lane.lane);
  }
}

// --- Blocks.

/// Poses `kVectorLanes` vertices from `lane` on. Outputs that are not wanted are null.
template <bool kStream>
SUNDER_INLINE void pose_lanes(const SkinWork& work, const Block& block, const float* numbers,
                              std::uint32_t lane, const Matrix& matrix, const Linear& normal_matrix,
                              float* positions, float* normals, float* tangents) {
  const Blocks& mesh = *work.mesh;
  const float* at_lane = numbers + lane;
  const Vector position = transform(matrix, load_morphed(work, block, at_lane, lane));
  store_interleaved<kStream>(position.x, position.y, position.z, positions + 3 * lane);
  if (normals != nullptr) {
    const Vector bind = load_morphed(work, block, at_lane + 3 * kLanes, 3 * kLanes + lane);
    Vector normal = transform(normal_matrix, bind);
    if (work.target.unit_length) normal = unit_or(normal, bind);
    store_interleaved<kStream>(normal.x, normal.y, normal.z, normals + 3 * lane);
  }
  if (tangents != nullptr) {
    const std::size_t part = mesh.layout.has_normals ? 6 * kLanes : 3 * kLanes;
    const Vector bind = load_morphed(work, block, at_lane + part, part + lane);
    Vector tangent = transform(linear_of(matrix), bind);
    if (work.target.unit_length) tangent = unit_or(tangent, bind);
    store_interleaved4(tangent.x, tangent.y, tangent.z, load(at_lane + part + 3 * kLanes),
                       tangents + 4 * lane);
  }
}

/// Poses a block of any kind, by any method.
template <bool kStream>
void pose_any_block(const SkinWork& work, const Block& block, const float* numbers,
                    float* positions, float* normals, float* tangents) {
  const Blocks& mesh = *work.mesh;
  const PaletteData& palette = *work.palette;
  if (palette.method == SkinningMethod::linear && (block.kind & kSparse) == 0) {
    const float* weights = numbers + kLanes * mesh.layout.attribute_floats();
    const std::uint16_t* slots = mesh.slots.data() + block.slots;
    const bool uneven =
        normals != nullptr && palette.any_uneven && moves_by(work, block, palette.is_uneven);
    for (std::uint32_t lane = 0; lane < kLanes; lane += kVectorLanes) {
      const Matrix matrix =
          blend_slots(weights + lane, slots, block.slot_count, palette.matrices.data());
      if (uneven)
        pose_lanes<kStream>(work, block, numbers, lane, matrix,
                            blend_normal_matrices(weights + lane, slots, block.slot_count,
                                                  palette.normal_matrices.data()),
                            positions, normals, tangents);
      else
        pose_lanes<kStream>(work, block, numbers, lane, matrix, linear_of(matrix), positions,
                            normals, tangents);
    }
    return;
  }
  BlendedLanes blended;
  if (palette.method == SkinningMethod::linear)
    blend_lanes(work, block, blended);
  else
    blend_motions(work, block, numbers, blended);
  for (std::uint32_t lane = 0; lane < kLanes; lane += kVectorLanes)
    pose_lanes<kStream>(work, block, numbers, lane, load_matrix(blended.matrix + lane),
                        load_linear(blended.normal + lane), positions, normals, tangents);
}

// The common case: weights per slot; positions and possibly normals, which are transformed like the
// positions. The operations are those of pose_any_block(), but every number stays in a register.
// Compilers do that for variables and not for structs, hence the macros.
#define SUNDER_ENTRIES(DO) \
  DO(xx, 0)                \
  DO(xy, 1)                \
  DO(xz, 2)                \
  DO(yx, 3) DO(yy, 4) DO(yz, 5) DO(zx, 6) DO(zy, 7) DO(zz, 8) DO(tx, 9) DO(ty, 10) DO(tz, 11)

template <bool kStream>
SUNDER_INLINE void transform_common(V xx, V xy, V xz, V yx, V yy, V yz, V zx, V zy, V zz, V tx,
                                    V ty, V tz, const float* from, bool unit_length,
                                    float* positions, float* normals) {
  V x = load(from), y = load(from + kLanes), z = load(from + 2 * kLanes);
  store_interleaved<kStream>(add(row(xx, yx, zx, x, y, z), tx), add(row(xy, yy, zy, x, y, z), ty),
                             add(row(xz, yz, zz, x, y, z), tz), positions);
  if (normals == nullptr) return;
  x = load(from + 3 * kLanes), y = load(from + 4 * kLanes), z = load(from + 5 * kLanes);
  const Vector normal = {row(xx, yx, zx, x, y, z), row(xy, yy, zy, x, y, z),
                         row(xz, yz, zz, x, y, z)};
  if (unit_length) {
    const Vector unit = unit_or(normal, {x, y, z});
    store_interleaved<kStream>(unit.x, unit.y, unit.z, normals);
  } else {
    store_interleaved<kStream>(normal.x, normal.y, normal.z, normals);
  }
}

template <bool kStream>
SUNDER_INLINE void pose_common_block(const float* matrices, const std::uint16_t* slots,
                                     std::uint32_t slot_count, std::uint32_t attribute_floats,
                                     const float* numbers, bool unit_length, float* positions,
                                     float* normals) {
  for (std::uint32_t lane = 0; lane < kLanes; lane += kVectorLanes) {
    const float* weights = numbers + kLanes * attribute_floats + lane;
#define SUNDER_BEGIN(entry, i) V entry = zero();
#define SUNDER_ADD(entry, i) entry = add_product(w, set(of[i]), entry);
    SUNDER_ENTRIES(SUNDER_BEGIN)
    for (std::uint32_t k = 0; k < slot_count; ++k) {
      const V w = load(weights + kLanes * k);
      const float* of = matrices + 12 * static_cast<std::size_t>(slots[k]);
      SUNDER_ENTRIES(SUNDER_ADD)
    }
#undef SUNDER_BEGIN
#undef SUNDER_ADD
    transform_common<kStream>(xx, xy, xz, yx, yy, yz, zx, zy, zz, tx, ty, tz, numbers + lane,
                              unit_length, positions + 3 * lane,
                              normals == nullptr ? nullptr : normals + 3 * lane);
  }
}

/// Poses two consecutive blocks with the same slots: each number of a matrix is loaded once for
/// both, because loads limit a single block. Only for vectors of 16 lanes, which come with 32
/// registers.
template <bool kStream>
SUNDER_INLINE void pose_common_pair(const float* matrices, const std::uint16_t* slots,
                                    std::uint32_t slot_count, std::uint32_t attribute_floats,
                                    const float* numbers, bool unit_length, float* positions,
                                    float* normals) {
  const float* next = numbers + kLanes * (attribute_floats + slot_count);
  const float *weights = numbers + kLanes * attribute_floats,
              *next_weights = next + kLanes * attribute_floats;
#define SUNDER_BEGIN(entry, i) V entry = zero(), next_##entry = entry;
#define SUNDER_ADD(entry, i)                 \
  const V of_##entry = set(of[i]);           \
  entry = add_product(w, of_##entry, entry); \
  next_##entry = add_product(next_w, of_##entry, next_##entry);
  SUNDER_ENTRIES(SUNDER_BEGIN)
  for (std::uint32_t k = 0; k < slot_count; ++k) {
    const V w = load(weights + kLanes * k), next_w = load(next_weights + kLanes * k);
    const float* of = matrices + 12 * static_cast<std::size_t>(slots[k]);
    SUNDER_ENTRIES(SUNDER_ADD)
  }
#undef SUNDER_BEGIN
#undef SUNDER_ADD
  transform_common<kStream>(xx, xy, xz, yx, yy, yz, zx, zy, zz, tx, ty, tz, numbers, unit_length,
                            positions, normals);
  transform_common<kStream>(next_xx, next_xy, next_xz, next_yx, next_yy, next_yz, next_zx, next_zy,
                            next_zz, next_tx, next_ty, next_tz, next, unit_length,
                            positions + 3 * kLanes,
                            normals == nullptr ? nullptr : normals + 3 * kLanes);
}
#undef SUNDER_ENTRIES

/// Whether a block is common, regardless of where its vertices go.
SUNDER_INLINE bool is_common(const SkinWork& work, const Block& block) {
  return work.is_common && (block.kind & (kSparse | kMorphed)) == 0 &&
         !(work.palette->any_uneven && moves_by(work, block, work.palette->is_uneven));
}

/// Poses a block into memory and scatters its vertices to their places.
inline void pose_apart(const SkinWork& work, const Block& block, const float* numbers) {
  const VertexTarget& target = work.target;
  PosedLanes posed;
  float* normals = target.normals.data == nullptr ? nullptr : posed.normals;
  if (is_common(work, block))
    pose_common_block<false>(work.palette->matrices.data(), work.mesh->slots.data() + block.slots,
                             block.slot_count, work.attribute_floats, numbers, target.unit_length,
                             posed.positions, normals);
  else
    pose_any_block<false>(work, block, numbers, posed.positions, normals,
                          target.tangents.data == nullptr ? nullptr : posed.tangents);
  if ((block.kind & kExact) != 0 && work.palette->method == SkinningMethod::linear)
    pose_exact_lanes(work, block, posed);

  std::uint32_t in_order[kLanes];
  const std::uint32_t* places = in_order;
  if ((block.kind & kScattered) != 0)
    places = work.mesh->scattered.places.data() + work.mesh->extras[block.extra].places;
  else
    for (std::uint32_t lane = 0; lane < kLanes; ++lane) in_order[lane] = block.first_vertex + lane;
  scatter(target.positions, posed.positions, 3, places, block.lane_count);
  if (target.normals.data != nullptr)
    scatter(target.normals, posed.normals, 3, places, block.lane_count);
  if (target.tangents.data != nullptr)
    scatter(target.tangents, posed.tangents, 4, places, block.lane_count);
}

template <bool kStream>
void pose_blocks(const SkinWork& work, std::uint32_t first, std::uint32_t end) {
  // Variables of this function: compilers take it that a store of a vector may change anything
  // else.
  const VertexTarget target = work.target;
  const Block* const blocks = work.mesh->blocks.data();
  const float* const stream = work.mesh->stream.data();
  const std::uint16_t* const slots = work.mesh->slots.data();
  const float* const matrices = work.palette->matrices.data();
  const std::uint32_t attribute_floats = work.attribute_floats;
  const bool has_normals = target.normals.data != nullptr, unit_length = target.unit_length;
  const bool packed = is_packed(target.positions, 3) &&
                      (!has_normals || is_packed(target.normals, 3)) &&
                      (target.tangents.data == nullptr || is_packed(target.tangents, 4));
  const bool all_common = work.is_common && packed && !work.palette->any_uneven;
  for (std::uint32_t b = first; b < end; ++b) {
    const Block block = blocks[b];
    const float* numbers = stream + block.numbers;
    prefetch_block(numbers, attribute_floats + block.slot_count);
    const std::size_t v = block.first_vertex;
    float* const positions = target.positions.data + 3 * v;
    float* const normals = has_normals ? target.normals.data + 3 * v : nullptr;
    if (all_common && block.kind == 0 && block.lane_count == kLanes) {
      if constexpr (kVectorLanes == kLanes) {
        if (b + 1 < end && blocks[b + 1].slots == block.slots && blocks[b + 1].kind == 0 &&
            blocks[b + 1].lane_count == kLanes) {
          ++b;
          prefetch_block(stream + blocks[b].numbers, attribute_floats + block.slot_count);
          pose_common_pair<kStream>(matrices, slots + block.slots, block.slot_count,
                                    attribute_floats, numbers, unit_length, positions, normals);
          continue;
        }
      }
      pose_common_block<kStream>(matrices, slots + block.slots, block.slot_count, attribute_floats,
                                 numbers, unit_length, positions, normals);
    } else if (!packed || block.lane_count != kLanes || (block.kind & (kScattered | kExact)) != 0) {
      pose_apart(work, block, numbers);
    } else if (is_common(work, block)) {
      pose_common_block<kStream>(matrices, slots + block.slots, block.slot_count, attribute_floats,
                                 numbers, unit_length, positions, normals);
    } else {
      pose_any_block<kStream>(
          work, block, numbers, positions, normals,
          target.tangents.data == nullptr ? nullptr : target.tangents.data + 4 * v);
    }
  }
  finish_streaming();
}

void run_kernel(const SkinWork& work, std::uint32_t first, std::uint32_t end) {
  const auto is_aligned = [](const float* data) {
    return reinterpret_cast<std::uintptr_t>(data) % 64 == 0;
  };  // null is, too
  if (work.is_beyond_cache && is_aligned(work.target.positions.data) &&
      is_aligned(work.target.normals.data))
    pose_blocks<true>(work, first, end);
  else
    pose_blocks<false>(work, first, end);
}
