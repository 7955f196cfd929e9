#include "state/database_errors.hpp"

#include "blactl/base/system_error.hpp"

#include "state/texts.hpp"

#include <cerrno>
#include <filesystem>
#include <utility>

namespace blactl::state::errors {
namespace {

std::string folder_of(const DatabaseName& file) {
  return printable(std::filesystem::path(file.path).parent_path().string());
}

std::string_view what(const DatabaseName& file) {
  return choose(file.what.en, file.what.ja);
}

std::string_view way_back(const DatabaseName& file) {
  return choose(file.way_back.en, file.way_back.ja);
}

Error bad_file(const DatabaseName& file, std::string message) {
  return {Code::bad_file, std::move(message),
          say<texts::table_unusable_hint>(printable(file.path), way_back(file))};
}

} // namespace

Error foreign(const DatabaseName& file) {
  return bad_file(file, say<texts::table_foreign>(printable(file.path), what(file)));
}

Error link(const DatabaseName& file) {
  return bad_file(file, say<texts::table_is_link>(printable(file.path)));
}

Error left_over(const DatabaseName& file, const std::string& log) {
  return bad_file(file, say<texts::table_left_over>(printable(log), what(file)));
}

Error damaged(const DatabaseName& file, std::string_view reason) {
  return bad_file(file,
                  say<texts::table_damaged>(printable(file.path), what(file), printable(reason)));
}

Error newer(const DatabaseName& file, std::int64_t version, std::int64_t known) {
  return {Code::bad_file, say<texts::table_newer>(printable(file.path), what(file), version, known),
          say<texts::table_newer_hint>(printable(file.path), way_back(file))};
}

Error moved_away(const DatabaseName& file) {
  return {Code::io, say<texts::table_moved>(printable(file.path), what(file)),
          say<texts::table_moved_hint>()};
}

Error busy(const DatabaseName& file) {
  return {Code::busy, say<texts::table_busy>(printable(file.path), what(file)),
          say<texts::table_busy_hint>(printable(file.path))};
}

Error denied(const DatabaseName& file, std::string_view reason) {
  return {Code::permission,
          say<texts::table_denied>(printable(file.path), what(file), printable(reason)),
          say<texts::table_denied_hint>(folder_of(file))};
}

Error io(const DatabaseName& file, std::string_view reason) {
  return {Code::io, say<texts::table_io>(printable(file.path), what(file), printable(reason)),
          say<texts::table_io_hint>(folder_of(file))};
}

Error of_system(const DatabaseName& file, int number) {
  switch (number) {
  case EDQUOT:
  case EFBIG:
  case EIO:
  case EMFILE:
  case ENFILE:
  case ENOMEM:
  case ENOSPC: return io(file, system_reason(number));
  default: return denied(file, system_reason(number));
  }
}

Error broken_off(const DatabaseName& file, int number) {
  Error error = of_system(file, number);
  error.message =
      say<texts::table_broken_off>(printable(file.path), what(file), system_reason(number));
  return error;
}

} // namespace blactl::state::errors
