#include <algorithm>
#include <chrono>
#include <cmath>
#include <new>
#include <stdexcept>

#include "core/internal/out_of_memory.h"
#include "particles/clusters/check_pose.h"
#include "particles/clusters/decompose.h"
#include "particles/clusters/decompose_model.h"
#include "particles/clusters/gradients.h"
#include "particles/clusters/read_model.h"
#include "tear/internal/surface.h"

namespace sunder {
namespace {

/// Metres. Within them a SurfaceFront's numbers of buckets and lengths of paths are finite floats.
constexpr double kShortestRange = 1e-33, kLongestRange = 1e37;

/// @param edge    mean length of the edges.
/// @param report  its range in metres is written.
Status find_range(const DecompositionOptions& options, double diagonal, double edge,
                  DecompositionReport& report) {
  // Edges below 1e-22 m have no length: its square is 0 in single precision.
  if (!(diagonal > 0 && edge > 0))
    return Status::failure(StatusCode::empty_input, kNone,
                           "the model has no face that can be divided into particles");
  report.range = options.is_fraction ? options.range * diagonal : options.range;
  if (report.range >= kShortestRange && report.range <= kLongestRange) return {};
  return Status::failure(StatusCode::invalid_argument, kNone,
                         "the range of particles is %g m; it must be from %g to %g", report.range,
                         kShortestRange, kLongestRange);
}

/// Whether a mesh has normals or tangents, which displacements turn by the gradients of weights.
bool has_directions(const Character& character) {
  return std::ranges::any_of(character.meshes, [](const Mesh& mesh) {
    return !mesh.normals.empty() || !mesh.tangents.empty();
  });
}

}  // namespace

namespace particles {

Result<std::unique_ptr<Structure>> decompose_model(const TornModel& model, const ModelPose& pose,
                                                   const DecompositionOptions& options,
                                                   const AuthoredTissue& tissue) {
  if (!(options.range > 0) || !std::isfinite(options.range))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the range of particles is %g; it must be finite and above 0",
                           options.range);
  if (Status status = validate_authored_tissue(tissue, model.source()); !status) return status;
  try {
    const auto begin = std::chrono::steady_clock::now();
    auto structure = std::make_unique<Structure>();
    structure->character.bone_count = model.character().skeleton.bones.size();
    structure->character.morph_weight_count = model.character().rest_morph_weights.size();
    if (Status status = check_pose(structure->character, pose); !status) return status;
    read_model(model, pose, *structure);
    if (Status status = find_range(options, diagonal_of(*structure, model),
                                   double{structure->character.edge_length}, structure->report);
        !status)
      return status;
    decompose(model, options, *structure);
    if (!tissue.empty()) {
      structure->authored.tissue = std::make_shared<const AuthoredTissue>(tissue);
      structure->authored.follow(model, structure->points.vertices, 0);
    }
    structure->report.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return structure;
  } catch (const std::length_error&) {
    return Status::failure(StatusCode::limit_exceeded, kNone,
                           "a range of %g makes more than %zu particles", options.range,
                           kMaximumParticles);
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

}  // namespace particles

ParticleAsset::ParticleAsset(std::shared_ptr<const particles::Structure> structure)
    : structure_(std::move(structure)) {}
ParticleAsset::~ParticleAsset() = default;

Result<std::shared_ptr<const ParticleAsset>> ParticleAsset::create(
    const TornModel& model, const ModelPose& pose, const DecompositionOptions& options,
    const AuthoredTissue& tissue) {
  if (model.newest_operation() != 0 || model.is_in_stroke())
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "an asset of particles needs a model that is not torn");
  auto made = particles::decompose_model(model, pose, options, tissue);
  if (!made) return made.error();
  try {
    const std::shared_ptr<particles::Structure> structure = std::move(*made);
    structure->finish(model.surface().triangle_count());
    if (has_directions(model.character()))
      (void)structure->gradients->of(model.surface(), *structure);
    // Only sets that follow tears need scratch memory.
    structure->scratch = {};
    return std::shared_ptr<const ParticleAsset>(new ParticleAsset(structure));
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

const DecompositionReport& ParticleAsset::report() const { return structure_->report; }
std::size_t ParticleAsset::memory_bytes() const { return structure_->memory_bytes(); }

}  // namespace sunder
