#pragma once

namespace sunder::tear {

/// Thrown if a model of fixed capacity has no room for the data that an operation appends. The
/// operation is rolled back.
struct CapacityExceeded {
  const char* what;
};

}  // namespace sunder::tear
