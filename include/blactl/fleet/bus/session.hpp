#pragma once
// One blactl process on one bus: the loop, our node, the roster, and jobs until they are done.

#include "blactl/base/error.hpp"
#include "blactl/can/loop.hpp"
#include "blactl/dronecan/node.hpp"
#include "blactl/dronecan/service.hpp"
#include "blactl/fleet/bus/replayed_jobs.hpp"
#include "blactl/fleet/bus/roster.hpp"
#include "blactl/fleet/bus/traffic.hpp"
#include "blactl/state/local_node_id.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace blactl::fleet {

/// The error of a process ended by one of these signals.
[[nodiscard]] Error interrupted_by(int signal);

class Session {
 public:
  /// The frames this session receives; a kernel filter drops the others.
  enum class Hearing : std::uint8_t {
    answers, ///< services for us, NodeStatus, actuator.Status, Allocation, and frames with our ID
    /// Also those that command and change servos: ArrayCommand, ArmingStatus, requests for GetSet,
    /// ExecuteOpcode and RestartNode.
    commands,
    all,
  };

  /// Without a local ID the session only listens. `profiles` outlive it.
  [[nodiscard]] static Result<std::unique_ptr<Session>>
  open(std::unique_ptr<can::Bus> bus, std::optional<state::LocalNodeId> local, Hearing hearing,
       const bla::Profiles& profiles);

  ~Session() = default;
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  [[nodiscard]] const Roster& roster() const { return roster_; }

  /// The roster for jobs, which enter responses.
  [[nodiscard]] Roster& records() { return roster_; }

  [[nodiscard]] dronecan::Node& node() { return node_; }

  [[nodiscard]] std::string_view interface() { return loop_.bus().name(); }

  [[nodiscard]] Time now() const { return loop_.now(); }

  /// The present wall time.
  [[nodiscard]] WallTime wall() const { return loop_.wall(); }

  /// The time at which the bus was opened and first heard.
  [[nodiscard]] Time opened() const { return opened_; }

  /// Whether the bus is a log: it provides the responses.
  [[nodiscard]] bool is_replay() const { return replay_.has_value(); }

  /// Whether it is, and all of it was heard.
  [[nodiscard]] bool has_played() const { return replay_ && replay_->finished(); }

  /// False: nothing is sent, for want of our own node ID.
  [[nodiscard]] bool may_ask() const { return node_.id().is_unicast() || replay_.has_value(); }

  /// Takes a servo from a file as if it had been heard. Only on a recording.
  void recall(const RecordedServo& recorded);

  /// Starts a job. On a recording it gets its responses from there, as soon as all of it was heard.
  void start(dronecan::Job& job);

  /// Ends a running job, with the outcome `cancelled`.
  void cancel(dronecan::Job& job) { node_.cancel(job, loop_.now()); }

  /// Starts these jobs and waits until they have ended; others go on. Errors: as live_until().
  [[nodiscard]] Result<void> run(std::span<dronecan::Job* const> jobs);

  /// Lets a service receive and act; it must live until detach().
  void attach(dronecan::Service& service) { services_.push_back(&service); }

  void detach(dronecan::Service& service) { std::erase(services_, &service); }

  /// Counts all frames from now on, including ours; null: stops counting. It must live as long as
  /// it counts.
  void count(Traffic* traffic) { traffic_ = traffic; }

  /// For a command that waits for servos: a bus without acknowledgements is not an error.
  void wait_alone() { waits_alone_ = true; }

  /// Called when a first signal comes while jobs run that must not be left half done: they have
  /// some grace to end. A second signal ends everything at once.
  void on_stopping(std::function<void()> hook) { stopping_ = std::move(hook); }

  /// Called for every request that is sent or gets no response; see dronecan::Node::Hooks.
  using RequestHook = std::function<void(const dronecan::Request&, int tries)>;

  void on_requests(RequestHook asked, RequestHook unanswered) {
    asked_ = std::move(asked);
    unanswered_ = std::move(unanswered);
  }

  /// Called when another node had our node ID and this one took a new one.
  using IdHook = std::function<void(const state::LocalNodeId&)>;

  void on_new_id(IdHook hook) { new_id_ = std::move(hook); }

  static constexpr Duration usual_grace = std::chrono::seconds(3);

  /// For a command that restores what it changed (contract, section 2).
  static constexpr Duration put_back_grace = std::chrono::seconds(10);

  /// Sets the grace of a command that restores what it changed: until it is over the session lives
  /// on after a first signal.
  void set_grace(Duration grace) { grace_ = grace; }

  /// Called when the interface goes away and is waited for, and when it is back; see away().
  void on_away(std::function<void()> hook) { away_hook_ = std::move(hook); }

