#pragma once
// "Did you mean": the known words that a mistyped one resembles.

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

namespace blactl {

/// The number of letters to insert, remove, replace or swap with the next one to turn one word into
/// the other (optimal string alignment).
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);

/// At most three of `words` that resemble `typed`, the nearest first, whatever the case and with or
/// without separators (`_`, `-`, `.`, blanks): those within a third of its letters (at least one),
/// and, if it has at least three letters, those that contain it or have a part within that
/// distance: "nodeid" and "limits" find static_node_id and angle_limit_cw.
[[nodiscard]] std::vector<std::string_view> nearest(std::string_view typed,
                                                    std::span<const std::string_view> words);

} // namespace blactl
