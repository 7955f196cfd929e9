// A log as somebody else wrote it, plain or packed: what is read of it, and its clock. A frame that
// was read is written and read again as the same.

#include "blactl/can/candump.hpp"
#include "blactl/can/replay.hpp"

#include "fuzz.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <string>

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

void read_again(std::string_view text) {
  const auto line = can::parse_line(text.substr(0, text.find('\n')));
  if (line && line->kind == can::LogLine::Kind::frame) {
    can::LineBuffer buffer;
    const auto same = can::parse_line(can::format_line(line->frame, line->at, "can0", buffer));
    fuzz::require(same && same->frame == line->frame);
  }
}

} // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  read_again(fuzz::as_text(data, size));
  const int file = memfd_create("log", MFD_CLOEXEC);
  fuzz::require(file >= 0 && write(file, data, size) == static_cast<ssize_t>(size));
  replay("/proc/self/fd/" + std::to_string(file));
  close(file);
  return 0;
}
