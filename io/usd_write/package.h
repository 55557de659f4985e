#pragma once

#include <sunder/io/usd_file.h>

#include <cstddef>
#include <string>
#include <vector>

namespace sunder::usd {

/// As usdz_package(). @throws gltf::Refusal
[[nodiscard]] std::vector<std::byte> package_of(const UsdLayer& layer, const std::string& name);

}  // namespace sunder::usd
