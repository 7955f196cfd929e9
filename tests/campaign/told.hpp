#pragma once
// What the document of a command says, and what is done with a false word.

#include "step.hpp"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace blactl::campaign {

/// A false word, or an order that must not have been sent.
class Lie : public std::runtime_error {
  using runtime_error::runtime_error;
};

/// Throws Lie unless `truth`.
void require(bool truth, const std::string& what);

/// "0x38"
[[nodiscard]] std::uint8_t address_in(const nlohmann::json& text);

/// Whether a change is told as held by the servo.
[[nodiscard]] bool is_held(const nlohmann::json& change);

/// Whether a servo is told to be as wished.
[[nodiscard]] bool is_reached(const nlohmann::json& node);

/// The nodes that name a servo, by serial number. Throws Lie where there is no such servo.
[[nodiscard]] std::vector<std::pair<std::int64_t, const nlohmann::json*>>
told_servos(const Step& step);

} // namespace blactl::campaign
