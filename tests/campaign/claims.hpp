#pragma once
// What the contract promises beside what is told of one servo's registers.

#include "step.hpp"

namespace blactl::campaign {

/// Throws Lie.
void check_claims(const Step& step);

/// Of `alloc --list` where nothing went wrong: the table is as the servos are. Throws Lie.
void check_table(const Step& list);

/// The fleet file of `replace` is whole, whatever happened, and names the new servo once that is
/// proven. Throws Lie.
void check_file(const Step& step);

/// Where nothing went wrong: undo right after a change takes it back. Throws Lie.
void check_undo(const Step& change, const Step& undo);

} // namespace blactl::campaign
