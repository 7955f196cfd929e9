#pragma once
// What a campaign found, for people and for the next process.

#include "campaign.hpp"
#include "sweep.hpp"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <string>

namespace blactl::campaign {

[[nodiscard]] nlohmann::json to_json(const Counts& counts);
[[nodiscard]] nlohmann::json to_json(const SweptByKind& swept);
[[nodiscard]] Counts counts_in(const nlohmann::json& told);
[[nodiscard]] SweptByKind swept_in(const nlohmann::json& told);

/// As Markdown. `first`: the seed of the first episode.
[[nodiscard]] std::string summary(const Counts& counts, std::uint64_t first);
[[nodiscard]] std::string summary(const SweptByKind& swept);

[[nodiscard]] std::size_t lies_in(const SweptByKind& swept);

} // namespace blactl::campaign
