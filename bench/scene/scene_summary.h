#pragma once

namespace sunder::bench {

/// One JSON object with the figures by which frames are judged.
void print_scene_summary();
/// Frame times of crowds by model, count and activity, and of a long loop.
void print_scene_tables();

}  // namespace sunder::bench
