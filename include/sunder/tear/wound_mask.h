#pragma once

#include <sunder/tear/torn_model.h>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace sunder {

struct WoundMaskOptions {
  std::uint32_t width = 1024, height = 1024;  ///< Texels of the texture, 1 to 16384.
  /// Index in Mesh::uv_sets; kNone: no texture, for distance_at() alone.
  std::uint32_t uv_set = 0;
  /// The submesh whose triangles are painted, where each has a texture of its own; kNone: all.
  std::uint32_t submesh = kNone;
  /// Where in the texture a place (u, v, 1) of the texture coordinates is.
  Eigen::Matrix<double, 2, 3> texture_from_uv = Eigen::Matrix<double, 2, 3>::Identity();
  double reach = 0.01;  ///< Metres along the surface; texels farther from a lip have this distance.
  /// Texels, 1 to 64. So far beyond the border of a chart texels get the value of the nearest place
  /// in it, so that a filter that reads across a UV seam finds the wound.
  std::uint32_t dilation = 4;
  /// The operations whose lips and removed skin count, as TornModel::history() numbers them: those
  /// before the first one and after the last one are as if they had made none, and paths cross
  /// theirs. kNone: all further.
  std::uint32_t first_operation = 0, operation_count = kNone;
};

/// What else a mask knows of the lip that is nearest to a texel.
enum class WoundChannel : std::uint8_t {
  /// The number of operations since the one that made it, 0 for the newest one; -1 where no lip is
  /// within reach.
  age,
  /// How deep the wall below it is, metres in bind space; 0 where there is none.
  depth,
};

/// A part of a texture. Texels are counted from the upper left corner.
struct TexelRectangle {
  std::uint32_t left = 0, top = 0;
  std::uint32_t width = 0, height = 0;  ///< 0: empty.

  [[nodiscard]] bool is_empty() const { return width == 0; }
  bool operator==(const TexelRectangle&) const = default;
};

/// A place of the source.
struct SourcePlace {
  std::uint32_t triangle = 0;              ///< Of the mesh.
  std::array<double, 3> barycentric = {};  ///< Per corner; sum 1.
};

/// How blood runs from lips: in rivulets, each along the steepest way down.
struct BloodFlowOptions {
  Vec3d down = -Vec3d::UnitY();  ///< In model space; any length but 0.
  double length = 0.06;          ///< Of the longest one along the surface in bind space, metres.
  double width = 0.003;          ///< Of the widest one where it begins, metres.
  double spacing = 0.012;        ///< Along lips from one to the next, on the mean; metres.
  std::uint64_t seed = 0;        ///< Chooses where they begin and how they wander.
};

/// Counts of what the texture cannot show.
struct WoundMaskNotes {
  /// Texels whose centre is inside several triangles: mirrored or stacked charts. They show the
  /// wounds of the triangle with the lowest index alone.
  std::uint32_t overlapping_texels = 0;
  /// Triangles that have no area in the texture, or that repeat it: wider than the whole of it.
  /// They are not painted.
  std::uint32_t unpainted_triangles = 0;
};

/// The wounds of a model in the texture of one of its meshes: per texel, the distance to the
/// nearest lip along the source's surface in bind space. A lip is an edge that operations made a
/// border, or at which a wall or cap begins. Texture coordinates wrap around: those of a tile
/// beyond 0 to 1 are painted at the same place of the texture.
///
/// Distances are lengths of straight lines in unfolded faces, as in Chen and Han 1990 and Xin and
/// Wang 2009, from each lip and from the corners that paths bend around; docs/wound_mask.md
/// describes the method. The same model gives the same bits on every machine. One thread at a time
/// per object.
class SUNDER_API WoundMask {
 public:
  /// Paints the whole texture.
  /// @param mesh  index in Character::meshes.
  /// @return index_out_of_range: no such mesh or submesh; not_found: no such UV set;
  ///         invalid_argument: an option is outside its range; limit_exceeded: out of memory.
  ///         O(triangles + texels + lips x faces within reach of each). Allocates 8 bytes per texel
  ///         and about 90 per triangle of the model.
  static Result<WoundMask> create(const TornModel& model, std::uint32_t mesh,
                                  const WoundMaskOptions& options = {});
  WoundMask(WoundMask&&) noexcept;
  WoundMask& operator=(WoundMask&&) noexcept;
  ~WoundMask();