  /// For a command that writes to servos: an interface that goes away ends what is being done, as
  /// bus-off does, so that nothing of it is sent when it is back. The session may go on.
  void break_off_when_away() { breaks_off_when_away_ = true; }

  /// The reason why the interface is away; empty: it is present.
  [[nodiscard]] const std::optional<Error>& away() const { return away_; }

  /// Waits until the bus is open, so that timeouts and listening times do not include an adapter's
  /// start. Our own node ID, unless it is one for tools, is listened for before it is used.
  [[nodiscard]] Result<void> wait_until_open();

  /// Runs until `deadline`; on a recording that is not played at its own pace, until all of it was
  /// heard, whatever the deadline. Errors of this, run() and wait_until_open(): interrupted,
  /// interface, bus_off, no_acknowledge, duplicate_node_id, no_local_node_id (others have our IDs);
  /// for a recording: bad_file. They end the session: every job is cancelled.
  [[nodiscard]] Result<void> live_until(Time deadline);

  /// Runs until `done` holds, which is checked after every event; returns whether it did before
  /// `deadline`.
  [[nodiscard]] Result<bool> live_until(Time deadline, const std::function<bool()>& done);

  /// Runs until no job is left.
  [[nodiscard]] Result<void> run();

  /// Calls `hook` whenever `descriptor` is readable, as long as the session lives; empty: stops
  /// that.
  void on_input(int descriptor, std::function<void()> hook);

  /// Called when the size of the terminal changes.
  void on_resize(std::function<void()> hook) { resized_ = std::move(hook); }

  /// Waits until `descriptor` (for the user's answer) is readable.
  [[nodiscard]] Result<void> wait_for_input(int descriptor);

  /// The signal that ended the session; 0: none.
  [[nodiscard]] int signal() const { return signal_; }

  /// A note on the opening of the bus; empty: none.
  [[nodiscard]] const std::string& opening_note() const { return opening_note_; }

  /// Whether any DroneCAN traffic was heard.
  [[nodiscard]] bool heard_anything() const { return heard_anything_; }

  /// The transport's reason why nothing was heard (see can::Bus).
  [[nodiscard]] std::optional<Error> silence() const { return loop_.bus().silence(); }

  /// Frames that the kernel dropped.
  [[nodiscard]] std::uint64_t lost_frames() const { return lost_; }

  /// Received items that were not frames of classic CAN.
  [[nodiscard]] std::uint64_t unreadable() const { return loop_.bus().unreadable(); }

  /// Our frames that were never acknowledged: the kernel may still send those it has.
  [[nodiscard]] std::size_t unsent() const { return loop_.unsent(); }

 private:
  Session(std::unique_ptr<can::Bus> bus, std::optional<state::LocalNodeId> local, Hearing hearing,
          const bla::Profiles& profiles);
  void begin_as_node();
  [[nodiscard]] Result<void> give_way();

  enum class Happened : std::uint8_t { something, deadline, input };
  [[nodiscard]] Result<Happened> step(Time deadline);
  [[nodiscard]] Result<Happened> take(const can::Event& event);
  void take_presence(std::optional<Error> away);
  [[nodiscard]] Result<Happened> take_frame(const can::Received& received);
  [[nodiscard]] Result<Happened> take_signal(int number);
  [[nodiscard]] Time next_deadline() const;
  void advance(Time now);
  [[nodiscard]] std::unexpected<Error> end(Error error);
  [[nodiscard]] Time acknowledge_deadline() const;

  [[nodiscard]] bool plays_at_once() const { return replay_ && !loop_.bus().is_paced(); }

  [[nodiscard]] Result<void> play();
  [[nodiscard]] Result<void> run_while(const std::function<bool()>& busy);

  std::optional<state::LocalNodeId> local_;
  Hearing hearing_;
  can::Loop loop_;
  Roster roster_;
  std::optional<ReplayedJobs> replay_; ///< on a recording
  dronecan::Node node_;
  std::vector<dronecan::Service*> services_;
  Traffic* traffic_ = nullptr;
  std::function<void()> stopping_, resized_;
  int input_ = -1; ///< for on_input()
  std::function<void()> input_hook_;
  std::function<void()> away_hook_;
  std::optional<Error> away_;
  RequestHook asked_, unanswered_;
  IdHook new_id_;
  bool waits_alone_ = false, breaks_off_when_away_ = false;
  int signal_ = 0;
  Duration grace_ = usual_grace;
  Time give_up_at_ = never; ///< after a signal: when running jobs are abandoned
  std::uint64_t lost_ = 0;
  Time opened_{};
  std::string opening_note_;
  bool heard_anything_ = false;
};

} // namespace blactl::fleet
