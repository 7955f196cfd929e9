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
  return can::parse_line(line) ||
         (line.starts_with("# ") && line.find("blactl ") != std::string_view::npos);
}

bool is_of_its_kind(std::string_view text, Content content) {
  switch (content) {
  case Content::log: return is_log(text);
  case Content::drawing: return text.find("<svg ") != std::string_view::npos;
  case Content::events: return text.starts_with(R"({"time":)");
  case Content::facts: return text.find("blactl-facts/") != std::string_view::npos;
  }
  return false;
}

std::string over_other(Content content, std::string_view option, const std::string& file) {
  switch (content) {
  case Content::log: return say<texts::log_over_other>(option, file);
  case Content::drawing: return say<texts::drawing_over_other>(option, file);
  case Content::events: return say<texts::events_over_other>(option, file);
  case Content::facts: return say<texts::facts_over_other>(option, file);
  }
  return {};
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

Result<void> check_target(const std::string& file, Content content, std::string_view option) {
  if (auto fit = check_no_state(file, option); !fit) {
    return fit;
  }
  const std::string text = is_regular(file) ? beginning(file) : std::string();
  if (!text.empty() && !is_of_its_kind(text, content)) {
    return fail(Code::usage, over_other(content, option, printable(file)),
                say<texts::log_over_other_hint>());
  }
  const bool is_written_at_once = content == Content::drawing || content == Content::facts;
  return is_written_at_once ? check_replaceable(file) : Result<void>();
}

} // namespace blactl::cli
