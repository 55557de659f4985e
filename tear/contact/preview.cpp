#include <sunder/tear/preview.h>

#include <algorithm>
#include <cmath>

#include "core/internal/ordered.h"
#include "tear/contact/searches.h"
#include "tear/model/model_access.h"
#include "tear/operation/cut.h"
#include "tear/operation/drill.h"
#include "tear/pieces/describe_piece.h"

namespace sunder {
namespace {

using tear::EditLog;

template <class Values>
void sort_unique(Values& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

/// Notes the mesh, the material and the bones of a triangle as it was.
void note_triangle(const Mesh& mesh, const Skin& skin, const tear::TriangleChange& change,
                   const tear::TriangleRef& ref, OperationPreview& preview) {
  preview.meshes.push_back(ref.mesh);
  preview.materials.push_back(mesh.submeshes[mesh.triangle_submesh[ref.triangle]].material);
  for (const Index vertex : change.vertices)
    for (const Influence& influence : mesh.weights.of(vertex))
      preview.bones.push_back(skin.bones[influence.slot]);
}

/// Looks at the surface as the operation would leave it.
void look_at_changes(const EditLog::Mark& begin, const tear::SurfaceEditor& editor,
                     OperationPreview& preview) {
  const Character& character = editor.character();
  editor.log.for_each_first_change(begin, [&](const tear::TriangleChange& change) {
    const tear::TriangleRef ref = editor.surface().triangle(change.triangle);
    const Mesh& mesh = character.meshes[ref.mesh];
    if (!is_same(mesh.triangles[ref.triangle], change.vertices))
      note_triangle(mesh, character.skins[mesh.skin], change, ref, preview);
  });
  sort_unique(preview.meshes);
  sort_unique(preview.materials);
  sort_unique(preview.bones);
  double length = 0;
  for (const Index edge : editor.opened_edges.tracked()) {
    const tear::TriangleRef ref = editor.surface().triangle(edge / 3);
    const auto position = [&](Index corner) -> Vec3d {
      return editor.births.position(ref.mesh, editor.vertex_at(corner)).cast<double>();
    };
    length += norm(Vec3d(position(tear::Surface::next(edge)) - position(edge)));
  }
  preview.length_bind = 0.5 * length;
}

/// The number of surfaces that a segment passes from outside to inside.
std::uint32_t layers_on(const Vec3d& base, const Vec3d& tip, tear::PosedSurface& surface,
                        std::vector<tear::FoundPlace>& found) {
  tear::all_on_segment(base, tip - base, surface, found);
  return static_cast<std::uint32_t>(
      std::ranges::count_if(found, [](const tear::FoundPlace& at) { return at.enters; }));
}

/// An operation of a model, performed and taken back.
template <class State>
class Rehearsal {
 public:
  Rehearsal(State& state, const WeightOptions& weights, bool names_all_pieces)
      : state_(state), weights_(weights), names_all_pieces_(names_all_pieces) {}

  /// @param approach  approach(surface, preview): looks at the surface as it is.
  /// @param work      work(Outcome&).
  /// @param miss      miss(surface): the least distance, if nothing was torn.
  template <class Approach, class Work, class Miss>
  Result<OperationPreview> perform(const ModelPose& pose, Approach approach, Work work, Miss miss) {
    if (Status status = state_.stand_in(pose); !status) return status;
    try {
      OperationPreview preview;
      tear::PosedSurface surface(state_.editor, state_.posed);
      approach(surface, preview);
      const EditLog::Mark begin = state_.begin_operation(true);
      const auto look = [&](const TearReport& done) {
        look_at_changes(begin, state_.editor, preview);
        for (const TornPiece& piece : done.pieces) preview.piece_areas.push_back(area_of(piece));
      };
      const auto do_work = [&](tear::Outcome& outcome) -> Status {
        work(outcome);
        return {};
      };
      auto report = state_.call({weights_, nullptr, names_all_pieces_}, do_work, look);
      if (!report) return report.error();
      state_.take_back();
      preview.report = std::move(*report);
      if (preview.report.runs == 0) preview.miss_distance = miss(surface);
      return preview;
    } catch (const std::bad_alloc&) {
      return out_of_memory();
    }
  }

 private:
  [[nodiscard]] double area_of(const TornPiece& piece) {
    const Index face = state_.editor.origins.surface_triangle(piece.mesh, piece.triangle);
    return tear::describe_piece(face, state_.editor, state_.posed).area_posed;
  }

  State& state_;
  const WeightOptions& weights_;
  bool names_all_pieces_;
};

constexpr double kNowhere = std::numeric_limits<double>::infinity();

/// The distance of the surface from what the blades sweep, as two triangles per segment.
double distance_of_sweep(std::span<const Blade> stroke, tear::PosedSurface& surface) {
  double least = kNowhere;
  for (std::size_t i = 1; i < stroke.size() && least > 0; ++i) {
    const Blade &from = stroke[i - 1], &to = stroke[i];
    least = tear::squared_distance_to({from.base, from.tip, to.tip}, least, surface);
    least = tear::squared_distance_to({from.base, to.tip, to.base}, least, surface);
  }
  return std::sqrt(least);
}

}  // namespace

Result<OperationPreview> preview_tear(const TornModel& model, const ModelPose& pose,
                                      std::span<const Blade> stroke, const TearOptions& options) {
  if (Status status = model.unpack(); !status) return status;
  auto& state = tear::ModelAccess::state_of(model);
  if (Status status = state.may_begin(); !status) return status;
  if (Status status = validate_tear(stroke, options); !status) return status;
  const WeightOptions weights = options.weights.value_or(state.weights);
  const auto approach = [&](tear::PosedSurface& surface, OperationPreview& preview) {
    std::vector<tear::FoundPlace> found;
    for (const Blade& blade : stroke)
      preview.layers = std::max(preview.layers, layers_on(blade.base, blade.tip, surface, found));
  };
  const auto work = [&](tear::Outcome& outcome) {
    state.stroke.begin(stroke.front(), options);
    for (const Blade& blade : stroke.subspan(1))
      state.stroke.extend(blade, state.workpiece(), outcome);
    state.stroke.finish(state.workpiece(), outcome);
  };
  return Rehearsal(state, weights, false)
      .perform(pose, approach, work,
               [&](tear::PosedSurface& surface) { return distance_of_sweep(stroke, surface); });
}

Result<OperationPreview> preview_cut(const TornModel& model, const ModelPose& pose,
                                     const PlaneCut& cut) {
  if (Status status = model.unpack(); !status) return status;
  auto& state = tear::ModelAccess::state_of(model);
  if (Status status = state.may_begin(); !status) return status;
  if (Status status = tear::validate_cut(cut, state.character.skeleton); !status) return status;
  const WeightOptions weights = cut.weights.value_or(state.weights);
  if (Status status = validate_weights(weights); !status) return status;
  return Rehearsal(state, weights, true)
      .perform(
          pose, [](tear::PosedSurface&, OperationPreview&) {},
          [&](tear::Outcome& outcome) { tear::cut_surface(cut, state.workpiece(), outcome); },
          [](tear::PosedSurface&) { return kNowhere; });
}

Result<OperationPreview> preview_drill(const TornModel& model, const ModelPose& pose,
                                       const Bore& bore) {
  if (Status status = model.unpack(); !status) return status;
  auto& state = tear::ModelAccess::state_of(model);
  if (Status status = state.may_begin(); !status) return status;
  if (Status status = tear::validate_bore(bore); !status) return status;
  const WeightOptions weights = bore.weights.value_or(state.weights);
  if (Status status = validate_weights(weights); !status) return status;
  const Vec3d end = bore.origin + bore.depth * normalized(bore.direction);
  const auto approach = [&](tear::PosedSurface& surface, OperationPreview& preview) {
    std::vector<tear::FoundPlace> found;
    preview.layers = layers_on(bore.origin, end, surface, found);
  };
  const auto work = [&](tear::Outcome& outcome) {
    tear::drill_surface(bore, state.workpiece(), outcome);
  };
  return Rehearsal(state, weights, false)
      .perform(pose, approach, work, [&](tear::PosedSurface& surface) {
        const auto nearest = tear::nearest_to_segment(bore.origin, end, kNowhere, surface);
        return nearest ? std::sqrt(nearest->squared_distance) : kNowhere;
      });
}

}  // namespace sunder
