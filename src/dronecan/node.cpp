#include "blactl/dronecan/node.hpp"

#include <algorithm>
#include <utility>

namespace blactl::dronecan {
namespace {

/// A node sends NodeStatus at least once a second (uavcan/protocol/341.NodeStatus). The first one
/// comes after a second, so that a short command never announces itself to an allocator.
constexpr Duration status_period = std::chrono::seconds(1);

/// A request that has not left within this time is given up (specification 4.1).
constexpr Duration transmit_timeout = std::chrono::seconds(1);

/// (kind, type, source, destination) remembered at a time: eight for each of 127 nodes.
constexpr std::size_t receiver_sessions = 1024;

/// With so many frames waiting to leave, NodeStatus and answers are omitted: nobody acknowledges,
/// or requests come faster than we can answer. A stale frame helps nobody.
constexpr std::size_t most_backlog = 16;

} // namespace

Node::Node(NodeId local, TransferIds* transfer_ids, Description description, Hooks hooks)
    : local_(local), transfer_ids_(transfer_ids), description_(std::move(description)),
      hooks_(std::move(hooks)),
      receiver_(receiver_sessions, anonymous,
                {.transfer = [this](const Transfer& transfer) { on_transfer(transfer); },
                 .error =
                     [this](ReceiveError error, std::uint32_t can_id, Time at) {
                       if (hooks_.error) {
                         hooks_.error(error, can_id, at);
                       }
                     },
                 .signature = [](Kind kind, std::uint16_t id) -> std::optional<std::uint64_t> {
                   const DataType* type = find_type(kind, id);
                   return type != nullptr ? std::optional(type->signature) : std::nullopt;
                 }}) {}

void Node::tell_time(Time now) {
  now_ = std::max(now_, now);
}

void Node::receive(const can::Frame& frame, Time at) {
  tell_time(at);
  receiver_.receive(frame, at);
}

void Node::sent(const can::Frame& frame, Time at) {
  tell_time(at);
  for (Active& active : jobs_) {
    if (active.asked && !active.left && active.frames.back() == frame) {
      active.left = true;
      active.deadline = at + active.step.request()->timeout;
      return;
    }
  }
}

void Node::echoes_lost(Time at) {
  tell_time(at);
  for (Active& active : jobs_) {
    if (active.asked && !active.left) {
      active.left = true;
      active.deadline = at + active.step.request()->timeout;
    }
  }
}

void Node::on_transfer(const Transfer& transfer) {
  const Header& header = transfer.header;
  const bool for_us = header.destination == local_ && local_.is_unicast();
  const bool is_response = header.kind == Kind::response;
  if (for_us && is_response && asked_for(transfer) == nullptr) {
    return;
  }
  // Listeners come first: a job's conclusions from an answer rest on what they know.
  if (hooks_.transfer) {
    hooks_.transfer(transfer);
  }
  if (for_us && is_response) {
    if (Active* active = asked_for(transfer)) { // a listener may have started and ended jobs
      finish(*active, {Outcome::Kind::answered, transfer.payload, transfer.at, active->asked_at});
    }
  } else if (for_us && header.data_type_id == GetNodeInfo::type.id) {
    answer_node_info(transfer);
  }
  wake();
}

/// Wakes the jobs whose pause is over.
void Node::wake() {
  for (Active& active : jobs_) {
    const Pause* pause = active.step.pause();
    if (pause != nullptr && pause->ready && pause->ready()) {
      finish(active, {Outcome::Kind::woken, {}, now_});
    }
  }
  ask_waiting(now_);
}

/// The job whose request this answers; null: none.
Node::Active* Node::asked_for(const Transfer& response) {
  const Header& header = response.header;
  const auto it = std::ranges::find_if(jobs_, [&](const Active& active) {
    return active.asked && active.step.request()->server == header.source &&
           active.step.request()->type->id == header.data_type_id &&
           active.transfer_id == response.transfer_id;
  });
  if (it == jobs_.end()) {
    return nullptr;
  }
  const auto& accepts = it->step.request()->accepts;
  return accepts && !accepts(response.payload) ? nullptr : &*it;
}

NodeStatus Node::status(Time now) const {
  NodeStatus status;
  status.uptime_s = static_cast<std::uint32_t>(
      std::chrono::duration_cast<std::chrono::seconds>(now - born_.value_or(now)).count());
  return status;
}

bool Node::is_congested() const {
  return hooks_.backlog && hooks_.backlog() >= most_backlog;
}

void Node::answer_node_info(const Transfer& request) {
  if (is_congested()) {
    return;
  }
  GetNodeInfo::Response response;
  response.status = status(now_);
  response.software_major = description_.major;
  response.software_minor = description_.minor;
  response.unique_id = description_.unique_id;
  response.name = description_.name;
  const Header header{.kind = Kind::response,
                      .priority = request.header.priority,
                      .data_type_id = GetNodeInfo::type.id,
                      .source = local_,
                      .destination = request.header.source};
  for (const auto& frame : segment(header, request.transfer_id, GetNodeInfo::type.signature,
                                   response.encode().bytes())) {
    hooks_.send(frame);
  }
}

void Node::change_id(NodeId local, TransferIds& transfer_ids, Time now) {
  tell_time(now);
  local_ = local;
  transfer_ids_ = &transfer_ids;
  for (Active& active : jobs_) {
    if (active.asked && active.step.request()->retries > 0) {
      withdraw(active);
      --active.tries; // it was not the server that stayed silent
      ask(active, now_);
    }
  }
}

void Node::broadcast(const DataType& type, Priority priority, const Payload& payload) {
  if (!local_.is_unicast()) {
    return;
  }
  const Header header{
      .kind = Kind::message, .priority = priority, .data_type_id = type.id, .source = local_};
  const TransferId id = transfer_ids_->next(Kind::message, type.id, anonymous);
  for (const auto& frame : segment(header, id, type.signature, payload.bytes())) {
    hooks_.send(frame);
  }
}

void Node::broadcast_status(Time now) {
  if (!is_congested()) {
    broadcast(NodeStatus::type, priority_medium, status(now).encode());
  }
}

void Node::start(Job& job, Time now) {
  tell_time(now);
  Active& active = jobs_.emplace_back(Active{.job = &job});
  finish(active, {Outcome::Kind::start, {}, now_});
  ask_waiting(now_);
}

/// Passes the outcome of its last step to the job and takes its next one.
void Node::tell(Active& active, const Outcome& outcome) {
  active.asked = false;
  active.deadline = never;
  active.tries = 0;
  active.may_have_left = false;
  const bool nested = std::exchange(in_callback_, true);
  // The old step lives on during the call: the outcome may point into what it holds.
  Step step = active.job->next(outcome);
  active.step = active.is_cancelled ? Step(std::nullopt) : std::move(step);
  in_callback_ = nested;
  if (const Pause* pause = active.step.pause()) {
    active.deadline = pause->until;
  }
}

/// As tell(), except that on an anonymous node, which cannot ask, a request ends the job.
void Node::finish(Active& active, const Outcome& outcome) {
  tell(active, outcome);
  if (active.step.request() != nullptr && !local_.is_unicast()) {
    tell(active, {Outcome::Kind::not_sent, {}, now_});
    active.step = std::nullopt;
  }
}

bool Node::is_busy(NodeId server) const {
  return std::ranges::any_of(jobs_, [&](const Active& active) {
    return active.asked && active.step.request()->server == server;
  });
}

void Node::ask(Active& active, Time now) {
  const Request& request = *active.step.request();
  const Header header{.kind = Kind::request,
                      .priority = request.priority,
                      .data_type_id = request.type->id,
                      .source = local_,
                      .destination = request.server};
  active.transfer_id = transfer_ids_->next(Kind::request, request.type->id, request.server);
  active.frames =
      segment(header, active.transfer_id, request.type->signature, request.payload.bytes());
  active.asked = active.may_have_left = true;
  active.left = false;
  active.asked_at = now;
  active.deadline = now + transmit_timeout;
  ++active.tries;
  if (hooks_.asked) {
    hooks_.asked(request, active.tries);
  }
  for (const auto& frame : active.frames) {
    hooks_.send(frame);
  }
}

bool Node::is_waiting(const Active& active) const {
  const Request* request = active.step.request();
  return request != nullptr && !active.asked && !is_busy(request->server);
}

void Node::ask_if_allowed(Active& active, Time now) {
  const Request& request = *active.step.request();
  if (!request.may_leave || request.may_leave(now)) {
    ask(active, now);
  } else {
    finish(active,
           {active.may_have_left ? Outcome::Kind::timed_out : Outcome::Kind::withheld, {}, now});
  }
}

/// Drops ended jobs, and sends the requests that waited for a server now free.
void Node::ask_waiting(Time now) {
  if (in_callback_) {
    return; // a job started another one: the call that runs it goes on with the list
  }
  const auto is_done = [](const Active& active) { return active.is_done(); };
  jobs_.remove_if(is_done);
  for (Active& active : jobs_) {
    while (is_waiting(active)) { // one whose request is withheld may have another
      ask_if_allowed(active, now);
    }
  }
  jobs_.remove_if(is_done);
}

void Node::advance(Time now) {
  tell_time(now);
  if (!born_ && local_.is_unicast()) {
    born_ = now;
    status_due_ = now + status_period;
  }
  if (status_due_ <= now) {
    broadcast_status(now);
    status_due_ += status_period;
    if (status_due_ <= now) { // this process slept: missed messages are not made up for
      status_due_ = now + status_period;
    }
  }
  for (Active& active : jobs_) {
    if (active.deadline > now) {
      continue;
    }
    if (active.step.pause() != nullptr) {
      finish(active, {Outcome::Kind::woken, {}, now});
    } else if (!active.left) {
      withdraw(active);
      finish(active, {Outcome::Kind::not_sent, {}, now});
    } else {
      unanswered(active, now);
    }
  }
  ask_waiting(now_);
}

void Node::unanswered(Active& active, Time now) {
  const Request& request = *active.step.request();
  if (hooks_.unanswered) {
    hooks_.unanswered(request, active.tries);
  }
  const bool may_leave = !request.may_leave || request.may_leave(now);
  if (active.tries <= request.retries && may_leave) {
    ask(active, now_);
  } else {
    finish(active, {Outcome::Kind::timed_out, {}, now});
  }
}

/// Drops the frames of a request not yet sent: nobody waits for its answer.
void Node::withdraw(const Active& active) {
  if (active.asked && !active.left && hooks_.withdraw) {
    hooks_.withdraw(active.frames);
  }
}

Time Node::next_deadline() const {
  Time due = born_ || !local_.is_unicast() ? status_due_ : now_;
  for (const Active& active : jobs_) {
    due = std::min(due, active.deadline);
  }
  return due;
}

void Node::cancel(Active& active, Time now) {
  withdraw(active);
  tell(active, {Outcome::Kind::cancelled, {}, now});
  active.step = std::nullopt;
  active.is_cancelled = true;
}

bool Node::is_running(const Job& job) const {
  return std::ranges::any_of(
      jobs_, [&](const Active& active) { return active.job == &job && !active.is_done(); });
}

void Node::cancel(Job& job, Time now) {
  tell_time(now);
  const auto it = std::ranges::find_if(
      jobs_, [&](const Active& active) { return active.job == &job && !active.is_done(); });
  if (it != jobs_.end()) {
    cancel(*it, now);
    ask_waiting(now_);
  }
}

void Node::stop(Time now) {
  tell_time(now);
  for (Active& active : jobs_) {
    if (!active.job->must_finish()) {
      cancel(active, now);
    }
  }
  ask_waiting(now_);
}

void Node::cancel_all(Time now) {
  tell_time(now);
  for (Active& active : jobs_) {
    cancel(active, now);
  }
  jobs_.clear();
}

} // namespace blactl::dronecan