  /// Follows an operation, an undo or a redo: paints anew the triangles within reach of lips that
  /// came or went. The result is that of create(), bit for bit.
  /// @param model   that of create(), or one in the same state.
  /// @param change  that of the call; calls must not be left out.
  /// @return the texels that may have changed; invalid_argument: the model has another source, for
  ///         instance after TornModel::compact(); limit_exceeded: out of memory, then make another
  ///         mask. O(changed triangles + changed lips x faces within reach of each + texels of
  ///         these faces).
  Result<TexelRectangle> update(const TornModel& model, const ChangeRecord& change);

  /// Lets blood run from the lips over the surface in a pose, lips closed, around bodies and over
  /// seams, until it is flat, overhangs at its lowest place, or ends. Removed skin stops it.
  /// Rivulets wander, are narrower at their ends, and are the same on every machine.
  /// @return how much blood runs over each texel, as distances() is ordered: 0 to 1;
  ///         invalid_argument: an option is not finite or not above 0, or the model has another
  ///         source; the failures of compute_palette(); limit_exceeded: out of memory.
  ///         O(vertices + lips + texels of the faces beside rivulets).
  [[nodiscard]] Result<std::vector<float>> flow(const TornModel& model, const ModelPose& pose,
                                                const BloodFlowOptions& options = {}) const;

  /// What else is known of the lip nearest to each texel, as distances() is ordered. Of lips at the
  /// same distance the newest or deepest one counts. The depth of a lip is the mean of that at its
  /// ends.
  /// @param model  in the state that the mask followed.
  /// @return invalid_argument: no such channel, the model has another source, or the mask did not
  ///         follow it; limit_exceeded: out of memory. O(texture + lips x faces within reach of
  ///         each + texels of these faces).
  [[nodiscard]] Result<std::vector<float>> channel(const TornModel& model,
                                                   WoundChannel wanted) const;
  /// How far the skin within reach of lips is stretched: the largest principal stretch of the torn
  /// triangle that a texel shows, from bind space; 1 for removed skin and beyond reach. A triangle
  /// less high than a thousandth of its longest side has the stretch of the largest one beside it.
  /// @param posed  the positions of the torn mesh's vertices, as deform_mesh() or a
  ///               CharacterInstance gives them, with or without displacements of tissue.
  /// @return as channel(); size_mismatch; non_finite_value. O(texture + texels within reach)
  [[nodiscard]] Result<std::vector<float>> stretches(const TornModel& model,
                                                     std::span<const Vec3f> posed) const;

  /// Per texel, row by row from the top: metres, at most WoundMaskOptions::reach. Negative where
  /// operations removed the skin. Texels that no triangle uses have the reach.
  [[nodiscard]] std::span<const float> distances() const;
  /// Whether a triangle, or the dilation beyond one, uses a texel. The index is unchecked.
  [[nodiscard]] bool is_painted(std::uint32_t column, std::uint32_t row) const;
  /// The place that a texel shows; none if it is not painted. The index is unchecked.
  [[nodiscard]] std::optional<SourcePlace> place_of(std::uint32_t column, std::uint32_t row) const;
  /// Whether all painted triangles that see a wound have an area in the texture and texels that no
  /// other triangle uses. Otherwise the texture does not show each wound at its place alone.
  /// O(texels of these triangles).
  [[nodiscard]] bool has_own_texels() const;
  /// The distance at any place of the mesh, as distances() has it; painted or not. The triangle is
  /// unchecked. O(lips within reach of it).
  [[nodiscard]] double distance_at(const SourcePlace& place) const;
  [[nodiscard]] const WoundMaskOptions& options() const;
  [[nodiscard]] const WoundMaskNotes& notes() const;

 private:
  struct State;
  explicit WoundMask(std::unique_ptr<State> state);

  std::unique_ptr<State> state_;
};

}  // namespace sunder
