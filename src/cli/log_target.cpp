#include "cli/log_target.hpp"

#include "blactl/base/replace_file.hpp"
#include "blactl/can/candump.hpp"
#include "blactl/state/state_folder.hpp"

#include "cli/texts.hpp"

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace blactl::cli {
namespace {

/// The beginning of a file tells what it is.
std::string beginning(const std::string& file) {
  constexpr std::size_t enough =
      4096; // some lines: none of ours is longer than a few hundred bytes
  std::string text(enough, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  return text;
}

/// Whether the first line is a frame, or the head of a report.
bool is_log(std::string_view text) {
  const std::string_view line = text.substr(0, text.find('\n'));
  return text.empty() || can::parse_line(line) ||
         (line.starts_with("# ") && line.find("blactl ") != std::string_view::npos);
}

bool is_drawing(std::string_view text) {
  return text.empty() || text.find("<svg ") != std::string_view::npos;
}

bool is_regular(const std::string& file) {
  std::error_code error;
  return std::filesystem::is_regular_file(file, error);
}

} // namespace

Result<void> check_no_state(const std::string& file, std::string_view option) {
  return state::is_state_file(file)
             ? fail(Code::usage, say<texts::log_over_state>(option, printable(file)),
                    say<texts::log_over_state_hint>())
             : Result<void>();
}

Result<void> check_drawing_target(const std::string& file, std::string_view option) {
  if (auto fit = check_no_state(file, option); !fit) {
    return fit;
  }
  if (is_regular(file) && !is_drawing(beginning(file))) {
    return fail(Code::usage, say<texts::drawing_over_other>(option, printable(file)),
                say<texts::log_over_other_hint>());
  }
  return check_replaceable(file);
}

Result<void> check_log_target(const std::string& file, std::string_view option) {
  if (auto fit = check_no_state(file, option); !fit) {
    return fit;
  }
  return is_regular(file) && !is_log(beginning(file))
             ? fail(Code::usage, say<texts::log_over_other>(option, printable(file)),
                    say<texts::log_over_other_hint>())
             : Result<void>();
}

} // namespace blactl::cli
