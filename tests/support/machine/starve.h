#pragma once

#include <sunder/core/status.h>

#include <cstdint>

#include <gtest/gtest.h>

#include "support/machine/allocation_count.h"
#include "support/machine/stress.h"

namespace sunder::test {

/// The status of a call that returns a Status or a Result.
inline Status status_of(const Status& status) { return status; }
template <class T>
Status status_of(const Result<T>& result) {
  return result.error();
}

/// Calls with memory for 0, 1, 2 … allocations, on a new subject each time, until there is enough.
/// With SUNDER_STRESS set each number is tried, otherwise more and more of them are left out.
/// @param make   make(): a pointer to a new subject.
/// @param call   call(subject): the Status or Result of a call. It fails with limit_exceeded, and
///               throws nothing.
/// @param check  check(subject, Status): called with memory enough, after each call.
template <class Make, class Call, class Check>
void starve(Make make, Call call, Check check) {
  if (!FailingAllocations::are_possible())
    GTEST_SKIP() << "this program has no operator new of its own";
  constexpr std::uint64_t kMost = 1'000'000;  // more than any call makes
  const std::uint64_t skipped_of = static_cast<std::uint64_t>(stressed(16, 1'000'000));
  for (std::uint64_t count = 0; count < kMost; count += 1 + count / skipped_of) {
    const auto subject = make();
    Status status;
    ASSERT_NO_THROW({
      const FailingAllocations failing(count);
      status = status_of(call(*subject));
    }) << count;
    ASSERT_TRUE(status || status.code() == StatusCode::limit_exceeded)
        << count << ": " << status.text();
    ASSERT_NO_FATAL_FAILURE(check(*subject, status)) << "after " << count << " allocations";
    if (::testing::Test::HasFailure()) FAIL() << "after " << count << " allocations";
    if (status) {
      EXPECT_GT(count, 0u) << "the call needs no memory, so nothing was tested";
      return;
    }
  }
  FAIL() << "there was never enough memory";
}

}  // namespace sunder::test
