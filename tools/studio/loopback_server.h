#pragma once

#include <sunder/core/status.h>

#include <cstdint>
#include <functional>
#include <span>
#include <string>

namespace sunder::tools {

/// A file as a browser gets it.
struct ServedFile {
  std::string path;  ///< "/model.glb"
  std::string type;  ///< MIME: "model/gltf-binary".
  std::string content;
};

/// Serves files to programs of this machine until SIGINT or SIGTERM: GET of these paths, on
/// 127.0.0.1 alone. A request that names another host is refused: a page of that host, whose name
/// points here, must not read the files.
///
/// @param port      0: a free one.
/// @param on_ready  is called with "http://127.0.0.1:8000" when requests are taken.
/// @return invalid_argument: the port cannot be listened at.
Status serve_on_loopback(std::span<const ServedFile> files, std::uint16_t port,
                         const std::function<void(const std::string& origin)>& on_ready);

/// A text for the query of an address: "my%20fox".
[[nodiscard]] std::string in_address(const std::string& text);

}  // namespace sunder::tools
