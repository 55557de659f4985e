// What is done in one place alone, because it must be done with care: printing texts in which names
// of files stand, writing files, and functions whose bits differ between C libraries.

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <set>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "architecture/bare_source.h"
#include "architecture/module_folders.h"
#include "architecture/source_tree.h"

namespace sunder::test {
namespace {

namespace fs = std::filesystem;

using Words = std::set<std::string_view>;

const Words kPrinting = {"printf", "vprintf", "fprintf", "vfprintf", "dprintf", "vdprintf",
                         "puts",   "fputs",   "fputc",   "putc",     "putchar", "fwrite",
                         "perror", "cout",    "cerr",    "clog",     "stdout",  "stderr"};
const Words kWriting = {"ofstream", "fopen",   "freopen", "rename",  "renameat",
                        "creat",    "O_CREAT", "O_TRUNC", "mkstemp", "copy_file"};

/// "file: word" of the first such identifier in the code of a file; empty if there is none.
std::string first_match(const fs::path& root, const fs::path& file, const Words& words) {
  const std::string code = without_comments_and_literals(text_of(file));
  const auto is_letter = [&](std::size_t i) {
    return i < code.size() && (std::isalnum(static_cast<unsigned char>(code[i])) || code[i] == '_');
  };
  for (std::size_t i = 0; i < code.size();) {
    std::size_t end = i;
    while (is_letter(end)) ++end;
    const std::string_view word = std::string_view(code).substr(i, end - i);
    if (words.contains(word)) return name_below(root, file) + ": " + std::string(word);
    i = std::max(end, i + 1);
  }
  return {};
}

std::string first_match_below(const fs::path& root, const std::string& folder,
                              const std::string& allowed, const Words& words) {
  for (const fs::path& file : source_files(root / folder)) {
    if (name_below(root, file).starts_with(allowed)) continue;
    if (std::string found = first_match(root, file, words); !found.empty()) return found;
  }
  return {};
}

TEST(OnePlace, the_command_prints_by_its_messages) {
  const fs::path root = SUNDER_SOURCE_DIR;
  EXPECT_EQ(first_match_below(root, "tools", "tools/messages/", kPrinting), "");
  EXPECT_NE(first_match_below(root, "tools/messages", "none", kPrinting), "");
}

TEST(OnePlace, files_are_written_by_one_function) {
  const fs::path root = SUNDER_SOURCE_DIR;
  EXPECT_EQ(first_match_below(root, "tools", "none", kWriting), "");
  // The helper process reads what the system says of its memory; it cannot write files.
  for (const char* const folder :
       {"io/assimp", "io/collada", "io/compression", "io/contained_import", "io/gltf",
        "io/gltf_patch", "io/gltf_read", "io/gltf_write", "io/import_checks", "io/import_messages",
        "io/operation_log", "io/trajectory", "io/urdf", "io/usd_write"})
    EXPECT_EQ(first_match_below(root, folder, "none", kWriting), "");
  EXPECT_NE(first_match_below(root, "io/files", "none", kWriting), "");
  for (const char* const module : {"core", "skinning", "particles", "scene", "samples"})
    EXPECT_EQ(first_match_below(root, module, "none", kWriting), "");
  EXPECT_EQ(first_match_below(root, "tear", "tear/bodies/qhull.cpp", kWriting),
            "");  // a null device
}

/// Functions that C libraries round differently, as they are called in C++ and by Eigen.
const char* const kInexactCalls[] = {
    "std::sin(",  "std::cos(",   "std::tan(",   "std::asin(",  "std::acos(",   "std::atan(",
    "std::sinh(", "std::cosh(",  "std::tanh(",  "std::atan2(", "std::exp(",    "std::exp2(",
    "std::log(",  "std::log2(",  "std::log10(", "std::pow(",   "std::expm1(",  "std::log1p(",
    "std::cbrt(", "std::hypot(", "AngleAxis",   ".slerp(",     ".eulerAngles("};

std::string inexact_call_below(const fs::path& root, const std::string& folder,
                               const std::string& allowed) {
  for (const fs::path& file : source_files(root / folder)) {
    const std::string name = name_below(root, file);
    if (name.starts_with(allowed) || module_of(name) != module_of(folder + "/")) continue;
    const std::string code = without_comments_and_literals(text_of(file));
    for (const char* const call : kInexactCalls)
      if (code.find(call) != std::string::npos) return name + ": " + call;
  }
  return {};
}

TEST(OnePlace, what_a_log_replays_has_the_same_bits_with_every_c_library) {
  const fs::path root = SUNDER_SOURCE_DIR;
  for (const char* const module :
       {"core", "core/operation", "skinning", "skinning/animation", "weights", "tear",
        "tear/bodies", "scene", "bindings/c", "include/sunder/core", "include/sunder/skinning",
        "include/sunder/tear"})
    EXPECT_EQ(inexact_call_below(root, module, "none"), "");
  EXPECT_EQ(inexact_call_below(root, "particles", "particles/bullet/"), "");
  EXPECT_NE(inexact_call_below(root, "io/robot", "none"), "");  // computed before a log is written
  for (const char* const code : {"double f() { return std::sin(1); }",
                                 "Quatd q(Eigen::AngleAxisd(1, axis));", "auto q = a.slerp(t, b);"})
    EXPECT_NE(inexact_call_below(FixtureTree("tear/a.cpp", code).root(), "tear", "none"), "")
        << code;
  EXPECT_EQ(inexact_call_below(FixtureTree("tear/a.cpp", "// std::sin(x)").root(), "tear", "none"),
            "");
}

TEST(OnePlace, the_words_are_found) {
  for (const char* const code : {"void f() { std::printf(\"a\"); }", "void f() { std::cerr << 1; }",
                                 "void f() { puts(x); }"}) {
    const FixtureTree tree("tools/info/a.cpp", code);
    EXPECT_NE(first_match_below(tree.root(), "tools", "tools/messages/", kPrinting), "") << code;
  }
  for (const char* const code : {"// std::printf\n", "auto a = printed(\"stdout\");",
                                 "int n = std::snprintf(text, 3, \"%d\", 1);"}) {
    const FixtureTree tree("tools/info/a.cpp", code);
    EXPECT_EQ(first_match_below(tree.root(), "tools", "tools/messages/", kPrinting), "") << code;
  }
}

}  // namespace
}  // namespace sunder::test
