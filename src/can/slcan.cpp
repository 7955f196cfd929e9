#include "blactl/can/slcan.hpp"

#include "blactl/can/serial_port.hpp"

#include "can/slcan_dialogue.hpp"
#include "can/slcan_evidence.hpp"
#include "can/slcan_texts.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <tuple>
#include <utility>

namespace blactl::can {
namespace {

/// The time that the vendor's program sleeps after each frame of a transfer.
constexpr Duration vendor_gap = std::chrono::milliseconds(3);

/// Unanswered lines in flight to an adapter that answers: enough to keep a bus of 1 Mbit/s busy
/// over the delay of USB, few enough for the smallest receive buffers (CAN232: 256 bytes).
constexpr std::size_t line_window = 4;

/// A frame waits for arbitration; an adapter silent for so long has lost the answer.
constexpr Duration acknowledge_time = std::chrono::milliseconds(250);

/// After so many lost answers in a row, the adapter does not answer frames.
constexpr unsigned most_silent_frames = 3;

/// After so many frames refused and none accepted, the adapter will refuse more.
constexpr std::size_t most_refused_frames = 3;

/// How long after the dialogue an answer may belong to one of its commands.
constexpr Duration late_answer_time = std::chrono::milliseconds(250);

/// The most reads before other work gets a turn: an adapter may flood.
constexpr int most_reads = 16;

} // namespace

Slcan::Slcan(std::unique_ptr<SerialPort> port, std::filesystem::path device, std::string name,
             const SlcanOptions& options)
    : port_(std::move(port)), device_(std::move(device)), name_(std::move(name)), options_(options),
      dialogue_(std::make_unique<SlcanDialogue>(options.opening, options.await_answers,
                                                options.inquires)),
      evidence_(std::make_unique<SlcanEvidence>()) {}

Result<std::unique_ptr<Slcan>> Slcan::open(const std::filesystem::path& device, std::string name,
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
      (acknowledges_ && awaited_.size() >= line_window)) {
    return false;
  }
  outgoing_ = to_slcan(frame);
  next_send_ = at + gap();
  awaited_.push_back(at + acknowledge_time);
  if (awaited_.size() > line_window) { // the adapter does not answer frames
    awaited_.pop_front();
  }
  flush();
  return true;
}

Time Slcan::send_again_at(Time /*refused*/) const {
  if (!open_ || !outgoing_.empty()) {
    return never; // receive() will change that
  }
  const bool full = acknowledges_ && awaited_.size() >= line_window;
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

/// Writes as much as the port accepts now.
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
    trace_answer({bytes.data(), *size}, at);
    for (const char byte : std::span(bytes).first(*size)) {
      evidence_->heard(byte);
      if (const auto line = parser_.take(byte)) {
        evidence_->understood(*line);
        take(*line, at);
      }
    }
    if (open_ && !gone_ && evidence_->is_no_slcan()) {
      broken(speaks_no_slcan());
    }
  }
}

/// Traces the adapter's output until it is open and its last answer overdue; not all of a flood.
void Slcan::trace_answer(std::string_view bytes, Time at) {
  constexpr unsigned most_pieces = 20;
  if (options_.trace && traced_ < most_pieces &&
      (!open_ || (late_answers_ > 0 && at < late_answers_until_))) {
    ++traced_;
    options_.trace(SlcanTalk::from_adapter, bytes);
  }
}

void Slcan::take(const SlcanLine& line, Time at) {
  switch (line.kind) {
  case SlcanLine::Kind::frame:
    if (open_) { // earlier input was meant for the program that left the channel open
      ready_.emplace_back(Received{line.frame, at, wall()});
    }
    break;
  case SlcanLine::Kind::done: acknowledged(true, at); break;
  case SlcanLine::Kind::refused: acknowledged(false, at); break;
  case SlcanLine::Kind::told: told(line.told, at); break;
  case SlcanLine::Kind::loopback:
  case SlcanLine::Kind::other: break;
  }
}

