#pragma once
// Writes registers of one identified servo and proves each by its answer and by reading it again.

#include "blactl/bla/parameter.hpp"
#include "blactl/dronecan/node.hpp"
#include "blactl/fleet/registers.hpp"
#include "blactl/fleet/roster.hpp"

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace blactl::fleet {

/// The words of the contract, section 5, `set`.
enum class ChangeStatus : std::uint8_t { planned, unchanged, written, failed, mismatch };
[[nodiscard]] std::string_view name(ChangeStatus status);

/// One register from what to what; register numbers.
struct Change {
  const bla::Parameter* parameter = nullptr;
  std::int64_t requested = 0;
  std::optional<std::int64_t> before{}, after{};
  ChangeStatus status = ChangeStatus::planned;
  std::optional<Error> error{};
};

/// Sends the planned changes in order; those that hold the value already are `unchanged` before.
/// An answer may show a clamped or refused value (requirement 73), so the register is read again
/// after each write. If the servo restarted since it was identified, its unique ID is asked again
/// before the next write, and what was written before is written again: it was in RAM only.
class WriteJob : public dronecan::Job {
 public:
  /// `member` has been identified; all references outlive the job.
  WriteJob(Member& member, std::vector<Change> changes, Patience patience);

  [[nodiscard]] dronecan::Step next(const dronecan::Outcome& outcome) override;

  [[nodiscard]] const Member& member() const { return member_; }

  [[nodiscard]] const std::vector<Change>& changes() const { return changes_; }

 private:
  enum class Step : std::uint8_t { begin, unique_id, write, read };

  [[nodiscard]] std::optional<dronecan::Request> go_on();
  [[nodiscard]] std::optional<dronecan::Request> read_back();
  void begin_again();
  void doubt_unchanged();
  [[nodiscard]] bool same_servo(const dronecan::Outcome& outcome);
  void judge(const dronecan::Outcome& outcome);
  void give_up(Error error);

  Member& member_;
  std::vector<Change> changes_;
  Patience patience_;
  Step step_ = Step::begin;
  std::size_t at_ = 0;
  std::uint32_t boot_;
  int restarts_ = 0; ///< seen while writing
};

} // namespace blactl::fleet
