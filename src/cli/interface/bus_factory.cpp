#include "cli/interface/bus_factory.hpp"

#include "blactl/can/link.hpp"
#include "blactl/can/link_setup.hpp"
#include "blactl/can/serial_adapters.hpp"

#include "cli/interface/scheme.hpp"
#include "cli/texts.hpp"

#include <utility>

namespace blactl::cli {
namespace {

/// A hint, with the serial adapters that could be meant instead.
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
    up += (up.empty() ? "" : ", ") + link.name;
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

} // namespace

Result<OpenBus> open_bus(const OpenRequest& request) {
  OpenRequest named = request;
  if (request.text.empty()) {
    auto name = the_only_interface();
    if (!name) {
      return std::unexpected(name.error());
    }
    request.reporter.detail(say<texts::only_interface>(*name));
    named.rest = std::move(*name);
    return open_socketcan(named);
  }
  auto name = parse_interface(request.text);
  if (!name) {
    return std::unexpected(name.error());
  }
  named.rest = std::move(name->rest);
  return name->scheme->open(named);
}

} // namespace blactl::cli
