#include "bench/stress/worker.h"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <optional>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "bench/stress/case_log.h"

namespace sunder::stress {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

Outcome run_here(const CaseName& name, const Steps& steps) {
  Outcome outcome;
  outcome.name = name;
  const Clock::time_point begin = Clock::now();
  find_family(name.family)->run(name.seed, steps, outcome.report);
  outcome.seconds = seconds_since(begin);
  return outcome;
}

void write_all(int to, const std::string& text) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t count = write(to, text.data() + done, text.size() - done);
    if (count <= 0) _exit(1);  // The parent is gone.
    done += static_cast<std::size_t>(count);
  }
}

/// A process that runs cases, and the pipes to and from it. It reads a line with family and seed
/// per case and answers with the line of its outcome.
class Worker {
 public:
  explicit Worker(const Steps& steps = {}) : steps_(steps) { start(); }
  ~Worker() { stop(); }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  void give(const CaseName& name) {
    current_ = name;
    begin_ = Clock::now();
    write_all(to_, name.family + " " + std::to_string(name.seed) + "\n");
  }
  [[nodiscard]] bool is_busy() const { return current_.has_value(); }
  [[nodiscard]] int from() const { return from_; }

  /// Call when from() can be read. The outcome, if the case ended.
  std::optional<Outcome> read_outcome() {
    char part[4096];
    const ssize_t count = read(from_, part, sizeof part);
    if (count <= 0) return fail("crash", describe_end());
    text_.append(part, static_cast<std::size_t>(count));
    const std::size_t end = text_.find('\n');
    if (end == std::string::npos) return std::nullopt;
    Outcome outcome;
    Steps steps;
    (void)from_line(text_.substr(0, end), outcome, steps);
    text_.clear();
    current_.reset();
    return outcome;
  }

  /// The outcome of a case that takes too long; its process ends.
  std::optional<Outcome> end_if_late(double seconds) {
    if (!is_busy() || seconds_since(begin_) < seconds) return std::nullopt;
    kill(child_, SIGKILL);
    (void)describe_end();
    return fail("hang", "not done after " + std::to_string(seconds) + " s");
  }

 private:
  void start() {
    int to[2], from[2];
    if (pipe(to) != 0 || pipe(from) != 0) std::abort();
    std::fflush(nullptr);
    child_ = fork();
    if (child_ < 0) std::abort();
    if (child_ == 0) {
      close(to[1]);
      close(from[0]);
      serve(to[0], from[1]);
    }
    close(to[0]);
    close(from[1]);
    to_ = to[1];
    from_ = from[0];
  }

  [[noreturn]] void serve(int from, int to) {
    std::FILE* const in = fdopen(from, "r");
    char family[64];
    unsigned long long seed = 0;
    while (std::fscanf(in, "%63s %llu", family, &seed) == 2)
      write_all(to, to_line(run_here({family, seed}, steps_)) + "\n");
    _exit(0);
  }

  std::string describe_end() {
    int status = 0;
    if (child_ > 0) waitpid(child_, &status, 0);
    child_ = -1;
    if (WIFSIGNALED(status)) return strsignal(WTERMSIG(status));
    return "exit " + std::to_string(WEXITSTATUS(status));
  }

  Outcome fail(const char* law, std::string text) {
    Outcome outcome;
    outcome.name = *current_;
    outcome.seconds = seconds_since(begin_);
    outcome.report.violate(law, std::move(text));
    current_.reset();
    text_.clear();
    stop();
    start();
    return outcome;
  }

  /// Later workers hold copies of this one's pipe, so that closing it would not end the process.
  void stop() {
    close(to_);
    close(from_);
    if (child_ <= 0) return;
    kill(child_, SIGKILL);
    waitpid(child_, nullptr, 0);
  }

  Steps steps_;
  pid_t child_ = -1;
  int to_ = -1, from_ = -1;
  std::string text_;
  std::optional<CaseName> current_;
  Clock::time_point begin_;
};

/// Waits for a moment, and hands on the outcomes of cases that ended.
void collect(std::vector<std::unique_ptr<Worker>>& workers, double seconds_of_case,
             const std::function<void(const Outcome&)>& end) {
  std::vector<pollfd> polled;
  for (const auto& worker : workers) polled.push_back({worker->from(), POLLIN, 0});
  (void)poll(polled.data(), polled.size(), 200);
  for (std::size_t i = 0; i < workers.size(); ++i) {
    if (!workers[i]->is_busy()) continue;
    std::optional<Outcome> outcome;
    if (polled[i].revents != 0) outcome = workers[i]->read_outcome();
    if (!outcome) outcome = workers[i]->end_if_late(seconds_of_case);
    if (outcome) end(*outcome);
  }
}

}  // namespace

Outcome run_apart(const CaseName& name, const Steps& steps, double seconds) {
  std::vector<std::unique_ptr<Worker>> workers;
  workers.push_back(std::make_unique<Worker>(steps));
  workers[0]->give(name);
  std::optional<Outcome> found;
  while (!found) collect(workers, seconds, [&](const Outcome& outcome) { found = outcome; });
  return *found;
}

void run_cases(std::span<const Family* const> chosen, std::uint64_t first, const RunLimits& limits,
               const std::function<bool(const CaseName&)>& is_done,
               const std::function<void(const Outcome&)>& end) {
  std::vector<std::unique_ptr<Worker>> workers;
  for (std::uint32_t i = 0; i < limits.workers; ++i) workers.push_back(std::make_unique<Worker>());
  const Clock::time_point begin = Clock::now();
  std::uint64_t next = first;
  const auto may_start = [&] {
    return (limits.cases == 0 || next < first + limits.cases) &&
           (limits.seconds <= 0 || seconds_since(begin) < limits.seconds);
  };
  for (;;) {
    bool is_any_busy = false;
    for (const auto& worker : workers) {
      while (!worker->is_busy() && may_start()) {
        const CaseName name = case_of(next++, chosen);
        if (!is_done(name)) worker->give(name);
      }
      is_any_busy = is_any_busy || worker->is_busy();
    }
    if (!is_any_busy) return;
    collect(workers, limits.seconds_of_case, end);
  }
}

}  // namespace sunder::stress
