#pragma once
// The kinds of interface that -i names. A new adapter is a class after can::Bus, a function that
// opens it, and a row of `schemes`: the help of -i, its hints, the completions and the factory go
// by this table.

#include "blactl/base/error.hpp"
#include "blactl/base/text.hpp"
#include "blactl/can/replay_texts.hpp"

#include "cli/interface/slcan_name.hpp"
#include "cli/texts.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace blactl::cli {

struct OpenBus;
struct OpenRequest;

// Errors: interface, permission, bad_file (scenario, fleet file), usage.
[[nodiscard]] Result<OpenBus> open_socketcan(const OpenRequest& request);
[[nodiscard]] Result<OpenBus> open_slcan(const OpenRequest& request);
[[nodiscard]] Result<OpenBus> open_mcast(const OpenRequest& request);
[[nodiscard]] Result<OpenBus> open_simulator(const OpenRequest& request);
[[nodiscard]] Result<OpenBus> open_scenario(const OpenRequest& request);
[[nodiscard]] Result<OpenBus> open_log(const OpenRequest& request);
[[nodiscard]] Result<OpenBus> open_fleet_file(const OpenRequest& request);

/// `-i mcast:` (contract, section 2): N[?if=IFACE].
struct McastName {
  std::uint8_t bus_number = 0;
  std::string link{}; ///< the network interface; empty: whichever the machine would take
};

/// "0?if=lo". The number alone is enough, and so is nothing: bus 0. Errors: usage.
[[nodiscard]] Result<McastName> parse_mcast(std::string_view text);

/// What stands behind a name, as far as commands care.
enum class Behind : unsigned char {
  link,       ///< a network interface of the kernel
  bus,        ///< any other real bus
  simulator,  ///< what `blactl sim` serves, or three servos of this process
  scenario,   ///< simulated servos of this process
  log,        ///< a recording of frames
  fleet_file, ///< settings, no frames at all
};

/// What is typed behind the colon.
enum class Operand : unsigned char { link, serial_port, file, other };

/// One kind of interface.
struct Scheme {
  std::string_view name; ///< before the colon
  Behind behind = Behind::bus;
  Operand operand = Operand::file;
  std::string_view form;           ///< for the help of -i
  std::string_view example = form; ///< for hints
  /// Of files of this kind; the rest is empty. Of two schemes of one name, that of the ending is
  /// meant.
  std::array<std::string_view, 3> endings{};
  bool may_be_bare = true; ///< nothing need stand behind the colon
  Result<OpenBus> (*open)(const OpenRequest& request);
  /// What is wrong with what stands behind the colon, before anything is opened; null: nothing.
  Result<void> (*check)(std::string_view rest) = nullptr;
  /// Why nothing can be sent there; null: it can.
  std::string (*refusal)(std::string_view typed) = nullptr;
  /// What to look at where nothing was heard on `bus`; null: what fits servos on any CAN bus.
  std::string (*silence)(std::string_view rest, std::string_view bus) = nullptr;

  /// Whether the name of a file says that it is of this kind.
  [[nodiscard]] constexpr bool has_ending(std::string_view file) const {
    return std::ranges::any_of(
        endings, [&](auto ending) { return !ending.empty() && file.ends_with(ending); });
  }
};

template <auto parse> Result<void> parsed_by(std::string_view rest) {
  const auto parsed = parse(rest);
  return parsed ? Result<void>{} : std::unexpected(parsed.error());
}

template <const Text& text> std::string about(std::string_view what) {
  return say<text>(what);
}

template <const Text& text> std::string about_rest(std::string_view rest, std::string_view) {
  return say<text>(printable(rest));
}

template <const Text& text> std::string about_bus(std::string_view, std::string_view bus) {
  return say<text>(bus);
}

inline std::string about_simulator(std::string_view rest, std::string_view bus) {
  return rest.empty() ? say<texts::silent_sim_hint>() : say<texts::silent_simulator_hint>(bus);
}

inline constexpr std::array schemes{
    // The kind of a name without a colon, and of no name.
    Scheme{.name = "socketcan",
           .behind = Behind::link,
           .operand = Operand::link,
           .form = "can0",
           .may_be_bare = false,
           .open = open_socketcan},
    Scheme{.name = "slcan",
           .operand = Operand::serial_port,
           .form = "slcan:DEV",
           .example = "slcan:/dev/ttyUSB0",
           .open = open_slcan,
           .check = parsed_by<parse_slcan>,
           .silence = about_bus<texts::silent_slcan_hint>},
    Scheme{.name = "mcast",
           .operand = Operand::other,
           .form = "mcast:N",
           .example = "mcast:0",
           .open = open_mcast,
           .check = parsed_by<parse_mcast>,
           .silence = about_bus<texts::silent_mcast_hint>},
    Scheme{.name = "sim",
           .behind = Behind::simulator,
           .form = "sim:",
           .open = open_simulator,
           .silence = about_simulator},
    Scheme{.name = "sim",
           .behind = Behind::scenario,
           .form = "sim:SCENARIO.json",
           .endings = {".json"},
           .open = open_scenario,
           .silence = about_rest<texts::silent_scenario_hint>},
    Scheme{.name = "replay",
           .behind = Behind::log,
           .form = "replay:FILE",
           .endings = {".log", ".asc", ".trc"},
           .may_be_bare = false,
           .open = open_log,
           .refusal = about<texts::log_takes_no_frames>,
           .silence = about_rest<texts::silent_log_hint>},
    Scheme{.name = "file",
           .behind = Behind::fleet_file,
           .form = "file:FLEET.json",
           .may_be_bare = false,
           .open = open_fleet_file,
           .refusal = about<texts::file_takes_no_frames>,
           .silence = about_rest<texts::silent_file_hint>},
};

struct InterfaceName {
  const Scheme* scheme = &schemes.front();
  std::string rest{}; ///< behind the colon; empty: the default

  [[nodiscard]] bool is(Behind behind) const { return scheme->behind == behind; }
};

/// `can0`, `socketcan:can0`, and the forms of the table. Errors: usage.
[[nodiscard]] Result<InterfaceName> parse_interface(std::string_view text);

/// As the help of -i writes the first of that kind.
[[nodiscard]] std::string_view form_of(Behind behind);

/// Whether `text` names an interface, and one of that kind.
[[nodiscard]] bool names(std::string_view text, Behind behind);

/// Why nothing can be sent to what stands behind -i, a log or a fleet file; empty: it can, as far
/// as its name tells.
[[nodiscard]] std::optional<Error> takes_no_frames(std::string_view text);

/// What to look at where nothing was heard, by the kind of interface that `text` names; `name`: of
/// the open bus. Empty: what is said of servos on any CAN bus fits.
[[nodiscard]] std::string silence_hint(std::string_view text, std::string_view name);

} // namespace blactl::cli
