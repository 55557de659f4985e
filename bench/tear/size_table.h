#pragma once

#include <map>
#include <string>

#include <benchmark/benchmark.h>

namespace sunder::bench {

/// Collects the medians of benchmarks that run at several sizes, and prints a table of them: a row
/// per operation, a column per size, in microseconds.
class SizeTable : public benchmark::BenchmarkReporter {
 public:
  [[nodiscard]] static std::string filter();  ///< A regular expression of the benchmarks in it.
  bool ReportContext(const Context& context) override;
  void ReportRuns(const std::vector<Run>& runs) override;
  void Finalize() override;

 private:
  std::map<std::string, std::map<int, double>> microseconds_;  ///< By name, by divisions.
};

}  // namespace sunder::bench
