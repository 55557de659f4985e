#pragma once

#include <sunder/tear/wound_mask.h>

#include <algorithm>
#include <unordered_map>
#include <vector>

#include "tear/model/model_access.h"
#include "tear/wound_mask/beams_of_faces.h"
#include "tear/wound_mask/spread.h"
#include "tear/wound_mask/texels.h"
#include "tear/wound_mask/torn_parts.h"

namespace sunder {

/// A lip, or something that is handled like one, that a face sees.
template <class Value>
struct SeenLip {
  Index face = 0;
  tear::Beam beam;
  Value value = {};
};

struct WoundMask::State {
  State(const TornModel& model, std::uint32_t of_mesh, const WoundMaskOptions& wanted)
      : options(wanted),
        mesh(of_mesh),
        faces(model.source()),
        texels(model.source(), mesh, faces, options),
        finder(faces.surface),
        spread(faces, options.reach),
        beams(static_cast<Index>(faces.shapes.size())),
        distances(options.uv_set == kNone ? 0 : std::size_t{options.width} * options.height,
                  static_cast<float>(options.reach)) {}

  /// Finds the lips of source triangles, ascending, again.
  /// @param seen  what sees lips that came or went is appended.
  void renew(std::span<const Index> origins, const TornModel& model, std::vector<Index>& seen);
  /// The lips and the skin that the wanted operations made.
  [[nodiscard]] tear::TornParts find(Index face, const tear::SurfaceEditor& editor,
                                     std::span<const tear::EditLog::Extent> begins) const;
  /// Paints a face. Calls visit(column, row) for each texel.
  template <class Visit>
  void paint(Index face, Visit visit);
  [[nodiscard]] Result<TexelRectangle> update(const TornModel& model, const ChangeRecord& change);
  [[nodiscard]] bool has_triangles_of(const Character& other) const;
  [[nodiscard]] double distance_at(Index face, const std::array<double, 3>& place) const;
  [[nodiscard]] bool is_removed(Index face, const std::array<double, 3>& place) const;
  /// Whether it followed all operations of a model with this source.
  [[nodiscard]] Status check_in_step(const TornModel& model) const;
  [[nodiscard]] std::vector<float> ages(const TornModel& model) const;
  [[nodiscard]] std::vector<float> depths(const TornModel& model) const;
  [[nodiscard]] std::vector<float> stretches(const TornModel& model,
                                             std::span<const Vec3f> posed) const;
  [[nodiscard]] bool counts_all_operations() const {
    return options.first_operation == 0 && options.operation_count == kNone;
  }
  /// Source triangles with lips or removed skin, ascending.
  [[nodiscard]] std::vector<Index> torn_faces() const;
  [[nodiscard]] std::vector<float> flow(const Character& source,
                                        std::span<const std::vector<Vec3f>> posed,
                                        const BloodFlowOptions& options) const;

  /// Calls visit(texel, place, seen) for the texels of the mesh's faces that see something: the
  /// index of the texel, its place in the face's plane, and what the face sees.
  template <class Value, class Visit>
  void for_each_texel_beside(std::vector<SeenLip<Value>>& seen, Visit visit) const;

  WoundMaskOptions options;
  std::uint32_t mesh = 0;
  tear::FlatFaces faces;
  tear::Texels texels;
  tear::PartFinder finder;
  tear::Spread spread;
  tear::BeamsOfFaces beams;
  std::unordered_map<Index, tear::TornParts> torn;  ///< Source triangles with lips or removed skin.
  std::vector<float> distances;
  std::vector<tear::Beam> seen_by_face;  ///< Scratch of paint().
};

template <class Value, class Visit>
void WoundMask::State::for_each_texel_beside(std::vector<SeenLip<Value>>& seen, Visit visit) const {
  std::stable_sort(seen.begin(), seen.end(), [](const SeenLip<Value>& a, const SeenLip<Value>& b) {
    return a.face < b.face;
  });
  const Index first = faces.surface.first_triangle[mesh],
              last = faces.surface.first_triangle[mesh + 1];
  for (std::size_t begin = 0, end = 0; begin < seen.size(); begin = end) {
    const Index face = seen[begin].face;
    while (end < seen.size() && seen[end].face == face) ++end;
    if (face < first || face >= last) continue;
    const std::span<const SeenLip<Value>> of_face(&seen[begin], end - begin);
    texels.for_each_of(face - first, [&](std::uint32_t column, std::uint32_t row,
                                         const std::array<double, 3>& place) {
      visit(std::size_t{row} * options.width + column, faces.place(face, place), of_face);
    });
  }
}

namespace tear {

/// The times at which the operations of a model began, and the stroke under way.
[[nodiscard]] std::vector<EditLog::Extent> begins_of(const TornModel& model);

}  // namespace tear
}  // namespace sunder
