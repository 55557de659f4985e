// What the C library costs beside the C++ library, in turns in one run: a call, and a frame with
// all that an engine reads from it.

#include <sunder/scene/scene.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <sunder_c.h>
#include <vector>

#include "bench/harness/json_object.h"
#include "bench/harness/measure.h"
#include "c/c_objects.h"
#include "support/models/rigs.h"

namespace sunder::bench {
namespace {

constexpr double kFrame = 1.0 / 90;

void expect(sunder_status status) {
  if (status == SUNDER_OK) return;
  std::fprintf(stderr, "%s\n", sunder_last_error());
  std::exit(1);
}

/// A soft instance that plays a clip, by C and by C++.
struct Scenes {
  explicit Scenes(const Character& character) {
    CharacterAssetOptions options;
    options.soft.emplace();
    SceneOptions one_thread;
    one_thread.threads = 1;
    scene.emplace(*Scene::create(one_thread));
    id = *scene->spawn(
        *CharacterAsset::create(std::make_shared<const Character>(character), options));
    if (!scene->play(id, 0)) std::exit(1);

    const test::CArrays arrays(character);
    sunder_character of_c = 0;
    sunder_asset asset = 0;
    sunder_asset_options c_options = sunder_default_asset_options();
    c_options.is_soft = 1;
    sunder_scene_options of_scene = sunder_default_scene_options();
    of_scene.threads = 1;
    expect(sunder_create_character(&arrays.data, &of_c));
    expect(sunder_create_asset(of_c, &c_options, &asset));
    expect(sunder_create_scene(&of_scene, &c_scene));
    expect(sunder_spawn(c_scene, asset, nullptr, &c_id));
    expect(sunder_play(c_scene, c_id, 0, nullptr, nullptr));
  }

  void tear(const Stroke& stroke) {
    const auto blades = test::blades_of(stroke);
    expect(sunder_submit_tear(c_scene, c_id, blades.data(),
                              static_cast<std::uint32_t>(blades.size()), nullptr, 0, nullptr));
    if (!scene->submit(id, TearCommand{stroke, {}})) std::exit(1);
  }

  double frame_of_cpp() {
    return seconds_of([&] {
      if (!scene->update(kFrame)) std::exit(1);
      const PosedMesh mesh = scene->mesh(id, 0, seen);
      seen = mesh.epoch;
    });
  }
  double frame_of_c() {
    return seconds_of([&] {
      expect(sunder_update(c_scene, kFrame));
      const sunder_result* results = nullptr;
      std::uint32_t count = 0;
      expect(sunder_get_results(c_scene, &results, &count));
      sunder_posed_mesh mesh;
      mesh.struct_size = sizeof mesh;
      expect(sunder_get_posed_mesh(c_scene, c_id, 0, c_seen, &mesh));
      c_seen = mesh.epoch;
    });
  }

  std::optional<Scene> scene;
  InstanceId id;
  std::uint64_t seen = 0, c_seen = 0;
  sunder_scene c_scene = 0;
  sunder_instance c_id = 0;
};

struct Figures {
  double call_ns = 0, mesh_ns = 0, mesh_of_cpp_ns = 0, overhead_ratio = 0;
  std::uint64_t allocations = 0;  ///< In a warm frame.
};

std::uint64_t allocated = 0;

/// Counts what the C library allocates from now on.
void count_allocations() {
  (void)sunder_set_allocator(
      [](void*, std::uint64_t bytes, std::uint64_t alignment) {
        ++allocated;
        return std::aligned_alloc(alignment, (bytes + alignment - 1) & ~(alignment - 1));
      },
      [](void*, void* memory, std::uint64_t, std::uint64_t) { std::free(memory); }, nullptr);
}

double ns_of_call(int calls, const auto& call) {
  return 1e9 * median(sample({.runs = 31}, [&] {
           return seconds_of([&] {
                    for (int i = 0; i < calls; ++i) call();
                  }) /
                  calls;
         }));
}

Figures measure() {
  count_allocations();
  const Character character = test::make_tube(120, 110, 12);  // 13 k vertices
  Scenes scenes(character);
  test::Random random(1);
  for (int i = 0; i < 5; ++i) scenes.frame_of_c(), scenes.frame_of_cpp();
  scenes.tear(test::random_stroke(character, scenes.scene->find(scenes.id)->pose(), random));
  for (int i = 0; i < 30; ++i) scenes.frame_of_c(), scenes.frame_of_cpp();

  Figures figures;
  std::vector<double> of_c, of_cpp;
  for (int i = 0; i < 400; ++i) {
    of_c.push_back(scenes.frame_of_c());
    of_cpp.push_back(scenes.frame_of_cpp());
  }
  figures.overhead_ratio = median(of_c) / median(of_cpp);
  const std::uint64_t before = allocated;
  scenes.frame_of_c();
  figures.allocations = allocated - before;
  std::uint32_t level = 0;
  figures.call_ns = ns_of_call(
      10'000, [&] { expect(sunder_get_shown_level(scenes.c_scene, scenes.c_id, &level)); });
  sunder_posed_mesh mesh;
  mesh.struct_size = sizeof mesh;
  figures.mesh_ns = ns_of_call(1'000, [&] {
    expect(sunder_get_posed_mesh(scenes.c_scene, scenes.c_id, 0, scenes.c_seen, &mesh));
  });
  figures.mesh_of_cpp_ns =
      ns_of_call(1'000, [&] { (void)scenes.scene->mesh(scenes.id, 0, scenes.seen); });
  return figures;
}

}  // namespace
}  // namespace sunder::bench

int main(int argc, char** argv) {
  const auto figures = sunder::bench::measure();
  if (argc > 1 && std::strcmp(argv[1], "--summary") == 0) {
    sunder::bench::JsonObject object;
    object.add("c_call_ns", figures.call_ns);
    object.add("c_overhead_ratio", figures.overhead_ratio);
    object.end();
    return 0;
  }
  std::printf("a call                        %.1f ns\n", figures.call_ns);
  std::printf("sunder_get_posed_mesh()       %.1f ns, Scene::mesh() %.1f ns\n", figures.mesh_ns,
              figures.mesh_of_cpp_ns);
  std::printf("a frame, C / C++              %.3f\n", figures.overhead_ratio);
  std::printf("allocations in a warm frame   %llu\n",
              static_cast<unsigned long long>(figures.allocations));
}
