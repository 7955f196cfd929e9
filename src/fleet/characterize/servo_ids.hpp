#pragma once
// Other servo IDs (0x45) for the servo on the bench, for a moment.

#include "blactl/base/error.hpp"

#include <cstdint>
#include <optional>

namespace blactl::fleet {

class TestBench;

/// Whether an ArrayCommand to this ID reaches no other unit on the bus, as far as heard.
[[nodiscard]] bool is_free_servo_id(const TestBench& bench, std::int64_t servo_id);

/// One other than 0 and the servo's own; empty: there is none.
[[nodiscard]] std::optional<std::int64_t> free_servo_id(const TestBench& bench);

/// When a new servo ID takes effect, by actuator.Status; `unseen`: that does not show it.
enum class ServoIdTaken : std::uint8_t { unseen, at_once, waits };

/// Writes 0x45, and listens.
[[nodiscard]] Result<ServoIdTaken> take_servo_id(TestBench& bench, std::int64_t servo_id);

} // namespace blactl::fleet
