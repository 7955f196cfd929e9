#pragma once
// The nodes on the bus: servos and others, units waiting for an ID, commanding and allocating
// nodes, collisions.

#include "blactl/bla/identity.hpp"
#include "blactl/dronecan/answer_watch.hpp"
#include "blactl/dronecan/transfer.hpp"
#include "blactl/dronecan/types.hpp"
#include "blactl/fleet/bus/allocation_watch.hpp"
#include "blactl/fleet/bus/command_watch.hpp"
#include "blactl/fleet/bus/servo.hpp"
#include "blactl/fleet/bus/unit_watch.hpp"
#include "blactl/state/allocation_store.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace blactl::fleet {

/// A node sends NodeStatus at least once a second; after this silence it is offline
/// (uavcan/protocol/341.NodeStatus).
inline constexpr Duration offline_time = std::chrono::seconds(3);

/// One node ID on the bus and the facts about its unit.
struct Member {
  dronecan::NodeId id{};
  Time first_heard{}, last_heard{};
  Time back_at{};      ///< its first frame after a silence in which another unit may have come
  Time missed_until{}; ///< likewise, in which it may have been saved, restarted and written to
  std::optional<dronecan::NodeStatus> status{}; ///< the newest, from NodeStatus or a response
  Time status_at{};
  std::optional<std::uint8_t> actuator_id{}; ///< from actuator.Status: only servos send it
  Time actuator_at{};                        ///< when it was last sent
  std::uint32_t boots = 0;                   ///< restarts seen, by uptimes going backwards

  /// From Roster::learn().
  std::optional<dronecan::GetNodeInfo::Response> info{};
  std::optional<dronecan::UniqueId> told_unique_id{}; ///< from a file, in place of `info`
  std::uint32_t info_boot = 0;                        ///< `boots` when `info` came
  Time info_at{};                                     ///< when `info` came
  Time info_start{};                                  ///< start of the unit, by the uptime in it
  bool is_servo = false;                              ///< it responded to register 0x50
  bla::Identity identity{};
  std::optional<std::int64_t> servo_id{}, static_node_id{};
  bool id_is_known = true;           ///< Servo::id_is_known
  bool identified = false;           ///< learn() was called with everything
  std::uint32_t identified_boot = 0; ///< `boots` at that time
  Time since{};                      ///< Servo::since
  bool is_young = false;             ///< Servo::is_young

  [[nodiscard]] bool sends_actuator_status() const { return actuator_id.has_value(); }

  [[nodiscard]] std::optional<dronecan::UniqueId> unique_id() const {
    return info ? std::optional(info->unique_id) : told_unique_id;
  }

  /// As it last told it.
  [[nodiscard]] std::optional<dronecan::Health> health() const {
    return status ? std::optional(status->health) : std::nullopt;
  }

  /// What it told of itself in the offline_time before `at`; empty: it may be otherwise by now.
  [[nodiscard]] std::optional<dronecan::NodeStatus> status_as_of(Time at) const {
    return at - status_at < offline_time ? status : std::nullopt;
  }

  /// Identified, and not restarted since.
  [[nodiscard]] bool is_known() const { return identified && identified_boot == boots; }

  /// Whether the unit has responded with this unique ID since its last restart.
  [[nodiscard]] bool is_unit(const dronecan::UniqueId& unique_id) const {
    return info && info_boot == boots && info->unique_id == unique_id;
  }

  /// Whether it has responded with another one.
  [[nodiscard]] bool is_another_unit(const dronecan::UniqueId& unique_id) const {
    return info && info_boot == boots && info->unique_id != unique_id;
  }

  /// Whether another unit may have come in a silence since this one told its unique ID.
  [[nodiscard]] bool may_be_another() const {
    return info && info_boot == boots && back_at > info_at;
  }

  /// Whether it has identified itself as another device than a BLA servo.
  [[nodiscard]] bool is_foreign() const { return identified && !is_servo && info; }

