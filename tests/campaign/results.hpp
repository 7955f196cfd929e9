#pragma once
// What a campaign found, for people and for the next process.

#include "campaign.hpp"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <string>

namespace blactl::campaign {

[[nodiscard]] nlohmann::json to_json(const Counts& counts);
[[nodiscard]] Counts from_json(const nlohmann::json& json);

/// As Markdown. `first`: the seed of the first episode.
[[nodiscard]] std::string summary(const Counts& counts, std::uint64_t first);

} // namespace blactl::campaign
