#pragma once
// Resets the RAM of one servo to factory defaults.

#include "blactl/dronecan/node.hpp"
#include "blactl/fleet/bus/register_access.hpp"
#include "blactl/fleet/bus/roster.hpp"
#include "blactl/fleet/change/guard.hpp"

#include <optional>
#include <utility>

namespace blactl::fleet {

/// Sends ERASE (opcode 1; 2.3, 4.9) once. Without a response the caller must read the registers to
/// see whether it was carried out.
class EraseJob final : public dronecan::Job {
 public:
  /// `roster` outlives the job. `may_be_driven`: also while another node drives the servo.
  EraseJob(const Roster& roster, Servo servo, Patience patience, bool may_be_driven = false)
      : roster_(roster), servo_(std::move(servo)), patience_(patience),
        guard_(roster, may_be_driven) {}

  [[nodiscard]] dronecan::Step next(const dronecan::Outcome& outcome) override;

  [[nodiscard]] bool is_confirmed() const { return is_confirmed_; }

  [[nodiscard]] bool is_refused() const { return is_refused_; }

  /// Whether the request left this machine, or may have.
  [[nodiscard]] bool is_sent() const { return at_ == At::request && !is_withheld_; }

  /// Set if the request certainly did not leave this machine; else the registers tell whether it
  /// was carried out, whatever the servo answered. Errors: no_acknowledge, interrupted, state; as
  /// Guard::forbids().
  [[nodiscard]] const std::optional<Error>& error() const { return error_; }

 private:
  enum class At : std::uint8_t { begin, unit, request };

  const Roster& roster_;
  Servo servo_;
  Patience patience_;
  Guard guard_;
  At at_ = At::begin;
  bool is_withheld_ = false;
  bool is_confirmed_ = false;
  bool is_refused_ = false;
  std::optional<Error> error_;
};

} // namespace blactl::fleet
