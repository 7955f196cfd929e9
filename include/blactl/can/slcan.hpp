#pragma once
// A CAN adapter behind a serial port that speaks slcan: the servos' starter kit, CANable, Zubax,
// ArduPilot.

#include "blactl/can/bus.hpp"
#include "blactl/can/slcan_adapter.hpp"
#include "blactl/can/slcan_line.hpp"

#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace blactl::can {

class SerialPort;
class SlcanDialogue;
class SlcanEvidence;

/// Which commands open the CAN channel of an adapter.
enum class SlcanOpening : std::uint8_t {
  /// C, S8, O, whatever the answer to S8. The default, because it is safe with both kinds of
  /// adapters: one with several bit rates never opens at a wrong one, which would spoil the frames
  /// of others on the bus; one with a fixed bit rate only has an unknown command to ignore.
  /// unproven: that the starter kit's adapter ignores it; `plain` is there if it does not.
  careful,
  /// O alone, as the program of the servo's vendor opens the starter kit's adapter.
  plain,
  /// As careful, for adapters that are known to have flow control: no gaps.
  s8,
};

/// The direction of traffic on the port.
enum class SlcanTalk : std::uint8_t { to_adapter, from_adapter };

struct SlcanOptions {
  unsigned baud = 1'000'000;
  SlcanOpening opening = SlcanOpening::careful;
  bool await_answers = true; ///< false: commands follow each other at once
  /// Time between the beginnings of two frames. Left out: 3 ms for `plain`, and for `careful` while
  /// the adapter answers nothing, as the vendor's program waits inside a transfer; else none.
  /// unproven: whether the starter kit's adapter needs it.
  std::optional<Duration> gap{};
  /// Before opening, asks an adapter that answers for its version and serial number.
  bool inquires = false;
  /// Called with the bytes to and from the adapter while it is opened. May be empty.
  std::function<void(SlcanTalk, std::string_view bytes)> trace{};
};

/// Frames as lines of text. An adapter does not report acknowledgement on the bus: what it has
/// accepted counts as sent, and a bus without any other node looks like a silent one.
///
/// Adapters that acknowledge lines get a few at a time; for others only the port's flow control and
/// the gap apply. The adapter's clock is not used: frames have the time at which they were read.
class Slcan final : public Bus {
 public:
  /// Opens the port and begins the opening dialogue, which goes on in receive(); its outcome is an
  /// event. `name`: as the user gave it. Errors: interface, permission (see SerialPort).
  [[nodiscard]] static Result<std::unique_ptr<Slcan>>
  open(const std::filesystem::path& device, std::string name, const SlcanOptions& options);

  /// Closes the CAN channel, as far as possible without waiting.
  ~Slcan() override;
  Slcan(const Slcan&) = delete;
  Slcan& operator=(const Slcan&) = delete;

  [[nodiscard]] std::string_view name() const override { return name_; }

  [[nodiscard]] bool is_open() const override { return open_; }

  [[nodiscard]] Result<bool> send(const Frame& frame) override;
  [[nodiscard]] Time send_again_at(Time refused) const override;
  [[nodiscard]] std::optional<BusEvent> receive() override;

  /// Does nothing: slcan has no filter that adapters agree on.
  [[nodiscard]] Result<void> filter(std::span<const Filter> /*filters*/) override { return {}; }

  [[nodiscard]] bool echoes() const override { return false; }

  /// An adapter that refuses to open or to send, that sends anything but slcan, or nothing at all.
  [[nodiscard]] std::optional<Error> silence() const override;

  /// The adapter's answers about itself so far.
  [[nodiscard]] const SlcanAnswers& answers() const { return answers_; }

  /// The kind of traffic heard on the port instead of slcan.
  [[nodiscard]] ForeignSpeech speech() const;

  /// Asks for the status, which an adapter has while it is open. False: not asked, because the
  /// adapter does not answer or is busy.
  [[nodiscard]] bool ask_status();

  [[nodiscard]] bool stamps() const override { return false; }

  [[nodiscard]] int descriptor() const override;

  [[nodiscard]] bool wants_to_write() const override { return !outgoing_.empty(); }

  [[nodiscard]] Time idle_until(Time deadline) override;

 private:
  Slcan(std::unique_ptr<SerialPort> port, std::filesystem::path device, std::string name,
        const SlcanOptions& options);

  void flush();
  void read_port();
  void trace_answer(std::string_view bytes, Time at);
  void take(const SlcanLine& line, Time at);
  void told(const std::string& answer, Time at);
  void converse();
  void opened();
  void acknowledged(bool accepted, Time at);
  void forget_lost(Time now);
  void broken(Error error);
  [[nodiscard]] Error refuses() const;
  [[nodiscard]] Error speaks_no_slcan() const;
  [[nodiscard]] Duration gap() const;

  std::unique_ptr<SerialPort> port_;
  std::filesystem::path device_;
  std::string name_;
  SlcanOptions options_;
  std::unique_ptr<SlcanDialogue> dialogue_;
  std::unique_ptr<SlcanEvidence> evidence_;
  SlcanParser parser_;
  std::deque<BusEvent> ready_;
  std::string outgoing_; ///< bytes the port has not accepted yet: a frame, or commands
  SlcanAnswers answers_;
  bool open_ = false;
  bool gone_ = false;
  Time next_send_{};           ///< when the gap after the last frame ends
  std::deque<Time> awaited_;   ///< frames without an answer: when to give up on each
  bool acknowledges_ = false;  ///< the adapter answers frames
  unsigned silent_frames_ = 0; ///< consecutive answers given up on
  unsigned late_answers_ = 0;  ///< to commands no longer waited for
  Time late_answers_until_{};
  unsigned traced_ = 0; ///< pieces of the adapter's output
};

} // namespace blactl::can