  /// The ID by which ArrayCommand reaches it: 0x45 of a servo, or what an actuator of another make
  /// sends; empty: unknown.
  [[nodiscard]] std::optional<std::int64_t> commanded_id() const {
    return is_foreign() ? std::optional<std::int64_t>(actuator_id) : servo_id;
  }

  /// The present knowledge of the unit.
  [[nodiscard]] Servo servo() const;
};

/// The listening time after which commanders, armed vehicles, shared IDs and used IDs have been
/// heard.
inline constexpr Duration bus_watch_time = std::chrono::milliseconds(1100);

/// The longest start of a servo, in which nobody can write to it (unproven).
inline constexpr Duration usual_start = std::chrono::milliseconds(500);

/// A servo sends actuator.Status every 100 ms (table 2-2): another unit that is switched on in its
/// place keeps silent for longer (unproven).
inline constexpr Duration longest_pause = std::chrono::milliseconds(150);

/// Commands that keep watching read a shared ID again when nothing has shown two units there for
/// this time.
inline constexpr Duration doubt_time = std::chrono::seconds(10);

/// The nodes on the bus. The session enters what is heard, and jobs enter the responses; all others
/// only read it.
class Roster {
 public:
  /// Listens for new units.
  class Listener {
   public:
    virtual ~Listener() = default;
    Listener(const Listener&) = delete;
    Listener& operator=(const Listener&) = delete;

    /// A node was heard for the first time, or its unit restarted: earlier facts may be about
    /// another unit.
    virtual void on_new_unit(const Member& member) = 0;

   protected:
    Listener() = default;
  };

  /// `local`: our own ID, whose frames are ignored. `profiles` outlive this.
  Roster(dronecan::NodeId local, const bla::Profiles& profiles);
  ~Roster() = default;
  Roster(const Roster&) = delete;
  Roster& operator=(const Roster&) = delete;

  [[nodiscard]] dronecan::NodeId local() const { return local_; }

  [[nodiscard]] const bla::Profiles& profiles() const { return profiles_; }

  void change_local(dronecan::NodeId local) { local_ = local; }

  /// The listener must live until remove(). Listeners may be added and removed at any time.
  void add(Listener& listener) { listeners_.push_back(&listener); }

  void remove(Listener& listener) { std::erase(listeners_, &listener); }

  /// Takes every frame of other nodes: for presence, and to find those that send twice as often as
  /// one unit can.
  void hear(const can::Frame& frame, Time at);

  /// Takes every frame of ours that has left.
  void hear_own(const can::Frame& frame, Time at);

  /// As UnitWatch::lose_time().
  void lose_time() { std::ranges::for_each(watches_, &UnitWatch::lose_time); }

  /// Whether what comes now has waited, nobody knows how long: its times tell nothing of uptimes
  /// and rates.
  void be_late(bool is_late);

  void receive(const dronecan::Transfer& transfer);

  /// As AllocationWatch::give().
  void give(const dronecan::UniqueId& unit, Time at) { allocations_.give(unit, at); }

  /// As CommandWatch::ask().
  void ask(const dronecan::Request& request, Time at) { commands_.ask(request, at); }

  /// The unit behind `id` responded to GetNodeInfo: earlier facts may be about another unit.
  void learn(dronecan::NodeId id, const dronecan::GetNodeInfo::Response& info, Time at);

  /// Takes an identification; `servo.boot` is that of its GetNodeInfo, and may be outdated.
  void learn(const Servo& servo, const std::optional<dronecan::GetNodeInfo::Response>& info);

  /// Takes a servo from a file as if it had been heard.
  void recall(const Servo& servo);

  /// The servo of this node was recognised after a restart, as `servo`, with the IDs it has now:
  /// the rest of its earlier identification stays valid.
  void learn_run(const Servo& servo);

  /// Takes the static node ID of a node, as read or written.
  void learn_static_node_id(dronecan::NodeId id, std::optional<std::int64_t> static_node_id);

  /// Two responses to GetNodeInfo had different unique IDs.
  void mark_doubled(dronecan::NodeId id, const dronecan::UniqueId& one,
                    const dronecan::UniqueId& other);

