#include "cli/confirm.hpp"

#include "cli/texts.hpp"

#include <termios.h>
#include <unistd.h>

#include <array>
#include <string>

namespace blactl::cli {
namespace {

/// What the person typed, without the line break; a closed terminal is an empty answer.
std::string read_line() {
  std::array<char, 256> buffer{};
  const ssize_t count = read(STDIN_FILENO, buffer.data(), buffer.size());
  std::string line(buffer.data(), count > 0 ? static_cast<std::size_t>(count) : 0);
  return line.substr(0, line.find_first_of("\r\n"));
}

} // namespace

Result<void> confirm(std::string_view question, Context& context) {
  if (context.shared().yes) {
    return {};
  }
  if (!Reporter::has_terminal()) {
    return fail(Code::not_confirmed, std::string(question) + say<texts::not_confirmed>(),
                say<texts::not_confirmed_hint>());
  }
  tcflush(STDIN_FILENO, TCIFLUSH); // what was typed before the question is no answer to it
  context.reporter().ask(std::string(question) + say<texts::question_yes_no>());
  if (auto ready = context.wait_for_input(STDIN_FILENO); !ready) {
    context.reporter().ask("\n"); // the question's line will get no answer
    return std::unexpected(ready.error());
  }
  const std::string answer = read_line();
  for (const std::string_view yes : {"y", "Y", "yes", "Yes", "YES"}) {
    if (answer == yes) {
      return {};
    }
  }
  return fail(Code::not_confirmed, say<texts::not_confirmed>()); // who said no needs no advice
}

} // namespace blactl::cli
