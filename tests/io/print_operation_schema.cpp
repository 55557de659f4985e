// Prints docs/operation_log.schema.json.

#include <cstdio>

#include "io/operation_schema.h"

int main() { return std::fputs(sunder::test::operation_schema().c_str(), stdout) < 0 ? 1 : 0; }
