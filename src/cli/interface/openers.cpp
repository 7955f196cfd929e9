// How each kind of interface is opened.

#include "blactl/can/mcast.hpp"
#include "blactl/can/silent_replay.hpp"
#include "blactl/can/simbus.hpp"
#include "blactl/can/slcan.hpp"
#include "blactl/can/socketcan.hpp"
#include "blactl/sim/bus/private_bus.hpp"
#include "blactl/sim/scenario/scenario.hpp"

#include "cli/interface/bus_factory.hpp"
#include "cli/interface/scheme.hpp"

#include <sys/stat.h>

#include <filesystem>
#include <system_error>
#include <utility>

namespace blactl::cli {
namespace {

/// What every kind of interface is.
template <class Kind>
Result<std::unique_ptr<can::Bus>> as_bus(Result<std::unique_ptr<Kind>> opened) {
  return opened ? Result<std::unique_ptr<can::Bus>>(std::move(*opened))
                : std::unexpected(std::move(opened.error()));
}

/// A piece of the dialogue with an adapter, for people.
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

Result<OpenBus> open_private(const OpenRequest& request, const Result<sim::Scenario>& scenario) {
  if (!scenario) {
    return std::unexpected(scenario.error());
  }
  for (const std::string& warning : scenario->warnings) {
    request.reporter.note(printable(warning));
  }
  return OpenBus{.bus = std::make_unique<sim::PrivateBus>(printable(request.text), *scenario)};
}

/// One whose time is another is another bus.
Result<std::unique_ptr<can::Bus>> reopen_simulator(const std::filesystem::path& path,
                                                   const std::string& name) {
  auto bus = can::SimBus::open(path, name);
  if (bus && (*bus)->has_virtual_clock()) {
    return fail(Code::interface, {});
  }
  return as_bus(std::move(bus));
}

} // namespace

/// Its name means another interface in every network namespace, but all of them may share the
/// folder. No process knows which namespace is that of the machine without being root, so each is
/// named.
state::LockPlace lock_place(std::string link) {
  struct stat status{};
  const bool known = stat("/proc/self/ns/net", &status) == 0;
  return {.interface = std::move(link),
          .network = known ? fmt::format("@{}", status.st_ino) : std::string()};
}

Result<OpenBus> open_socketcan(const OpenRequest& request) {
  auto bus = can::SocketCan::open(request.rest);
  if (!bus) {
    return std::unexpected(bus.error());
  }
  // Not as it was typed: an interface may have further names.
  const std::string link((*bus)->name());
  return OpenBus{.bus = std::move(*bus), .place = lock_place(link), .reopen = [link] {
                   return can::SocketCan::open(link);
                 }};
}

/// The name of the bus says the network interface: those on another one do not hear each other.
Result<OpenBus> open_mcast(const OpenRequest& request) {
  const auto name = parse_mcast(request.rest);
  if (!name) {
    return std::unexpected(name.error());
  }
  auto bus = can::Mcast::open(name->bus_number, name->link);
  if (!bus) {
    return std::unexpected(bus.error());
  }
  auto place = lock_place(std::string((*bus)->name()));
  if (name->link.empty()) {
    request.reporter.note(say<texts::mcast_chosen>(place.interface));
  }
  return OpenBus{.bus = std::move(*bus), .place = std::move(place), .reopen = [name = *name] {
                   return as_bus(can::Mcast::open(name.bus_number, name.link));
                 }};
}

Result<OpenBus> open_slcan(const OpenRequest& request) {
  auto name = parse_slcan(request.rest);
  if (!name) {
    return std::unexpected(name.error());
  }
  name->options.inquires = request.inquires;
  name->options.trace = [&reporter = request.reporter](can::SlcanTalk talk,
                                                       std::string_view bytes) {
    tell(reporter, talk, bytes);
  };
  const std::string device = name->device.string();
  auto bus = can::Slcan::open(name->device, "slcan:" + printable(device), name->options);
  if (!bus) {
    return std::unexpected(bus.error());
  }
  // Links by product or by place lead to one device.
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

Result<OpenBus> open_simulator(const OpenRequest& request) {
  const std::string& socket = request.rest;
  const std::string name = printable(request.text);
  const std::filesystem::path path =
      socket.empty() ? can::default_socket_path() : std::filesystem::path(socket);
  auto bus =
      socket.empty() ? can::SimBus::open_if_served(path, name) : can::SimBus::open(path, name);
  if (!bus) {
    return std::unexpected(bus.error());
  }
  if (*bus == nullptr) {
    request.reporter.note(say<texts::sim_is_private>());
    return open_private(request, sim::default_scenario(request.profiles));
  }
  const bool is_virtual = (*bus)->has_virtual_clock();
  // Many paths may lead there.
  std::error_code error;
  const auto canonical = std::filesystem::canonical(path, error);
  const auto& where = error ? path : canonical;
  OpenBus opened{
      .bus = std::move(*bus),
      .place = {.interface = "sim:" + where.string(), .folder = where.parent_path().string()}};
  if (!is_virtual) {
    opened.reopen = [path, name] { return reopen_simulator(path, name); };
  }
  return opened;
}

Result<OpenBus> open_scenario(const OpenRequest& request) {
  return open_private(request, sim::read_scenario(request.rest, request.profiles));
}

Result<OpenBus> open_log(const OpenRequest& request) {
  auto log = can::ReplayBus::open(request.rest, printable(request.text));
  if (!log) {
    return std::unexpected(log.error());
  }
  const can::ReplayBus* replay = log->get();
  return OpenBus{.bus = std::move(*log), .log = replay};
}

Result<OpenBus> open_fleet_file(const OpenRequest& request) {
  auto fleet = fleet::read_fleet_file(request.rest, request.profiles);
  if (!fleet) {
    return std::unexpected(fleet.error());
  }
  return OpenBus{.bus = std::make_unique<can::SilentReplay>(printable(request.text)),
                 .fleet = std::move(*fleet)};
}

} // namespace blactl::cli
