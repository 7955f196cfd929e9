#include "cli/help.hpp"

#include "cli/commands.hpp"
#include "cli/interface/scheme.hpp"
#include "cli/texts.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <span>
#include <vector>

namespace blactl::cli {
namespace {

std::string spaces(std::size_t count) {
  return std::string(count, ' ');
}

std::string_view in_language(const Text& text) {
  return choose(text.en, text.ja);
}

/// The left column: "-n, --node LIST".
std::string label(const Option& option) {
  std::string text = option.letter != 0 ? std::string{'-', option.letter, ',', ' '} : "    ";
  text += option.name;
  return option.value.empty() ? text : text + " " + std::string(option.value);
}

/// The description, with the possible words of the value.
std::string description(const Option& option) {
  std::string text(in_language(option.help));
  if (!option.words.empty() && option.kind != Kind::suggested) { // else it says so already
    text += ": ";
    for (const std::string_view word : option.words) {
      text += word == option.words.front() ? "" : ", ";
      text += word;
    }
  }
  return text;
}

struct Row {
  std::string label;
  std::string text;
};

/// Two columns under a heading. If the labels leave little room the texts go below them.
std::string section(std::string_view heading, const std::vector<Row>& rows, std::size_t width) {
  constexpr std::size_t margin = 2;
  constexpr std::size_t gap = 2;
  constexpr std::size_t least_text = 30;
  std::size_t column = 0;
  for (const Row& row : rows) {
    column = std::max(column, margin + display_width(row.label) + gap);
  }
  const bool below = column + least_text > width;
  column = below ? margin + 8 : column;
  std::string out = "\n" + wrap(heading, width, 0, 0) + "\n";
  for (const Row& row : rows) {
    const std::string left = spaces(margin) + row.label;
    out += left + (below ? "\n" + spaces(column) : spaces(column - display_width(left)));
    out += wrap(row.text, width, column, column) + "\n";
  }
  return out;
}

std::string option_section(std::span<const Option> options, std::string_view heading,
                           std::size_t width) {
  std::vector<Row> rows;
  for (const Option& option : options) {
    if (!option.hidden) {
      rows.push_back({label(option), description(option)});
    }
  }
  return rows.empty() ? std::string() : section(heading, rows, width);
}

/// "[PARAM…]", "PARAM=VALUE…", "[FILE]".
std::string usage_of(const Option& argument) {
  const std::string name =
      std::string(argument.name) + (argument.repeat == Repeat::list ? "…" : "");
  return argument.required ? name : "[" + name + "]";
}

std::string program_help(std::size_t width) {
  std::string out(wrap(say<texts::help_program>(), width, 0, 0));
  out += "\n\n" + wrap(say<texts::help_usage>("blactl [OPTIONS] COMMAND [ARGUMENTS]"), width, 8, 0);
  out += "\n";
  std::vector<Row> rows;
  for (const Command* command : all_commands()) {
    rows.push_back({std::string(command->name), std::string(in_language(command->help))});
  }
  out += section(say<texts::help_commands>(), rows, width);
  out += option_section(shared_options(), say<texts::help_shared>(), width);
  return out + "\n" + wrap(say<texts::help_exit_status>(), width, 0, 0) + "\n";
}

std::vector<std::string> remarks(const Traits& traits) {
  std::vector<std::string> texts;
  if (traits.from_file) {
    texts.push_back(say<texts::help_from_file>());
  } else if (traits.for_newcomer) {
    texts.push_back(say<texts::help_for_newcomer>());
  } else if (traits.from_history) {
    texts.push_back(say<texts::help_from_history>());
  } else if (traits.writes) {
    texts.push_back(say<texts::help_writes>());
  }
  if (traits.recordings) {
    const std::string_view log = form_of(Behind::log), file = form_of(Behind::fleet_file);
    texts.push_back(traits.needs_frames ? say<texts::help_logs>(log)
                                        : say<texts::help_recordings>(log, file));
  }
  if (traits.offline) {
    texts.push_back(say<texts::help_no_bus>());
  }
  texts.push_back(say<texts::help_see_shared>());
  return texts;
}

std::string command_help(const Command& command, std::size_t width) {
  std::string usage = "blactl " + std::string(command.name) + " [OPTIONS]";
  std::vector<Row> rows;
  for (const Option& argument : command.arguments) {
    usage += " " + usage_of(argument);
    rows.push_back({std::string(argument.name), std::string(in_language(argument.help))});
  }
  std::string out =
      wrap(fmt::format("blactl {}: {}", command.name, in_language(command.help)), width, 0, 0);
  out += "\n\n" + wrap(say<texts::help_usage>(usage), width, 8, 0) + "\n";
  if (!rows.empty()) {
    out += section(say<texts::help_arguments>(), rows, width);
  }
  out += option_section(command.options, say<texts::help_options>(), width) + "\n";
  for (const std::string& remark : remarks(command.traits)) {
    out += wrap(remark, width, 0, 0) + "\n";
  }
  return out;
}

} // namespace

std::size_t terminal_width() {
  constexpr std::size_t usual = 80;
  winsize size{};
  const bool known = ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? size.ws_col : usual;
}

std::string help(const Command* command, std::size_t width) {
  constexpr std::size_t least = 40;
  width = std::max(width, least);
  return command == nullptr ? program_help(width) : command_help(*command, width);
}

} // namespace blactl::cli
