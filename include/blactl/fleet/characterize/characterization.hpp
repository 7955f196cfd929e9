#pragma once
// Measures on one servo on the bench what the specification leaves open, and leaves it as it was.
//
// What there is to ask is a table, open_questions(): each is a setting of the simulator that is
// unproven (sim/behaviour.hpp), by its key in a facts file. What is measured is done in three
// phases: what only reads; what writes to RAM while the output is off; starts, for which the servo
// restarts and saves what its ROM holds already.

#include "blactl/base/text.hpp"
#include "blactl/fleet/bus/identification.hpp"
#include "blactl/fleet/bus/read_job.hpp"
#include "blactl/fleet/bus/session.hpp"
#include "blactl/fleet/bus/snapshot.hpp"
#include "blactl/state/allocation_store.hpp"

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace blactl::fleet {

/// A setting that only a real servo could settle.
struct OpenQuestion {
  std::string_view setting; ///< its key in a facts file
  Text what;                ///< what it says
  Text reason;              ///< why it is not measured, as long as nothing else is known
};

/// In the order of the table that people see.
[[nodiscard]] std::span<const OpenQuestion> open_questions();

/// A flag; or a word or a time: "clamp", "80ms".
using FactValue = std::variant<bool, std::string>;

struct Fact {
  std::string_view setting;
  std::optional<FactValue> value{}; ///< empty: not measured
  std::string reason{};             ///< why it was not
};

/// What was seen and is no setting: the name of the node, how long starts took.
struct Observation {
  std::string what, value;
};

/// What a servo says of itself in GetNodeInfo.
struct NodeInfo {
  std::string name; ///< foreign bytes
  std::uint8_t software_major = 0, software_minor = 0, hardware_major = 0, hardware_minor = 0;
};

struct Characterization {
  Servo servo;             ///< as it is now
  std::vector<Fact> facts; ///< one of each open question, in their order
  std::vector<Observation> observations{};
  std::optional<NodeInfo> info{};
  /// Why it was not finished.
  std::optional<Error> error{};
  /// What it could not be given back; empty: it is as it was.
  std::optional<Error> not_put_back{};
  /// Something was changed, and put back.
  bool was_put_back = false;

  [[nodiscard]] bool is_done() const { return !error && !not_put_back; }
};

/// How it is treated.
struct BenchManner {
  Identification::Options identification{};
  bool while_driven = false;
  /// Nobody else of this machine allocates on the interface: this process may.
  bool may_allocate = false;
  std::function<Result<state::AllocationStore>()> allocations{}; ///< as Manner::allocations
  std::function<void(const std::string&)> progress{};            ///< what is measured now
  /// It was interrupted, or failed, and what was changed is put back.
  std::function<void()> putting_back{};
};

/// How long putting back may take after a first signal, or an error.
inline constexpr Duration put_back_time = Session::put_back_grace;

/// The registers that must be known before: what is changed, and what it is commanded.
/// Errors: no_profile, where the model is not known well enough to write to it.
[[nodiscard]] Result<std::vector<const bla::Parameter*>>
registers_to_characterize(const Servo& servo);

/// Why this servo must not be measured now, as far as the bus was heard; empty: it may. Errors: why
/// `before` is not complete; cross_check (it turns, or pushes: no restart can give that back); as
/// forbidden().
[[nodiscard]] std::optional<Error>
refuse_to_characterize(const Session& session, const Snapshot& before, bool while_driven);

/// The question before it: what will happen to this servo.
[[nodiscard]] std::string question_to_characterize(const Snapshot& before);

/// Measures, and puts back what it changed, also where it is interrupted. `before` holds
/// registers_to_characterize().
[[nodiscard]] Characterization characterize(Session& session, const bla::Profiles& profiles,
                                            const Snapshot& before, const BenchManner& manner);

/// The facts file ("schema":"blactl-facts/1") of what was measured.
[[nodiscard]] std::string facts_file(const Characterization& measured, WallTime now,
                                     std::string_view tool_version);

} // namespace blactl::fleet
