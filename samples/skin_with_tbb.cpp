// Skinning on the scheduler of oneTBB, through a ParallelFor.

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "samples/waving_strip.h"

namespace {

void run(void*, std::uint32_t count, sunder::ParallelFor::Task task, const void* work) {
  tbb::parallel_for(0u, count, [=](std::uint32_t index) { task(work, index); });
}

}  // namespace

int main() {
  sunder::ParallelFor hook;
  hook.run = run;
  hook.threads = static_cast<std::uint32_t>(tbb::this_task_arena::max_concurrency());
  return samples::wave_by("oneTBB", hook);
}
