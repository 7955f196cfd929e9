#pragma once
// Who is on the bus: nodes and servos, who waits for an ID, who commands, allocates, collides.

#include "blactl/bla/identity.hpp"
#include "blactl/dronecan/answer_watch.hpp"
#include "blactl/dronecan/transfer.hpp"
#include "blactl/dronecan/types.hpp"
#include "blactl/fleet/bus/command_watch.hpp"
#include "blactl/fleet/bus/servo.hpp"
#include "blactl/fleet/bus/unit_watch.hpp"
#include "blactl/state/allocation_store.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace blactl::fleet {

/// One node ID on the bus and what is known of the unit behind it.
struct Member {
  dronecan::NodeId id{};
  Time first_heard{}, last_heard{};
  std::optional<dronecan::NodeStatus> status{}; ///< the newest, heard or answered
  Time status_at{};
  std::optional<std::uint8_t> actuator_id{}; ///< from actuator.Status: only servos send it
  std::uint32_t boots = 0;                   ///< restarts seen, by uptimes going backwards

  /// What Roster::learn() was told.
  std::optional<dronecan::GetNodeInfo::Response> info{};
  std::optional<dronecan::UniqueId> told_unique_id{}; ///< by a file, in place of `info`
  std::uint32_t info_boot = 0;                        ///< `boots` when `info` came
  Time info_at{};                                     ///< when `info` came
  Time info_start{};     ///< when the unit started, by the uptime that came with it
  bool is_servo = false; ///< it answered register 0x50
  bla::Identity identity{};
  std::optional<std::int64_t> servo_id{}, static_node_id{};
  bool id_is_known = true;           ///< Servo::id_is_known
  bool identified = false;           ///< learn() was told all
  std::uint32_t identified_boot = 0; ///< `boots` when it did
  Time since{};                      ///< Servo::since

  [[nodiscard]] bool sends_actuator_status() const { return actuator_id.has_value(); }

  [[nodiscard]] std::optional<dronecan::UniqueId> unique_id() const {
    return info ? std::optional(info->unique_id) : told_unique_id;
  }

  /// Identified, and not restarted since.
  [[nodiscard]] bool is_known() const { return identified && identified_boot == boots; }

  /// This unit said since its last restart that it has this unique ID.
  [[nodiscard]] bool is_unit(const dronecan::UniqueId& unique_id) const {
    return info && info_boot == boots && info->unique_id == unique_id;
  }

  /// It said that it is another one.
  [[nodiscard]] bool is_another_unit(const dronecan::UniqueId& unique_id) const {
    return info && info_boot == boots && info->unique_id != unique_id;
  }

  /// What is known of the unit now.
  [[nodiscard]] Servo servo() const;
};

/// An unsettled allocation request: the part of the unique ID that was heard.
using UniqueIdPrefix = std::vector<std::uint8_t>;

/// A node sends NodeStatus once a second at least; one that was not heard for so long is offline
/// (uavcan/protocol/341.NodeStatus).
inline constexpr Duration offline_time = std::chrono::seconds(3);

/// How long to listen until who commands, says armed, shares an ID or has one has been heard.
inline constexpr Duration bus_watch_time = std::chrono::milliseconds(1100);

/// Who is on the bus. A session tells it what is heard and jobs tell it what they were answered;
/// everybody else only reads it.
class Roster {
 public:
  /// Somebody who wants to know at once.
  class Listener {
   public:
    virtual ~Listener() = default;
    Listener(const Listener&) = delete;
    Listener& operator=(const Listener&) = delete;

    /// A node was heard for the first time, or its unit restarted: what was known of it may be
    /// another's.
    virtual void on_new_unit(const Member& member) = 0;

   protected:
    Listener() = default;
  };

  /// `local`: our own ID, whose frames are not those of a member. `profiles` outlive this.
  Roster(dronecan::NodeId local, const bla::Profiles& profiles);
  ~Roster() = default;
  Roster(const Roster&) = delete;
  Roster& operator=(const Roster&) = delete;

  [[nodiscard]] dronecan::NodeId local() const { return local_; }

  [[nodiscard]] const bla::Profiles& profiles() const { return profiles_; }

  void change_local(dronecan::NodeId local) { local_ = local; }

  /// It must live until remove(). Listeners may be added and removed at any time.
  void add(Listener& listener) { listeners_.push_back(&listener); }

  void remove(Listener& listener) { std::erase(listeners_, &listener); }

  /// Every frame of other nodes: who lives, and who sends twice as often as one unit can.
  void hear(const can::Frame& frame, Time at);

  /// Every transfer heard.
  void receive(const dronecan::Transfer& transfer);

  /// The unit behind `id` answered GetNodeInfo: whatever was known may have been another's.
  void learn(dronecan::NodeId id, const dronecan::GetNodeInfo::Response& info, Time at);

