#pragma once
// Errors as values: contract code, message, hint, and the servo concerned.

#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <string_view>

namespace blactl {

/// The codes of the contract, section 3. Scripts read their names, which never change.
enum class Code : std::uint8_t {
  io,
  state,
  internal,
  usage,
  bad_file,
  unknown_parameter,
  out_of_range,
  read_only,
  unsupported,
  cross_check,
  interface,
  permission,
  bus_off,
  no_acknowledge,
  timeout,
  not_found,
  not_back,
  not_recorded,
  refused,
  mismatch,
  not_confirmed,
  faults,
  duplicate_node_id,
  duplicate_servo_id,
  duplicate_unique_id,
  other_allocator,
  armed,
  driven,
  busy,
  no_local_node_id,
  no_profile,
  model_mismatch,
  rom_unread,
  stale_plan,
  table_full,
  label_mismatch,
  firmware_too_old,
  several_servos,
  counter_end,
  attempts,
  interrupted,
};

/// The code's name in the contract, as in "code" of an error document: "out_of_range".
[[nodiscard]] std::string_view name(Code code);

/// The exit status of a command that failed with `code` alone (contract, section 3).
[[nodiscard]] int exit_status(Code code);

/// An error as it is reported to a person and to a script.
struct Error {
  Code code = Code::internal;
  std::string message;                   ///< In the language of the session.
  std::string hint{};                    ///< The next thing to type; empty: nothing to add.
  std::optional<std::uint8_t> node_id{}; ///< The servo concerned, by its node ID.
};

template <class T> using Result = std::expected<T, Error>;

/// Shorthand for returning an error from a function that returns Result<T>.
[[nodiscard]] inline std::unexpected<Error> fail(Code code, std::string message,
                                                 std::string hint = {}) {
  return std::unexpected(Error{code, std::move(message), std::move(hint), std::nullopt});
}

} // namespace blactl
