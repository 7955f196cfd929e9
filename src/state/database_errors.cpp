#include "state/database_errors.hpp"

#include "blactl/base/system_error.hpp"

#include "state/texts.hpp"

#include <cerrno>
#include <filesystem>
#include <utility>

namespace blactl::state::errors {
namespace {

std::string folder_of(const std::string& path) {
  return printable(std::filesystem::path(path).parent_path().string());
}

Error bad_file(const std::string& path, std::string message) {
  return {Code::bad_file, std::move(message), say<texts::table_unusable_hint>(printable(path))};
}

} // namespace

Error foreign(const std::string& path) {
  return bad_file(path, say<texts::table_foreign>(printable(path)));
}

Error link(const std::string& path) {
  return bad_file(path, say<texts::table_is_link>(printable(path)));
}

Error left_over(const std::string& path, const std::string& log) {
  return bad_file(path, say<texts::table_left_over>(printable(log)));
}

Error damaged(const std::string& path, std::string_view reason) {
  return bad_file(path, say<texts::table_damaged>(printable(path), printable(reason)));
}

Error newer(const std::string& path, std::int64_t version, std::int64_t known) {
  return {Code::bad_file, say<texts::table_newer>(printable(path), version, known),
          say<texts::table_newer_hint>(printable(path))};
}

Error moved_away(const std::string& path) {
  return {Code::io, say<texts::table_moved>(printable(path)), say<texts::table_moved_hint>()};
}

Error busy(const std::string& path) {
  return {Code::busy, say<texts::table_busy>(printable(path)),
          say<texts::table_busy_hint>(printable(path))};
}

Error denied(const std::string& path, std::string_view reason) {
  return {Code::permission, say<texts::table_denied>(printable(path), printable(reason)),
          say<texts::table_denied_hint>(folder_of(path))};
}

Error io(const std::string& path, std::string_view reason) {
  return {Code::io, say<texts::table_io>(printable(path), printable(reason)),
          say<texts::table_io_hint>(folder_of(path))};
}

Error of_system(const std::string& path, int number) {
  switch (number) {
  case EDQUOT:
  case EFBIG:
  case EIO:
  case EMFILE:
  case ENFILE:
  case ENOMEM:
  case ENOSPC: return io(path, system_reason(number));
  default: return denied(path, system_reason(number));
  }
}

} // namespace blactl::state::errors
