#pragma once

#include <span>
#include <string>
#include <vector>

#include "pipeline/validation/checks/codes.h"

namespace sunder::validation {

using Places = std::vector<FindingPlace>;

/// The findings of one validation, and what became of every code.
class FindingList {
 public:
  explicit FindingList(const Character& target);

  /// Aggregates places into one finding; without places the code passes.
  /// @param detail  a sentence to append, or empty.
  void add(Code code, Places places, const std::string& detail = {},
           Evidence evidence = Evidence::exact);
  /// As add(), with places that the source has too: only the others count; if there are none, the
  /// finding is a note.
  void add_new(Code code, Places places, const Places& inherited, const std::string& detail = {},
               Evidence evidence = Evidence::exact);
  /// A finding that is not about places, or has another severity than its code.
  void add_finding(Code code, Severity severity, Evidence evidence, std::string text, Places places,
                   double value);
  /// Makes the findings of a code errors.
  void raise_to_error(Code code);
  void not_tested(Code code, const std::string& why);

  /// Sorts findings and settles the verdicts.
  void finish(ValidationReport& report);

 private:
  [[nodiscard]] std::string place_text(const FindingPlace& place) const;
  void mark_tested(Code code, Verdict verdict);

  const Character& target_;
  std::vector<Finding> findings_;
  std::vector<CodeVerdict> verdicts_;
};

}  // namespace sunder::validation
