#include "blactl/can/recorder.hpp"

#include "blactl/base/system_error.hpp"
#include "blactl/can/candump.hpp"
#include "blactl/can/replay_texts.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <tuple>
#include <utility>

namespace blactl::can {
namespace {

constexpr mode_t file_mode = 0644;

bool fits_a_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
         c == '_' || c == '-';
}

} // namespace

std::string log_interface(std::string_view bus_name) {
  std::string_view rest = bus_name.substr(0, bus_name.find('?'));
  while (rest.ends_with('/')) {
    rest.remove_suffix(1);
  }
  rest.remove_prefix(rest.rfind('/') + 1); // npos + 1 is 0
  std::string name(rest);
  std::ranges::replace_if(name, [](char c) { return !fits_a_name(c); }, '-');
  name.resize(std::min(name.size(), longest_interface_name));
  name.resize(name.find_last_not_of('-') + 1);
  return name.empty() ? "can" : name;
}

Result<std::unique_ptr<Recorder>> Recorder::open(std::unique_ptr<Bus> bus,
                                                 const std::string& path) {
  const int descriptor =
      ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOCTTY, file_mode);
  if (descriptor < 0) {
    return fail(Code::io, say<texts::record_unopened>(printable(path), system_reason(errno)),
                say<texts::record_unopened_hint>());
  }
  return std::unique_ptr<Recorder>(new Recorder(std::move(bus), descriptor, path));
}

Recorder::Recorder(std::unique_ptr<Bus> bus, int descriptor, std::string path)
    : bus_(std::move(bus)), descriptor_(descriptor), path_(std::move(path)),
      interface_(log_interface(bus_->name())) {}

Recorder::~Recorder() {
  close(descriptor_);
}

Result<bool> Recorder::send(const Frame& frame) {
  auto taken = bus_->send(frame);
  if (taken && *taken && !bus_->echoes()) {
    record(frame, bus_->wall());
  }
  return taken;
}

std::optional<BusEvent> Recorder::receive() {
  while (auto event = bus_->receive()) {
    if (const auto* sent = std::get_if<Sent>(&*event)) {
      record(sent->frame, sent->wall);
    }
    const auto* received = std::get_if<Received>(&*event);
    if (received != nullptr) {
      record(received->frame, received->wall);
    }
    if (received == nullptr || passes(received->frame)) {
      return event;
    }
  }
  return std::nullopt;
}

bool Recorder::passes(const Frame& frame) const {
  return filters_.empty() || std::ranges::any_of(filters_, [&](const Filter& filter) {
           return frame.extended && (frame.id & filter.mask) == (filter.id & filter.mask);
         });
}

Result<void> Recorder::filter(std::span<const Filter> filters) {
  filters_.assign(filters.begin(), filters.end());
  return {};
}

void Recorder::record(const Frame& frame, WallTime at) {
  if (error_) {
    return;
  }
  LineBuffer buffer;
  auto line = format_line(frame, at, interface_, buffer);
  const auto size = static_cast<std::int64_t>(line.size());
  while (!line.empty()) {
    const auto written = write(descriptor_, line.data(), line.size());
    if (written < 0 && errno == EINTR) {
      continue;
    }
    if (written < 0) {
      stop(errno);
      return;
    }
    line.remove_prefix(static_cast<std::size_t>(written));
  }
  complete_ += size;
}

void Recorder::begin_anew() {
  const bool is_empty = ftruncate(descriptor_, 0) == 0 && lseek(descriptor_, 0, SEEK_SET) == 0;
  complete_ = 0;
  error_.reset();
  if (!is_empty) {
    stop(errno);
  }
}

/// Truncates: a full disk may hold a part of the line, which would read as another frame.
void Recorder::stop(int error) {
  error_ = Error{Code::io, say<texts::record_failed>(printable(path_), system_reason(error)),
                 say<texts::record_failed_hint>()};
  std::ignore = ftruncate(descriptor_, complete_); // fails on a pipe, which has no file to mend
}

} // namespace blactl::can
