#pragma once

#include <string>
#include <vector>

#include "support/models/gltf_builder.h"

namespace sunder::test {

/// A document with one fault that loading accepts or repairs.
struct FaultyDocument {
  std::string name;
  GltfBuilder builder;
};

/// One per kind of fault, many of which concern parts that loading does not look at.
std::vector<FaultyDocument> faulty_documents();

}  // namespace sunder::test
