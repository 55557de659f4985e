#pragma once

namespace sunder::stress {

/// Prints tables of errors, angles and times against the number of operations, the distance from
/// degenerate places, and the scale and offset of the coordinates, in Markdown. Takes minutes.
void print_trouble_tables();

}  // namespace sunder::stress
