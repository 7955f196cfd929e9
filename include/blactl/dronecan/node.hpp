#pragma once
// This process as a DroneCAN node: its own services, and questions to other nodes as jobs.

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

/// One question to one node.
struct Request {
  NodeId server;
  const DataType* type = nullptr;
  Payload payload;
  Duration timeout = std::chrono::milliseconds(500); ///< servers answer within 0.5 s (spec. 4.1)
  int retries = 2;                                   ///< further tries, each with a new transfer ID
  Priority priority = priority_service;
  /// Whether a payload is an answer to this question (the right parameter name); empty: any is.
  std::function<bool(Bytes)> accepts;
};

/// How a question ended.
struct Outcome {
  enum class Kind : std::uint8_t {
    start,     ///< there was no question yet
    answered,  ///< `payload` is the answer
    timed_out, ///< the question went out, no answer came
    not_sent,  ///< the question did not leave this machine in time; the kernel may still send it
    woken,     ///< the pause is over
    cancelled,
    not_recorded, ///< the bus is a recording that does not hold the answer
  };

  Kind kind = Kind::start;
  Bytes payload; ///< valid during the call
  Time at{};     ///< when the answer's first frame came, or when the waiting ended
  Time asked{};  ///< when the question went to the bus that was answered

  [[nodiscard]] bool answered() const { return kind == Kind::answered; }
};

/// A job that asks nothing now. It goes on (`woken`) as soon as `ready` holds after a transfer was
/// heard, at `until` at the latest.
struct Pause {
  Time until = never;
  std::function<bool()> ready{}; ///< empty: only the time counts
};

/// What a job does next: a question, a pause, or neither: it has ended.
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

  /// Whether it has begun what must not be left half done (a ROM write): Node::stop() lets it go
  /// on.
  [[nodiscard]] virtual bool must_finish() const { return false; }

 protected:
  Job() = default;
};

/// A node as a state machine without I/O: frames and time in, frames out.
///
/// One question is in flight for each server, as many servers are busy as there are jobs; jobs for
/// a busy server wait for their turn. Answers are matched by server, data type and transfer ID;
/// whatever else arrives is no answer.
class Node {
 public:
  struct Hooks {
    std::function<void(const can::Frame&)> send;
    /// Every transfer heard, services between other nodes included; but no answer to this node that
    /// it does not wait for, or no more: it may tell of a time long past. May be empty.
    std::function<void(const Transfer&)> transfer;
    /// A transfer that could not be reassembled. May be empty.
    std::function<void(ReceiveError, std::uint32_t can_id, Time)> error;
    /// Frames that wait to leave this machine. May be empty: none.
    std::function<std::size_t()> backlog{};
    /// These frames shall not leave any more, as far as they are still here. May be empty.
    std::function<void(std::span<const can::Frame>)> withdraw{};
    /// A question goes out, for the first time (`tries` is 1) or again. May be empty.
    std::function<void(const Request&, int tries)> asked{};
    /// No answer came in time to a question that went out. May be empty.
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
  /// Echoes were lost: questions without one are taken as sent.
  void echoes_lost(Time at);
  /// What is asked from here on is asked `now`.
  void tell_time(Time now);
  /// Does what is due. All that was on the bus before `now` must have been read: a question whose
  /// answer waits to be read is not unanswered.
  void advance(Time now);
  /// When advance() is due; `never`: nothing is waited for.
  [[nodiscard]] Time next_deadline() const;

  /// From here on this is node `local`. What waits for an answer to the ID before is asked again. A
  /// question that must not be asked twice (no retries) stays without its answer.
  void change_id(NodeId local, TransferIds& transfer_ids, Time now);

  /// Begins a job; it must live until it ended or cancel_all() was called. May be called by a job
  /// or hook at any time. Without a local ID its first question ends it, as not sent.
  void start(Job& job, Time now);

  /// Jobs that have not ended.
  [[nodiscard]] std::size_t jobs() const { return jobs_.size(); }

  /// Whether this job has begun and not ended.
  [[nodiscard]] bool is_running(const Job& job) const;

  /// Ends this job, if it runs, with the outcome `cancelled`; what it asks then is not sent.
  void cancel(Job& job, Time now);

  /// Sends a message. Without a local ID nothing is sent.
  void broadcast(const DataType& type, Priority priority, const Payload& payload);

  /// Ends the jobs that may be left half done, with the outcome `cancelled`.
  void stop(Time now);

  /// Ends every job with the outcome `cancelled`; what they ask then is not sent.
  void cancel_all(Time now);

 private:
  struct Active {
    Job* job = nullptr;
    Step step = std::nullopt;
    TransferId transfer_id = 0;
    int tries = 0;
    bool asked = false;               ///< handed to the bus
    bool left = false;                ///< its last frame was echoed
    bool is_cancelled = false;        ///< perhaps in its own call: what it asks then is not sent
    std::vector<can::Frame> frames{}; ///< of the question; the last one recognises the echo
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
  void ask_waiting(Time now);
  [[nodiscard]] bool is_busy(NodeId server) const;
  [[nodiscard]] NodeStatus status(Time now) const;

  NodeId local_;
  TransferIds* transfer_ids_;
  Description description_;
  Hooks hooks_;
  Receiver receiver_;
  std::list<Active> jobs_;
  bool in_callback_ = false; ///< a job is being asked: the list must not shrink
  std::optional<Time> born_;
  Time status_due_ = never;
  Time now_{};
};

} // namespace blactl::dronecan
