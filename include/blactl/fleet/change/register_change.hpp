#pragma once
// The change of one register of one servo.

#include "blactl/base/error.hpp"
#include "blactl/bla/parameter.hpp"

#include <cstdint>
#include <optional>
#include <string_view>

namespace blactl::fleet {

/// The words of the contract, section 5, `set`.
enum class ChangeStatus : std::uint8_t { planned, unchanged, written, failed, mismatch };
[[nodiscard]] std::string_view name(ChangeStatus status);

/// Raw values; `before` and `after` are empty if unknown.
struct RegisterChange {
  const bla::Parameter* parameter = nullptr;
  std::int64_t requested = 0;
  std::optional<std::int64_t> before{}, after{};
  ChangeStatus status = ChangeStatus::planned;
  std::optional<Error> error{};

  [[nodiscard]] bool is_planned() const { return status == ChangeStatus::planned; }
};

/// From the value held, if known; nothing is to be done if that is the requested one.
[[nodiscard]] inline RegisterChange change_from(std::optional<std::int64_t> before,
                                                const bla::Parameter* parameter,
                                                std::int64_t requested) {
  const bool is_held = before == requested;
  return {.parameter = parameter,
          .requested = requested,
          .before = before,
          .after = is_held ? before : std::nullopt,
          .status = is_held ? ChangeStatus::unchanged : ChangeStatus::planned};
}

} // namespace blactl::fleet
