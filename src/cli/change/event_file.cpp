#include "cli/change/event_file.hpp"

#include "blactl/base/json_writer.hpp"
#include "blactl/base/system_error.hpp"

#include "cli/change/texts.hpp"
#include "cli/log_target.hpp"
#include "cli/output/node_head.hpp"
#include "cli/trace/time.hpp"

#include <fcntl.h>
#include <sys/types.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

namespace blactl::cli {

Result<std::unique_ptr<EventFile>> EventFile::open(const std::string& path) {
  if (path == "-") {
    return blactl::fail(Code::usage, say<texts::events_no_stdout>(),
                        say<texts::events_unopened_hint>());
  }
  if (auto fit = check_target(path, Content::events, "--events"); !fit) {
    return std::unexpected(std::move(fit.error()));
  }
  constexpr mode_t file_mode = 0644;
  // O_NONBLOCK: neither a pipe without a reader nor a slow reader is waited for
  const int descriptor = ::open(
      path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOCTTY | O_NONBLOCK, file_mode);
  if (descriptor < 0) {
    return blactl::fail(Code::io,
                        say<texts::events_unopened>(printable(path), system_reason(errno)),
                        say<texts::events_unopened_hint>());
  }
  return std::unique_ptr<EventFile>(new EventFile(descriptor, path));
}

EventFile::~EventFile() {
  close(descriptor_);
}

void EventFile::tell(WallTime time, const fleet::Servo& servo, std::string_view stage,
                     std::string_view status) {
  std::string line;
  JsonWriter json(line);
  json.begin_object();
  json.key("time");
  json.number(UnixTime(time).text());
  write_head(json, servo);
  json.member("stage", stage);
  json.member("status", status);
  json.end_object();
  tell(std::move(line));
}

void EventFile::tell(std::string line) {
  if (error_) {
    return;
  }
  line += '\n';
  ssize_t written = 0;
  do {
    written = write(descriptor_, line.data(), line.size());
  } while (written < 0 && errno == EINTR);
  if (written != static_cast<ssize_t>(line.size())) {
    const std::string reason = system_reason(written < 0 ? errno : ENOSPC);
    error_ = Error{Code::io, say<texts::events_ended>(printable(path_), reason),
                   say<texts::events_ended_hint>(), std::nullopt};
  }
}

} // namespace blactl::cli
