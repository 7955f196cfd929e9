#include "cli/confirm.hpp"

#include "cli/texts.hpp"

#include <termios.h>
#include <unistd.h>

#include <array>
#include <string>

namespace blactl::cli {
namespace {

/// The typed line without its line break; a closed terminal is an empty answer.
std::string read_line() {
  std::array<char, 256> buffer{};
  const ssize_t count = read(STDIN_FILENO, buffer.data(), buffer.size());
  std::string line(buffer.data(), count > 0 ? static_cast<std::size_t>(count) : 0);
  return line.substr(0, line.find_first_of("\r\n"));
}

/// Input typed before the question does not answer it.
Result<std::string> answer_to(const std::string& question, Context& context) {
  tcflush(STDIN_FILENO, TCIFLUSH);
  context.reporter().ask(question);
  if (auto ready = context.wait_for_input(STDIN_FILENO); !ready) {
    context.reporter().ask("\n"); // ends the line of the unanswered question
    return std::unexpected(ready.error());
  }
  return read_line();
}

} // namespace

Result<void> confirm(std::string_view question, Context& context, std::string_view option) {
  if (context.shared().yes && option.empty()) {
    return {};
  }
  if (context.shared().yes || !Reporter::has_terminal()) {
    return fail(Code::not_confirmed, std::string(question) + say<texts::not_confirmed>(),
                option.empty() ? say<texts::not_confirmed_hint>()
                               : say<texts::not_confirmed_by_option_hint>(option));
  }
  const auto answer = answer_to(std::string(question) + say<texts::question_yes_no>(), context);
  if (!answer) {
    return std::unexpected(answer.error());
  }
  for (const std::string_view yes : {"y", "Y", "yes", "Yes", "YES"}) {
    if (*answer == yes) {
      return {};
    }
  }
  return fail(Code::not_confirmed, say<texts::not_confirmed>()); // a refusal needs no hint
}

Result<void> wait_for_enter(std::string_view text, Context& context) {
  const auto answer = answer_to(std::string(text), context);
  return answer ? Result<void>() : std::unexpected(answer.error());
}

} // namespace blactl::cli