  /// Null: never heard and never learnt.
  [[nodiscard]] const Member* find(dronecan::NodeId id) const;

  /// The facts about this ID; empty for one that was never heard.
  [[nodiscard]] Member member(dronecan::NodeId id) const;

  [[nodiscard]] const std::map<dronecan::NodeId, Member>& members() const { return members_; }

  /// Whether its unit has started since this member was last heard, and is under another ID.
  [[nodiscard]] bool has_moved(const Member& member) const;

  /// Further node IDs whose servos, running at the same time, have the unique ID of this one.
  [[nodiscard]] std::vector<dronecan::NodeId> copies(dronecan::NodeId id) const;

  [[nodiscard]] bool heard(dronecan::NodeId id) const { return heard_[id.value()]; }

  /// The time of the last frame of any other node. What has come by then was heard, however late
  /// this process reads.
  [[nodiscard]] Time last_heard() const;

  /// Whether two units use this ID, as far as heard.
  [[nodiscard]] bool is_doubled(dronecan::NodeId id) const;
  [[nodiscard]] std::set<dronecan::NodeId> doubled() const;

  /// Forgets the shared IDs on which nothing has shown two units since then. The unit that is left
  /// has to be identified, as after a restart. For commands that keep watching: those that change
  /// servos do not forget.
  void forget_doubled(Time since);

  /// From now on another unit that shows after a silence has taken the place of the one before it;
  /// else they are two. Two that are there at once leave no silence. For commands that only look.
  void accept_exchanges() { accepts_exchanges_ = true; }

  /// Forgets the nodes that were not heard since then: another unit that comes on such an ID is no
  /// second one; and allocators that have been silent. For a command that sees one servo
  /// after the other.
  void forget_gone(Time since);

  /// The unique IDs of the units that use this ID, if two were received; else none.
  [[nodiscard]] std::set<dronecan::UniqueId> units(dronecan::NodeId id) const;

  /// The IDs that this unit cannot have: those under which any frame of another was heard, those
  /// that others have in 0x46, and our own.
  [[nodiscard]] state::NodeIds ids_in_use(const dronecan::UniqueId& unit) const;

  /// As AllocationWatch::pending().
  [[nodiscard]] std::vector<UniqueIdPrefix> pending() const { return allocations_.pending(); }

  [[nodiscard]] const std::map<UniqueIdPrefix, Asking>& requests() const {
    return allocations_.requests();
  }

  /// Whether a unit with this unique ID has asked for a node ID and got none.
  [[nodiscard]] bool is_pending(const dronecan::UniqueId& unique_id) const {
    return asked_at(unique_id).has_value();
  }

  /// As AllocationWatch::asked_at().
  [[nodiscard]] std::optional<Time> asked_at(const dronecan::UniqueId& unique_id) const {
    return allocations_.asked_at(unique_id);
  }

  [[nodiscard]] std::set<dronecan::NodeId> allocators() const { return allocations_.allocators(); }

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

  /// The latest possible start of this node's unit, by its last uptime; empty: none was received.
  [[nodiscard]] std::optional<Time> started(dronecan::NodeId id) const {
    return watches_[id.value()].started();
  }

  /// As CommandWatch::giver_of(), with a static node ID; also an allocator that has just given it
  /// to another unit than that of `except`.
  [[nodiscard]] std::optional<dronecan::NodeId> giver_of(dronecan::NodeId given,
                                                         dronecan::NodeId except, Time since) const;

  /// Who is meant by what servos tell of themselves, and which nodes those were: what answers there
  /// later may be another unit.
  void choose(std::set<dronecan::NodeId> nodes, std::function<bool(const Servo&)> is_meant) {
    chosen_ = std::move(nodes);
    is_meant_ = std::move(is_meant);
  }

  /// Whether another unit is in the place of one that was chosen.
  [[nodiscard]] bool is_exchanged(const Servo& servo) const {
    return chosen_.contains(servo.id) && !is_meant_(servo);
  }

