#pragma once
// Errors as values: a code of the command-line contract, what happened, what to type next, whose.

#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <string_view>

namespace blactl {

/// The codes of the contract, section 3. Their names are what scripts read: they never change.
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
  other_allocator,
  armed,
  driven,
  busy,
  no_local_node_id,
  no_profile,
  model_mismatch,
  stale_plan,
  table_full,
  label_mismatch,
  firmware_too_old,
  several_servos,
  counter_end,
  interrupted,
};

/// The word of the contract, as in "code" of an error document: "out_of_range".
[[nodiscard]] std::string_view name(Code code);

/// The exit status of a command that failed with `code` alone (contract, section 3).
[[nodiscard]] int exit_status(Code code);

/// What went wrong, for a person and for a script.
struct Error {
  Code code = Code::internal;
  std::string message;                   ///< What happened, in the language of the session.
  std::string hint{};                    ///< What to type next; empty: nothing to add.
  std::optional<std::uint8_t> node_id{}; ///< The servo it is about, by its address on the bus.
};

template <class T> using Result = std::expected<T, Error>;

/// Shorthand for returning an error from a function that returns Result<T>.
[[nodiscard]] inline std::unexpected<Error> fail(Code code, std::string message,
                                                 std::string hint = {}) {
  return std::unexpected(Error{code, std::move(message), std::move(hint), std::nullopt});
}

} // namespace blactl
