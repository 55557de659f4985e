#include <sunder/core/mesh.h>
#include <sunder/core/status.h>

#include <gtest/gtest.h>

namespace sunder {
namespace {

// Documented preconditions stop debug builds; other builds promise nothing, so nothing is tested.
#if !defined(NDEBUG)

TEST(AssertDeathTest, a_failed_result_has_no_value) {
  Result<int> result = Status::failure(StatusCode::empty_input, kNone, "nothing");
  EXPECT_DEATH((void)*result, "has_value");
}

TEST(AssertDeathTest, influences_of_a_vertex_that_does_not_exist) {
  const Mesh mesh;
  EXPECT_DEATH((void)mesh.weights.of(0), "vertex_count");
}

#endif

}  // namespace
}  // namespace sunder
