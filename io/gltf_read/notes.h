#pragma once

#include <sunder/io/character_bytes.h>

#include <string>

namespace sunder::gltf {

/// Collects the notes of the load report. Equal texts about the same place that follow each other
/// are counted, not repeated. In strict mode, a repair or loss refuses the file instead.
class Notes {
 public:
  Notes(LoadReport& report, bool strict) : report_(report), strict_(strict) {}

  void inform(const std::string& place, const std::string& text, std::uint32_t count = 1);
  /// @param code, index  of the refusal in strict mode.
  void repaired(StatusCode code, std::uint32_t index, const std::string& place,
                const std::string& text, std::uint32_t count = 1);
  void dropped(StatusCode code, std::uint32_t index, const std::string& place,
               const std::string& text, std::uint32_t count = 1);

 private:
  void add(LoadNote::Kind kind, const std::string& place, const std::string& text,
           std::uint32_t count);

  LoadReport& report_;
  bool strict_;
};

}  // namespace sunder::gltf
