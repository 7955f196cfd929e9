#include "cli/interface/mcast_name.hpp"

#include "cli/texts.hpp"

#include <charconv>
#include <system_error>

namespace blactl::cli {

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
