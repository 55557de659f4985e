#include <sunder/core/memory_scope.h>

#include <utility>

namespace sunder {
namespace {

thread_local std::pmr::memory_resource* now = nullptr;

}  // namespace

MemoryScope::MemoryScope(std::pmr::memory_resource* memory) : outer_(std::exchange(now, memory)) {}
MemoryScope::~MemoryScope() { now = outer_; }
std::pmr::memory_resource* MemoryScope::current() { return now; }

}  // namespace sunder
