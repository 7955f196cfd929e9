#include "blactl/can/slcan.hpp"

#include "blactl/can/serial_port.hpp"

#include "can/slcan_dialogue.hpp"
#include "can/slcan_texts.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <tuple>
#include <utility>

namespace blactl::can {
namespace {

/// The vendor's program sleeps so long after each frame of a transfer.
constexpr Duration vendor_gap = std::chrono::milliseconds(3);

/// Lines without an answer, of an adapter that answers them: enough to keep a bus of 1 Mbit/s
/// busy over the delay of USB, few enough for the smallest receive buffers (CAN232: 256 bytes).
constexpr std::size_t window = 4;

/// A frame waits for arbitration; an adapter that says nothing for so long has lost the answer.
constexpr Duration acknowledge_time = std::chrono::milliseconds(250);

/// So many lost answers in a row: the adapter does not answer frames after all.
constexpr unsigned most_silent_frames = 3;

/// How long after the dialogue an answer may belong to one of its commands.
constexpr Duration late_answer_time = std::chrono::milliseconds(250);

/// Read at most, before somebody else has a turn: an adapter may flood.
constexpr int most_reads = 16;

} // namespace

Slcan::Slcan(std::unique_ptr<SerialPort> port, std::filesystem::path device, std::string name,
             const SlcanOptions& options)
    : port_(std::move(port)), device_(std::move(device)), name_(std::move(name)), options_(options),
      dialogue_(std::make_unique<SlcanDialogue>(options.opening, options.await_answers)) {}

Result<std::unique_ptr<Bus>> Slcan::open(const std::filesystem::path& device, std::string name,
                                         const SlcanOptions& options) {
  auto port = SerialPort::open(device, options.baud);
  if (!port) {
    return std::unexpected(std::move(port.error()));
  }
  std::unique_ptr<Slcan> bus(new Slcan(std::move(*port), device, std::move(name), options));
  bus->dialogue_->begin(bus->now());
  bus->converse();
  return bus;
}

Slcan::~Slcan() {
  if (!gone_) {
    outgoing_ += "C\r";
    std::ignore = port_->write(outgoing_);
  }
}

int Slcan::descriptor() const {
  return port_->descriptor();
}

Result<bool> Slcan::send(const Frame& frame) {
  const Time at = now();
  forget_lost(at);
  if (!open_ || !outgoing_.empty() || at < next_send_ ||
      (acknowledges_ && awaited_.size() >= window)) {
    return false;
  }
  outgoing_ = to_slcan(frame);
  next_send_ = at + gap();
  awaited_.push_back(at + acknowledge_time);
  if (awaited_.size() > window) { // of an adapter that does not answer frames
    awaited_.pop_front();
  }
  flush();
  return true;
}

Time Slcan::send_again_at(Time /*refused*/) const {
  if (!open_ || !outgoing_.empty()) {
    return never; // receive() will change that
  }
  const bool full = acknowledges_ && awaited_.size() >= window;
  return full ? std::max(next_send_, awaited_.front()) : next_send_;
}

Duration Slcan::gap() const {
  if (options_.gap) {
    return *options_.gap;
  }
  const bool answers = acknowledges_ || dialogue_->adapter_answers();
  const bool careful = options_.opening == SlcanOpening::careful && !answers;
  return careful || options_.opening == SlcanOpening::plain ? vendor_gap : Duration::zero();
}

std::optional<BusEvent> Slcan::receive() {
  if (ready_.empty() && !gone_) {
    flush();
    read_port();
    converse();
  }
  if (ready_.empty()) {
    return std::nullopt;
  }
  BusEvent event = std::move(ready_.front());
  ready_.pop_front();
  return event;
}

Time Slcan::idle_until(Time deadline) {
  return std::min(deadline, dialogue_->deadline());
}

/// Writes what the port takes now.
void Slcan::flush() {
  if (outgoing_.empty() || gone_) {
    return;
  }
  if (const auto taken = port_->write(outgoing_)) {
    outgoing_.erase(0, *taken);
  } else {
    broken(taken.error());
  }
}

void Slcan::read_port() {
  std::array<char, 1024> bytes{};
  for (int i = 0; i < most_reads && ready_.empty() && !gone_; ++i) {
    const auto size = port_->read(bytes);
    if (!size) {
      broken(size.error());
      return;
    }
    if (*size == 0) {
      return;
    }
    const Time at = now();
    for (const char byte : std::span(bytes).first(*size)) {
      if (const auto line = parser_.take(byte)) {
        take(*line, at);
      }
    }
  }
}

void Slcan::take(const SlcanLine& line, Time at) {
  switch (line.kind) {
  case SlcanLine::Kind::frame:
    if (open_) { // what comes before was meant for the program that left the channel open
      ready_.emplace_back(Received{line.frame, at, wall()});
    }
    break;
  case SlcanLine::Kind::done: acknowledged(true, at); break;
  case SlcanLine::Kind::refused: acknowledged(false, at); break;
  case SlcanLine::Kind::loopback:
  case SlcanLine::Kind::other: break;
  }
}

/// Goes on with the opening dialogue.
void Slcan::converse() {
  if (open_ || gone_) {
    return;
  }
  dialogue_->advance(now());
  outgoing_ += dialogue_->take_commands();
  flush();
  if (dialogue_->is_done() && !gone_) {
    opened();
  }
}

void Slcan::opened() {
  const std::string device = printable(device_.string());
  if (dialogue_->refused()) {
    broken({Code::interface, say<texts::adapter_refuses>(device),
            say<texts::adapter_refuses_hint>(device)});
    return;
  }
  open_ = true;
  late_answers_ = static_cast<unsigned>(dialogue_->unanswered());
  late_answers_until_ = now() + late_answer_time;
  ready_.emplace_back(
      Opened{dialogue_->rate_refused() ? say<texts::adapter_rate_fixed>(device) : std::string()});
}

/// CR, Z or BEL: the answer to the first command or frame that waits for one.
void Slcan::acknowledged(bool accepted, Time at) {
  if (!open_) {
    dialogue_->answered(accepted, at);
    converse();
    return;
  }
  if (late_answers_ > 0 && at < late_answers_until_) {
    --late_answers_;
    return;
  }
  if (awaited_.empty()) {
    return;
  }
  awaited_.pop_front();
  acknowledges_ = true;
  silent_frames_ = 0;
  if (!accepted) {
    ready_.emplace_back(BusFault{FaultKind::transmit_timeout, at});
  }
}

/// Answers that did not come in time hold no place any more.
void Slcan::forget_lost(Time now) {
  while (!awaited_.empty() && awaited_.front() <= now) {
    awaited_.pop_front();
    if (++silent_frames_ >= most_silent_frames) {
      acknowledges_ = false;
    }
  }
}

void Slcan::broken(Error error) {
  gone_ = true;
  outgoing_.clear();
  ready_.emplace_back(Gone{std::move(error)});
}

} // namespace blactl::can
