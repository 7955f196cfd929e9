#include "cli/interface/bus_factory.hpp"

#include "blactl/can/link.hpp"
#include "blactl/can/mcast.hpp"
#include "blactl/can/replay_texts.hpp"
#include "blactl/can/serial_adapters.hpp"
#include "blactl/can/simbus.hpp"
#include "blactl/can/slcan.hpp"
#include "blactl/can/socketcan.hpp"
#include "blactl/sim/private_bus.hpp"
#include "blactl/sim/scenario.hpp"

#include "cli/interface/slcan_name.hpp"
#include "cli/texts.hpp"

#include <charconv>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

namespace blactl::cli {
namespace {

/// A hint, and which serial adapters could be meant instead.
std::string with_adapters(std::string hint) {
  if (const std::string adapters = can::describe(can::serial_adapters()); !adapters.empty()) {
    hint += "; " + adapters;
  }
  return hint;
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
  // Not as it was typed: an interface may have further names.
  const std::string first_name((*bus)->name());
  return OpenBus{std::move(*bus), first_name, nullptr};
}

/// The name of the bus says the network interface: those on another one do not hear each other.
Result<OpenBus> open_mcast(const InterfaceName& name, const Reporter& reporter) {
  auto bus = can::Mcast::open(name.bus_number, name.rest);
  if (!bus) {
    return std::unexpected(bus.error());
  }
  const std::string full_name((*bus)->name());
  if (name.rest.empty()) {
    reporter.note(say<texts::mcast_chosen>(full_name));
  }
  return OpenBus{std::move(*bus), full_name};
}

Result<OpenBus> open_slcan(std::string_view rest) {
  const auto name = parse_slcan(rest);
  if (!name) {
    return std::unexpected(name.error());
  }
  const std::string device = name->device.string();
  auto bus = can::Slcan::open(name->device, "slcan:" + printable(device), name->options);
  if (!bus) {
    return std::unexpected(bus.error());
  }
  // Links by product or by place lead to one device.
  std::error_code error;
  const auto canonical = std::filesystem::canonical(name->device, error);
  return OpenBus{std::move(*bus), "slcan:" + (error ? device : canonical.string())};
}

Result<OpenBus> open_private(std::string_view text, const Result<sim::Scenario>& scenario) {
  if (!scenario) {
    return std::unexpected(scenario.error());
  }
  return OpenBus{std::make_unique<sim::PrivateBus>(printable(text), *scenario), {}, nullptr};
}

Result<OpenBus> open_simulator(std::string_view text, const std::string& socket,
                               const bla::Profiles& profiles, const Reporter& reporter) {
  const bool default_socket = socket.empty();
  const std::string path = default_socket ? can::default_socket_path().string() : socket;
  if (default_socket && !std::filesystem::exists(path)) {
    reporter.note(say<texts::sim_is_private>());
    return open_private(text, sim::default_scenario(profiles));
  }
  auto bus = can::SimBus::open(path, printable(text));
  if (!bus) {
    return std::unexpected(bus.error());
  }
  // Many paths may lead there.
  std::error_code error;
  const auto canonical = std::filesystem::canonical(path, error);
  const auto where = error ? std::filesystem::absolute(path, error) : canonical;
  return OpenBus{std::move(*bus), "sim:" + where.string(), nullptr, where.parent_path().string()};
}

Result<OpenBus> open_log(std::string_view text, const std::string& path) {
  auto log = can::ReplayBus::open(path, printable(text));
  if (!log) {
    return std::unexpected(log.error());
  }
  const can::ReplayBus* bus = log->get();
  return OpenBus{std::move(*log), {}, bus};
}

/// What stands behind "mcast:": "0?if=lo". The number alone is enough, and so is nothing: bus 0.
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

} // namespace

Result<InterfaceName> parse_interface(std::string_view text) {
  const auto colon = text.find(':');
  const std::string_view scheme = text.substr(0, colon);
  if (colon == std::string_view::npos || scheme == "socketcan") {
    const auto name = colon == std::string_view::npos ? text : text.substr(colon + 1);
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
  if (scheme == "replay" && colon + 1 < text.size()) {
    return InterfaceName{.kind = InterfaceKind::replay,
                         .rest = std::string(text.substr(colon + 1))};
  }
  return fail(Code::usage, say<texts::bad_interface>(printable(text)),
              say<texts::bad_interface_hint>());
}

std::optional<Error> takes_no_frames(std::string_view text) {
  const auto name = parse_interface(text);
  if (!name || name->kind != InterfaceKind::replay) {
    return std::nullopt;
  }
  return Error{Code::usage, say<texts::log_takes_no_frames>(printable(text)),
               say<texts::log_takes_no_frames_hint>(), std::nullopt};
}

Result<OpenBus> open_bus(std::string_view text, const bla::Profiles& profiles,
                         const Reporter& reporter) {
  if (text.empty()) {
    const auto name = the_only_interface();
    return name ? open_socketcan(*name) : Result<OpenBus>(std::unexpected(name.error()));
  }
  const auto name = parse_interface(text);
  if (!name) {
    return std::unexpected(name.error());
  }
  switch (name->kind) {
  case InterfaceKind::mcast: return open_mcast(*name, reporter);
  case InterfaceKind::slcan: return open_slcan(name->rest);
  case InterfaceKind::simulator: return open_simulator(text, name->rest, profiles, reporter);
  case InterfaceKind::scenario: return open_private(text, sim::read_scenario(name->rest, profiles));
  case InterfaceKind::replay: return open_log(text, name->rest);
  case InterfaceKind::socketcan: break;
  }
  return open_socketcan(name->rest);
}

} // namespace blactl::cli
