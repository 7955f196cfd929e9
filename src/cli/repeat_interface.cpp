#include "cli/repeat_interface.hpp"

#include "blactl/base/text.hpp"

#include "cli/commands.hpp"
#include "cli/interface/scheme.hpp"

#include <algorithm>
#include <string_view>

namespace blactl::cli {
namespace {

constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyz";

/// As a shell takes it for one word.
std::string quoted(const std::string& text) {
  std::string safe = "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./:,=@%+";
  if (text.find_first_not_of(safe.append(letters)) == std::string::npos) {
    return text;
  }
  std::string all = "'";
  for (const char c : text) {
    all += c == '\'' ? std::string("'\\''") : std::string(1, c);
  }
  return all + '\'';
}

/// Whether this, after the name of the program, is a command that uses a bus, and no more than a
/// way to its help.
bool uses_bus(std::string_view text) {
  constexpr std::string_view help = "--help";
  const std::string_view word = text.substr(0, text.find_first_not_of(std::string(letters) + '-'));
  const Command* command = find_command(word);
  return word.starts_with("--") ? word != help
                                : command != nullptr && command->traits.session &&
                                      !text.substr(word.size()).starts_with(" --help");
}

bool was_typed(const Shared& shared) {
  const bool is_of_environment = std::ranges::any_of(
      shared.from_environment, [](const Origin& origin) { return origin.option == "--interface"; });
  return !shared.interface.empty() && !is_of_environment;
}

} // namespace

void repeat_interface(std::string& hint, const Shared& shared) {
  if (!was_typed(shared) || takes_no_frames(shared.interface)) {
    return;
  }
  constexpr std::string_view program = "blactl ";
  const std::string option = "-i " + quoted(printable(shared.interface)) + ' ';
  for (auto at = hint.find(program); at != std::string::npos; at = hint.find(program, at)) {
    at += program.size();
    if (uses_bus(std::string_view(hint).substr(at))) {
      hint.insert(at, option);
      at += option.size();
    }
  }
}

} // namespace blactl::cli
