#include "aim/surface_parts.h"

#include <algorithm>
#include <array>

#include "aim/joined_sets.h"
#include "core/internal/ordered.h"

namespace sunder::aim {
namespace {

/// A part that holds less of the limb and of other bones than this share of what the limb moves is
/// a scarf between them, not their body; unless it is a large part of the limb and shares so much
/// of itself: a face below much hair and a hat.
constexpr double kLeastShared = 0.02;
/// A large part of the limb holds at least this share of it. Where no part joins it to others,
/// those are its body. A smaller part that joins it is a joint between them: the ball in the hip of
/// a doll.
constexpr double kLeastOfLimb = 0.1;
/// The limb alone moves a part if it moves at least so much of it.
constexpr double kLeastOfProp = 0.9;

double area_of(const PosedSurface& surface, Index face) {
  const auto [a, b, c] = surface.corners(face);
  return 0.5 * norm((b - a).cross(c - a));
}

}  // namespace

SurfaceParts::SurfaceParts(const Limb& limb) {
  find_parts(limb.surface);
  measure(limb);
  choose_body();
}

bool SurfaceParts::is_of_prop(Index face) const {
  const Part& part = parts_[part_of_face_[face]];
  return !is_of_body(face) && part.moved >= kLeastOfProp * part.size;
}

void SurfaceParts::find_parts(const PosedSurface& surface) {
  const tear::Surface& of = surface.surface();
  const Index count = surface.face_count();
  JoinedSets joined(count);
  for (Index h = 0; h < 3 * count; ++h)
    if (of.twin[h] != kNone) joined.join(h / 3, of.twin[h] / 3);
  for (const auto& [a, b] : of.cracks) joined.join(a / 3, b / 3);
  // What a cut has separated is one part: the pieces of a triangle have the same origin.
  for (Index face = 0; face < count; ++face) {
    const tear::TriangleRef ref = of.triangle(face);
    const Index origin = of.first_triangle[ref.mesh] + ref.source_triangle;
    if (origin < of.first_triangle[ref.mesh + 1]) joined.join(face, origin);
  }
  std::vector<Index> part_of_set(count, kNone);
  for (Index face = 0; face < count; ++face) {
    Index& part = part_of_set[joined.set_of(face)];
    if (part == kNone) {
      part = static_cast<Index>(parts_.size());
      parts_.emplace_back();
    }
    part_of_face_.push_back(part);
  }
}

void SurfaceParts::measure(const Limb& limb) {
  const Index count = limb.surface.face_count();
  double area = 0, faces = 0;
  for (Index face = 0; face < count; ++face) {
    sizes_.push_back(limb.surface.is_live(face) ? area_of(limb.surface, face) : 0.0);
    area += sizes_.back();
    faces += limb.surface.is_live(face) ? 1 : 0;
  }
  for (Index face = 0; face < count; ++face) {
    moved_sizes_.push_back(0);
    if (!limb.surface.is_live(face)) continue;
    sizes_[face] = 0.5 / faces + (area > 0 ? 0.5 * sizes_[face] / area : 0.0);
    moved_sizes_[face] = sizes_[face] * limb.bones.shares_of_face(face).limb();
    Part& part = parts_[part_of_face_[face]];
    part.size += sizes_[face];
    part.moved += moved_sizes_[face];
  }
}

void SurfaceParts::choose_body() {
  double whole = 0, most = 0;
  Part* best = nullptr;
  for (const Part& part : parts_) whole += part.moved;
  for (Part& part : parts_) {
    const double shared = std::min(part.moved, part.size - part.moved);
    if (!(shared > most) || part.size < kLeastOfLimb * whole) continue;
    most = shared;
    best = &part;
  }
  const auto joins = [&](const Part& part) {
    return most >= kLeastShared * whole ||
           (part.moved >= kLeastOfLimb * whole && most >= kLeastShared * part.size);
  };
  if (best != nullptr && joins(*best)) {
    best->is_body = true;
    return;
  }
  bool has_body = false;
  for (Part& part : parts_) {
    part.is_body = part.moved > 0 && part.moved >= kLeastOfLimb * whole;
    has_body |= part.is_body;
  }
  if (!has_body)  // a soup of faces
    for (Part& part : parts_) part.is_body = true;
}

}  // namespace sunder::aim
