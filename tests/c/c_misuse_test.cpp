// No call of the C library ends the program, whatever it is given.

#include <iterator>
#include <set>
#include <string>

#include "c/c_objects.h"
#include "c/random_arguments.h"
#include "c_calls.inc"
#include "support/machine/stress.h"

namespace sunder::test {
namespace {

/// All arguments are zero.
struct Zeros {
  template <class Handle>
  Handle handle(const char* /*kind*/) {
    return 0;
  }
  template <class Handle>
  Handle* handle_out(const char* /*kind*/) {
    return nullptr;
  }
  template <class Pointer>
  Pointer pointer() {
    return nullptr;
  }
  template <class Struct>
  Struct* structure(const Struct& /*one*/) {
    return nullptr;
  }
  template <class Struct>
  Struct sized() {
    return {};
  }
  template <class Number>
  Number number(const char* /*name*/) {
    return 0;
  }
};

TEST(CMisuse, every_function_refuses_zeros) {
  Zeros zeros;
  for (const auto& [name, call] : Calls<Zeros>::kAll) {
    // A scene can be made of null options, but not without a place for its handle. Without
    // functions, memory comes from the heap again.
    if (std::string_view(name) == "sunder_set_allocator") continue;
    EXPECT_NE(call(zeros), SUNDER_OK) << name;
    EXPECT_STRNE(sunder_last_error(), "") << name;
  }
  EXPECT_GT(std::size(Calls<Zeros>::kAll), 80u);
}

/// The arguments of RandomArguments, but all handles are one of another kind, or a destroyed one.
struct WrongHandle : RandomArguments<Random> {
  WrongHandle(Random& random, std::uint32_t of) : RandomArguments(random), wrong(of) {}
  template <class Handle>
  Handle handle(const char* /*kind*/) {
    return static_cast<Handle>(wrong);
  }
  std::uint32_t wrong;
};

TEST(CMisuse, handles_of_another_kind_and_destroyed_ones_are_refused) {
  Random random(1);
  const sunder_character character = create(make_tube(6, 5, 3));
  sunder_bytes bytes = 0;
  EXPECT_DONE(sunder_save_glb(character, nullptr, &bytes));
  for (const bool is_destroyed : {false, true}) {
    if (is_destroyed) {
      EXPECT_DONE(sunder_destroy_bytes(bytes));
    }
    WrongHandle arguments(random, bytes);
    for (const auto& [name, call] : Calls<WrongHandle>::kAll) {
      const std::string function(name);
      const bool takes_none =
          function == "sunder_create_character" || function == "sunder_load_glb" ||
          function == "sunder_create_scene" || function == "sunder_find_material" ||
          function == "sunder_tension_for_gap" || function == "sunder_set_allocator" ||
          function == "sunder_blade_force";
      const bool is_of_bytes = function.find("_bytes") != std::string::npos;
      if (takes_none || (is_of_bytes && !is_destroyed)) continue;
      arguments.begin_call();
      EXPECT_NE(call(arguments), SUNDER_OK) << name;
    }
  }
  EXPECT_EQ(sunder_destroy_bytes(bytes), SUNDER_INVALID_HANDLE);
  EXPECT_EQ(sunder_destroy_bytes(character), SUNDER_INVALID_HANDLE);
  EXPECT_NE(std::string(sunder_last_error()).find("a character"), std::string::npos);
  EXPECT_DONE(sunder_destroy_character(character));
}

TEST(CMisuse, a_number_never_names_a_second_object) {
  const sunder_character character = create(make_tube(6, 5, 3));
  std::set<std::uint32_t> seen;
  for (int i = 0; i < 9000; ++i) {  // more than one slot has generations
    sunder_scene scene = 0;
    sunder_scene_options options = sunder_default_scene_options();
    options.threads = 1;
    ASSERT_EQ(sunder_create_scene(&options, &scene), SUNDER_OK);
    EXPECT_NE(scene, 0u);
    EXPECT_TRUE(seen.insert(scene).second);
    EXPECT_DONE(sunder_destroy_scene(scene));
    EXPECT_EQ(sunder_destroy_scene(scene), SUNDER_INVALID_HANDLE);
  }
  EXPECT_DONE(sunder_destroy_character(character));
}

TEST(CMisuse, random_calls_do_no_harm) {
  using Arguments = RandomArguments<Random>;
  constexpr auto& kAll = Calls<Arguments>::kAll;
  std::set<std::string> worked;
  const Character model = rich_character();
  const CArrays arrays(model);
  const int seeds = stressed(12, 50);
  for (int seed = 0; seed < seeds; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    Arguments arguments(random);
    for (int i = 0; i < 6000; ++i) {
      if (i % 150 == 0) {
        ASSERT_TRUE(keep_new_objects(arrays.data, arguments));
      }
      const auto& [name, call] = kAll[random.index(static_cast<std::uint32_t>(std::size(kAll)))];
      arguments.begin_call();
      const sunder_status status = call(arguments);
      arguments.end_call(status);
      EXPECT_NE(status, SUNDER_INTERNAL_ERROR) << name << ": " << sunder_last_error();
      if (status == SUNDER_OK) worked.insert(name);
    }
  }
  EXPECT_GT(worked.size(), 60u);  // Most functions got past their checks.
}

TEST(CMisuse, another_version_is_refused) {
  EXPECT_DONE(sunder_check_abi(SUNDER_C_VERSION, 0));
  EXPECT_DONE(sunder_check_abi(SUNDER_C_VERSION + 1, sunder_features()));
  EXPECT_EQ(sunder_check_abi(SUNDER_C_VERSION + 0x100, 0), SUNDER_UNSUPPORTED_FEATURE);
  EXPECT_EQ(sunder_check_abi(SUNDER_C_VERSION, 0x80000000u), SUNDER_UNSUPPORTED_FEATURE);
  EXPECT_EQ(sunder_version(), SUNDER_C_VERSION);
}

TEST(CMisuse, statuses_have_names) {
  for (const sunder_status status : {0, 1, 7, 17, 100, 101, 102}) {
    EXPECT_STRNE(sunder_status_name(status), "unknown") << status;
  }
  for (const sunder_status status : {-1, 18, 99, 103}) {
    EXPECT_STREQ(sunder_status_name(status), "unknown");
  }
}

}  // namespace
}  // namespace sunder::test
