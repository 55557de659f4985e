#include "bench/particles/particles_loop.h"

#include <sunder/particles/soft_body.h>
#include <sunder/skinning/pose.h>
#include <sunder/skinning/skinned_mesh.h>
#include <sunder/tear/tear_stroke.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>

#include "bench/harness/cpu_seconds.h"
#include "bench/harness/skinned_subdivision.h"
#include "bench/harness/subdivided_model.h"
#include "support/machine/random.h"
#include "support/models/rigs.h"

#if SUNDER_BENCH_IO
#include <sunder/io/character_file.h>

#include "particles/internal/angular_frequency.h"
#endif

namespace sunder::bench {
namespace {

constexpr int kFramesPerSecond = 90, kFrames = 20 * kFramesPerSecond, kRound = 3 * kFramesPerSecond;
constexpr int kUntornFrames = kFramesPerSecond, kStrokeFrames = kFramesPerSecond / 2;
constexpr int kFramesAPush = 10;

void require(const Status& status) {
  if (status) return;
  std::fprintf(stderr, "the loop failed: %.*s\n", static_cast<int>(status.text().size()),
               status.text().data());
  std::exit(1);
}
template <class T>
T take(Result<T> result) {
  require(result.error());
  return std::move(*result);
}

std::shared_ptr<const Character> load(int divisions, std::string& name) {
#if SUNDER_BENCH_IO
  const std::filesystem::path file = SUNDER_SHARED_MODELS "/rigged/cactoro.glb";
  if (std::filesystem::exists(file)) {
    name = "cactoro";
    return std::make_shared<Character>(
        subdivide_skinned(*take(load_character(file)).character, divisions));
  }
#endif
  name = "bunny";
  return std::make_shared<Character>(make_subdivided_model(divisions, 64));
}

/// Where the tools go: the box around the surface at rest.
struct Places {
  Vec3d middle, size;

  /// The blade of the stroke at a part of its way, in [0, 1], across the front.
  [[nodiscard]] Blade blade(int round, double part) const {
    const double x = middle.x() + (part - 0.5) * 0.35 * size.x();
    const double y = middle.y() + 0.07 * (round % 5 - 4) * size.y() + 0.05 * part * size.y();
    return {{x, y, middle.z() + size.z()}, {x, y, middle.z() - 0.2 * size.z()}};
  }
};

Places places_of(const ParticleSet& set) {
  Eigen::AlignedBox3d box;
  for (const Vec3f& at : set.positions()) box.extend(Eigen::Vector3d(at.cast<double>()));
  return {box.center(), box.sizes()};
}

/// All objects of the frame, and the times of its stages.
class Loop {
 public:
  explicit Loop(std::shared_ptr<const Character> character);

  LoopTimes frame(int i);
  [[nodiscard]] const ParticleSet& set() const { return *set_; }

 private:
  struct OfMesh {
    SkinnedMesh skinned;
    std::vector<Vec3f> positions, normals;
    PosedBuffer buffer{VertexTarget()};
  };

  void pose_at(int i);
  void push();
  LoopFrame operate(int i, LoopTimes& times);
  LoopFrame operate_in_round(int round, int at, LoopTimes& times);
  void follow(LoopTimes& times);
  void update(const MeshChange& change);
  void deform(LoopTimes& times);
  template <class Call>
  void change(LoopTimes& times, Call call) {
    times.operate += cpu_seconds_of([&] { require(call(&record_)); });
    follow(times);
  }

