#include "particles/body_state.h"
#include "particles/internal/vector_bytes.h"

namespace sunder::particles {
namespace {

using particles::bytes_of;

std::size_t bytes_of(const Motion& motion) {
  std::size_t bytes = bytes_of(motion.serials) + bytes_of(motion.material_of) +
                      bytes_of(motion.awake) + bytes_of(motion.touched) + bytes_of(motion.bound) +
                      bytes_of(motion.tired) + bytes_of(motion.quiet.seconds);
  for (const auto* column :
       {&motion.displacements, &motion.velocities, &motion.starts, &motion.forces,
        &motion.lip_forces, &motion.winds, &motion.quiet.from, &motion.quiet.pulls})
    bytes += bytes_of(*column);
  return bytes + bytes_of(motion.plastic.strains) + bytes_of(motion.plastic.forces);
}

std::size_t bytes_of(const ShownMotion& shown) {
  return bytes_of(shown.displacements) + bytes_of(shown.turns) + bytes_of(shown.is_displaced) +
         shown.moved_vertices.memory_bytes();
}

std::size_t bytes_of(const StepScratch& scratch) {
  return bytes_of(scratch.active) + bytes_of(scratch.needed) + bytes_of(scratch.changed) +
         bytes_of(scratch.followed) + bytes_of(scratch.is_needed) + bytes_of(scratch.sums) +
         bytes_of(scratch.corrections) + bytes_of(scratch.steps) + bytes_of(scratch.pulls);
}

}  // namespace

std::size_t BodyState::memory_bytes() const {
  return sizeof(BodyState) + bytes_of(materials) + bytes_of(motion) + bytes_of(graph.first) +
         scratch.self_contact.memory_bytes() + bytes_of(graph.local) + bytes_of(graph.springs) +
         bytes_of(graph.masses) + bytes_of(graph.rates) + rests.memory_bytes() +
         outer.of_pose.memory_bytes() + solver.memory_bytes() + contact.memory_bytes() +
         outer.threads.memory_bytes() + bytes_of(shown) + bytes_of(scratch);
}

}  // namespace sunder::particles
