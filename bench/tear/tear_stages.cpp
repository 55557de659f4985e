#include "bench/tear/tear_stages.h"

#include <cstdlib>

#include "bench/harness/measure.h"
#include "tear/internal/mesh_vertices.h"
#include "tear/path/entry.h"
#include "tear/path/imprint.h"
#include "tear/path/imprint_point.h"
#include "tear/surface/describe_change.h"
#include "tear/surface/improve.h"
#include "tear/surface/open.h"

namespace sunder::bench {

using tear::BladePlane;
using tear::EditLog;
using tear::SurfaceEditor;
using tear::SurfaceHit;

StagedTear::StagedTear(const Scene& scene)
    : scene_(scene),
      character_(*scene.character),
      editor_(*scene.character, character_),
      replay_(scene.mesh()) {}

void StagedTear::begin_pose(Stages& stages) {
  const ModelPose& pose = scene_.next_pose();
  stages.pose += seconds_of([&] {
    if (!posed_.begin(character_, pose)) std::abort();
  });
  tip_ = kNone;
}

Stages StagedTear::run_query() {
  Stages stages;
  begin_pose(stages);
  const Blade &from = scene_.stroke[0], &to = scene_.stroke[1];
  stages.query = seconds_of([&] {
    const auto hit = first_hit(from, editor_, posed_);
    const auto plane = BladePlane::through(hit->position, from, to);
    if (!contact_at(*hit, *plane, editor_, posed_)) std::abort();
  });
  return stages;
}

Stages StagedTear::run() {
  Stages stages;
  lips_.clear();
  births_.clear();
  editor_.scratch().reset();
  const EditLog::Mark begin = editor_.mark();
  begin_pose(stages);
  for (std::size_t i = 0; i + 1 < scene_.stroke.size(); ++i)
    tear_segment(scene_.stroke[i], scene_.stroke[i + 1], stages);
  stages.change_record = seconds_of([&] { tear::describe_change(begin, editor_, change_); });
  editor_.roll_back(begin);
  posed_.forget_from(begin.points);
  stages.attributes = time_attributes();
  return stages;
}

void StagedTear::tear_segment(const Blade& from, const Blade& to, Stages& stages) {
  const EditLog::Mark before = editor_.mark();
  std::optional<SurfaceHit> contact;
  std::optional<BladePlane> plane;
  stages.query += seconds_of([&] {
    if (tip_ != kNone) {
      plane = BladePlane::through(posed_.position(editor_, tip_), from, to);
      return;
    }
    const auto hit = first_hit(from, editor_, posed_);
    if (!hit) std::abort();  // the scene's strokes begin on the surface
    plane = BladePlane::through(hit->position, from, to);
    contact = contact_at(*hit, *plane, editor_, posed_);
  });
  const Index first_vertex = character_.meshes[0].vertex_count();
  tear::Path path(editor_.scratch());
  stages.imprint += seconds_of([&] {
    if (contact) tip_ = imprint_point(*contact, tear::Snapping::by_shape, editor_, posed_);
    path = imprint_path(*plane, tip_, editor_, posed_);
  });
  const Mesh& mesh = character_.meshes[0];
  for (Index v = first_vertex; v < mesh.vertex_count(); ++v)
    births_.push_back(editor_.births.at(0, v));
  stages.open += seconds_of([&] {
    std::vector<tear::PointEdge> edges;
    for (std::size_t i = 0; i + 1 < path.points.size(); ++i)
      edges.push_back({path.points[i], path.points[i + 1]});
    const std::size_t first_lip = lips_.size();
    open_edges(edges, path.half_edges, {}, editor_, lips_);
    for (std::size_t i = first_lip; i < lips_.size(); ++i)
      posed_.pin(lips_[i].left, Vec3d(posed_.position(editor_, lips_[i].right)));
  });
  tip_ = path.points.back();
  stages.improve += seconds_of([&] { improve_faces(before, editor_); });
}

double StagedTear::time_attributes() {
  const std::uint32_t count = replay_.vertex_count();
  const double seconds = seconds_of([&] {
    for (const Birth& birth : births_)
      append_interpolated_vertex(scene_.mesh().triangles[birth.triangle], birth.barycentric,
                                 replay_);
  });
  remove_vertices_from(count, replay_);
  return seconds;
}

}  // namespace sunder::bench