  std::shared_ptr<const Character> character_;
  std::unique_ptr<TornModel> model_;
  std::unique_ptr<ParticleSet> set_;
  std::unique_ptr<SoftBody> body_;
  std::vector<BonePalette> palettes_;
  std::vector<OfMesh> meshes_;
  std::optional<TearStroke> stroke_;
  Places places_;
  std::size_t clip_ = 0;
  Pose local_;
  ModelPose pose_;
  ChangeRecord record_;
  test::Random random_{1};
};

Loop::Loop(std::shared_ptr<const Character> character)
    : character_(std::move(character)),
      model_(std::make_unique<TornModel>(take(TornModel::create(character_)))) {
  pose_ = take(rest_pose(*character_));
  set_ = std::make_unique<ParticleSet>(take(ParticleSet::create(*model_, pose_)));
  const std::array<SoftMaterial, 1> materials = {};
  body_ = std::make_unique<SoftBody>(take(SoftBody::create(*set_, pose_, materials)));
  for (const Skin& skin : character_->skins)
    palettes_.push_back(
        take(BonePalette::create(skin.bones.size(), character_->rest_morph_weights.size())));
  for (const Mesh& mesh : character_->meshes) {
    meshes_.push_back(
        {take(SkinnedMesh::create(source_of(mesh), character_->skins[mesh.skin].bones.size())),
         std::vector<Vec3f>(2 * mesh.vertex_count() + 100000),
         std::vector<Vec3f>(2 * mesh.vertex_count() + 100000)});
    OfMesh& made = meshes_.back();
    made.buffer.set_target(
        {mesh.vertex_count(), {made.positions[0].data()}, {made.normals[0].data()}, {}});
  }
  places_ = places_of(*set_);
  if (!character_->clips.empty()) local_ = take(local_rest_pose(*character_));
  for (std::size_t c = 0; c < character_->clips.size(); ++c)
    if (character_->clips[c].name.ends_with("Walk")) clip_ = c;
}

void Loop::pose_at(int i) {
  if (character_->clips.empty()) {
    for (Affine3d& bone : pose_.model_from_bone)
      bone.translation().x() += i % 2 == 0 ? 1e-4 : -1e-4;
    return;
  }
  require(sample_clip(character_->clips[clip_], i / double{kFramesPerSecond}, local_));
  require(compute_model_pose(character_->skeleton, local_, pose_));
}

void Loop::push() {
  const SoftMaterial& material = body_->materials()[0];
  const double speed =
      0.2 * particles::angular_frequency(material.return_frequency);  // times the range
  for (std::uint32_t p = 0; p < set_->particle_count(); ++p)
    require(body_->add_impulse(p, body_->mass(p) * speed * set_->range(p) * random_.direction()));
}

void Loop::update(const MeshChange& change) {
  OfMesh& mesh = meshes_[change.mesh];
  require(
      mesh.skinned.update(source_of(model_->character().meshes[change.mesh]), change.first_vertex));
  mesh.buffer.set_vertex_count(mesh.skinned.vertex_count());
}

void Loop::follow(LoopTimes& times) {
  times.follow += cpu_seconds_of([&] { require(set_->follow(*model_, {&record_, 1})); });
  times.update += cpu_seconds_of([&] {
    for (const MeshChange& change : record_.meshes) update(change);
  });
}

LoopFrame Loop::operate(int i, LoopTimes& times) {
  if (i < kUntornFrames) return LoopFrame::untorn;
  return operate_in_round((i - kUntornFrames) / kRound, (i - kUntornFrames) % kRound, times);
}

LoopFrame Loop::operate_in_round(int round, int at, LoopTimes& times) {
  if (at < kStrokeFrames) {
    if (at == 0) stroke_.emplace(take(TearStroke::create(*model_, pose_, places_.blade(round, 0))));
    const Blade blade = places_.blade(round, (at + 1.0) / kStrokeFrames);
    change(times, [&](ChangeRecord* record) {
      return stroke_->extend(pose_, blade, 0.0, record).error();
    });
    return LoopFrame::stroke;
  }
  if (at == kStrokeFrames) {
    change(times, [&](ChangeRecord* record) { return stroke_->end(record).error(); });
    stroke_.reset();
    return LoopFrame::stroke;
  }
  if (at < 2 * kStrokeFrames) {
    require(body_->set_tension({at % 2 == 0 ? 1.0 : 1.1, {}}));
    return LoopFrame::gape;
  }
  PlaneCut cut;
  cut.point = places_.middle + Vec3d(0.25 * places_.size.x(), 0, 0);
  cut.normal = {1, 0.1 * round, 0.05};
  cut.caps = true;
  Bore bore;
  bore.origin = places_.middle + Vec3d(0, 0.02 * round * places_.size.y(), places_.size.z());
  bore.radius = 0.03 * places_.size.norm();
  bore.depth = 2 * places_.size.z();
  bore.wall = true;
  const auto undo = [&](ChangeRecord* record) { return model_->undo(record); };
  switch (at - 2 * kStrokeFrames) {
    case 10:
      change(times, [&](ChangeRecord* record) { return model_->cut(pose_, cut, record).error(); });
      return LoopFrame::cut;
    case 30:
      change(times,
             [&](ChangeRecord* record) { return model_->drill(pose_, bore, record).error(); });
      return LoopFrame::drill;
    case 50:
    case 60:
    case 90: change(times, undo); return LoopFrame::undo;
    case 70:
      change(times, [&](ChangeRecord* record) { return model_->redo(record); });
      return LoopFrame::redo;
    default: return LoopFrame::still;
  }
}

void Loop::deform(LoopTimes& times) {
  const std::vector<Skin>& skins = character_->skins;
  for (std::size_t s = 0; s < skins.size(); ++s) require(palettes_[s].set(skins[s], pose_));
  for (std::uint32_t m = 0; m < meshes_.size(); ++m) {
    VertexDisplacements displaced;
    times.moved += cpu_seconds_of([&] { displaced.moved = body_->moved_vertices(*model_, m); });
    times.gradients += cpu_seconds_of([&] { displaced.gradients = set_->gradients(*model_); });
    displaced.vertex_rows = set_->vertex_points(m);
    displaced.influences = set_->influences();
    displaced.displacements = body_->displacements();
    displaced.model_from_gradient = body_->rotations();
    const BonePalette& palette = palettes_[character_->meshes[m].skin];
    times.deform += cpu_seconds_of(
        [&] { require(meshes_[m].skinned.deform(palette, meshes_[m].buffer, {}, &displaced)); });
  }
}

LoopTimes Loop::frame(int i) {
  LoopTimes times;
  pose_at(i);
  if (i % kFramesAPush == 0) push();
  times.kind = operate(i, times);
  times.settle = cpu_seconds_of([&] { (void)set_->settle(*model_); });
  times.step =
      cpu_seconds_of([&] { require(body_->step(*model_, pose_, 1.0 / kFramesPerSecond)); });
  deform(times);
  return times;
}

}  // namespace

const char* name_of(LoopFrame kind) {
  constexpr std::array<const char*, 8> kNames = {"untorn", "stroke", "gape", "still",
                                                 "cut",    "drill",  "undo", "redo"};
  return kNames[static_cast<std::size_t>(kind)];
}

LoopFigures play_loop(int divisions) {
  LoopFigures figures;
  const std::shared_ptr<const Character> character = load(divisions, figures.name);
  Loop loop(character);
  for (const Mesh& mesh : character->meshes) figures.vertices += mesh.vertex_count();
  figures.points = loop.set().report().points;
  figures.particles = loop.set().particle_count();
  figures.bones = character->skeleton.bones.size();
  for (int i = -30; i < kFrames; ++i) {
    const LoopTimes times = loop.frame(i);
    if (i >= 0) figures.frames.push_back(times);
  }
  return figures;
}

}  // namespace sunder::bench
