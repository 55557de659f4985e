#pragma once

#include <sunder/core/character.h>
#include <sunder/core/stroke.h>
#include <sunder/tear/change_record.h>
#include <sunder/weights/interpolate.h>

#include <memory>
#include <span>

namespace sunder {

/// What one tear did, in figures.
struct TearReport {
  std::uint32_t pieces = 0;           ///< Connected runs of torn surface. 0: the stroke missed and nothing changed.
  std::uint32_t segments = 0;         ///< Of the stroke.
  std::uint32_t segments_missed = 0;  ///< Met no surface within the blade's reach.
  std::uint32_t faces_crossed = 0;
  std::uint32_t points_added = 0;
  std::uint32_t vertices_added = 0;
  std::uint32_t triangles_added = 0;
  std::uint32_t triangles_retired = 0;  ///< 0: a tear without width removes nothing.
  std::uint32_t blocked = 0;  ///< Places where the surface could not be torn, because its faces are too small or degenerate.
  double length_posed = 0.0;  ///< Of the tear on the posed surface, metres.
};

/// A character that can be torn. It keeps the source, the torn meshes, and the topology of their surface.
class SUNDER_API TornModel {
 public:
  /// @param source  satisfies validate_character(); kept. The model starts as a copy of it.
  /// @return the first fault of the source; empty_input for none; limit_exceeded above 700 million triangles. O(size of the
  /// source).
  static Result<TornModel> create(std::shared_ptr<const Character> source);

  TornModel(TornModel&&) noexcept;
  TornModel& operator=(TornModel&&) noexcept;
  ~TornModel();

  /// Tears the posed surface open along a stroke, without a gap: the two lips coincide until something pulls them apart.
  ///
  /// Each two neighbouring blades sweep a segment, cut by one plane: through the tip where the tear stands (or the first blade's
  /// hit) and the second blade. The tear enters where the sweep first meets the surface, on the layer nearest to the blade's base,
  /// and follows that layer, face to face, while the blade reaches it. Its two ends are joined. See docs/tear.md.
  ///
  /// @param pose    one matrix a bone, all finite; morph weights as the character's.
  /// @param stroke  at least two blades, model space; each longer than zero; neighbours turned by less than 90 degrees.
  /// @param change  written where given: what an engine has to mirror.
  /// @return what was done; a stroke that misses is a success with pieces = 0. size_mismatch, non_finite_value, invalid_argument
  ///         (index = the blade), limit_exceeded (out of memory): the model is as it was, bit for bit.
  ///
  /// O(all faces) where the tear enters, then O(faces crossed). Allocates.
  Result<TearReport> tear(const ModelPose& pose, std::span<const Blade> stroke, ChangeRecord* change = nullptr);

  /// The model as it stands. Meshes have those vertices and triangles of the source first, under their numbers. A torn mesh carries
  /// the attribute `_TEARSIDE`, in which the two lips of a tear differ.
  [[nodiscard]] const Character& character() const;
  [[nodiscard]] const Character& source() const;

  /// Surface points are shared by the vertices that a UV seam or hard edge duplicates, over all meshes.
  [[nodiscard]] std::uint32_t point_count() const;
  /// The point at a corner (0, 1, 2) of a triangle of a mesh. Unchecked.
  [[nodiscard]] std::uint32_t point_at(std::uint32_t mesh, std::uint32_t triangle, std::uint32_t corner) const;
  /// Where an appended vertex came from; vertices of the source have no birth. A copy of one lies in a corner of its birth
  /// triangle. Unchecked.
  [[nodiscard]] Birth birth(std::uint32_t mesh, std::uint32_t vertex) const;
  /// The source triangle that a triangle is a part of. Unchecked.
  [[nodiscard]] std::uint32_t source_triangle(std::uint32_t mesh, std::uint32_t triangle) const;

 private:
  struct State;
  explicit TornModel(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace sunder
