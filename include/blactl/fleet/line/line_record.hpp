#pragma once
// The record of one servo of a production line as it comes about (contract, sections 5 to 7,
// "provision", "ledger").

#include "blactl/base/error.hpp"
#include "blactl/base/time.hpp"
#include "blactl/bla/profile.hpp"
#include "blactl/fleet/bus/servo.hpp"
#include "blactl/fleet/bus/snapshot.hpp"
#include "blactl/fleet/change/result.hpp"
#include "blactl/fleet/files/label.hpp"
#include "blactl/state/ledger_record.hpp"

#include <string>
#include <string_view>

namespace blactl::fleet {

namespace verdict {
inline constexpr std::string_view pass = "pass", fail = "fail", error = "error", skip = "skip",
                                  scrap = "scrap";
} // namespace verdict

/// Of an end with this error: fail (the unit's fault), or error (the station's).
[[nodiscard]] std::string_view verdict_of(Code code);

/// Whether after this end the same unit is done again as soon as it is heard: it was away, or the
/// bus was.
[[nodiscard]] bool is_done_again(Code code);

/// A record that begins now, with the members of `common`: those that all records of a run share.
[[nodiscard]] state::LedgerRecord begun_record(const state::LedgerRecord& common, WallTime now);

/// What the unit has said of itself.
void enter(state::LedgerRecord& record, const Servo& servo);

void enter(state::LedgerRecord& record, const Label& label);

/// The outcome of its change; of a register that is not as it should be, the first.
void enter(state::LedgerRecord& record, const GoalResult& result);

/// What was read in the end: all configuration, and some that changes by itself.
void enter(state::LedgerRecord& record, const Snapshot& held, const bla::Profiles& profiles);

/// Ends it, with the error if there is one; its message is the reason, unless there is another.
void end(state::LedgerRecord& record, std::string_view verdict, const std::optional<Error>& error,
         WallTime now);

/// Over the settings of a servo, by address: "0x20=1\n" each.
[[nodiscard]] std::string digest(const Snapshot& held);

/// Over what a profile says of its registers, by address: name, access, default and limits.
[[nodiscard]] std::string digest(const bla::Profile& profile);

} // namespace blactl::fleet
