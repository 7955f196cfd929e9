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
  /// C, S8, O, and whatever the adapter says to S8. This is the default because it is safe with
  /// both kinds of adapters: one with several bit rates never opens at a wrong one, which would
  /// spoil the frames of others on the bus; one with a fixed bit rate has an unknown command to
  /// ignore. unproven: that the starter kit's adapter ignores it; `plain` is there if it does not.
  careful,
  /// O alone, as the program of the servo's vendor opens the starter kit's adapter.
  plain,
  /// As careful, for adapters that are known to have flow control: no gaps.
  s8,
};

/// Who speaks.
enum class SlcanTalk : std::uint8_t { to_adapter, from_adapter };

struct SlcanOptions {
  unsigned baud = 1'000'000;
  SlcanOpening opening = SlcanOpening::careful;
  bool await_answers = true; ///< false: commands follow each other at once
  /// Time between the beginnings of two frames. Left out: 3 ms for `plain`, and for `careful` while
  /// the adapter answers nothing, as the vendor's program waits inside a transfer; else none.
  /// unproven: whether the starter kit's adapter needs it.
  std::optional<Duration> gap{};
  /// Before it is opened, an adapter that answers is asked for its version and serial number.
  bool inquires = false;
  /// Called with what is sent to the adapter and what it says while it is opened. May be empty.
  std::function<void(SlcanTalk, std::string_view bytes)> trace{};
};

/// Frames as lines of text. An adapter tells nothing of acknowledgement on the bus: what it has
/// taken counts as sent, and a bus without any other node looks like a silent one.
///
/// Adapters that acknowledge lines get a few at a time; the others are left to the port's own flow
/// control and the gap. The adapter's clock is not used: frames bear the time they were read at.
class Slcan final : public Bus {
 public:
  /// Opens the port and begins the opening dialogue, which goes on in receive(); how it ends is an
  /// event. `name`: as a person names it. Errors: interface, permission (see SerialPort).
  [[nodiscard]] static Result<std::unique_ptr<Slcan>>
  open(const std::filesystem::path& device, std::string name, const SlcanOptions& options);

  /// Closes the CAN channel, as far as that takes no waiting.
  ~Slcan() override;
  Slcan(const Slcan&) = delete;
  Slcan& operator=(const Slcan&) = delete;

  [[nodiscard]] std::string_view name() const override { return name_; }

  [[nodiscard]] bool is_open() const override { return open_; }

  [[nodiscard]] Result<bool> send(const Frame& frame) override;
  [[nodiscard]] Time send_again_at(Time refused) const override;
  [[nodiscard]] std::optional<BusEvent> receive() override;

  /// slcan has none that adapters agree on.
  [[nodiscard]] Result<void> filter(std::span<const Filter> /*filters*/) override { return {}; }

  [[nodiscard]] bool echoes() const override { return false; }

  /// An adapter that refuses to open or to send, that says what is no slcan, or nothing at all.
  [[nodiscard]] std::optional<Error> silence() const override;

  /// What it has told of itself so far.
  [[nodiscard]] const SlcanAnswers& answers() const { return answers_; }

  /// What was heard on the port instead of slcan.
  [[nodiscard]] ForeignSpeech speech() const;

  /// Asks for the status, which an adapter knows while it is open: one that answers, and that is at
  /// rest. False: it is not asked.
  [[nodiscard]] bool ask_status();

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
  std::string outgoing_; ///< what the port did not take yet: a frame, or commands
  SlcanAnswers answers_;
  bool open_ = false;
  bool gone_ = false;
  Time next_send_{};           ///< when the gap after the last frame ends
  std::deque<Time> awaited_;   ///< frames without an answer: when that is given up
  bool acknowledges_ = false;  ///< the adapter answers frames
  unsigned silent_frames_ = 0; ///< answers given up one after the other
  unsigned late_answers_ = 0;  ///< to commands that were not waited for
  Time late_answers_until_{};
  unsigned traced_ = 0; ///< pieces of what the adapter said
};

} // namespace blactl::can
