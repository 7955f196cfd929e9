#pragma once
// Who is on the bus: nodes and servos, who waits for an ID, who commands, allocates, collides.

#include "blactl/bla/identity.hpp"
#include "blactl/dronecan/transfer.hpp"
#include "blactl/dronecan/types.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace blactl::fleet {

/// One node ID on the bus and what is known of the unit behind it.
struct Member {
  dronecan::NodeId id;
  Time first_heard{}, last_heard{};
  std::optional<dronecan::NodeStatus> status;
  Time status_at{};
  std::optional<std::uint8_t> actuator_id; ///< from actuator.Status: only servos send it
  std::uint32_t boots = 0;                 ///< restarts seen, by uptimes going backwards

  /// Answers to the questions of Identification.
  std::optional<dronecan::GetNodeInfo::Response> info;
  std::uint32_t info_boot = 0; ///< `boots` when `info` came
  bool is_servo = false;       ///< it answered register 0x50
  bla::Identity identity;
  std::optional<std::int64_t> servo_id, static_node_id;
  bool identified = false;           ///< Identification ended well
  std::uint32_t identified_boot = 0; ///< `boots` when it did

  [[nodiscard]] bool sends_actuator_status() const { return actuator_id.has_value(); }

  /// Identified, and not restarted since.
  [[nodiscard]] bool is_known() const { return identified && identified_boot == boots; }

  /// This unit said since its last restart that it has this unique ID.
  [[nodiscard]] bool is_unit(const dronecan::UniqueId& unique_id) const {
    return info && info_boot == boots && info->unique_id == unique_id;
  }
};

/// An unsettled allocation request: the part of the unique ID that was heard.
using UniqueIdPrefix = std::vector<std::uint8_t>;

/// Another node that moves servos: ArrayCommand, or writes to 0x00-0x02.
struct Commander {
  dronecan::NodeId source;
  std::map<std::uint8_t, Time> servo_ids; ///< by ArrayCommand; 255: every servo
  std::map<dronecan::NodeId, Time> nodes; ///< by GetSet
};

/// How long a command counts as "drives" (contract, section 4).
inline constexpr Duration driving_time = std::chrono::seconds(2);

class Roster {
 public:
  /// `local`: our own ID, whose frames are not those of a member.
  explicit Roster(dronecan::NodeId local) : local_(local) {}

  [[nodiscard]] dronecan::NodeId local() const { return local_; }

  /// Called for each ID when it is heard for the first time, and whenever its unit restarted: what
  /// was known of it may be another's.
  void on_new_unit(std::function<void(Member&)> hook) { new_unit_ = std::move(hook); }

  /// Every frame of other nodes: who lives, and who sends twice as often as one unit can.
  void hear(const can::Frame& frame, Time at);

  /// Every transfer heard.
  void receive(const dronecan::Transfer& transfer);

  /// Two answers to GetNodeInfo gave different unique IDs.
  void mark_doubled(dronecan::NodeId id) { doubled_.insert(id); }

  /// The member with this ID, heard or not; added if it is new.
  [[nodiscard]] Member& member(dronecan::NodeId id);
  /// Null: never heard and never asked for.
  [[nodiscard]] const Member* find(dronecan::NodeId id) const;

  [[nodiscard]] const std::map<dronecan::NodeId, Member>& members() const { return members_; }

  [[nodiscard]] std::map<dronecan::NodeId, Member>& members() { return members_; }

  [[nodiscard]] bool heard(dronecan::NodeId id) const { return heard_[id.value()]; }

  /// Two units use this ID, as far as heard.
  [[nodiscard]] bool is_doubled(dronecan::NodeId id) const;
  [[nodiscard]] std::set<dronecan::NodeId> doubled() const;

  [[nodiscard]] const std::set<UniqueIdPrefix>& pending() const { return pending_; }

  /// A unit with this unique ID asked for a node ID and got none.
  [[nodiscard]] bool is_pending(const dronecan::UniqueId& unique_id) const;

  [[nodiscard]] const std::set<dronecan::NodeId>& allocators() const { return allocators_; }

  [[nodiscard]] const std::map<dronecan::NodeId, Commander>& commanders() const {
    return commanders_;
  }

  /// A node whose last ArmingStatus says that the vehicle is armed.
  [[nodiscard]] std::optional<dronecan::NodeId> armed_by() const {
    return armed_.empty() ? std::nullopt : std::optional(*armed_.begin());
  }

  /// The node that drives this servo now, as far as heard.
  [[nodiscard]] std::optional<dronecan::NodeId> driver_of(const Member& servo, Time now) const;

 private:
  /// Two counters of uptime on one ID, and the rate of actuator.Status.
  struct Pulse {
    Time window_start{};
    unsigned count = 0;
    std::array<std::optional<Time>, 2> boots{}; ///< when the unit(s) behind the ID started
    std::size_t last_boot = 0;
    std::uint32_t last_uptime_s = 0;
  };

  void count_status(dronecan::NodeId source, Time at);
  void on_status(const dronecan::Transfer& transfer);
  void on_allocation(const dronecan::Transfer& transfer);
  void on_command(const dronecan::Transfer& transfer);
  void on_write(const dronecan::Transfer& transfer);
  [[nodiscard]] bool is_news(dronecan::NodeId source, std::uint32_t uptime_s, Time at) const;
  void watch_uptime(Member& member, std::uint32_t uptime_s, Time at);
  [[nodiscard]] bool has_restarted(Member& member, std::uint32_t uptime_s, Time at);
  Commander& commander(dronecan::NodeId source);
  [[nodiscard]] bool is_too_fast(dronecan::NodeId id) const;

  dronecan::NodeId local_;
  std::function<void(Member&)> new_unit_;
  std::map<dronecan::NodeId, Member> members_;
  std::array<bool, 128> heard_{};
  std::array<Pulse, 128> pulses_{};
  std::set<dronecan::NodeId> doubled_;
  std::set<dronecan::NodeId> too_fast_; ///< sent actuator.Status like two servos
  std::set<UniqueIdPrefix> pending_;
  std::set<dronecan::NodeId> allocators_;
  std::map<dronecan::NodeId, Commander> commanders_;
  std::set<dronecan::NodeId> armed_;
};

} // namespace blactl::fleet
