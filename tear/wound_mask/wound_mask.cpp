#include <sunder/skinning/deform.h>
#include <sunder/tear/wound_mask.h>

#include <cmath>
#include <utility>

#include "core/internal/out_of_memory.h"
#include "tear/wound_mask/mask_state.h"
#include "tear/wound_mask/rivulets.h"

namespace sunder {
namespace {

using tear::Beam;
using tear::Surface;
using tear::TornParts;

Status check_options(const TornModel& model, std::uint32_t mesh, const WoundMaskOptions& options) {
  constexpr std::uint32_t kMostTexels = 16384, kMostDilation = 64;
  const Character& source = model.source();
  if (mesh >= source.meshes.size())
    return Status::failure(StatusCode::index_out_of_range, mesh, "mesh %u of %zu", mesh,
                           source.meshes.size());
  if (options.submesh != kNone && options.submesh >= source.meshes[mesh].submeshes.size())
    return Status::failure(StatusCode::index_out_of_range, options.submesh,
                           "submesh %u of mesh %u, which has %zu", options.submesh, mesh,
                           source.meshes[mesh].submeshes.size());
  if (!options.texture_from_uv.allFinite())
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the texture of a wound mask is not at a finite place");
  if (options.uv_set != kNone && options.uv_set >= source.meshes[mesh].uv_sets.size())
    return Status::failure(StatusCode::not_found, options.uv_set,
                           "mesh %u has no texture coordinates %u: it has %zu sets", mesh,
                           options.uv_set, source.meshes[mesh].uv_sets.size());
  const auto is_size = [&](std::uint32_t size) { return size >= 1 && size <= kMostTexels; };
  if (!is_size(options.width) || !is_size(options.height))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "a wound mask has 1 to %u texels a side, not %u x %u", kMostTexels,
                           options.width, options.height);
  if (!(options.reach > 0) || !std::isfinite(static_cast<float>(options.reach)))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the reach of a wound mask must be finite and above 0 metres");
  if (options.dilation < 1 || options.dilation > kMostDilation)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the dilation of a wound mask is 1 to %u texels, not %u", kMostDilation,
                           options.dilation);
  return {};
}

Status check_flow(const BloodFlowOptions& options) {
  const auto is_length = [](double value) {
    return value > 0 && std::isfinite(static_cast<float>(value));
  };
  if (!is_length(options.length) || !is_length(options.width) || !is_length(options.spacing))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "length, width and spacing of rivulets must be finite and above 0");
  if (!options.down.allFinite() || !(options.down.norm() > 0))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the direction down must be finite and not 0");
  return {};
}

/// Grows to hold texels.
class Bounds {
 public:
  void add(std::uint32_t column, std::uint32_t row) {
    left_ = std::min(left_, column);
    right_ = std::max(right_, column + 1);
    top_ = std::min(top_, row);
    bottom_ = std::max(bottom_, row + 1);
  }
  [[nodiscard]] TexelRectangle rectangle() const {
    if (right_ == 0) return {};
    return {left_, top_, right_ - left_, bottom_ - top_};
  }

 private:
  std::uint32_t left_ = kNone, top_ = kNone, right_ = 0, bottom_ = 0;
};

void sort_and_unite(std::vector<Index>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

}  // namespace

void WoundMask::State::renew(std::span<const Index> origins, const TornModel& model,
                             std::vector<Index>& seen) {
  const tear::SurfaceEditor& editor = tear::ModelAccess::state_of(model).editor;
  finder.follow(editor.surface());
  std::vector<tear::EditLog::Extent> begins;
  if (!counts_all_operations()) begins = tear::begins_of(model);
  for (const Index origin : origins) {
    TornParts now = find(origin, editor, begins);
    const auto known = torn.find(origin);
    const bool was_torn = known != torn.end(), is_torn = !now.lips.empty() || now.skin.is_cut_away;
    if (was_torn ? known->second == now : !is_torn) continue;
    seen.push_back(origin);
    if (!was_torn || known->second.lips != now.lips) {
      beams.remove_from(origin, seen);
      for (const tear::SpreadBeam& beam : spread.from(origin, now.lips)) {
        beams.add(origin, beam);
        seen.push_back(beam.face);
      }
    }
    if (is_torn)
      torn.insert_or_assign(origin, std::move(now));
    else
      torn.erase(known);
  }
  sort_and_unite(seen);
}

