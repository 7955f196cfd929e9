#pragma once
// Whether what a station said is what the simulator knows of its servos.

#include "line_story.hpp"

namespace blactl::campaign {

/// Throws Lie.
void judge_line(const LineStory& story);

} // namespace blactl::campaign
