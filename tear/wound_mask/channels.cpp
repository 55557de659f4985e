#include <cmath>
#include <functional>
#include <map>
#include <queue>
#include <utility>

#include "core/internal/out_of_memory.h"
#include "tear/wound_mask/mask_state.h"
#include "tear/wound_mask/wall_depths.h"

namespace sunder {
namespace tear {
namespace {

constexpr double kThinnestPart = 1e-3;  ///< Height of a part of a triangle, of its longest side.

/// A part of a triangle of the source, and its stretch.
struct StretchedPart {
  std::array<std::array<double, 3>, 3> places;
  double area = 0, stretch = 1;
  bool is_thin = false;
};

/// The largest principal stretch of a triangle.
double stretch_of(const std::array<Vec3d, 3>& from, const std::array<Vec3d, 3>& to) {
  const auto metric = [](const std::array<Vec3d, 3>& at) {
    const Vec3d a = at[1] - at[0], b = at[2] - at[0];
    return std::array<double, 3>{a.dot(a), a.dot(b), b.dot(b)};
  };
  const auto [a, b, c] = metric(from);
  const auto [p, q, r] = metric(to);
  // The eigenvalues of the product of the inverse of the first metric with the second one.
  const double determinant = a * c - b * b;
  const double half_trace = 0.5 * (c * p - 2 * b * q + a * r) / determinant,
               product = (p * r - q * q) / determinant;
  const double root = std::sqrt(std::max(0.0, half_trace * half_trace - product));
  return std::sqrt(std::max(0.0, half_trace + root));
}

std::vector<StretchedPart> parts_with_stretch(Index face, const PartFinder& finder,
                                              const SurfaceEditor& torn,
                                              std::span<const Vec3f> posed) {
  std::vector<StretchedPart> parts;
  const StretchedPart* largest = nullptr;
  finder.for_each_part(face, torn.surface(), [&](Index part) {
    const TriangleRef ref = torn.surface().triangle(part);
    const Mesh& mesh = torn.character().meshes[ref.mesh];
    const Triangle& vertices = mesh.triangles[ref.triangle];
    if (is_retired(vertices)) return;
    StretchedPart& made = parts.emplace_back();
    std::array<Vec3d, 3> from, to;
    for (std::size_t k = 0; k < 3; ++k) {
      made.places[k] = torn.births.place_in_origin(ref, vertices[k]);
      from[k] = mesh.positions[vertices[k]].cast<double>();
      to[k] = posed[vertices[k]].cast<double>();
    }
    made.area = (from[1] - from[0]).cross(from[2] - from[0]).norm();
    const double longest =
        std::max({(from[1] - from[0]).squaredNorm(), (from[2] - from[1]).squaredNorm(),
                  (from[0] - from[2]).squaredNorm()});
    made.is_thin = !(made.area > kThinnestPart * longest);
    if (!made.is_thin) made.stretch = stretch_of(from, to);
  });
  for (const StretchedPart& part : parts)
    if (!part.is_thin && (largest == nullptr || part.area > largest->area)) largest = &part;
  for (StretchedPart& part : parts)
    if (part.is_thin && largest != nullptr) part.stretch = largest->stretch;
  return parts;
}

}  // namespace

std::vector<EditLog::Extent> begins_of(const TornModel& model) {
  auto& state = ModelAccess::state_of(model);
  std::vector<EditLog::Extent> begins;
  const auto add = [&](const EditLog::Mark& begin) {
    begins.push_back({begin.triangles, begin.triangle_changes});
  };
  for (const auto& entry : state.history.done()) add(entry->begin);
  if (state.has_stroke) add(state.history.filled().begin);
  return begins;
}

}  // namespace tear

using tear::SurfaceEditor;

std::vector<float> WoundMask::State::ages(const TornModel& model) const {
  const SurfaceEditor& editor = tear::ModelAccess::state_of(model).editor;
  const std::vector<tear::EditLog::Extent> begins = tear::begins_of(model);
  std::vector<SeenLip<Index>> seen;
  tear::Spread beside(faces, options.reach);
  for (const Index face : torn_faces()) {
    const std::vector<tear::LipSegment>& lips = torn.at(face).lips;
    const std::vector<Index> operations =
        finder.operations_of(face, lips, faces.surface, editor, begins);
    for (std::size_t i = 0; i < lips.size(); ++i)
      for (const tear::SpreadBeam& at : beside.from(face, std::span(&lips[i], 1)))
        seen.push_back({at.face, at.beam, operations[i]});
  }
  std::vector<float> ages(distances.size(), -1.0f);
  for_each_texel_beside(
      seen, [&](std::size_t texel, tear::Flat at, std::span<const SeenLip<Index>> lips) {
        std::pair<double, Index> nearest = {options.reach, 0};  // distance, operations since
        for (const SeenLip<Index>& lip : lips)
          nearest = std::min(
              nearest, {lip.beam.distance(at), static_cast<Index>(begins.size()) - 1 - lip.value});
        if (nearest.first < options.reach) ages[texel] = static_cast<float>(nearest.second);
      });
  return ages;
}

std::vector<float> WoundMask::State::depths(const TornModel& model) const {
  const SurfaceEditor& editor = tear::ModelAccess::state_of(model).editor;
  const tear::WallDepths walls(editor);
  std::vector<SeenLip<double>> seen;
  tear::Spread beside(faces, options.reach);
  for (const Index face : torn_faces()) {
    std::map<tear::LipSegment, double> depths;
    for (const tear::LipSegment& lip : torn.at(face).lips) depths[lip] = 0;
    finder.for_each_part(face, editor.surface(), [&](Index part) {
      for (Index h = 3 * part; h < 3 * part + 3; ++h) {
        const double depth = walls.below(h);
        if (!(depth > 0)) continue;
        const auto a = editor.source_barycentric(h),
                   b = editor.source_barycentric(tear::Surface::next(h));
        const auto lip = depths.find({{std::min(a, b), std::max(a, b)}});
        if (lip != depths.end()) lip->second = std::max(lip->second, depth);
      }
    });
    for (const auto& [lip, depth] : depths)
      for (const tear::SpreadBeam& at : beside.from(face, std::span(&lip, 1)))
        seen.push_back({at.face, at.beam, depth});
  }
  std::vector<float> result(distances.size());
  for_each_texel_beside(
      seen, [&](std::size_t texel, tear::Flat at, std::span<const SeenLip<double>> lips) {
        std::pair<double, double> nearest = {options.reach, 0};  // distance, height
        for (const SeenLip<double>& lip : lips)
          nearest = std::min(nearest, {lip.beam.distance(at), -lip.value});
        if (nearest.first < options.reach) result[texel] = static_cast<float>(-nearest.second);
      });
  return result;
}

std::vector<float> WoundMask::State::stretches(const TornModel& model,
                                               std::span<const Vec3f> posed) const {
  const SurfaceEditor& editor = tear::ModelAccess::state_of(model).editor;
  const tear::Surface& surface = faces.surface;
  std::vector<float> result(distances.size(), 1.0f);
  for (Index face = surface.first_triangle[mesh]; face < surface.first_triangle[mesh + 1]; ++face) {
    bool sees_lip = false;
    beams.for_each_in(face, [&](const tear::Beam&) { sees_lip = true; });
    if (!sees_lip) continue;
    const std::vector<tear::StretchedPart> parts =
        tear::parts_with_stretch(face, finder, editor, posed);
    texels.for_each_of(
        face - surface.first_triangle[mesh],
        [&](std::uint32_t column, std::uint32_t row, const std::array<double, 3>& place) {
          const std::size_t texel = std::size_t{row} * options.width + column;
          if (!(std::abs(double{distances[texel]}) < options.reach) || is_removed(face, place))
            return;
          const auto at = std::max_element(parts.begin(), parts.end(), [&](auto& a, auto& b) {
            return tear::area_inside(a.places, place) < tear::area_inside(b.places, place);
          });
          if (at != parts.end()) result[texel] = static_cast<float>(at->stretch);
        });
  }
  return result;
}

Status WoundMask::State::check_in_step(const TornModel& model) const {
  if (!has_triangles_of(model.source()))
    return Status::failure(StatusCode::invalid_argument, kNone, "the model has another source");
  if (!finder.is_in_step(tear::ModelAccess::state_of(model).editor.surface()))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the mask did not follow all operations of the model: update() it");
  return {};
}

Result<std::vector<float>> WoundMask::channel(const TornModel& model, WoundChannel wanted) const {
  if (wanted != WoundChannel::age && wanted != WoundChannel::depth)
    return Status::failure(StatusCode::invalid_argument, kNone, "there is no wound channel %d",
                           static_cast<int>(wanted));
  return or_out_of_memory([&]() -> Result<std::vector<float>> {
    if (const Status status = model.unpack(); !status) return status;
    if (const Status status = state_->check_in_step(model); !status) return status;
    return wanted == WoundChannel::age ? state_->ages(model) : state_->depths(model);
  });
}

Result<std::vector<float>> WoundMask::stretches(const TornModel& model,
                                                std::span<const Vec3f> posed) const {
  return or_out_of_memory([&]() -> Result<std::vector<float>> {
    if (const Status status = model.unpack(); !status) return status;
    if (const Status status = state_->check_in_step(model); !status) return status;
    const std::uint32_t count = model.character().meshes[state_->mesh].vertex_count();
    if (posed.size() != count)
      return Status::failure(StatusCode::size_mismatch, kNone,
                             "%zu positions for the %u vertices of the torn mesh", posed.size(),
                             count);
    for (std::uint32_t v = 0; v < count; ++v)
      if (!posed[v].allFinite())
        return Status::failure(StatusCode::non_finite_value, v, "the position of vertex %u", v);
    return state_->stretches(model, posed);
  });
}

}  // namespace sunder