TornParts WoundMask::State::find(Index face, const tear::SurfaceEditor& editor,
                                 std::span<const tear::EditLog::Extent> begins) const {
  TornParts found = finder.find(face, faces.surface, editor);
  if (counts_all_operations()) return found;
  const std::uint64_t first = options.first_operation, end = first + options.operation_count;
  if (first >= begins.size()) return {};
  const std::vector<Index> operations =
      finder.operations_of(face, found.lips, faces.surface, editor, begins);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < operations.size(); ++i)
    if (operations[i] >= first && operations[i] < end) found.lips[kept++] = found.lips[i];
  found.lips.resize(kept);
  if (end < begins.size()) found.skin = finder.find(face, faces.surface, editor, begins[end]).skin;
  if (found.skin.is_cut_away)
    found.before = finder.find(face, faces.surface, editor, begins[first]).skin;
  return found;
}

std::vector<Index> WoundMask::State::torn_faces() const {
  std::vector<Index> result;
  for (const auto& [face, parts] : torn) result.push_back(face);
  std::sort(result.begin(), result.end());
  return result;
}

template <class Visit>
void WoundMask::State::paint(Index face, Visit visit) {
  const Surface& surface = faces.surface;
  if (face < surface.first_triangle[mesh] || face >= surface.first_triangle[mesh + 1]) return;
  seen_by_face.clear();
  beams.for_each_in(face, [&](const Beam& beam) { seen_by_face.push_back(beam); });
  const auto parts = torn.find(face);
  texels.for_each_of(
      face - surface.first_triangle[mesh],
      [&](std::uint32_t column, std::uint32_t row, const std::array<double, 3>& place) {
        const tear::Flat at = faces.place(face, place);
        double least = options.reach;
        for (const Beam& beam : seen_by_face) least = std::min(least, beam.distance(at));
        const bool is_removed = parts != torn.end() && parts->second.is_removed(place);
        distances[std::size_t{row} * options.width + column] =
            static_cast<float>(is_removed ? -least : least);
        visit(column, row);
      });
}

std::vector<float> WoundMask::State::flow(const Character& source,
                                          std::span<const std::vector<Vec3f>> posed,
                                          const BloodFlowOptions& wanted) const {
  tear::Rivulets rivulets(
      source, faces, posed, wanted,
      [this](Index face, const std::array<double, 3>& place) { return is_removed(face, place); });
  for (const Index face : torn_faces()) rivulets.run_from(face, torn.at(face).lips);
  // A face sees the parts of rivulets beside it as lips.
  std::vector<SeenLip<double>> seen;
  tear::Spread beside(faces, wanted.width / 2);
  for (const tear::RivuletPart& part : rivulets.parts())
    for (const tear::SpreadBeam& at : beside.from(part.face, std::span(&part.segment, 1)))
      seen.push_back({at.face, at.beam, part.radius});
  std::vector<float> flows(distances.size());
  for_each_texel_beside(
      seen, [&](std::size_t texel, tear::Flat at, std::span<const SeenLip<double>> lips) {
        double most = 0;
        for (const SeenLip<double>& lip : lips)
          most = std::max(most, 2 * (1 - lip.beam.distance(at) / lip.value));
        flows[texel] = static_cast<float>(std::min(most, 1.0));
      });
  return flows;
}

double WoundMask::State::distance_at(Index face, const std::array<double, 3>& place) const {
  const tear::Flat at = faces.place(face, place);
  double least = options.reach;
  beams.for_each_in(face, [&](const Beam& beam) { least = std::min(least, beam.distance(at)); });
  return is_removed(face, place) ? -least : least;
}

bool WoundMask::State::is_removed(Index face, const std::array<double, 3>& place) const {
  const auto parts = torn.find(face);
  return parts != torn.end() && parts->second.is_removed(place);
}

bool WoundMask::State::has_triangles_of(const Character& other) const {
  const std::vector<Index>& first = faces.surface.first_triangle;
  if (other.meshes.size() + 1 != first.size()) return false;
  for (std::size_t i = 0; i < other.meshes.size(); ++i)
    if (other.meshes[i].triangle_count() != first[i + 1] - first[i]) return false;
  return true;
}

