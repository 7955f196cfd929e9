#pragma once
// Measures on one servo on the bench what the specification leaves open, and restores the servo
// afterwards.
//
// The table open_questions() lists the unproven settings of the simulator (sim/behaviour.hpp) by
// their keys in a facts file. The measurements have three phases: reads only; writes to RAM while
// the output is off; starts, for which the servo restarts and saves what its ROM already holds.

#include "blactl/base/text.hpp"
#include "blactl/fleet/bus/identification.hpp"
#include "blactl/fleet/bus/read_job.hpp"
#include "blactl/fleet/bus/session.hpp"
#include "blactl/fleet/bus/snapshot.hpp"
#include "blactl/fleet/change/history.hpp"
#include "blactl/state/allocation_store.hpp"

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace blactl::fleet {

/// A setting that only a real servo can settle.
struct OpenQuestion {
  std::string_view setting; ///< its key in a facts file
  Text what;                ///< its meaning
  Text reason;              ///< why it is not measured, unless a more specific reason is known
};

/// All questions, in the order of the table for people.
[[nodiscard]] std::span<const OpenQuestion> open_questions();

/// A flag; or a word or a time: "clamp", "80ms".
using FactValue = std::variant<bool, std::string>;

struct Fact {
  std::string_view setting;
  std::optional<FactValue> value{}; ///< empty: not measured
  std::string reason{};             ///< why it was not measured
};

/// An observation that is not a setting: the name of the node, the duration of starts.
struct Observation {
  std::string what, value;
};

/// The servo's GetNodeInfo response.
struct NodeInfo {
  std::string name; ///< untrusted bytes
  std::uint8_t software_major = 0, software_minor = 0, hardware_major = 0, hardware_minor = 0;
};

struct Characterization {
  Servo servo;               ///< as it is now
  std::vector<Fact> facts{}; ///< one for each open question, in the same order
  std::vector<Observation> observations{};
  std::optional<NodeInfo> info{};
  /// The reason why it was not finished.
  std::optional<Error> error{};
  /// The settings that could not be restored; empty: all are as before.
  std::optional<Error> not_put_back{};
  /// Whether something was changed, and restored.
  bool was_put_back = false;

  [[nodiscard]] bool is_done() const { return !error && !not_put_back; }
};

/// Options of a characterization.
struct BenchManner {
  Identification::Options identification{};
  bool while_driven = false;
  /// Whether this process may allocate node IDs: no other on this machine does so on the interface.
  bool may_allocate = false;
  std::function<Result<state::AllocationStore>()> allocations{}; ///< as Manner::allocations
  std::function<void(const std::string&)> progress{};            ///< called with the present stage
  History* history = nullptr;                                    ///< null: no record
  /// As Manner::not_recorded and end_not_recorded.
  std::function<std::optional<Error>(const Error&)> not_recorded{};
  std::function<void(const Error&)> end_not_recorded{};
  /// Called when, after an interruption or error, changes are being restored.
  std::function<void()> putting_back{};
};

/// The time limit for restoring after a first signal or an error.
inline constexpr Duration put_back_time = Session::put_back_grace;

/// The registers to read beforehand: those that are changed, and the commands. Errors: no_profile,
/// if the model is not known well enough to write to it.
[[nodiscard]] Result<std::vector<const bla::Parameter*>>
registers_to_characterize(const Servo& servo);

/// The reason why this servo must not be measured now, as far as the bus was heard; empty: it may.
/// Errors: why `before` is incomplete; cross_check (it is turning or exerting torque, which no
/// restart can bring back); those of forbidden().
[[nodiscard]] std::optional<Error>
refuse_to_characterize(const Session& session, const Snapshot& before, bool while_driven);

/// The question to the user beforehand: what will happen to this servo.
[[nodiscard]] std::string question_to_characterize(const Snapshot& before);

/// Measures, and restores what it changed, also after an interruption. `before` holds
/// registers_to_characterize().
[[nodiscard]] Characterization characterize(Session& session, const bla::Profiles& profiles,
                                            const Snapshot& before, const BenchManner& manner);

/// The facts file ("schema":"blactl-facts/1") for the measurements.
[[nodiscard]] std::string facts_file(const Characterization& measured, WallTime now,
                                     std::string_view tool_version);

} // namespace blactl::fleet
