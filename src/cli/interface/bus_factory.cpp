#include "cli/interface/bus_factory.hpp"

#include "blactl/can/link.hpp"
#include "blactl/can/link_setup.hpp"
#include "blactl/can/mcast.hpp"
#include "blactl/can/replay_texts.hpp"
#include "blactl/can/serial_adapters.hpp"
#include "blactl/can/silent_recording.hpp"
#include "blactl/can/simbus.hpp"
#include "blactl/can/slcan.hpp"
#include "blactl/can/socketcan.hpp"
#include "blactl/sim/bus/private_bus.hpp"
#include "blactl/sim/scenario/scenario.hpp"

#include "cli/interface/slcan_name.hpp"
#include "cli/texts.hpp"

#include <sys/stat.h>

#include <charconv>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

namespace blactl::cli {
namespace {

/// A hint, with the serial adapters that could be meant instead.
std::string with_adapters(std::string hint) {
  if (const std::string adapters = can::describe(can::serial_adapters()); !adapters.empty()) {
    hint += "; " + adapters;
  }
  return hint;
}

/// Converts any kind of interface to its base.
template <class Kind>
Result<std::unique_ptr<can::Bus>> as_bus(Result<std::unique_ptr<Kind>> opened) {
  return opened ? Result<std::unique_ptr<can::Bus>>(std::move(*opened))
                : std::unexpected(std::move(opened.error()));
}

/// The name of the only CAN interface that is up.
Result<std::string> the_only_interface() {
  const auto links = can::links();
  if (!links) {
    return std::unexpected(links.error());
  }
  if (const can::Link* link = can::only_one_up(*links)) {
    return link->name;
  }
  std::string up;
  const can::Link* down = nullptr;
  for (const can::Link& link : *links) {
    if (!link.is_up) {
      down = &link;
      continue;
    }
    up += up.empty() ? "" : ", ";
    up += link.name;
  }
  if (!up.empty()) {
    return fail(Code::interface, say<texts::several_interfaces>(up),
                with_adapters(say<texts::several_interfaces_hint>(up.substr(0, up.find(',')))));
  }
  return fail(Code::interface, say<texts::no_interface>(),
              with_adapters(down != nullptr
                                ? say<texts::interface_is_down>(down->name, can::up_command(*down))
                                : say<texts::no_interface_hint>()));
}

Result<OpenBus> open_socketcan(const std::string& name) {
  auto bus = can::SocketCan::open(name);
  if (!bus) {
    return std::unexpected(bus.error());
  }
  // not as typed: an interface may have further names
  const std::string link((*bus)->name());
  return OpenBus{.bus = std::move(*bus), .place = lock_place(link), .reopen = [link] {
                   return can::SocketCan::open(link);
                 }};
}

/// The bus is named by its network interface: nodes on different ones do not hear each other.
Result<OpenBus> open_mcast(const InterfaceName& name, const Reporter& reporter) {
  auto bus = can::Mcast::open(name.bus_number, name.rest);
  if (!bus) {
    return std::unexpected(bus.error());
  }
  auto place = lock_place(std::string((*bus)->name()));
  if (name.rest.empty()) {
    reporter.note(say<texts::mcast_chosen>(place.interface));
  }
  return OpenBus{.bus = std::move(*bus), .place = std::move(place), .reopen = [name] {
                   return as_bus(can::Mcast::open(name.bus_number, name.rest));
                 }};
}

/// Prints a piece of the dialogue with an adapter.
void tell(const Reporter& reporter, can::SlcanTalk talk, std::string_view bytes) {
  constexpr std::size_t longest = 64;
  const std::string text = printable(bytes.substr(0, longest));
  if (talk == can::SlcanTalk::to_adapter) {
    reporter.detail(say<texts::adapter_sent>(text));
  } else {
    reporter.detail(bytes.size() <= longest ? say<texts::adapter_said>(text)
                                            : say<texts::adapter_said_much>(text, bytes.size()));
  }
}

Result<OpenBus> open_slcan(std::string_view rest, const Reporter& reporter, bool inquires) {
  auto name = parse_slcan(rest);
  if (!name) {
    return std::unexpected(name.error());
  }
  name->options.inquires = inquires;
  name->options.trace = [&reporter](can::SlcanTalk talk, std::string_view bytes) {
    tell(reporter, talk, bytes);
  };
  const std::string device = name->device.string();
  auto bus = can::Slcan::open(name->device, "slcan:" + printable(device), name->options);
  if (!bus) {
    return std::unexpected(bus.error());
  }
  // links by product or by place lead to one device
  std::error_code error;
  const auto canonical = std::filesystem::canonical(name->device, error);
  can::Slcan* adapter = bus->get();
  name->options.inquires = false;
  return OpenBus{.bus = std::move(*bus),
                 .place = {.interface = "slcan:" + (error ? device : canonical.string())},
                 .reopen =
                     [name = *name, shown = "slcan:" + printable(device)] {
                       return as_bus(can::Slcan::open(name.device, shown, name.options));
                     },
                 .adapter = adapter};
}

Result<OpenBus> open_private(std::string_view text, const Result<sim::Scenario>& scenario,
                             const Reporter& reporter) {
  if (!scenario) {
    return std::unexpected(scenario.error());
  }
  for (const std::string& warning : scenario->warnings) {
    reporter.note(printable(warning));
  }
  return OpenBus{.bus = std::make_unique<sim::PrivateBus>(printable(text), *scenario)};
}

/// A bus with another clock is another bus.
Result<std::unique_ptr<can::Bus>> reopen_simulator(const std::filesystem::path& path,
                                                   const std::string& name) {
  auto bus = can::SimBus::open(path, name);
  if (bus && (*bus)->has_virtual_clock()) {
    return fail(Code::interface, {});
  }
  return as_bus(std::move(bus));
}

Result<OpenBus> open_simulator(std::string_view text, const std::string& socket,
                               const bla::Profiles& profiles, const Reporter& reporter) {
  const std::filesystem::path path =
      socket.empty() ? can::default_socket_path() : std::filesystem::path(socket);
  auto bus = socket.empty() ? can::SimBus::open_if_served(path, printable(text))
                            : can::SimBus::open(path, printable(text));
  if (!bus) {
    return std::unexpected(bus.error());
  }
  if (*bus == nullptr) {
    reporter.note(say<texts::sim_is_private>());
    return open_private(text, sim::default_scenario(profiles), reporter);
  }
  const bool is_virtual = (*bus)->has_virtual_clock();
  // many paths may lead there
  std::error_code error;
  const auto canonical = std::filesystem::canonical(path, error);
  const auto& where = error ? path : canonical;
  OpenBus opened{
      .bus = std::move(*bus),
      .place = {.interface = "sim:" + where.string(), .folder = where.parent_path().string()}};
  if (!is_virtual) {
    opened.reopen = [path, name = printable(text)] { return reopen_simulator(path, name); };
  }
  return opened;
}

Result<OpenBus> open_log(std::string_view text, const std::string& path) {
  auto log = can::ReplayBus::open(path, printable(text));
  if (!log) {
    return std::unexpected(log.error());
  }
  const can::ReplayBus* replay = log->get();
  return OpenBus{.bus = std::move(*log), .log = replay};
}

Result<OpenBus> open_fleet_file(std::string_view text, const std::string& path,
                                const bla::Profiles& profiles) {
  auto fleet = fleet::read_fleet_file(path, profiles);
  if (!fleet) {
    return std::unexpected(fleet.error());
  }
  return OpenBus{.bus = std::make_unique<can::SilentRecording>(printable(text)),
                 .fleet = std::move(*fleet)};
}

/// Parses the rest of "mcast:": "0?if=lo". The number alone is enough; without it, bus 0.
std::optional<InterfaceName> parse_mcast(std::string_view text) {
  constexpr std::string_view key = "if=";
  InterfaceName name{.kind = InterfaceKind::mcast, .rest = {}};
  const auto mark = text.find('?');
  const std::string_view number = text.substr(0, mark);
  const auto [stop, error] =
      std::from_chars(number.data(), number.data() + number.size(), name.bus_number);
  if (!number.empty() && (error != std::errc() || stop != number.data() + number.size())) {
    return std::nullopt;
  }
  if (mark != std::string_view::npos) {
    const std::string_view option = text.substr(mark + 1);
    if (!option.starts_with(key) || option.size() == key.size()) {
      return std::nullopt;
    }
    name.rest = option.substr(key.size());
  }
  return name;
}

/// A guess at the intended name, if the kind of interface is missing; empty: no guess, it may be
/// the name of a CAN interface. (One named "sim" is socketcan:sim.)
std::string with_kind(std::string_view text) {
  const std::string typed = printable(text);
  if (text == "sim") {
    return "sim:";
  }
  if (text == "mcast") {
    return "mcast:0";
  }
  if (text == "replay") {
    return "replay:FILE";
  }
  if (text == "file") {
    return "file:FLEET.json";
  }
  if (text == "slcan") {
    const auto adapters = can::serial_adapters();
    return "slcan:" + (adapters.empty() ? "/dev/ttyUSB0" : printable(adapters.front().string()));
  }
  if (text.ends_with(".json")) {
    return "sim:" + typed;
  }
  if (text.ends_with(".log")) {
    return "replay:" + typed;
  }
  if (text.starts_with("ttyUSB") || text.starts_with("ttyACM")) {
    return "slcan:/dev/" + typed;
  }
  return text.starts_with("/dev/") ? "slcan:" + typed : std::string();
}

} // namespace

/// Its name means another interface in every network namespace, but all of them may share the
/// folder. Only root can find out which namespace is the machine's own, so each gets its name.
state::LockPlace lock_place(std::string link) {
  struct stat status{};
  const bool known = stat("/proc/self/ns/net", &status) == 0;
  return {.interface = std::move(link),
          .network = known ? fmt::format("@{}", status.st_ino) : std::string()};
}

Result<InterfaceName> parse_interface(std::string_view text) {
  const auto colon = text.find(':');
  const std::string_view scheme = text.substr(0, colon);
  if (colon == std::string_view::npos) {
    if (const std::string meant = with_kind(text); !meant.empty()) {
      return fail(Code::usage, say<texts::interface_meant>(printable(text)),
                  say<texts::interface_meant_hint>(meant));
    }
  }
  if (colon == std::string_view::npos || scheme == "socketcan") {
    const auto name = colon == std::string_view::npos ? text : text.substr(colon + 1);
    if (name.empty()) {
      return fail(Code::usage, say<texts::interface_name_missing>(printable(text)),
                  say<texts::bad_interface_hint>());
    }
    return InterfaceName{.kind = InterfaceKind::socketcan, .rest = std::string(name)};
  }
  if (scheme == "slcan") {
    return InterfaceName{.kind = InterfaceKind::slcan, .rest = std::string(text.substr(colon + 1))};
  }
  if (scheme == "sim") {
    const std::string_view rest = text.substr(colon + 1);
    return InterfaceName{.kind = rest.ends_with(".json") ? InterfaceKind::scenario
                                                         : InterfaceKind::simulator,
                         .rest = std::string(rest)};
  }
  if (scheme == "mcast") {
    const auto name = parse_mcast(text.substr(colon + 1));
    return name ? Result<InterfaceName>(*name)
                : fail(Code::usage, say<texts::bad_mcast>(printable(text)),
                       say<texts::bad_mcast_hint>());
  }
  if ((scheme == "replay" || scheme == "file") && colon + 1 < text.size()) {
    return InterfaceName{.kind = scheme == "file" ? InterfaceKind::file : InterfaceKind::replay,
                         .rest = std::string(text.substr(colon + 1))};
  }
  return fail(Code::usage, say<texts::bad_interface>(printable(text)),
              say<texts::bad_interface_hint>());
}

std::optional<Error> takes_no_frames(std::string_view text) {
  const auto name = parse_interface(text);
  const bool is_log = name && name->kind == InterfaceKind::replay;
  const bool is_fleet_file = name && name->kind == InterfaceKind::file;
  if (!is_log && !is_fleet_file) {
    return std::nullopt;
  }
  const std::string typed = printable(text);
  return Error{Code::usage,
               is_log ? say<texts::log_takes_no_frames>(typed)
                      : say<texts::file_takes_no_frames>(typed),
               say<texts::log_takes_no_frames_hint>(), std::nullopt};
}

std::string silence_hint(std::string_view text, std::string_view name) {
  const auto interface = text.empty() ? InterfaceName{} : parse_interface(text);
  switch (interface ? interface->kind : InterfaceKind::socketcan) {
  case InterfaceKind::slcan: return say<texts::silent_slcan_hint>();
  case InterfaceKind::mcast: return say<texts::silent_mcast_hint>(name);
  case InterfaceKind::simulator:
    return interface->rest.empty() ? say<texts::silent_sim_hint>()
                                   : say<texts::silent_simulator_hint>(name);
  case InterfaceKind::scenario: return say<texts::silent_scenario_hint>(printable(interface->rest));
  case InterfaceKind::replay: return say<texts::silent_log_hint>(printable(interface->rest));
  case InterfaceKind::file: return say<texts::silent_file_hint>(printable(interface->rest));
  case InterfaceKind::socketcan: break;
  }
  return {};
}

Result<OpenBus> open_bus(std::string_view text, const bla::Profiles& profiles,
                         const Reporter& reporter, bool inquires) {
  if (text.empty()) {
    const auto name = the_only_interface();
    if (name) {
      reporter.detail(say<texts::only_interface>(*name));
    }
    return name ? open_socketcan(*name) : Result<OpenBus>(std::unexpected(name.error()));
  }
  const auto name = parse_interface(text);
  if (!name) {
    return std::unexpected(name.error());
  }
  switch (name->kind) {
  case InterfaceKind::mcast: return open_mcast(*name, reporter);
  case InterfaceKind::slcan: return open_slcan(name->rest, reporter, inquires);
  case InterfaceKind::simulator: return open_simulator(text, name->rest, profiles, reporter);
  case InterfaceKind::scenario:
    return open_private(text, sim::read_scenario(name->rest, profiles), reporter);
  case InterfaceKind::replay: return open_log(text, name->rest);
  case InterfaceKind::file: return open_fleet_file(text, name->rest, profiles);
  case InterfaceKind::socketcan: break;
  }
  return open_socketcan(name->rest);
}

} // namespace blactl::cli
