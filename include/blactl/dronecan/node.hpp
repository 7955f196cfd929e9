#pragma once
// This process as a DroneCAN node: its own services, and requests to other nodes as jobs.

#include "blactl/base/time.hpp"
#include "blactl/can/frame.hpp"
#include "blactl/dronecan/transfer.hpp"
#include "blactl/dronecan/transfer_ids.hpp"
#include "blactl/dronecan/types.hpp"

#include <functional>
#include <list>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace blactl::dronecan {

/// One request to one node.
struct Request {
  NodeId server;
  const DataType* type = nullptr;
  Payload payload;
  Duration timeout = std::chrono::milliseconds(500); ///< servers answer within 0.5 s (spec. 4.1)
  int retries = 2;                                   ///< further tries, each with a new transfer ID
  Priority priority = priority_service;
  /// Whether a payload answers this request (has its parameter name); empty: any does.
  std::function<bool(Bytes)> accepts;
  /// Asked before each sending, repetitions included: whether it may leave now; empty: it may.
  std::function<bool(Time)> may_leave{};
};

/// The outcome of a request or a pause.
struct Outcome {
  enum class Kind : std::uint8_t {
    start,     ///< no request yet
    answered,  ///< `payload` is the answer
    timed_out, ///< the request was sent, no answer came
    not_sent,  ///< the request did not leave this machine in time; the kernel may still send it
    withheld,  ///< `may_leave` kept it back before it was sent once
    woken,     ///< the pause is over
    cancelled,
    not_recorded, ///< the bus is a recording that does not hold the answer
  };

  Kind kind = Kind::start;
  Bytes payload; ///< valid during the call
  Time at{};     ///< when the answer's first frame came, or the wait ended
  Time asked{};  ///< when the answered request went to the bus

  [[nodiscard]] bool answered() const { return kind == Kind::answered; }
};

/// A pause of a job. It ends (`woken`) as soon as `ready` holds after a received transfer, at
/// `until` at the latest.
struct Pause {
  Time until = never;
  std::function<bool()> ready{}; ///< empty: only the time counts
};

/// The next step of a job: a request, a pause, or neither when it has ended.
class Step {
 public:
  Step(std::nullopt_t) {} // NOLINT: reads as "nothing"

  Step(Request request) : step_(std::move(request)) {} // NOLINT: is a step

  Step(Pause pause) : step_(std::move(pause)) {} // NOLINT: is a step

  Step(std::optional<Request> request) { // NOLINT: is a step
    if (request) {
      step_ = std::move(*request);
    }
  }

  [[nodiscard]] const Request* request() const { return std::get_if<Request>(&step_); }

  [[nodiscard]] const Pause* pause() const { return std::get_if<Pause>(&step_); }

  [[nodiscard]] bool is_end() const { return std::holds_alternative<std::monostate>(step_); }

 private:
  std::variant<std::monostate, Request, Pause> step_;
};

/// A conversation with one node: given the outcome of the last step, the next one.
class Job {
 public:
  virtual ~Job() = default;
  Job(const Job&) = delete;
  Job& operator=(const Job&) = delete;

  [[nodiscard]] virtual Step next(const Outcome& outcome) = 0;

  /// Whether it has begun work that must be completed (a ROM write): Node::stop() lets it go on.
  [[nodiscard]] virtual bool must_finish() const { return false; }

 protected:
  Job() = default;
};

/// A node as a state machine without I/O: frames and time in, frames out.
///
/// At most one request is in flight per server, and as many servers are busy as there are jobs;
/// jobs for a busy server wait their turn. Answers are matched by server, data type and transfer
/// ID.
class Node {
 public:
  struct Hooks {
    std::function<void(const can::Frame&)> send;
    /// Called for every transfer heard, services between other nodes included, except answers to
    /// this node that it does not, or no longer, wait for: they may be stale. May be empty.
    std::function<void(const Transfer&)> transfer;
    /// Called for a transfer that could not be reassembled. May be empty.
    std::function<void(ReceiveError, std::uint32_t can_id, Time)> error;
    /// Returns the number of frames waiting to leave this machine. May be empty: none.
    std::function<std::size_t()> backlog{};
    /// Drops these frames, as far as they have not left. May be empty.
    std::function<void(std::span<const can::Frame>)> withdraw{};
    /// Called when a request is sent, the first time (`tries` is 1) or again. May be empty.
    std::function<void(const Request&, int tries)> asked{};
    /// Called when no answer came in time to a request that was sent. May be empty.
    std::function<void(const Request&, int tries)> unanswered{};
  };

