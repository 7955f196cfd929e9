#pragma once
// Identifies one servo and reads registers of it.

#include "blactl/fleet/identification.hpp"

#include <functional>
#include <vector>

namespace blactl::fleet {

/// What one register held: its number, narrowed to its width, or why it is not known.
struct Reading {
  const bla::Parameter* parameter = nullptr;
  Result<std::int64_t> raw;
};

class ReadJob : public dronecan::Job {
 public:
  /// The registers to read of a servo, once it is identified.
  /// Errors: whatever makes reading pointless; nothing is read then.
  using Plan = std::function<Result<std::vector<const bla::Parameter*>>(const Member& servo)>;

  ReadJob(Roster& roster, Member& member, const bla::Profiles& profiles,
          Identification::Options options, Plan plan);

  [[nodiscard]] dronecan::Step next(const dronecan::Outcome& outcome) override;

  [[nodiscard]] const Member& member() const { return member_; }

  /// In the order of the plan.
  [[nodiscard]] const std::vector<Reading>& readings() const { return readings_; }

  /// Why the servo was not identified, is no BLA servo, or the plan was refused.
  [[nodiscard]] const std::optional<Error>& error() const { return error_; }

  /// What register `address` held, if it was read.
  [[nodiscard]] std::optional<std::int64_t> raw(bla::Address address) const;

 private:
  [[nodiscard]] std::optional<dronecan::Request> make_plan();
  [[nodiscard]] std::optional<dronecan::Request> read_next();

  Member& member_;
  Patience patience_;
  Identification identification_;
  Plan plan_;
  std::vector<const bla::Parameter*> wanted_;
  std::vector<Reading> readings_;
  std::optional<Error> error_;
};

} // namespace blactl::fleet