void Slcan::told(const std::string& answer, Time at) {
  switch (answer.front()) {
  case 'V': answers_.version = answer.substr(1); break;
  case 'N': answers_.serial_number = answer.substr(1); break;
  default:
    answers_.status = static_cast<std::uint8_t>(std::stoul(answer.substr(1), nullptr, 16));
    break;
  }
  if (!open_) {
    dialogue_->told(answer, at);
    converse();
  } else if (late_answers_ > 0 && at < late_answers_until_) {
    --late_answers_;
  }
}

bool Slcan::ask_status() {
  if (!open_ || gone_ || !outgoing_.empty() || !dialogue_->adapter_answers()) {
    return false;
  }
  const std::string command = "F\r";
  if (options_.trace) {
    options_.trace(SlcanTalk::to_adapter, command);
  }
  outgoing_ += command;
  ++late_answers_; // an adapter that does not know the command refuses it
  late_answers_until_ = now() + late_answer_time;
  flush();
  return true;
}

ForeignSpeech Slcan::speech() const {
  return evidence_->speech();
}

/// Goes on with the opening dialogue.
void Slcan::converse() {
  if (open_ || gone_) {
    return;
  }
  dialogue_->advance(now());
  const std::string commands = dialogue_->take_commands();
  if (options_.trace && !commands.empty()) {
    options_.trace(SlcanTalk::to_adapter, commands);
  }
  outgoing_ += commands;
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
  if (dialogue_->waited_in_vain() && evidence_->is_no_slcan()) {
    broken(speaks_no_slcan());
    return;
  }
  evidence_->dialogue_ended(dialogue_->adapter_answers());
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
  evidence_->frame_answered(accepted);
  if (!accepted) {
    ready_.emplace_back(BusFault{FaultKind::transmit_timeout, at});
  }
  if (evidence_->refused_all() >= most_refused_frames) {
    broken(refuses());
  }
}

/// Frees the places of answers that did not come in time.
void Slcan::forget_lost(Time now) {
  while (!awaited_.empty() && awaited_.front() <= now) {
    awaited_.pop_front();
    if (++silent_frames_ >= most_silent_frames) {
      acknowledges_ = false;
    }
  }
}

Error Slcan::refuses() const {
  const std::string device = printable(device_.string());
  if (dialogue_->open_refused()) {
    return {Code::interface, say<texts::adapter_stays_closed>(device),
            say<texts::adapter_stays_closed_hint>(device), std::nullopt};
  }
  return {Code::interface, say<texts::adapter_takes_no_frames>(device, evidence_->refused_all()),
          say<texts::adapter_takes_no_frames_hint>(device), std::nullopt};
}

Error Slcan::speaks_no_slcan() const {
  const std::string device = printable(device_.string());
  switch (evidence_->speech()) {
  case ForeignSpeech::mavlink:
    return {Code::interface, say<texts::port_speaks_mavlink>(device),
            say<texts::port_speaks_mavlink_hint>(), std::nullopt};
  case ForeignSpeech::text:
    return {Code::interface, say<texts::port_speaks_text>(device),
            say<texts::adapter_speaks_no_slcan_hint>(device), std::nullopt};
  case ForeignSpeech::none: break;
  }
  return {Code::interface, say<texts::adapter_speaks_no_slcan>(device, options_.baud),
          say<texts::adapter_speaks_no_slcan_hint>(device), std::nullopt};
}

std::optional<Error> Slcan::silence() const {
  if (evidence_->only_garbage()) {
    return speaks_no_slcan();
  }
  if (evidence_->refused_all() > 0 || (dialogue_->open_refused() && !evidence_->took_frames())) {
    return refuses();
  }
  if (evidence_->is_mute()) {
    const std::string device = printable(device_.string());
    return Error{Code::not_found, say<texts::adapter_is_mute>(device),
                 say<texts::adapter_is_mute_hint>(device), std::nullopt};
  }
  return std::nullopt;
}

void Slcan::broken(Error error) {
  gone_ = true;
  outgoing_.clear();
  ready_.emplace_back(Gone{std::move(error)});
}

} // namespace blactl::can