  struct Description {
    std::string name;
    UniqueId unique_id{};
    std::uint8_t major = 0, minor = 0;
  };

  /// `transfer_ids` outlives the node. Without a local ID (anonymous) it only listens.
  Node(NodeId local, TransferIds* transfer_ids, Description description, Hooks hooks);

  [[nodiscard]] NodeId id() const { return local_; }

  /// `at`: when the frame was on the bus, which may be long before it is read.
  void receive(const can::Frame& frame, Time at);
  void sent(const can::Frame& frame, Time at);
  /// Reports lost echoes: requests without one are taken as sent.
  void echoes_lost(Time at);
  /// Sets the time of the requests that follow.
  void tell_time(Time now);
  /// Does what is due. Everything on the bus before `now` must have been read: a request whose
  /// answer waits to be read is not unanswered.
  void advance(Time now);
  /// When advance() is due; `never`: nothing is pending.
  [[nodiscard]] Time next_deadline() const;

  /// Becomes node `local`. Requests awaiting an answer to the old ID are sent again; one that must
  /// not be repeated (no retries) stays unanswered.
  void change_id(NodeId local, TransferIds& transfer_ids, Time now);

  /// Begins a job, which must live until it has ended or cancel_all() was called. May be called by
  /// a job or hook at any time. Without a local ID its first request ends it, as not sent.
  void start(Job& job, Time now);

  /// The number of jobs that have not ended.
  [[nodiscard]] std::size_t jobs() const { return jobs_.size(); }

  /// Whether this job has begun and not ended.
  [[nodiscard]] bool is_running(const Job& job) const;

  /// Ends this job, if it runs, with the outcome `cancelled`; a request it then makes is not sent.
  void cancel(Job& job, Time now);

  /// Sends a message. Does nothing without a local ID.
  void broadcast(const DataType& type, Priority priority, const Payload& payload);

  /// Ends the jobs that need not be completed (must_finish()), with the outcome `cancelled`.
  void stop(Time now);

  /// Ends every job with the outcome `cancelled`; requests they then make are not sent.
  void cancel_all(Time now);

 private:
  struct Active {
    Job* job = nullptr;
    Step step = std::nullopt;
    TransferId transfer_id = 0;
    int tries = 0;
    bool asked = false;               ///< handed to the bus
    bool may_have_left = false;       ///< a try of this request was handed to the bus
    bool left = false;                ///< its last frame was echoed
    bool is_cancelled = false;        ///< perhaps in its own call: its request is then not sent
    std::vector<can::Frame> frames{}; ///< of the request; the last one identifies the echo
    Time asked_at{};                  ///< the last time
    Time deadline = never;            ///< of the answer, the echo or the pause

    [[nodiscard]] bool is_done() const { return step.is_end(); }
  };

  void on_transfer(const Transfer& transfer);
  [[nodiscard]] Active* asked_for(const Transfer& response);
  void answer_node_info(const Transfer& request);
  [[nodiscard]] bool is_congested() const;
  void broadcast_status(Time now);
  void wake();
  void withdraw(const Active& active);
  void unanswered(Active& active, Time now);
  void cancel(Active& active, Time now);
  void tell(Active& active, const Outcome& outcome);
  void finish(Active& active, const Outcome& outcome);
  void ask(Active& active, Time now);
  [[nodiscard]] bool is_waiting(const Active& active) const;
  void ask_if_allowed(Active& active, Time now);
  void ask_waiting(Time now);
  [[nodiscard]] bool is_busy(NodeId server) const;
  [[nodiscard]] NodeStatus status(Time now) const;

  NodeId local_;
  TransferIds* transfer_ids_;
  Description description_;
  Hooks hooks_;
  Receiver receiver_;
  std::list<Active> jobs_;
  bool in_callback_ = false; ///< a job is being called: the list must not shrink
  std::optional<Time> born_;
  Time status_due_ = never;
  Time now_{};
};

} // namespace blactl::dronecan
