#include "tools/picture/soft_scene.h"

#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <utility>

#include "tools/demo/demo_rig.h"
#include "tools/messages/messages.h"
#include "tools/picture/model_looks.h"
#include "tools/picture/open_lips.h"
#include "tools/picture/rims.h"
#include "tools/picture/torn_scene.h"
#include "tools/render/trace.h"

namespace sunder::tools {
namespace {

constexpr int kWidth = 640, kHeight = 480;
constexpr double kStep = 1.0 / 60;
constexpr int kMostSteps = 600;
constexpr double kClipFraction = 0.40;
constexpr double kThickness = 0.006;  ///< Thickness of the flesh, as a fraction of the diagonal.

void check(const Status& status) {
  if (status) return;
  print_error("soft_pictures: " + std::string(status.text()));
  std::exit(1);
}

template <class T>
T check(Result<T> result) {
  if (!result) check(result.error());
  return std::move(*result);
}

SoftTissue soft_tissue(const std::vector<SoftMaterial>& materials, double range) {
  SoftTissue tissue;
  tissue.materials = materials;
  tissue.decomposition.range = range;
  return tissue;
}

CharacterAssetOptions soft_options(const SoftTissue& tissue) {
  CharacterAssetOptions options;
  options.unit_length = true;
  options.soft = tissue;
  return options;
}

std::shared_ptr<const Character> cactus() {
  static const auto made = std::make_shared<const Character>(make_cactus());
  return made;
}

PoseSpec clip_pose(const Character& character) {
  return ClipPose{std::uint32_t{0},
                  kClipFraction * static_cast<double>(character.clips[0].duration)};
}

/// Successive particles get colours that differ much.
Vec4f color_of(std::uint32_t particle) {
  const double hue = std::fmod(0.618033988749895 * particle, 1.0);
  Vec4f color = Vec4f::Ones();
  for (int i = 0; i < 3; ++i) {
    const double wave = 0.5 + 0.5 * std::cos(2 * std::numbers::pi * (hue - i / 3.0));
    color[i] = static_cast<float>(0.06 + 0.94 * wave);
  }
  return color;
}

}  // namespace

SoftScene::SoftScene(const std::vector<SoftMaterial>& materials, double range)
    : SoftScene(cactus(), soft_tissue(materials, range), clip_pose(*cactus())) {}

SoftScene::SoftScene(std::shared_ptr<const Character> character, const SoftTissue& tissue,
                     const PoseSpec& spec)
    : source(std::move(character)),
      instance(check(CharacterInstance::create(source, soft_options(tissue)))),
      rest(check(bind_pose(*source))),
      pose(check(make_pose(*source, spec))),
      diagonal_(bounds_of(*source, check(pose_model(*source, rest))).size().norm()) {
  check(instance.prepare_to_tear());
  draw_frame(0);
}

void SoftScene::draw_frame(double seconds) {
  check(instance.advance(pose, seconds));
  check(instance.draw());
}

void SoftScene::tear(const std::vector<Vec2d>& path) {
  Stroke stroke;
  for (const Vec2d& at : path) stroke.push_back({{at.x(), at.y(), 1.0}, {at.x(), at.y(), -0.05}});
  ChangeRecord change;
  (void)check(instance.tear(rest, stroke, {}, &change));
  draw_frame(0);
  changes.push_back(std::move(change));
}

Result<ForceTearingReport> SoftScene::tear_overstretched(const ForceTearingOptions& options) {
  Result<ForceTearingReport> report = instance.tear_overstretched(options);
  draw_frame(0);
  return report;
}

void SoftScene::step() { draw_frame(kStep); }

int SoftScene::step_until_still() {
  int steps = 0;
  do step();
  while (++steps < kMostSteps && body().awake_count() > 0);
  return steps;
}

std::uint32_t SoftScene::point_at(const Vec3d& rest_place) const {
  const std::span<const Vec3f> at = particles().positions();
  const auto farther = [&](const Vec3f& a, const Vec3f& b) {
    return (a.cast<double>() - rest_place).squaredNorm() <
           (b.cast<double>() - rest_place).squaredNorm();
  };
  return static_cast<std::uint32_t>(std::min_element(at.begin(), at.end(), farther) - at.begin());
}

Vec3d SoftScene::place(std::uint32_t point) const {
  const std::vector<DeformedMesh> bones = posed();
  for (std::uint32_t m = 0; m < bones.size(); ++m) {
    const auto points = particles().vertex_points(m);
    const auto vertex = std::find(points.begin(), points.end(), point);
    if (vertex != points.end())
      return bones[m].positions[static_cast<std::size_t>(vertex - points.begin())].cast<double>() +
             body().point_displacement(point);
  }
  return Vec3d::Zero();
}

double SoftScene::widest_gap() const {
  double widest = 0;
  for (const ChangeRecord& change : changes)
    for (const LipPair& pair : change.lips)
      widest = std::max(
          widest,
          (body().point_displacement(pair.left) - body().point_displacement(pair.right)).norm());
  return widest;
}

std::vector<DeformedMesh> SoftScene::posed() const {
  return check(pose_model(instance.character(), pose));
}

std::vector<DeformedMesh> SoftScene::displaced() {
  std::vector<DeformedMesh> result(instance.character().meshes.size());
  for (std::uint32_t m = 0; m < result.size(); ++m) {
    const PosedMesh mesh = instance.mesh(m);
    result[m].positions.assign(mesh.positions.begin(), mesh.positions.end());
    result[m].normals.assign(mesh.normals.begin(), mesh.normals.end());
  }
  return result;
}

void SoftScene::draw(const std::string& png, const ViewFrame& frame, const Vec3d& centre,
                     double radius) {
  std::vector<Wound> wounds;
  for (const ChangeRecord& change : changes) wounds.push_back(wound_of(std::span(&change, 1)));
  const ModelLooks looks = check(ModelLooks::create(nullptr));
  const std::vector<DeformedMesh> closed = posed(), open = displaced();
  const BloodCovers blood = check(BloodCovers::create(*instance.model(), pose, looks, 0));
  const RenderScene scene = make_torn_scene({*instance.model(), closed, open, wounds, blood}, looks,
                                            kThickness * diagonal_);
  write(png, scene, frame, centre, radius);
}

void SoftScene::write(const std::string& png, const RenderScene& scene, const ViewFrame& frame,
                      const Vec3d& centre, double radius) {
  Camera camera;
  camera.focal_point = centre;
  camera.up = frame.up;
  camera.eye = centre + radius / std::tan(camera.view_angle_degrees / 2 * std::numbers::pi / 180) *
                            frame.towards_eye;
  check(write_png(png, trace(scene, camera, {kWidth, kHeight})));
}

void SoftScene::draw_sheet(const std::string& png, const ViewFrame& frame, const Vec3d& centre,
                           double radius, const Sheet& sheet) {
  const ModelLooks looks = check(ModelLooks::create(nullptr));
  RenderScene scene = looks.begin_scene();
  const std::vector<DeformedMesh> outer = displaced();
  std::vector<DeformedMesh> inner = outer;
  std::uint32_t points = 0;
  for (std::uint32_t m = 0; m < outer.size(); ++m) {
    const Mesh& mesh = instance.character().meshes[m];
    looks.add_mesh(mesh, outer[m], {}, scene);
    for (std::size_t v = 0; v < outer[m].positions.size(); ++v)
      inner[m].positions[v] -= static_cast<float>(sheet.thickness) * outer[m].normals[v];
    Mesh lining = mesh;
    lining.color_sets.assign(1, std::vector<Vec4f>(mesh.positions.size(), sheet.inner));
    looks.add_mesh(lining, inner[m], {}, scene);
    points = std::max(points, mesh.vertex_count());
  }
  // Strips between both sides along all borders.
  Mesh strips;
  strips.submeshes.push_back({"border", kNone});
  DeformedMesh at;
  for (const RimEdge& edge : find_borders_at(
           *instance.model(), std::vector<bool>(particles().positions().size(), true))) {
    const auto first = static_cast<std::uint32_t>(at.positions.size());
    const DeformedMesh& over = outer[edge.mesh];
    const Vec3f along = over.positions[edge.b] - over.positions[edge.a];
    const Vec3f facing = along.cross(over.normals[edge.a]);
    for (const std::uint32_t vertex : {edge.a, edge.b})
      for (const DeformedMesh* side : {&over, &std::as_const(inner)[edge.mesh]}) {
        at.positions.push_back(side->positions[vertex]);
        at.normals.push_back(facing.normalized());  // Zero for an edge without length.
      }
    strips.triangles.push_back({first, first + 1, first + 2});
    strips.triangles.push_back({first + 1, first + 3, first + 2});
  }
  strips.positions = at.positions;
  strips.triangle_submesh.assign(strips.triangles.size(), 0);
  strips.color_sets.assign(1, std::vector<Vec4f>(strips.positions.size(), sheet.inner));
  looks.add_mesh(strips, at, {}, scene);
  if (sheet.filling != nullptr)
    looks.add_mesh(*sheet.filling, {sheet.filling->positions, sheet.filling->normals, {}}, {},
                   scene);
  write(png, scene, frame, centre, radius);
}

void SoftScene::draw_particles(const std::string& png) const {
  const std::vector<DeformedMesh> bones = posed();
  std::vector<std::vector<Vec4f>> colors(bones.size());
  for (std::uint32_t m = 0; m < bones.size(); ++m)
    for (const std::uint32_t point : particles().vertex_points(m)) {
      Vec4f color = Vec4f::Zero();
      if (point != kNone) {
        const ParticleInfluences& of = particles().influences()[point];
        for (std::size_t k = 0; k < 4; ++k) color += of.weights[k] * color_of(of.particles[k]);
      }
      color[3] = 1.0f;
      colors[m].push_back(color);
    }
  const ModelLooks looks = check(ModelLooks::create(nullptr));
  RenderScene scene = looks.begin_scene();
  for (std::uint32_t m = 0; m < bones.size(); ++m) {
    Mesh mesh = source->meshes[m];
    mesh.color_sets.assign(1, colors[m]);
    looks.add_mesh(mesh, bones[m], {}, scene);
  }
  const ViewFrame frame = look_from(17, 7);
  Camera camera;
  camera.up = frame.up;
  camera.focal_point = bounds_of(*source, bones).centre();
  camera.eye = camera.focal_point + 1.75 * diagonal_ * frame.towards_eye;
  check(write_png(png, trace(scene, camera, {kWidth, kHeight})));
}

ViewFrame look_from(double side, double above) {
  const double a = side * std::numbers::pi / 180, b = above * std::numbers::pi / 180;
  ViewFrame frame;
  frame.towards_eye = {std::sin(a) * std::cos(b), std::sin(b), std::cos(a) * std::cos(b)};
  frame.right = Vec3d::UnitY().cross(frame.towards_eye).normalized();
  frame.up = frame.towards_eye.cross(frame.right);
  return frame;
}

}  // namespace sunder::tools
