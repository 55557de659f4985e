// Skinning on a plain thread pool, through a ParallelFor.

#include "samples/thread_pool.h"
#include "samples/waving_strip.h"

int main() {
  samples::ThreadPool pool(4);
  return samples::wave_by("thread pool", pool.hook());
}
