// Measures skinning: ours, naive Eigen, and reading and writing the same number of bytes, in turns;
// with all bones moving and with few.

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <deque>
#include <functional>

#include "bench/harness/json_object.h"
#include "bench/harness/measure.h"
#include "bench/peers/native_peers.h"
#include "bench/skinning/displacing.h"
#include "bench/skinning/posing_turns.h"
#include "bench/skinning/skinning_scene.h"
#include "samples/thread_pool.h"

namespace sunder::bench {
namespace {

constexpr const char* kHelp =
    "bench_skinning [--summary]\n"
    "\n"
    "Poses the bunny with 1, 3, 7 and 16 divisions per edge, on 64 bones, with up to four smooth\n"
    "influences per vertex. Positions and normals; nanoseconds per vertex, medians, candidates\n"
    "in turns.\n"
    "  ordered   vertices in order_for_skinning(), for every candidate\n"
    "  file      vertices in the file's order, which scatters them over the bones\n"
    "  warm      the same character in every frame\n"
    "  crowd     so many characters in turn that none stays in a cache\n"
    "  touch     reads and writes the same number of bytes\n"
    "Eigen and touch are compiled for this machine only, ours for any.\n"
    "\n"
    "--summary prints one JSON object, for ordered vertices.\n"
    "  vs_eigen_in_cache    time of naive Eigen / ours, warm; the lower one of the sizes up to\n"
    "                       35 thousand vertices\n"
    "  vs_eigen_900k        the same at 892 thousand vertices\n"
    "  vs_touch_900k        our time / time of touch, at 892 thousand vertices; touch is the\n"
    "                       fastest of plain and non-temporal stores, with and without prefetches\n"
    "  vs_touch             the same by size\n"
    "  two_threads          time on one thread / time on two, with the sample's thread pool; the\n"
    "                       lowest of the sizes from 31 thousand vertices on\n"
    "  two_threads_3k       the same at 3.5 thousand\n"
    "  one_bone_overhead    a frame in which one of 64 bones moved: its mean time as a fraction "
    "of\n"
    "                       a full frame, minus the fraction of vertices that the bone moves; the\n"
    "                       maximum over the sizes\n"
    "  idle_us              set() and deform() of an unchanged pose, at the slowest size\n"
    "  displace_ns          what displacing every vertex adds per vertex: positions, normals and\n"
    "                       tangents, at 31 thousand vertices\n"
    "  max_error_vs_double  metres, for a character of 2 m, at any size\n";

constexpr std::array<int, 4> kDivisions = {1, 3, 7, 16};

double time_of(const std::vector<PosingCandidate>& candidates, const char* name) {
  for (const PosingCandidate& candidate : candidates)
    if (std::strcmp(candidate.name, name) == 0) return median(candidate.ns_per_vertex);
  return 0;
}

/// The minimum over the candidates whose name begins with the text.
double least_time_of(const std::vector<PosingCandidate>& candidates, const char* begin) {
  double least = 0;
  for (const PosingCandidate& candidate : candidates)
    if (std::strncmp(candidate.name, begin, std::strlen(begin)) == 0)
      least = least == 0 ? median(candidate.ns_per_vertex)
                         : std::min(least, median(candidate.ns_per_vertex));
  return least;
}

void add_touching(std::vector<PosingCandidate>& candidates, std::deque<CrowdMember>& crowd) {
  const auto add = [&](const char* name, Stores stores, std::size_t ahead) {
    candidates.push_back({name, [&crowd, stores, ahead](std::size_t) {
                            for (CrowdMember& member : crowd)
                              touch(member.in.data(), member.mesh.stream_bytes() / sizeof(float),
                                    member.positions.data(), member.normals.data(),
                                    3 * member.vertices, stores, ahead);
                          }});
  };
  add("touch", Stores::plain, 0);
  add("touch, early", Stores::plain, 8192);
  add("touch, around caches", Stores::around_caches, 0);
  add("touch, around caches, early", Stores::around_caches, 8192);
}

/// The same on two threads, each with a part of the bytes.
void add_touching_by(samples::ThreadPool& pool, std::vector<PosingCandidate>& candidates,
                     std::deque<CrowdMember>& crowd) {
  static constexpr std::uint32_t kParts = 8;
  struct Work {
    const CrowdMember* member;
    Stores stores;
    static void part(const void* work, std::uint32_t index) {
      const auto& [member, how] = *static_cast<const Work*>(work);
      const auto cut = [index](std::size_t floats) { return floats / kParts / 16 * 16 * index; };
      const std::size_t in = member->mesh.stream_bytes() / sizeof(float),
                        out = 3 * std::size_t{member->vertices};
      touch(member->in.data() + cut(in), in / kParts, member->positions.data() + cut(out),
            member->normals.data() + cut(out), out / kParts, how, 8192);
    }
  };
  for (const Stores stores : {Stores::plain, Stores::around_caches})
    candidates.push_back(
        {stores == Stores::plain ? "by two: touch" : "by two: touch, around caches",
         [&, stores](std::size_t) {
           for (const CrowdMember& member : crowd) {
             const Work work = {&member, stores};
             const ParallelFor hook = pool.hook();
             hook.run(hook.context, kParts, &Work::part, &work);
           }
         }});
}

struct Times {
  double eigen = 0, ours = 0, two_threads = 0, touch = 0, touch_two_threads = 0;
};

Times measure_crowd(const SkinningScene& scene, std::deque<CrowdMember>& crowd, int turns) {
  samples::ThreadPool pool(2);
  std::vector<PosingCandidate> candidates;
  candidates.push_back({"eigen", [&](std::size_t pose) {
                          for (CrowdMember& member : crowd) member.pose_by_eigen(scene, pose);
                        }});
  candidates.push_back({"ours", [&](std::size_t pose) {
                          for (CrowdMember& member : crowd)
                            member.pose_by_ours(pose, member.buffer);
                        }});
  candidates.push_back({"two threads", [&](std::size_t pose) {
                          for (CrowdMember& member : crowd)
                            member.pose_by_ours(pose, member.buffer, pool.hook());
                        }});
  add_touching(candidates, crowd);
  add_touching_by(pool, candidates, crowd);
  measure_posing(candidates,
                 static_cast<double>(scene.vertex_count()) * static_cast<double>(crowd.size()),
                 turns);
  return {time_of(candidates, "eigen"), time_of(candidates, "ours"),
          time_of(candidates, "two threads"), least_time_of(candidates, "touch"),
          least_time_of(candidates, "by two")};
}

/// Measures a frame in which nothing or one bone moved.
struct Frames {
  double full_us = 0, set_us = 0, idle_us = 0;
  double one_bone_share = 0;  ///< Mean, as a fraction of a full frame.
  double moved_share = 0;     ///< Mean fraction of the vertices that one bone moves.
};

Frames measure_frames(const SkinningScene& scene, CrowdMember& member) {
  const Skin& skin = scene.character.skins[0];
  const std::size_t slots = skin.bones.size();
  BonePalette palette = *BonePalette::create(slots, scene.poses[0].morph_weights.size());
  std::array<std::vector<double>, 3> seconds;  // full, set, idle
  std::vector<double> shares(slots);
  for (const Influence& influence : scene.mesh().weights.influences)
    if (influence.weight > 0.0f) shares[influence.slot] += 1.0 / scene.vertex_count();
  const auto frame = [&] {
    return seconds_of([&] { (void)member.mesh.deform(palette, member.buffer); });
  };
  for (int i = 0; i < 40; ++i) {
    const ModelPose& pose = scene.poses[static_cast<std::size_t>(i) % SkinningScene::kPoses];
    seconds[1].push_back(seconds_of([&] { (void)palette.set(skin, pose); }));
    seconds[0].push_back(frame());
    seconds[2].push_back(seconds_of([&] {
                           for (int j = 0; j < 100; ++j) {
                             (void)palette.set(skin, pose);
                             (void)member.mesh.deform(palette, member.buffer);
                           }
                         }) /
                         100);
  }
  const double full = median(seconds[0]);
  Frames result = {full * 1e6, median(seconds[1]) * 1e6, median(seconds[2]) * 1e6, 0, 0};
  std::vector<Affine3f> matrices = scene.matrices[0];
  for (std::size_t slot = 0; slot < slots; ++slot) {
    std::vector<double> of_slot;
    for (int i = 0; i < 15; ++i) {
      matrices[slot].translation().x() += 1e-3f;
      (void)palette.set(matrices, scene.poses[0].morph_weights);
      of_slot.push_back(frame());
    }
    result.one_bone_share += median(of_slot) / full / static_cast<double>(slots);
    result.moved_share += shares[slot] / static_cast<double>(slots);
  }
  return result;
}

/// Other attributes and layouts, of our code only.
std::vector<std::pair<const char*, double>> measure_variants(const SkinningScene& scene) {
  CrowdMember member(scene), twisting(scene, SkinningMethod::dual_quaternion);
  const std::uint32_t count = member.vertices;
  float* interleaved = member.interleaved.data();
  PosedBuffer positions({count, {member.positions.data()}, {}, {}});
  PosedBuffer unit({count, {member.positions.data()}, {member.normals.data()}, {}, true});
  PosedBuffer strided({count, {interleaved, 24}, {interleaved + 3, 24}, {}});
  std::vector<PosingCandidate> candidates;
  const auto add = [&](const char* name, CrowdMember& of, PosedBuffer& buffer) {
    candidates.push_back(
        {name, [&of, &buffer](std::size_t pose) { of.pose_by_ours(pose, buffer); }});
  };
  add("positions", member, positions);
  add("positions, unit normals", member, unit);
  add("positions, normals, interleaved", member, strided);
  add("the same by dual quaternions", twisting, twisting.buffer);
  measure_posing(candidates, count, 15);
  std::vector<std::pair<const char*, double>> result;
  for (const PosingCandidate& candidate : candidates)
    result.emplace_back(candidate.name, median(candidate.ns_per_vertex));
  return result;
}

std::deque<CrowdMember> make_crowd(const SkinningScene& scene) {
  std::deque<CrowdMember> crowd;
  std::size_t bytes = 0;
  while (bytes < (std::size_t{96} << 20u) || crowd.size() < 2) {
    crowd.emplace_back(scene);
    bytes += crowd.back().mesh.stream_bytes() + 24u * scene.vertex_count();
  }
  return crowd;
}

struct SizeFigures {
  std::uint32_t vertices = 0;
  Times warm;
  Frames frames;
  SkinningError error, eigen_error;
};

SizeFigures measure_size(const SkinningScene& scene, std::deque<CrowdMember>& alone) {
  SizeFigures figures;
  figures.vertices = scene.vertex_count();
  figures.warm = measure_crowd(scene, alone, 25);
  figures.frames = measure_frames(scene, alone.front());
  CrowdMember& member = alone.front();
  member.pose_by_eigen(scene, 0);
  figures.eigen_error = error_of(scene, 0, member.positions.data(), member.normals.data());
  member.buffer.set_target(member.buffer.target());
  member.pose_by_ours(0, member.buffer);
  figures.error = error_of(scene, 0, member.positions.data(), member.normals.data());
  return figures;
}

void print_row(std::uint32_t vertices, const char* what, const Times& times) {
  std::printf("| %u, %s | %.2f | %.2f | %.2f | %.1f | %.1f | %.1f | %.1f |\n", vertices, what,
              times.eigen, times.ours, times.touch, times.eigen / times.ours,
              times.ours / times.touch, times.ours / times.two_threads,
              times.touch / times.touch_two_threads);
}

void print_speeds() {
  std::printf(
      "| vertices | Eigen | ours | touch | Eigen / ours | ours / touch | two threads | touch, two "
      "threads |\n|---|---|---|---|---|---|---|---|\n");
  for (const int divisions : kDivisions)
    for (const bool ordered : {true, false}) {
      const SkinningScene scene(divisions, ordered);
      std::deque<CrowdMember> members;
      members.emplace_back(scene);
      print_row(scene.vertex_count(), ordered ? "ordered, warm" : "file's order, warm",
                measure_crowd(scene, members, 25));
      if (!ordered) continue;
      members = make_crowd(scene);
      print_row(scene.vertex_count(), "ordered, crowd", measure_crowd(scene, members, 9));
      std::fflush(stdout);
    }
}

/// What changes little, other attributes and layouts, and displacements, of our code alone.
void print_frames() {
  std::printf(
      "\n| vertices, ordered | a frame, µs | `set()`, µs | unchanged, µs | vertices that a bone "
      "moves | time of its frame | largest error at 2 m, m | of Eigen, m |\n"
      "|---|---|---|---|---|---|---|---|\n");
  std::string variants = "\n| vertices, ordered |", rows;
  bool is_first = true;
  for (const int divisions : kDivisions) {
    const SkinningScene scene(divisions, true);
    std::deque<CrowdMember> alone;
    alone.emplace_back(scene);
    const SizeFigures figures = measure_size(scene, alone);
    const Frames& frames = figures.frames;
    std::printf("| %u | %.3g | %.2g | %.2g | %.1f %% | %.1f %% | %.1e | %.1e |\n",
                scene.vertex_count(), frames.full_us, frames.set_us, frames.idle_us,
                100 * frames.moved_share, 100 * frames.one_bone_share, figures.error.position,
                figures.eigen_error.position);
    rows += "| " + std::to_string(scene.vertex_count()) + " |";
    const auto add = [&](const std::string& name, double ns) {
      if (is_first) variants += " " + name + " |";
      char text[32];
      std::snprintf(text, sizeof text, " %.2f |", ns);
      rows += text;
    };
    for (const auto& [name, ns] : measure_variants(scene)) add(name, ns);
    const Displacing displacing = measure_displacing(scene);
    add("displacing positions adds", displacing.positions);
    add("with normals", displacing.normals);
    add("with tangents too", displacing.tangents);
    rows += "\n";
    is_first = false;
  }
  std::printf("%s\n|---|---|---|---|---|---|---|---|\n%s", variants.c_str(), rows.c_str());
}

void print_summary() {
  std::vector<SizeFigures> sizes;
  for (const int divisions : kDivisions) {
    const SkinningScene scene(divisions, true);
    std::deque<CrowdMember> alone;
    alone.emplace_back(scene);
    sizes.push_back(measure_size(scene, alone));
  }
  const auto vs_touch = [](const SizeFigures& size) { return size.warm.ours / size.warm.touch; };
  const auto vs_eigen = [](const SizeFigures& size) { return size.warm.eigen / size.warm.ours; };
  const auto threads = [](const SizeFigures& size) {
    return size.warm.ours / size.warm.two_threads;
  };
  double one_bone = -1, idle = 0, error = 0;
  std::vector<std::pair<std::string, double>> touch_by_size;
  for (const SizeFigures& size : sizes) {
    one_bone = std::max(one_bone, size.frames.one_bone_share - size.frames.moved_share);
    idle = std::max(idle, size.frames.idle_us);
    error = std::max(error, size.error.position);
    touch_by_size.emplace_back(std::to_string(size.vertices), vs_touch(size));
  }
  JsonObject object;
  object.add("vs_eigen_in_cache", std::min(vs_eigen(sizes[0]), vs_eigen(sizes[1])));
  object.add("vs_eigen_900k", vs_eigen(sizes[3]));
  object.add("vs_touch_900k", vs_touch(sizes[3]));
  object.add("vs_touch", touch_by_size);
  object.add("two_threads", std::min({threads(sizes[1]), threads(sizes[2]), threads(sizes[3])}));
  object.add("two_threads_3k", threads(sizes[0]));
  object.add("one_bone_overhead", one_bone);
  object.add("idle_us", idle);
  object.add("displace_ns", measure_displacing(SkinningScene(kDivisions[1], true)).tangents);
  object.add("max_error_vs_double", error);
  object.end();
}

}  // namespace
}  // namespace sunder::bench

int main(int argc, char** argv) {
  if (argc == 1) {
    sunder::bench::print_speeds();
    sunder::bench::print_frames();
    return 0;
  }
  if (argc == 2 && std::strcmp(argv[1], "--summary") == 0) {
    sunder::bench::print_summary();
    return 0;
  }
  const bool asked = argc == 2 && std::strcmp(argv[1], "--help") == 0;
  std::fputs(sunder::bench::kHelp, asked ? stdout : stderr);
  return asked ? 0 : 2;
}
