#include "particles/clusters/band.h"
#include "particles/clusters/gradients.h"
#include "particles/clusters/set_data.h"
#include "particles/internal/vector_bytes.h"

namespace sunder::particles {
namespace {

using particles::bytes_of;

std::size_t bytes_of(const Particle& particle) {
  return sizeof(Particle) + bytes_of(particle.terms) + bytes_of(particle.morph_terms) +
         bytes_of(particle.neighbours) + bytes_of(particle.sides);
}

std::size_t bytes_of(const PointColumns& columns) {
  return bytes_of(columns.positions) + bytes_of(columns.vertices) + bytes_of(columns.slabs) +
         bytes_of(columns.influences) + bytes_of(columns.owners) + bytes_of(columns.lip_points);
}

std::size_t bytes_of(const Change& change) {
  std::size_t bytes = sizeof(Change) + bytes_of(change.vertices) +
                      change.changed_points.memory_bytes() + bytes_of(change.changed_vertices) +
                      bytes_of(change.changed_lips);
  for (const auto& [index, particle] : change.changed_particles) bytes += bytes_of(particle);
  if (!change.appended) return bytes;
  const Change::Appended& appended = *change.appended;
  bytes += bytes_of(appended.points) + bytes_of(appended.joined) + bytes_of(appended.lips) +
           bytes_of(appended.vertex_points);
  for (const Particle& particle : appended.particles) bytes += bytes_of(particle);
  return bytes;
}

std::size_t bytes_of(const RepairScratch& scratch) {
  std::size_t bytes = scratch.front.memory_bytes() + scratch.band_front.memory_bytes() +
                      bytes_of(scratch.met) + bytes_of(scratch.beside) + bytes_of(scratch.work_of) +
                      bytes_of(scratch.score_of) + bytes_of(scratch.area_change) +
                      bytes_of(scratch.edit.works) + bytes_of(scratch.edit.memberships) +
                      bytes_of(scratch.edit.counted) + bytes_of(scratch.edit.by_particle) +
                      bytes_of(scratch.edit.first_of_particle);
  for (const Marks* marks :
       {&scratch.worked, &scratch.logged_points, &scratch.logged_particles, &scratch.seen,
        &scratch.given, &scratch.scored, &scratch.has_area_change})
    bytes += marks->memory_bytes();
  return bytes;
}

}  // namespace

std::size_t Gradients::memory_bytes() const {
  return bytes_of(gradients_) + is_known_.capacity() / 8 + bytes_of(unknown_);
}

std::size_t Structure::memory_bytes() const {
  std::size_t bytes = sizeof(Structure) + bytes_of(points) + points.memberships.memory_bytes() +
                      bytes_of(points.older_lips) + bytes_of(authored.of_points) +
                      bytes_of(vertex_points.of_mesh) + bytes_of(members.joined) + bytes_of(lips) +
                      bytes_of(tears.threads) + bytes_of(dirty) + bytes_of(scratch) +
                      gradients->memory_bytes() + character.border.memory_bytes();
  if (members.decomposed.use_count() == 1)
    bytes += bytes_of(members.decomposed->first) + bytes_of(members.decomposed->points);
  for (const Particle& particle : particles) bytes += bytes_of(particle);
  for (const Change& change : tears.done) bytes += bytes_of(change);
  for (const Change& change : tears.undone) bytes += bytes_of(change);
  return bytes;
}

}  // namespace sunder::particles
