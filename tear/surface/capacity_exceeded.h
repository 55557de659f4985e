#pragma once

namespace sunder::tear {

/// Thrown if a model of fixed capacity has no room for what an operation would append. The
/// operation is rolled back.
struct CapacityExceeded {
  const char* what;
};

}  // namespace sunder::tear
