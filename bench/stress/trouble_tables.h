#pragma once

#include <filesystem>

namespace sunder::stress {

/// Prints tables of errors, angles and times against the number of operations, the distance from
/// degenerate places, and the scale and offset of the coordinates, in Markdown. Takes minutes.
/// @param folder  of the plots, one per table (SVG); empty for none.
void print_trouble_tables(const std::filesystem::path& folder);

}  // namespace sunder::stress
