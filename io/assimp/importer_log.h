#pragma once

#include <string>
#include <vector>

#include "io/assimp/notes.h"

namespace sunder::assimp_import {

/// Collects the warnings and errors that assimp's importers log in this thread during its lifetime;
/// one object per thread at a time. Importers often drop or replace what a file says and tell only
/// the log. If the program has set a logger of its own, objects exclude each other, because that
/// logger mixes the messages of all threads.
class ImporterLog {
 public:
  ImporterLog();
  ~ImporterLog();
  ImporterLog(const ImporterLog&) = delete;
  ImporterLog& operator=(const ImporterLog&) = delete;

  /// Different messages, in order, without repetitions and the file's folder; at most 32.
  [[nodiscard]] const std::vector<std::string>& messages() const;

 private:
  class Collector;
  class ThreadLogger;
  Collector* collector_;
};

/// Adds the messages as notes: `dropped` where they name an index or a count that does not fit, so
/// that a strict import refuses the file; otherwise information.
void add_notes(const std::vector<std::string>& messages, Notes& notes);

}  // namespace sunder::assimp_import
