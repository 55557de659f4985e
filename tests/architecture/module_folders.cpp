#include "architecture/module_folders.h"

#include <map>

namespace sunder::test {
namespace {

const std::map<std::string, std::string> kFolders = {
    {"aim", "pipeline/aim"},
    {"animation", "skinning/animation"},
    {"binding", "pipeline/binding"},
    {"bodies", "tear/bodies"},
    {"certificate", "weights/certificate"},
    {"coupled_refit", "weights/coupled_refit"},
    {"operation", "core/operation"},
    {"plan", "pipeline/plan"},
    {"ragdoll", "pipeline/ragdoll"},
    {"robot", "io/robot"},
    {"validation", "pipeline/validation"},
};

}  // namespace

std::string folder_of(const std::string& module) {
  const auto found = kFolders.find(module);
  return found == kFolders.end() ? module : found->second;
}

std::string module_of(const std::string& path) {
  for (const auto& [module, folder] : kFolders)
    if (path.starts_with(folder + "/")) return module;
  return path.substr(0, path.find('/'));
}

}  // namespace sunder::test
