#pragma once
// One run of a station as a whole: its end, what it had begun, and whether each visit brought its
// record.

#include "line_story.hpp"

namespace blactl::campaign {

/// Throws Lie.
void judge_shift(const LineStory& story, const Shift& shift);

} // namespace blactl::campaign