  /// What a node said of itself; `servo.boot` is that of its GetNodeInfo, which may be over.
  void learn(const Servo& servo, const std::optional<dronecan::GetNodeInfo::Response>& info);

  /// What a file says of a servo counts as if it had been heard.
  void recall(const Servo& servo);

  /// The servo of this node was recognised after a restart, as `servo` says: what it said of
  /// itself before holds on.
  void learn_run(const Servo& servo);

  /// The static node ID that a node has now, as it was read or written.
  void learn_static_node_id(dronecan::NodeId id, std::optional<std::int64_t> static_node_id);

  /// Two answers to GetNodeInfo gave different unique IDs.
  void mark_doubled(dronecan::NodeId id, const dronecan::UniqueId& one,
                    const dronecan::UniqueId& other);

  /// Null: never heard and never learnt of.
  [[nodiscard]] const Member* find(dronecan::NodeId id) const;

  /// What is known of this ID; of one that was never heard nothing is.
  [[nodiscard]] Member member(dronecan::NodeId id) const;

  [[nodiscard]] const std::map<dronecan::NodeId, Member>& members() const { return members_; }

  /// Since this member was heard last, its unit said under another ID who it is.
  [[nodiscard]] bool has_moved(const Member& member) const;

  [[nodiscard]] bool heard(dronecan::NodeId id) const { return heard_[id.value()]; }

  /// Two units use this ID, as far as heard.
  [[nodiscard]] bool is_doubled(dronecan::NodeId id) const;
  [[nodiscard]] std::set<dronecan::NodeId> doubled() const;

  /// The unique IDs of the units that use this ID, where two told theirs; else none.
  [[nodiscard]] std::set<dronecan::UniqueId> units(dronecan::NodeId id) const;

  /// What this unit cannot be given: IDs of which any frame of another was heard, those that others
  /// have in 0x46, and our own.
  [[nodiscard]] state::NodeIds ids_in_use(const dronecan::UniqueId& unit) const;

  [[nodiscard]] const std::set<UniqueIdPrefix>& pending() const { return pending_; }

  /// A unit with this unique ID asked for a node ID and got none.
  [[nodiscard]] bool is_pending(const dronecan::UniqueId& unique_id) const;

  [[nodiscard]] const std::set<dronecan::NodeId>& allocators() const { return allocators_; }

  [[nodiscard]] const std::map<dronecan::NodeId, Commander>& commanders() const {
    return commands_.commanders();
  }

  /// As CommandWatch::said_armed().
  [[nodiscard]] std::optional<dronecan::NodeId> said_armed() const {
    return commands_.said_armed();
  }

  /// As CommandWatch::armed_by().
  [[nodiscard]] std::optional<dronecan::NodeId> armed_by(Time now) const {
    return commands_.armed_by(now);
  }

  /// When the unit of this node started at the latest, by its last uptime; empty: it told none.
  [[nodiscard]] std::optional<Time> started(dronecan::NodeId id) const {
    return watches_[id.value()].started();
  }

  /// As CommandWatch::writer_to().
  [[nodiscard]] std::optional<dronecan::NodeId>
  writer_to(dronecan::NodeId id, Time since, std::optional<bla::Address> reg = std::nullopt) const {
    return commands_.writer_to(id, since, reg);
  }

  /// Another node that commanded this servo to move after `since`, as far as heard.
  [[nodiscard]] std::optional<dronecan::NodeId> commander_of(const Servo& servo, Time since) const;

  /// The node that drives this servo now, as far as heard.
  [[nodiscard]] std::optional<dronecan::NodeId> driver_of(const Servo& servo, Time now) const;

 private:
  [[nodiscard]] Member& known(dronecan::NodeId id);
  void announce(const Member& member);
  void hear_status(Member& sender, const can::Frame& frame, Time at);
  void on_status(const dronecan::Transfer& transfer);
  void on_allocation(const dronecan::Transfer& transfer);
  void take(UnitWatch::Start start, Member& sender);
  [[nodiscard]] bool is_too_fast(dronecan::NodeId id) const;

  dronecan::NodeId local_;
  const bla::Profiles& profiles_;
  std::vector<Listener*> listeners_;
  std::map<dronecan::NodeId, Member> members_;
  std::array<bool, 128> heard_{};
  std::array<UnitWatch, 128> watches_{};
  CommandWatch commands_;
  dronecan::AnswerWatch answers_;
  std::set<dronecan::NodeId> doubled_;
  std::map<dronecan::NodeId, std::set<dronecan::UniqueId>> units_; ///< of doubled IDs
  std::set<UniqueIdPrefix> pending_;
  std::set<dronecan::NodeId> allocators_;
};

} // namespace blactl::fleet
