// A small model and operations on it, made of bytes: all laws hold after each operation, and every
// state comes back by undo, redo and replay.

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "bench/stress/torn_subject.h"
#include "fuzz/operations_of_bytes.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace sunder;
  fuzz::Trial trial = fuzz::trial_of({data, size});
  stress::CaseReport report;
  stress::TornSubject subject(std::move(trial.character), report);
  for (const Operation& operation : trial.operations)
    if (!subject.has_failed()) subject.operate(operation);
  test::Random random(size);
  if (!subject.has_failed()) subject.finish(random);
  for (const stress::Violation& violation : report.violations)
    std::fprintf(stderr, "%s: %s\n", violation.law.c_str(), violation.text.c_str());
  if (!report.violations.empty()) std::abort();
  return 0;
}
