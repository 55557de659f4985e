#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace sunder::particles {

/// A growing list of many entries, which do not move but for the first ones: to copy a vector of a
/// megabyte because it grows takes a frame longer than what is appended in many.
template <class T>
class ChunkedList {
 public:
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] T& operator[](std::size_t i) { return chunks_[i / kChunk][i % kChunk]; }
  [[nodiscard]] const T& operator[](std::size_t i) const { return chunks_[i / kChunk][i % kChunk]; }
  void push_back(const T& value) {
    if (size_ % kChunk == 0) {
      std::vector<T> chunk;
      if (size_ > 0) chunk.reserve(kChunk);  // the first one is that of a small tear, perhaps
      chunks_.push_back(std::move(chunk));
    }
    chunks_.back().push_back(value);
    ++size_;
  }
  void assign(std::span<const T> values) {
    chunks_.clear();
    size_ = 0;
    for (const T& value : values) push_back(value);
  }
  /// Calls visit(entry) for all entries, the first one first.
  template <class Visit>
  void for_each(Visit visit) const {
    for (const std::vector<T>& chunk : chunks_) std::for_each(chunk.begin(), chunk.end(), visit);
  }
  template <class Visit>
  void for_each(Visit visit) {
    for (std::vector<T>& chunk : chunks_) std::for_each(chunk.begin(), chunk.end(), visit);
  }
  [[nodiscard]] std::size_t memory_bytes() const {
    std::size_t bytes = chunks_.capacity() * sizeof(chunks_[0]);
    for (const std::vector<T>& chunk : chunks_) bytes += chunk.capacity() * sizeof(T);
    return bytes;
  }

 private:
  static constexpr std::size_t kChunk = 1024;  ///< Entries of each chunk but the last one.

  std::vector<std::vector<T>> chunks_;
  std::size_t size_ = 0;
};

}  // namespace sunder::particles
