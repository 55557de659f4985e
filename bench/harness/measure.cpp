#include "bench/harness/measure.h"

#include <malloc.h>

namespace sunder::bench {

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void sweep_caches() {
  constexpr std::size_t kBytes = std::size_t{64} << 20, kLine = 64;
  static std::vector<std::uint8_t> memory(kBytes);
  for (std::size_t i = 0; i < kBytes; i += kLine) ++memory[i];
}

std::uint64_t bytes_in_use() {
  const struct mallinfo2 info = mallinfo2();
  return info.uordblks + info.hblkhd;  // arenas, and blocks that are mapped separately
}

}  // namespace sunder::bench
