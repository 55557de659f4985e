// Reads the `#include` lines of the repository and checks them against the arrows of
// docs/architecture.md.

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "architecture/module_folders.h"
#include "architecture/source_tree.h"

namespace sunder::test {
namespace {

namespace fs = std::filesystem;

std::set<std::string> word_set_of(const std::string& text) {
  std::istringstream stream(text);
  std::set<std::string> words;
  for (std::string word; stream >> word;) words.insert(word);
  return words;
}

/// The modules that each module may include by <sunder/…>, including itself.
const std::map<std::string, std::set<std::string>> kMayUse = {
    {"core", {"core"}},
    {"robot", {"core", "operation", "weights", "certificate", "robot"}},
    {"operation", {"core", "operation"}},
    {"skinning", {"core", "operation", "skinning"}},
    {"animation", {"core", "operation", "skinning", "animation"}},
    {"weights", {"core", "weights"}},
    {"bodies", {"core", "operation", "skinning", "bodies"}},
    {"coupled_refit", {"core", "weights", "coupled_refit"}},
    {"certificate", {"core", "weights", "certificate"}},
    {"tear", {"bodies", "core", "operation", "skinning", "weights", "certificate", "tear"}},
    {"aim", {"bodies", "core", "operation", "skinning", "weights", "certificate", "tear", "aim"}},
    {"particles", {"bodies", "core", "operation", "skinning", "weights", "tear", "particles"}},
    {"scene",
     {"bodies", "core", "operation", "skinning", "animation", "weights", "tear", "particles",
      "scene"}},
    {"validation",
     {"bodies", "core", "operation", "skinning", "weights", "certificate", "tear", "validation"}},
    {"ragdoll",
     {"bodies", "core", "operation", "skinning", "animation", "weights", "tear", "particles",
      "ragdoll"}},
    {"plan",
     {"bodies", "core", "robot", "operation", "skinning", "weights", "certificate", "tear",
      "particles", "plan"}},
    {"binding", {"core", "operation", "skinning", "weights", "binding"}},
    {"io", {"core", "robot", "operation", "skinning", "weights", "io"}},
    {"bindings",
     {"bodies", "core", "operation", "skinning", "animation", "weights", "tear", "particles",
      "ragdoll", "scene", "validation", "io", "bindings"}},
    {"tools",
     {"bodies", "core", "robot", "operation", "skinning", "animation", "weights", "certificate",
      "coupled_refit", "tear", "aim", "plan", "particles", "ragdoll", "scene", "validation",
      "binding", "io", "tools"}},
    {"samples",
     {"bodies", "core", "robot", "operation", "skinning", "animation", "weights", "certificate",
      "tear", "aim", "plan", "particles", "ragdoll", "scene", "validation", "binding", "io"}},
};

/// Folders that may include <sunder/sunder.h>, which includes all modules.
const std::set<std::string> kMayUseUmbrella = {"samples", "tools"};

/// Folders that may include third parties; all others include only the standard library and Eigen.
/// Samples are programs of users, without access to private headers, and may use threads.
const std::map<std::string, std::set<std::string>> kThirdParties = {
    {"io", {"assimp", "nlohmann"}},
    {"bindings", {"sunder_c.h"}},  // our own C header
    {"skinning", {"hwy"}},
    {"tools", {"CLI", "nlohmann"}},
    {"samples", {"btBulletDynamicsCommon.h", "tbb"}},
};

/// Third parties that a single room may include.
const std::map<std::string, std::set<std::string>> kThirdPartyOfRoom = {
    {"pipeline/plan", {"ceres"}},
    {"samples/unreal", {"CoreMinimal.h", "DynamicMesh", "ProceduralMeshComponent.h", "sunder_c.h"}},
    {"pipeline/binding", {"unsupported"}},  // the tree of boxes in Eigen's package
    {"io/collada", {"tinyxml2.h"}},
    {"io/compression", {"draco", "meshoptimizer.h"}},
    {"io/fbx", {"zlib.h"}},
    {"io/gltf_decoders", {"simdjson.h"}},
    {"io/import_helper", {"seccomp.h"}},
    {"particles/bullet", {"BulletCollision", "BulletDynamics"}},
    {"tools/studio", {"event2", "netinet"}},
    {"tools/render", {"embree3", "jpeglib.h", "png.h", "zlib.h"}},
    {"pipeline/validation/match", {"unsupported"}},  // the tree of boxes in Eigen's package
    {"io/usd_write", {"zlib.h"}},
    {"io/urdf", {"console_bridge", "tinyxml2.h", "urdf_model", "urdf_parser"}},
};

/// Third parties that a single file may include.
const std::map<std::string, std::set<std::string>> kThirdPartyOfFile = {
    {"bindings/godot/interface_check.cpp", {"gdextension_interface.h"}},
    {"tear/bodies/qhull.cpp", {"libqhull_r"}},
    {"weights/coupled_refit/ceres_refit.cpp", {"ceres"}},
};

const std::set<std::string> kMayUseOperatingSystem = {"io", "tools"};

const std::set<std::string> kStandardHeaders = word_set_of(R"(
    algorithm any array atomic barrier bit bitset cassert cctype cerrno cfenv cfloat charconv
    chrono cinttypes climits clocale cmath compare complex concepts condition_variable coroutine
    csetjmp csignal cstdarg cstddef cstdint cstdio cstdlib cstring ctime cuchar cwchar cwctype
    deque exception execution filesystem forward_list fstream functional future initializer_list
    iomanip ios iosfwd iostream istream iterator latch limits list locale map memory
    memory_resource mutex new numbers numeric optional ostream queue random ranges ratio regex
    scoped_allocator semaphore set shared_mutex source_location span sstream stack stdexcept
    stop_token streambuf string string_view system_error thread tuple type_traits typeindex
    typeinfo unordered_map unordered_set utility valarray variant vector version assert.h ctype.h
    errno.h float.h limits.h math.h stdarg.h stddef.h stdint.h stdio.h stdlib.h string.h time.h)");

const std::set<std::string> kOperatingSystemHeaders = {"dlfcn.h",  "fcntl.h", "grp.h",   "poll.h",
                                                       "signal.h", "spawn.h", "unistd.h"};

/// The reason why `file`, of `module`, may not have this include; empty if it may.
std::string fault(const std::string& module, const std::string& file, bool is_public,
                  const Include& include) {
  const std::size_t slash = include.path.find('/');
  const std::string first = include.path.substr(0, slash);
  if (include.quoted) {
    if (first == "sunder") return "public headers are included as <sunder/…>";
    if (is_public) return "a public header includes a private one";
    const std::string owner = module_of(include.path);
    if (owner != module && kMayUse.count(owner) != 0 &&
        include.path.starts_with(folder_of(owner) + "/internal/"))
      return kMayUse.at(module).count(owner) != 0
                 ? std::string()
                 : "the arrow from " + module + " to " + owner + " is not allowed";
    if (slash == std::string::npos || owner != module)
      return "private headers are included as \"" + folder_of(module) + "/…\", from there only";
    return {};
  }
  if (first == "sunder") {
    if (include.path == "sunder/sunder.h") {
      return kMayUseUmbrella.count(module) != 0 ? std::string()
                                                : "modules include what they use, not all";
    }
    const std::string rest = include.path.substr(slash + 1);
    const std::string used = rest.substr(0, rest.find('/'));
    return kMayUse.at(module).count(used) != 0
               ? std::string()
               : "the arrow from " + module + " to " + used + " is not allowed";
  }
  if (kMayUse.count(first) != 0 && slash != std::string::npos)
    return "a private header in angle brackets";
  if (first == "Eigen" || kStandardHeaders.count(include.path) != 0) return {};
  if (is_public) return "third parties other than Eigen stay out of public headers";
  if (const auto allowed = kThirdParties.find(module);
      allowed != kThirdParties.end() && allowed->second.count(first) != 0)
    return {};
  if (const auto own = kThirdPartyOfRoom.find(file.substr(0, file.rfind('/')));
      own != kThirdPartyOfRoom.end() && own->second.count(first) != 0)
    return {};
  if (const auto own = kThirdPartyOfFile.find(file);
      own != kThirdPartyOfFile.end() && own->second.count(first) != 0)
    return {};
  if (kMayUseOperatingSystem.count(module) != 0 &&
      (first == "sys" || first == "linux" || kOperatingSystemHeaders.count(include.path) != 0))
    return {};
  return module + "/ may not use this third party";
}

/// One line per include that breaks a rule, sorted: "weights/a.cpp: <sunder/tear/b.h>: why".
std::vector<std::string> include_faults(const fs::path& root) {
  std::vector<std::string> faults;
  const auto check_folder = [&](const std::string& module, const fs::path& folder, bool is_public) {
    for (const fs::path& path : source_files(folder)) {
      const std::string file = name_below(root, path);
      if (!is_public && module_of(file) != module) continue;  // a module in this one's folder
      for (const Include& include : includes_of(path))
        if (const std::string why = fault(module, file, is_public, include); !why.empty())
          faults.push_back(file + ": " + include.path + ": " + why);
    }
  };
  for (const auto& [module, unused] : kMayUse) {
    check_folder(module, root / folder_of(module), false);
    check_folder(module, root / "include" / "sunder" / module, true);
  }
  if (fs::is_directory(root / "include" / "sunder"))
    for (const auto& entry : fs::directory_iterator(root / "include" / "sunder"))
      if (entry.path().filename() != "sunder.h" &&
          kMayUse.count(entry.path().filename().string()) == 0)
        faults.push_back("include/sunder/" + entry.path().filename().string() + ": not a module");
  std::sort(faults.begin(), faults.end());
  return faults;
}

std::vector<std::string> faults_of(const std::string& file, const std::string& content) {
  const FixtureTree tree(file, content);
  return include_faults(tree.root());
}

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(Architecture, our_tree_follows_the_arrows) {
  ASSERT_TRUE(fs::exists(fs::path(SUNDER_SOURCE_DIR) / "include/sunder/core/mesh.h"));
  EXPECT_THAT(include_faults(SUNDER_SOURCE_DIR), IsEmpty());
}

TEST(Architecture, every_source_of_a_folder_with_modules_is_of_a_module) {
  const fs::path root = SUNDER_SOURCE_DIR;
  std::set<std::string> folders;
  for (const auto& [module, unused] : kMayUse) {
    const std::string path = folder_of(module);
    EXPECT_FALSE(source_files(root / path).empty()) << path;
    folders.insert(path.substr(0, path.find('/')));
  }
  for (const std::string& folder : folders)
    for (const fs::path& file : source_files(root / folder))
      EXPECT_TRUE(kMayUse.contains(module_of(name_below(root, file)))) << file;
}

TEST(Architecture, an_upward_arrow_is_found) {
  EXPECT_THAT(faults_of("weights/a.cpp", "#include <sunder/tear/topology.h>"),
              ElementsAre(HasSubstr("from weights to tear")));
  EXPECT_THAT(faults_of("include/sunder/core/a.h", "#  include  <sunder/skinning/deform.h>"),
              ElementsAre(HasSubstr("from core to skinning")));
  EXPECT_THAT(faults_of("io/gltf/a.cpp", "#include <sunder/tear/topology.h>"),
              ElementsAre(HasSubstr("from io to tear")));
  EXPECT_THAT(faults_of("io/gltf/a.cpp", "#include <sunder/weights/influences.h>"), IsEmpty());
  EXPECT_THAT(faults_of("tear/a.cpp", "#include <sunder/io/character_file.h>"),
              ElementsAre(HasSubstr("from tear to io")));
}

/// The top-level folders that some module of a folder may include.
std::set<std::string> folders_below(const std::string& folder) {
  const auto top = [](const std::string& module) {
    const std::string path = folder_of(module);
    return path.substr(0, path.find('/'));
  };
  std::set<std::string> below;
  for (const auto& [module, used] : kMayUse)
    if (top(module) == folder)
      for (const std::string& other : used) below.insert(top(other));
  below.erase(folder);
  return below;
}

TEST(Architecture, no_folder_is_on_a_circle_of_arrows) {
  for (const auto& [module, unused] : kMayUse) {
    const std::string path = folder_of(module), start = path.substr(0, path.find('/'));
    std::set<std::string> reached;
    std::vector<std::string> open = {start};
    while (!open.empty()) {
      const std::string folder = open.back();
      open.pop_back();
      for (const std::string& next : folders_below(folder))
        if (reached.insert(next).second) open.push_back(next);
    }
    EXPECT_FALSE(reached.contains(start)) << start;
  }
}

TEST(Architecture, a_module_within_the_folder_of_another_has_arrows_of_its_own) {
  EXPECT_THAT(faults_of("tear/bodies/a.cpp", "#include <sunder/tear/topology.h>"),
              ElementsAre(HasSubstr("from bodies to tear")));
  EXPECT_THAT(faults_of("tear/a.cpp", "#include \"tear/bodies/hull.h\""),
              ElementsAre(HasSubstr("private headers")));
  EXPECT_THAT(faults_of("tear/bodies/a.cpp", "#include \"tear/bodies/hull.h\""), IsEmpty());
  EXPECT_THAT(faults_of("scene/a.cpp", "#include \"core/operation/internal/fields.h\""), IsEmpty());
  EXPECT_THAT(faults_of("weights/a.cpp", "#include \"core/operation/internal/fields.h\""),
              ElementsAre(HasSubstr("from weights to operation")));
}

TEST(Architecture, a_third_party_in_a_public_header_is_found) {
  EXPECT_THAT(faults_of("include/sunder/io/a.h", "#include <nlohmann/json.hpp>"),
              ElementsAre(HasSubstr("third parties")));
  EXPECT_THAT(faults_of("include/sunder/io/a.h",
                        "#include <Eigen/Core>\n#include <vector>\n#include <sunder/core/mesh.h>"),
              IsEmpty());
}

TEST(Architecture, a_third_party_behind_another_door_is_found) {
  EXPECT_THAT(faults_of("tear/a.cpp", "#include <nlohmann/json.hpp>"),
              ElementsAre(HasSubstr("third party")));
  EXPECT_THAT(faults_of("tear/a.cpp", "#include <hwy/highway.h>"),
              ElementsAre(HasSubstr("third party")));
  EXPECT_THAT(faults_of("skinning/a.cpp", "#include <hwy/highway.h>"), IsEmpty());
  EXPECT_THAT(faults_of("weights/a.cpp", "#include <ceres/solver.h>"),
              ElementsAre(HasSubstr("third party")));
  EXPECT_THAT(faults_of("weights/coupled_refit/ceres_refit.cpp", "#include <ceres/solver.h>"),
              IsEmpty());
  EXPECT_THAT(faults_of("particles/a.cpp", "#include <BulletDynamics/Dynamics/btRigidBody.h>"),
              ElementsAre(HasSubstr("third party")));
  EXPECT_THAT(faults_of("particles/bullet/bullet_body.cpp",
                        "#include <BulletDynamics/Dynamics/btRigidBody.h>"),
              IsEmpty());
  EXPECT_THAT(faults_of("include/sunder/particles/a.h", "#include <btBulletDynamicsCommon.h>"),
              ElementsAre(HasSubstr("third parties")));
  EXPECT_THAT(faults_of("tools/a.cpp", "#include <assimp/scene.h>"),
              ElementsAre(HasSubstr("third party")));
  EXPECT_THAT(faults_of("io/assimp/a.cpp", "#include <assimp/scene.h>\n#include <sys/wait.h>"),
              IsEmpty());
}

TEST(Architecture, a_private_header_of_another_module_is_found) {
  EXPECT_THAT(faults_of("weights/a.cpp", "#include \"tear/surface.h\""),
              ElementsAre(HasSubstr("private headers")));
  EXPECT_THAT(faults_of("tear/a.cpp", "#include <tear/surface.h>"),
              ElementsAre(HasSubstr("angle brackets")));
  EXPECT_THAT(faults_of("include/sunder/tear/a.h", "#include \"tear/surface.h\""),
              ElementsAre(HasSubstr("public header includes")));
  EXPECT_THAT(faults_of("tear/a.cpp", "#include \"surface.h\""),
              ElementsAre(HasSubstr("private headers")));
  EXPECT_THAT(faults_of("tear/a.cpp", "#include \"tear/surface.h\""), IsEmpty());
}

TEST(Architecture, quotes_around_a_public_header_are_found) {
  EXPECT_THAT(faults_of("tear/a.cpp", "#include \"sunder/tear/topology.h\""),
              ElementsAre(HasSubstr("<sunder/")));
}

TEST(Architecture, the_header_of_all_modules_is_for_programs) {
  EXPECT_THAT(faults_of("samples/a.cpp", "#include <sunder/sunder.h>"), IsEmpty());
  EXPECT_THAT(faults_of("tear/a.cpp", "#include <sunder/sunder.h>"),
              ElementsAre(HasSubstr("include what they use")));
  EXPECT_THAT(faults_of("include/sunder/sunder.h", "#include <sunder/core/mesh.h>"), IsEmpty());
}

TEST(Architecture, the_header_of_all_modules_includes_every_public_header) {
  const fs::path root = fs::path(SUNDER_SOURCE_DIR) / "include";
  std::set<std::string> included, installed;
  for (const Include& include : includes_of(root / "sunder/sunder.h"))
    included.insert(include.path);
  for (const fs::path& file : source_files(root))
    if (const std::string name = name_below(root, file);
        !name.starts_with("sunder/aim/") && name != "sunder/operation/aimed_operation.h" &&
        !name.starts_with("sunder/validation/") && !name.starts_with("sunder/certificate/") &&
        !name.starts_with("sunder/coupled_refit/") && !name.starts_with("sunder/robot/") &&
        !name.starts_with("sunder/binding/") && !name.starts_with("sunder/ragdoll/") &&
        !name.starts_with("sunder/plan/") && name != "sunder/io/robot_file.h" &&
        name != "sunder/core/memory_operators.h" && name != "sunder/io/trajectory_file.h" &&
        name != "sunder/io/usd_file.h" && name != "sunder/particles/fitted_colliders.h")
      installed.insert(name);  // what a frame needs; pipelines include their own
  EXPECT_EQ(installed.erase("sunder/sunder.h"), 1u);
  EXPECT_EQ(installed.erase("sunder_c.h"), 1u);
  EXPECT_EQ(included, installed);
}

TEST(Architecture, public_headers_are_for_every_compiler) {
  const fs::path root = fs::path(SUNDER_SOURCE_DIR) / "include";
  for (const fs::path& file : source_files(root)) {
    const std::string name = name_below(root, file);
    if (name == "sunder/core/api.h" || name == "sunder_c.h") continue;  // behind macros
    for (const char* const extension : {"__attribute__", "__builtin", "[[gnu::"})
      EXPECT_EQ(text_of(file).find(extension), std::string::npos) << file << ": " << extension;
  }
}

TEST(Architecture, an_unknown_public_folder_is_found) {
  EXPECT_THAT(faults_of("include/sunder/misc/a.h", "#include <vector>"),
              ElementsAre(HasSubstr("not a module")));
}

}  // namespace
}  // namespace sunder::test
