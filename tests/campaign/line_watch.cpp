#include "line_watch.hpp"

#include "bus_around.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <optional>
#include <stdexcept>
#include <utility>

namespace blactl::campaign {
namespace {

using nlohmann::json;
using namespace std::chrono_literals;

class WatchedBus final : public test::BusAround {
 public:
  WatchedBus(std::unique_ptr<can::Bus> bus, LineWatch& watch)
      : BusAround(std::move(bus)), watch_(watch) {}

  [[nodiscard]] std::optional<can::BusEvent> receive() override {
    watch_.look();
    return BusAround::receive();
  }

 private:
  LineWatch& watch_;
};

} // namespace

LineWatch::LineWatch(World& world, const std::vector<Visit>& visits, bool has_labels)
    : world_(world), visits_(visits) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0 || dup2(ends[0], STDIN_FILENO) < 0) {
    throw std::runtime_error("no pipe for labels");
  }
  close(ends[0]);
  labels_ = ends[1];
  if (!has_labels) {
    close(std::exchange(labels_, -1));
  }
}

LineWatch::~LineWatch() {
  if (labels_ >= 0) {
    close(labels_);
  }
  const int nothing = open("/dev/null", O_RDONLY | O_CLOEXEC);
  dup2(nothing, STDIN_FILENO);
  close(nothing);
}

std::unique_ptr<can::Bus> LineWatch::around(std::unique_ptr<can::Bus> bus) {
  return std::make_unique<WatchedBus>(std::move(bus), *this);
}

void LineWatch::look() {
  struct stat file{};
  if (fstat(STDOUT_FILENO, &file) == 0 && static_cast<std::size_t>(file.st_size) > seen_) {
    std::string more(static_cast<std::size_t>(file.st_size) - seen_, '\0');
    const auto got = pread(STDOUT_FILENO, more.data(), more.size(), static_cast<off_t>(seen_));
    more.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
    seen_ += more.size();
    rest_ += more;
    for (auto end = rest_.find('\n'); end != std::string::npos; end = rest_.find('\n')) {
      take(rest_.substr(0, end));
      rest_.erase(0, end + 1);
    }
  }
  scan();
}

void LineWatch::take(const std::string& line) {
  json record = json::parse(line, nullptr, false);
  if (record.is_discarded() || !record.contains("record_id")) {
    return;
  }
  const bool uses_label = record["verdict"] != "error";
  open_ -= uses_label && open_ > 0 ? 1U : 0U;
  told_.push_back({.record = std::move(record), .at = world_.now(), .states = world_.states()});
}

/// A label as its unit comes; but not while the station still has one.
void LineWatch::scan() {
  constexpr Duration before = 500ms;
  while (labels_ >= 0 && next_ < visits_.size() &&
         visits_[next_].span.from - before <= world_.now()) {
    const Visit& visit = visits_[next_++];
    if (open_ == 0 && world_.now() < visit.span.to) {
      std::string line = visit.label + '\n';
      const iovec text{.iov_base = line.data(), .iov_len = line.size()};
      open_ += writev(labels_, &text, 1) > 0 ? 1U : 0U; // write() may be made to fail
    }
  }
}

std::vector<ToldRecord> LineWatch::told(const std::string& out) {
  rest_ += out.substr(std::min(seen_, out.size()));
  seen_ = out.size();
  for (auto end = rest_.find('\n'); end != std::string::npos; end = rest_.find('\n')) {
    take(rest_.substr(0, end));
    rest_.erase(0, end + 1);
  }
  return std::exchange(told_, {});
}

} // namespace blactl::campaign
