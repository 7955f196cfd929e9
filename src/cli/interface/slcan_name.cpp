#include "cli/interface/slcan_name.hpp"

#include "blactl/can/serial_port.hpp"

#include "cli/texts.hpp"

#include <charconv>
#include <chrono>
#include <optional>
#include <set>
#include <string>

namespace blactl::cli {
namespace {

using can::SlcanOpening;

constexpr unsigned longest_gap = 1000; // ms

std::optional<unsigned> whole(std::string_view text) {
  unsigned value = 0;
  const auto [stop, error] = std::from_chars(text.begin(), text.end(), value);
  return error == std::errc() && stop == text.end() ? std::optional(value) : std::nullopt;
}

/// The error in a value, for people; empty: none.
std::string set_option(std::string_view key, std::string_view value, can::SlcanOptions& options) {
  if (key == "baud") {
    const auto baud = whole(value);
    if (!baud || !can::is_baud_rate(*baud)) {
      return say<texts::slcan_bad_baud>(printable(value));
    }
    options.baud = *baud;
  } else if (key == "open") {
    if (value != "plain" && value != "s8") {
      return say<texts::bad_word>("open", printable(value), "plain, s8");
    }
    options.opening = value == "plain" ? SlcanOpening::plain : SlcanOpening::s8;
  } else if (key == "ack") {
    if (value != "auto" && value != "none") {
      return say<texts::bad_word>("ack", printable(value), "auto, none");
    }
    options.await_answers = value == "auto";
  } else if (key == "gap") {
    const auto gap = whole(value);
    if (!gap || *gap > longest_gap) {
      return say<texts::bad_number>("gap", printable(value), 0, longest_gap);
    }
    options.gap = std::chrono::milliseconds(*gap);
  } else {
    return say<texts::slcan_unknown_key>(printable(key));
  }
  return {};
}

} // namespace

Result<SlcanName> parse_slcan(std::string_view text) {
  const auto refuse = [&](const std::string& what) {
    return fail(Code::usage, say<texts::slcan_bad_name>(printable(text), what),
                say<texts::slcan_name_hint>());
  };
  const auto question = text.find('?');
  SlcanName name{std::filesystem::path(text.substr(0, question)), {}};
  if (name.device.empty()) {
    return refuse(say<texts::slcan_no_device>());
  }
  if (!name.device.has_parent_path()) {
    name.device = "/dev" / name.device;
  }
  std::string_view rest =
      question == std::string_view::npos ? std::string_view() : text.substr(question + 1);
  std::set<std::string_view> seen;
  while (!rest.empty()) {
    const auto end = rest.find('&');
    const std::string_view option = rest.substr(0, end);
    rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
    const auto equals = option.find('=');
    const std::string_view key = option.substr(0, equals);
    if (!seen.insert(key).second) {
      return refuse(say<texts::slcan_doubled_key>(printable(key)));
    }
    const auto value =
        equals == std::string_view::npos ? std::string_view() : option.substr(equals + 1);
    if (const auto wrong = set_option(key, value, name.options); !wrong.empty()) {
      return refuse(wrong);
    }
  }
  return name;
}

} // namespace blactl::cli