Result<TexelRectangle> WoundMask::State::update(const TornModel& model,
                                                const ChangeRecord& change) {
  if (!has_triangles_of(model.source()))
    return Status::failure(StatusCode::invalid_argument, kNone, "the model has another source");
  const Surface& surface = faces.surface;
  std::vector<Index> origins;
  const auto add = [&](std::uint32_t of_mesh, std::uint32_t triangle) {
    const Index origin = model.source_triangle(of_mesh, triangle),
                first = surface.first_triangle[of_mesh];
    if (origin < surface.first_triangle[of_mesh + 1] - first) origins.push_back(first + origin);
  };
  for (const MeshChange& of : change.meshes) {
    for (const RewrittenTriangle& rewritten : of.rewritten) add(of.mesh, rewritten.triangle);
    for (std::uint32_t i = 0; i < of.triangle_count; ++i) add(of.mesh, of.first_triangle + i);
  }
  // Where a weld joins different vertices, triangles keep them.
  const auto add_around = [&](Index point) {
    const Surface& now = model.surface();
    if (point >= now.point_count() || now.point_corner[point] == kNone) return;
    now.for_each_in_fan(now.point_corner[point], [&](Index corner) {
      const tear::TriangleRef of = now.triangle(corner / 3);
      add(of.mesh, of.triangle);
    });
  };
  for (const WeldedPoint& of : change.welded) {
    add_around(of.kept);
    if (of.lost != of.kept) add_around(of.lost);
  }
  sort_and_unite(origins);
  // A triangle keeps its corners where a tear runs along its edge and the other side gets new ones.
  const std::size_t count = origins.size();
  for (std::size_t i = 0; i < count; ++i)
    for (Index h = 3 * origins[i]; h < 3 * origins[i] + 3; ++h)
      if (surface.twin[h] != kNone) origins.push_back(surface.twin[h] / 3);
  sort_and_unite(origins);
  std::vector<Index> seen;
  renew(origins, model, seen);
  Bounds bounds;
  const auto grow = [&](std::uint32_t column, std::uint32_t row) { bounds.add(column, row); };
  for (const Index face : seen) paint(face, grow);
  return bounds.rectangle();
}

WoundMask::WoundMask(std::unique_ptr<State> state) : state_(std::move(state)) {}
WoundMask::WoundMask(WoundMask&&) noexcept = default;
WoundMask& WoundMask::operator=(WoundMask&&) noexcept = default;
WoundMask::~WoundMask() = default;

Result<WoundMask> WoundMask::create(const TornModel& model, std::uint32_t mesh,
                                    const WoundMaskOptions& options) {
  if (const Status status = check_options(model, mesh, options); !status) return status;
  return or_out_of_memory([&]() -> Result<WoundMask> {
    if (const Status status = model.unpack(); !status) return status;
    auto state = std::make_unique<State>(model, mesh, options);
    std::vector<Index> all(state->faces.shapes.size()), seen;
    for (Index i = 0; i < all.size(); ++i) all[i] = i;
    state->renew(all, model, seen);
    for (const Index face : seen) state->paint(face, [](std::uint32_t, std::uint32_t) {});
    return WoundMask(std::move(state));
  });
}

Result<TexelRectangle> WoundMask::update(const TornModel& model, const ChangeRecord& change) {
  return or_out_of_memory([&]() -> Result<TexelRectangle> {
    if (const Status status = model.unpack(); !status) return status;
    return state_->update(model, change);
  });
}

Result<std::vector<float>> WoundMask::flow(const TornModel& model, const ModelPose& pose,
                                           const BloodFlowOptions& options) const {
  const Character& source = model.source();
  if (!state_->has_triangles_of(source))
    return Status::failure(StatusCode::invalid_argument, kNone, "the model has another source");
  if (const Status status = check_flow(options); !status) return status;
  return or_out_of_memory([&]() -> Result<std::vector<float>> {
    std::vector<std::vector<Vec3f>> posed(source.meshes.size());
    std::vector<Affine3f> palette;
    for (std::size_t m = 0; m < posed.size(); ++m) {
      const Skin& skin = source.skins[source.meshes[m].skin];
      palette.resize(skin.bones.size());
      if (const Status status = compute_palette(skin, pose, palette); !status) return status;
      DeformedMesh deformed;
      if (const Status status =
              deform_mesh(source.meshes[m], palette, pose.morph_weights, deformed);
          !status)
        return status;
      posed[m] = std::move(deformed.positions);
    }
    return state_->flow(source, posed, options);
  });
}

std::span<const float> WoundMask::distances() const { return state_->distances; }
bool WoundMask::is_painted(std::uint32_t column, std::uint32_t row) const {
  return state_->texels.is_owned(std::size_t{row} * state_->options.width + column);
}
std::optional<SourcePlace> WoundMask::place_of(std::uint32_t column, std::uint32_t row) const {
  return state_->texels.place_of(column, row);
}
bool WoundMask::has_own_texels() const {
  const Surface& surface = state_->faces.surface;
  const Index first = surface.first_triangle[state_->mesh],
              end = surface.first_triangle[state_->mesh + 1];
  for (Index face = first; face < end; ++face) {
    bool sees_lip = false;
    state_->beams.for_each_in(face, [&](const Beam&) { sees_lip = true; });
    if (sees_lip && state_->faces.has_area(face) && state_->texels.lacks_texels(face - first))
      return false;
  }
  return true;
}
double WoundMask::distance_at(const SourcePlace& place) const {
  return state_->distance_at(state_->faces.surface.first_triangle[state_->mesh] + place.triangle,
                             place.barycentric);
}
const WoundMaskOptions& WoundMask::options() const { return state_->options; }
const WoundMaskNotes& WoundMask::notes() const { return state_->texels.notes(); }

}  // namespace sunder
