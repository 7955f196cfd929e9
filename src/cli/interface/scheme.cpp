#include "cli/interface/scheme.hpp"

#include "blactl/can/serial_adapters.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <system_error>
#include <vector>

namespace blactl::cli {
namespace {

bool looks_like_serial_port(std::string_view text) {
  return text.starts_with("ttyUSB") || text.starts_with("ttyACM") || text.starts_with("/dev/");
}

/// `scheme` as somebody may have meant it who typed no colon; empty: he did not.
std::string meant_by(std::string_view text, const Scheme& scheme) {
  if (scheme.operand == Operand::link) {
    return {};
  }
  const std::string prefix = std::string(scheme.name) + ":";
  if (text == scheme.name) {
    const auto ports = scheme.operand == Operand::serial_port
                           ? can::serial_adapters()
                           : std::vector<std::filesystem::path>();
    return ports.empty() ? std::string(scheme.example) : prefix + printable(ports.front().string());
  }
  if (scheme.operand == Operand::serial_port && looks_like_serial_port(text)) {
    return prefix + (text.starts_with("/") ? "" : "/dev/") + printable(text);
  }
  return scheme.has_ending(text) ? prefix + printable(text) : std::string();
}

/// The scheme of a name that has a colon; null: there is none.
const Scheme* find_scheme(std::string_view name, std::string_view rest) {
  const Scheme* found = nullptr;
  for (const Scheme& scheme : schemes) {
    if (scheme.name == name && (found == nullptr || scheme.has_ending(rest))) {
      found = &scheme;
    }
  }
  return found;
}

std::string examples() {
  std::string list;
  for (const Scheme& scheme : schemes) {
    list += (list.empty() ? "-i " : ", -i ") + std::string(scheme.example);
  }
  return say<texts::bad_interface_hint>(list);
}

/// A text without a colon is the name of a CAN interface, unless it looks like something else. (One
/// that is called "sim" is socketcan:sim.)
Result<InterfaceName> parse_bare(std::string_view text) {
  if (text.empty()) {
    return fail(Code::usage, say<texts::interface_name_missing>(text), examples());
  }
  for (const Scheme& scheme : schemes) {
    if (const std::string meant = meant_by(text, scheme); !meant.empty()) {
      return fail(Code::usage, say<texts::interface_meant>(printable(text)),
                  say<texts::interface_meant_hint>(meant));
    }
  }
  return InterfaceName{.rest = std::string(text)};
}

} // namespace

Result<InterfaceName> parse_interface(std::string_view text) {
  const auto colon = text.find(':');
  if (colon == std::string_view::npos) {
    return parse_bare(text);
  }
  const std::string_view rest = text.substr(colon + 1);
  const Scheme* scheme = find_scheme(text.substr(0, colon), rest);
  if (scheme == nullptr) {
    return fail(Code::usage, say<texts::bad_interface>(printable(text)), examples());
  }
  if (rest.empty() && !scheme->may_be_bare) {
    return fail(Code::usage, say<texts::interface_name_missing>(printable(text)), examples());
  }
  if (scheme->check != nullptr) {
    if (const auto fine = scheme->check(rest); !fine) {
      return std::unexpected(fine.error());
    }
  }
  return InterfaceName{scheme, std::string(rest)};
}

std::string_view form_of(Behind behind) {
  return std::ranges::find(schemes, behind, &Scheme::behind)->form;
}

bool names(std::string_view text, Behind behind) {
  const auto name = parse_interface(text);
  return name && name->is(behind);
}

std::optional<Error> takes_no_frames(std::string_view text) {
  const auto name = parse_interface(text);
  if (!name || name->scheme->refusal == nullptr) {
    return std::nullopt;
  }
  return Error{Code::usage, name->scheme->refusal(printable(text)),
               say<texts::log_takes_no_frames_hint>(), std::nullopt};
}

std::string silence_hint(std::string_view text, std::string_view name) {
  const auto interface = text.empty() ? InterfaceName{} : parse_interface(text);
  if (!interface || interface->scheme->silence == nullptr) {
    return {};
  }
  return interface->scheme->silence(interface->rest, name);
}

Result<McastName> parse_mcast(std::string_view text) {
  constexpr std::string_view key = "if=";
  const auto refuse = [&] {
    return fail(Code::usage, say<texts::bad_mcast>(printable(text)), say<texts::bad_mcast_hint>());
  };
  McastName name;
  const auto mark = text.find('?');
  const std::string_view number = text.substr(0, mark);
  const auto [stop, error] =
      std::from_chars(number.data(), number.data() + number.size(), name.bus_number);
  if (!number.empty() && (error != std::errc() || stop != number.data() + number.size())) {
    return refuse();
  }
  if (mark != std::string_view::npos) {
    const std::string_view option = text.substr(mark + 1);
    if (!option.starts_with(key) || option.size() == key.size()) {
      return refuse();
    }
    name.link = option.substr(key.size());
  }
  return name;
}

} // namespace blactl::cli
