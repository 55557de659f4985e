// The structs of operations of sunder_c.h have a member for each described field, with its default.

#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <sunder_c.h>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/operation/internal/describe_operations.h"
#include "core/operation/internal/names.h"

namespace sunder::test {
namespace {

/// Where a struct of sunder_c.h has its members on a machine of 64 bits.
std::map<std::string, std::size_t> members_of(const std::string& name) {
  std::ifstream file(std::filesystem::path(SUNDER_SOURCE_DIR) / "bindings/c/sunder_api.json");
  const nlohmann::json api = nlohmann::json::parse(file);
  std::map<std::string, std::size_t> members;
  for (const nlohmann::json& of : api["structs"])
    if (of["name"] == name)
      for (const nlohmann::json& member : of["fields"])
        members[member["name"]] = member["offset64"];
  return members;
}

/// Compares described fields with the members of a struct of C.
class CMembers {
 public:
  CMembers(const std::string& name, const void* value)
      : members_(members_of(name)), value_(static_cast<const std::byte*>(value)) {}

  void operator()(const Field& field, double number, const auto&...) const {
    expect(field.name, number);
  }
  template <class T>
  requires std::is_enum_v<T> || std::is_same_v<T, std::uint32_t>
  void operator()(const Field& field, const T& value, const auto&...) const {
    expect(field.name, static_cast<std::uint32_t>(value));
  }
  void operator()(const Field& field, bool flag) const {
    expect("has_" + std::string(field.name), std::uint32_t{flag});
  }
  void operator()(const Field& field, const Vec3d& vector, const auto&...) const {
    for (std::size_t i = 0; i < 3; ++i)
      expect(field.name, vector[static_cast<int>(i)], i * sizeof(double));
  }
  void operator()(const Field&, const std::optional<WeightOptions>& weights) const {
    ASSERT_FALSE(weights);
    expect("weight_policy", std::int32_t{SUNDER_WEIGHTS_OF_MODEL});
    expect("maximum_influences", WeightOptions{}.maximum_influences);
  }
  void operator()(const Field& field, const std::optional<SectionRay>& ray) const {
    expect("has_" + std::string(field.name), std::uint32_t{ray.has_value()});
    (*this)({.name = "ray_origin", .text = ""}, SectionRay{}.origin);
    (*this)({.name = "ray_direction", .text = ""}, SectionRay{}.direction);
  }
  /// Names and lists: null.
  void operator()(const Field& field, const std::string&, const Name&) const {
    expect(field.name, static_cast<const char*>(nullptr));
  }
  void operator()(const Field& field, const std::vector<Vec3d>&, const List&) const {
    expect(field.name, static_cast<const double*>(nullptr));
  }
  void object(const Field&, const auto& body) const { body(*this); }

 private:
  template <class T>
  void expect(const std::string& name, const T& wanted, std::size_t after = 0) const {
    const auto found = members_.find(name);
    ASSERT_NE(found, members_.end()) << name << " is missing";
    T value{};
    std::memcpy(&value, value_ + found->second + after, sizeof value);
    EXPECT_EQ(value, wanted) << name;
  }

  std::map<std::string, std::size_t> members_;
  const std::byte* value_;
};

template <class Described, class CStruct>
void compare(const char* name, const CStruct& value) {
  if (sizeof(void*) != 8) GTEST_SKIP() << "offsets are known for 64 bits";
  const CMembers members(name, &value);
  const Described of{};
  describe(members, of);
}

TEST(COperations, TearsHaveTheDescribedFields) {
  compare<TearOptions>("sunder_tear_options", sunder_default_tear_options());
}

TEST(COperations, CutsHaveTheDescribedFields) {
  compare<PlaneCut>("sunder_cut", sunder_default_cut());
}

TEST(COperations, BoresHaveTheDescribedFields) {
  compare<Bore>("sunder_bore", sunder_default_bore());
}

TEST(COperations, WeldsHaveTheDescribedFields) {
  compare<Weld>("sunder_weld", sunder_default_weld());
}

TEST(COperations, SuturesHaveTheDescribedFields) {
  compare<Suture>("sunder_suture", sunder_default_suture());
}

TEST(COperations, EnumeratorsAreThoseOfLogs) {
  EXPECT_EQ(SUNDER_LAYERS_ALL, static_cast<int>(last_named<Layers>()));
  EXPECT_EQ(SUNDER_WEIGHTS_EXACT, static_cast<int>(last_named<WeightPolicy>()));
}

}  // namespace
}  // namespace sunder::test
