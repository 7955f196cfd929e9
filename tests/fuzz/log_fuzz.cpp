// A log as somebody else wrote it, plain or packed, of candump, Vector or PEAK: what is read of it,
// and its clock. A frame that was read is written and read again as the same.

#include "blactl/can/candump.hpp"
#include "blactl/can/replay.hpp"

#include "can/log/asc.hpp"
#include "can/log/trc.hpp"
#include "fuzz.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>

using namespace blactl;

namespace {

void replay(const std::string& path) {
  auto bus = can::ReplayBus::open(path, "replay:" + path);
  fuzz::require(bus.has_value());
  while (true) {
    const auto event = (*bus)->receive();
    if (event &&
        (std::holds_alternative<can::Ended>(*event) || std::holds_alternative<can::Gone>(*event))) {
      return;
    }
  }
}

void write_again(const std::optional<can::LogLine>& line) {
  if (line && line->kind == can::LogLine::Kind::frame) {
    can::LineBuffer buffer;
    const auto same = can::parse_line(can::format_line(line->frame, line->at, "can0", buffer));
    fuzz::require(same && same->frame == line->frame);
  }
}

/// The text as lines of a log that begins so.
template <class Log>
void read_behind(std::initializer_list<std::string_view> header, std::string_view text) {
  Log log;
  for (const auto line : header) {
    (void)log.parse(line);
  }
  while (!text.empty()) {
    const auto line = text.substr(0, text.find('\n'));
    write_again(log.parse(line));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
  }
}

} // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = fuzz::as_text(data, size);
  write_again(can::parse_line(text.substr(0, text.find('\n'))));
  read_behind<can::AscLog>({"base hex timestamps relative"}, text);
  read_behind<can::AscLog>({"base dec timestamps absolute"}, text);
  for (const auto* version : {";$FILEVERSION=1.1", ";$FILEVERSION=1.3"}) {
    read_behind<can::TrcLog>({version}, text);
  }
  read_behind<can::TrcLog>({";$FILEVERSION=2.1", ";$COLUMNS=N,O,T,B,I,d,R,L,D"}, text);
  const int file = memfd_create("log", MFD_CLOEXEC);
  fuzz::require(file >= 0 && write(file, data, size) == static_cast<ssize_t>(size));
  replay("/proc/self/fd/" + std::to_string(file));
  close(file);
  return 0;
}
