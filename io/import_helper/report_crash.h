#pragma once

namespace sunder::import_helper {

/// Makes signals of crashes and of the CPU limit tell the caller their number and end the process.
/// The caller may not get the wait status: a program that ignores SIGCHLD, or waits for all its
/// children, takes it.
void report_crashes();

/// The reply has begun, so nothing else may be sent.
void stop_reporting();

/// Tells the caller why there is no reply, and ends the process. Does not allocate.
[[noreturn]] void report_failure(unsigned long long cause);

}  // namespace sunder::import_helper
