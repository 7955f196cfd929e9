#pragma once
// "Did you mean": the known words that a mistyped one resembles.

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

namespace blactl {

/// How many letters must be inserted, removed, replaced or swapped with the next to turn one word
/// into the other (optimal string alignment).
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);

/// At most three of `words` that resemble `typed`, the nearest first: those within a third of its
/// letters (at least one), and those that contain it, if it has at least three letters.
[[nodiscard]] std::vector<std::string_view> nearest(std::string_view typed,
                                                    std::span<const std::string_view> words);

} // namespace blactl
