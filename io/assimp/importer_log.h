#pragma once

#include <string>
#include <vector>

#include "io/assimp/notes.h"

namespace sunder::assimp_import {

/// Collects the warnings and errors that assimp's importers log during its lifetime. Importers
/// often drop or replace what a file says and tell only the log. Objects exclude each other,
/// because the log is that of the process.
class ImporterLog {
 public:
  ImporterLog();
  ~ImporterLog();
  ImporterLog(const ImporterLog&) = delete;
  ImporterLog& operator=(const ImporterLog&) = delete;

  /// Different messages, in order, without repetitions and the file's folder; at most 32.
  [[nodiscard]] const std::vector<std::string>& messages() const;

 private:
  class Stream;
  Stream* stream_;
};

/// Adds the messages as notes: `dropped` where they name an index or a count that does not fit, so
/// that a strict import refuses the file; otherwise information.
void add_notes(const std::vector<std::string>& messages, Notes& notes);

}  // namespace sunder::assimp_import
