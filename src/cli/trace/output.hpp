#pragma once
// The results of a trace, and the ways to show them.

#include "blactl/base/json_writer.hpp"
#include "blactl/base/time.hpp"
#include "blactl/bla/profile.hpp"
#include "blactl/can/frame.hpp"
#include "blactl/dronecan/transfer.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace blactl::cli {

/// The reason why a transfer is not shown as one (contract, section 5).
enum class TraceError : std::uint8_t {
  crc,
  toggle,
  missing_start,
  transfer_id,
  truncated,
  timeout,
  too_short, ///< complete, but shorter than its type: "short"
};

inline constexpr std::size_t trace_errors = 7;

/// The word of the contract: "crc", …, "short".
[[nodiscard]] inline std::string_view name(TraceError error) {
  constexpr std::array<std::string_view, trace_errors> words{
      "crc", "toggle", "missing_start", "transfer_id", "truncated", "timeout", "short"};
  return words[std::to_underlying(error)];
}

/// message, request, response.
[[nodiscard]] inline std::string_view name(dronecan::Kind kind) {
  constexpr std::array<std::string_view, 3> words{"message", "request", "response"};
  return words[std::to_underlying(kind)];
}

/// A frame, with its interface and times.
struct Heard {
  const can::Frame& frame;
  Time at; ///< may be of any clock with a constant offset to `wall`
  WallTime wall;
  std::string_view interface; ///< untrusted
};

/// The interface and the time of something heard.
struct Occasion {
  std::string_view interface; ///< untrusted: from a log
  WallTime at;
};

/// One way to show a trace. All its input has passed the filter, except frames. The views append to
/// one string and allocate nothing once it has grown.
class TraceOutput {
 public:
  virtual ~TraceOutput() = default;
  TraceOutput(const TraceOutput&) = delete;
  TraceOutput& operator=(const TraceOutput&) = delete;

  /// Takes every frame, before its transfer. `wanted`: it is DroneCAN and passes the filter.
  virtual void frame(const Heard& heard, bool wanted) = 0;
  /// Returns whether the transfer was shown: false if its payload is too short for its type.
  [[nodiscard]] virtual bool transfer(const Occasion& occasion,
                                      const dronecan::Transfer& transfer) = 0;
  virtual void broken(const Occasion& occasion, TraceError error, std::uint32_t can_id) = 0;

 protected:
  TraceOutput() = default;
};

/// One JSON object per line (contract, section 5, `trace`).
class JsonTrace final : public TraceOutput {
 public:
  /// `out` outlives the view.
  explicit JsonTrace(std::string& out) : out_(out) {}

  void frame(const Heard&, bool) override {}

  bool transfer(const Occasion& occasion, const dronecan::Transfer& transfer) override;
  void broken(const Occasion& occasion, TraceError error, std::uint32_t can_id) override;

 private:
  std::string& out_;
  std::string hex_; ///< of one payload
};

/// The form of times for people: in seconds since the first frame, or by the local wall clock.
enum class Clock : std::uint8_t { since_first, wall };

/// One line per transfer for a technician.
class TextTrace final : public TraceOutput {
 public:
  /// `out` and `profiles` outlive the view.
  TextTrace(std::string& out, const bla::Profiles& profiles, Clock clock)
      : out_(out), profiles_(profiles), clock_(clock) {}

  void frame(const Heard& heard, bool) override { first_ = first_.value_or(heard.wall); }

  bool transfer(const Occasion& occasion, const dronecan::Transfer& transfer) override;
  void broken(const Occasion& occasion, TraceError error, std::uint32_t can_id) override;

 private:
  [[nodiscard]] std::string time_text(WallTime at) const;
  void begin_line(const Occasion& occasion, const dronecan::Header& header);
  [[nodiscard]] bool write_value(const dronecan::Transfer& transfer);

  std::string& out_;
  const bla::Profiles& profiles_;
  Clock clock_;
  std::optional<WallTime> first_; ///< of all frames, shown or not
};

} // namespace blactl::cli