  /// Another node that has written the servo ID of this servo since it told it first: who is meant
  /// may have been told by that.
  [[nodiscard]] std::optional<dronecan::NodeId> renumbered_by(const Servo& servo) const;

  /// A node that was first heard after `since`, sends this servo ID, and is none of the units
  /// `own`; one that has not told yet who it is may be any.
  [[nodiscard]] const Member* newcomer_with(std::int64_t servo_id, Time since,
                                            dronecan::NodeId except,
                                            const std::set<dronecan::UniqueId>& own) const;

  /// As CommandWatch::giver_of(), with a servo ID.
  [[nodiscard]] std::optional<dronecan::NodeId>
  giver_of_servo_id(std::int64_t given, dronecan::NodeId except, Time since) const {
    return commands_.giver_of(bla::address::servo_id, given, except, since);
  }

  /// As CommandWatch::setter_of().
  [[nodiscard]] std::optional<dronecan::NodeId>
  setter_of(dronecan::NodeId id, Time since, std::optional<bla::Address> reg = std::nullopt) const {
    return commands_.setter_of(id, since, reg);
  }

  /// As CommandWatch::writer_to().
  [[nodiscard]] std::optional<dronecan::NodeId>
  writer_to(dronecan::NodeId id, Time since, std::optional<bla::Address> reg = std::nullopt) const {
    return commands_.writer_to(id, since, reg);
  }

  /// As CommandWatch::written_to().
  [[nodiscard]] std::vector<CommandWatch::Written> written_to(dronecan::NodeId id,
                                                              Time since) const {
    return commands_.written_to(id, since);
  }

  /// As CommandWatch::saver_of().
  [[nodiscard]] std::optional<dronecan::NodeId> saver_of(dronecan::NodeId id, Time since) const {
    return commands_.saver_of(id, since);
  }

  /// Another node that commanded this servo to move after `since`, as far as heard.
  [[nodiscard]] std::optional<dronecan::NodeId> commander_of(const Servo& servo, Time since) const;

  /// As CommandWatch::commander_of_id().
  [[nodiscard]] std::optional<dronecan::NodeId> commander_of_id(std::int64_t servo_id,
                                                                Time now) const {
    return commands_.commander_of_id(servo_id, now);
  }

  /// The node that drives this servo now, as far as heard.
  [[nodiscard]] std::optional<dronecan::NodeId> driver_of(const Servo& servo, Time now) const;

 private:
  [[nodiscard]] Member& known(dronecan::NodeId id);
  void announce(const Member& member);
  void hear_request(const dronecan::Header& header, const can::Frame& frame, Time at);
  void hear_status(Member& sender, const can::Frame& frame, Time at);
  void on_status(const dronecan::Transfer& transfer);
  void greet(const Member& sender, Time at);
  void take(UnitWatch::Start start, Member& sender, Time heard_before);
  void begin_anew(dronecan::NodeId id);
  [[nodiscard]] std::optional<Time> doubled_at(dronecan::NodeId id) const;
  void begin_unit(Member& member);

  dronecan::NodeId local_;
  const bla::Profiles& profiles_;
  std::vector<Listener*> listeners_;
  std::map<dronecan::NodeId, Member> members_;
  std::array<bool, 128> heard_{};
  std::map<dronecan::UniqueId, Time> first_told_; ///< when units were first asked for their IDs
  std::set<dronecan::NodeId> chosen_;
  std::function<bool(const Servo&)> is_meant_;
  std::array<UnitWatch, 128> watches_{};
  CommandWatch commands_;
  dronecan::AnswerWatch answers_;
  std::map<dronecan::NodeId, Time> doubled_; ///< when that last showed
  bool accepts_exchanges_ = false;
  bool is_late_ = false;                                           ///< what is heard has waited
  std::map<dronecan::NodeId, std::set<dronecan::UniqueId>> units_; ///< of doubled IDs
  AllocationWatch allocations_;
};

} // namespace blactl::fleet
