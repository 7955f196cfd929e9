#include "cli/option_values.hpp"

#include "cli/texts.hpp"

#include <charconv>
#include <cstdlib>

namespace blactl::cli {
namespace {

std::optional<Duration> decimal_seconds(std::string_view text) {
  constexpr std::size_t most_digits = 6;
  const auto point = text.find('.');
  const std::string_view whole = text.substr(0, point);
  std::string fraction(point == std::string_view::npos ? "" : text.substr(point + 1));
  const bool digits_only =
      (std::string(whole) + fraction).find_first_not_of("0123456789") == std::string::npos;
  if (whole.empty() || whole.size() > most_digits || fraction.size() > most_digits ||
      !digits_only || (point != std::string_view::npos && fraction.empty())) {
    return std::nullopt;
  }
  fraction.resize(most_digits, '0');
  return Duration(std::strtoll((std::string(whole) + fraction).c_str(), nullptr, 10));
}

std::string in_seconds(Duration duration) {
  return fmt::format("{}", std::chrono::duration<double>(duration).count());
}

} // namespace

void OptionValues::add(CLI::App& app, const char* names, const char* help, const char* type,
                       std::function<void(const Given&)> check) {
  Slot& slot = *slots_.emplace_back(std::make_unique<Slot>());
  const std::string_view all = names;
  slot.given.name = all.substr(all.find("--"));
  slot.given.command = app.get_parent() != nullptr ? app.get_name() : std::string();
  slot.check = std::move(check);
  names_.push_back(slot.given.name);
  app.add_option(names, slot.given.text, help)->type_name(type)->each([&slot](const std::string&) {
    slot.is_given = true;
  });
}

void OptionValues::text(CLI::App& app, const char* names, const char* help, const char* type,
                        std::optional<std::string>& out) {
  add(app, names, help, type, [&out](const Given& given) { out = given.text; });
}

void OptionValues::seconds(CLI::App& app, const char* names, const char* help, Duration& out,
                           Duration min, Duration max) {
  add(app, names, help, "SEC", [this, &out, min, max](const Given& given) {
    take_seconds(given, min, max, [&out](Duration value) { out = value; });
  });
}

void OptionValues::seconds(CLI::App& app, const char* names, const char* help,
                           std::optional<Duration>& out, Duration min, Duration max) {
  add(app, names, help, "SEC", [this, &out, min, max](const Given& given) {
    take_seconds(given, min, max, [&out](Duration value) { out = value; });
  });
}

void OptionValues::take_seconds(const Given& given, Duration min, Duration max,
                                const std::function<void(Duration)>& take) {
  const auto value = decimal_seconds(given.text);
  if (!value || *value < min || *value > max) {
    refuse(given, say<texts::bad_seconds>(given.name, printable(given.text), in_seconds(min),
                                          in_seconds(max)));
    return;
  }
  take(*value);
}

void OptionValues::whole(CLI::App& app, const char* names, const char* help, const char* type,
                         std::function<void(std::uint64_t)> take, std::uint64_t min,
                         std::uint64_t max) {
  add(app, names, help, type, [this, take = std::move(take), min, max](const Given& given) {
    std::uint64_t value{};
    const char* end = given.text.data() + given.text.size();
    const auto [stop, error] = std::from_chars(given.text.data(), end, value);
    if (error != std::errc() || stop != end || value < min || value > max) {
      refuse(given, say<texts::bad_number>(given.name, printable(given.text), min, max));
      return;
    }
    take(value);
  });
}

void OptionValues::refuse_word(const Given& given, const std::string& known) {
  refuse(given, say<texts::bad_word>(given.name, printable(given.text), known));
}

void OptionValues::refuse(const Given& given, std::string message) {
  failed(std::move(message), given.command.empty() ? say<texts::see_help>()
                                                   : say<texts::see_command_help>(given.command));
}

void OptionValues::failed(std::string message, std::string hint) {
  if (!error_) {
    error_ = Error{Code::usage, std::move(message), std::move(hint), std::nullopt};
  }
}

Result<void> OptionValues::check() {
  for (const auto& slot : slots_) {
    if (!slot->is_given) {
      continue;
    }
    // An unset variable of a script: -n "$NODE" must not mean every servo.
    if (slot->given.text.empty()) {
      refuse(slot->given, say<texts::empty_value>(slot->given.name));
    } else {
      slot->check(slot->given);
    }
  }
  return error_ ? Result<void>(std::unexpected(*error_)) : Result<void>();
}

} // namespace blactl::cli
