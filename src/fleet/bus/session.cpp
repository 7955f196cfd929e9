#include "blactl/fleet/bus/session.hpp"

#include "blactl/fleet/bus/identification.hpp"
#include "blactl/fleet/bus/texts.hpp"

#include "fleet/bus/hearing.hpp"

#include <signal.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace blactl::fleet {

using dronecan::NodeId;

namespace {

/// The longest wait of our frame for its echo on a silent bus.
constexpr Duration acknowledge_time = std::chrono::milliseconds(100);

dronecan::UniqueId own_unique_id(NodeId id) {
  // never zero, the same at every start: required by allocators with a table
  dronecan::UniqueId unique_id{'b', 'l', 'a', 'c', 't', 'l'};
  unique_id.back() = id.value();
  return unique_id;
}

/// The initial node ID: with one that is not for tools it only listens at first.
NodeId first_id(const std::optional<state::LocalNodeId>& local) {
  return local && state::is_tool_id(local->id()) ? local->id() : dronecan::anonymous;
}

} // namespace

Session::Session(std::unique_ptr<can::Bus> bus, std::optional<state::LocalNodeId> local,
                 Hearing hearing, const bla::Profiles& profiles)
    : local_(std::move(local)), hearing_(hearing), loop_(std::move(bus)),
      roster_(first_id(local_), profiles),
      node_(first_id(local_), local_ ? &local_->transfer_ids() : nullptr,
            {.name = std::string(own_name),
             .unique_id = own_unique_id(local_ ? local_->id() : dronecan::anonymous)},
            {.send = [this](const can::Frame& frame) { loop_.send(frame); },
             .transfer =
                 [this](const dronecan::Transfer& transfer) {
                   roster_.receive(transfer);
                   for (dronecan::Service* service : services_) {
                     service->receive(transfer);
                   }
                   if (replay_) {
                     replay_->receive(transfer);
                   }
                 },
             .error = {},
             .backlog = [this] { return loop_.unsent(); },
             .withdraw = [this](auto frames) { loop_.withdraw(frames); },
             .asked =
                 [this](const dronecan::Request& request, int tries) {
                   roster_.ask(request, loop_.now());
                   if (traffic_ != nullptr && request.retries > 0) { // probes are not counted
                     traffic_->ask(request.server);
                   }
                   if (asked_) {
                     asked_(request, tries);
                   }
                 },
             .unanswered =
                 [this](const dronecan::Request& request, int tries) {
                   if (traffic_ != nullptr && request.retries > 0) {
                     traffic_->miss_answer(request.server);
                   }
                   if (unanswered_) {
                     unanswered_(request, tries);
                   }
                 }}) {
  if (loop_.bus().is_replay()) {
    replay_.emplace(roster_);
  }
}

Result<std::unique_ptr<Session>> Session::open(std::unique_ptr<can::Bus> bus,
                                               std::optional<state::LocalNodeId> local,
                                               Hearing hearing, const bla::Profiles& profiles) {
  const NodeId id = local ? local->id() : dronecan::anonymous;
  std::unique_ptr<Session> session(
      new Session(std::move(bus), std::move(local), hearing, profiles));
  if (auto filtered = session->loop_.bus().filter(filters(hearing, id)); !filtered) {
    return std::unexpected(filtered.error());
  }
  return session;
}

std::unexpected<Error> Session::end(Error error) {
  loop_.drop_queue();
  node_.cancel_all(loop_.now());
  if (replay_) {
    replay_->cancel();
  }
  return std::unexpected(std::move(error));
}

/// The deadline for the echo of our frame.
Time Session::acknowledge_deadline() const {
  const auto since = waits_alone_ ? std::nullopt : loop_.unacknowledged_since();
  return since ? *since + acknowledge_time : never;
}

Result<Session::Happened> Session::step(Time deadline) {
  const can::Event event = loop_.next(std::min(deadline, next_deadline()));
  node_.tell_time(loop_.now());
  auto happened = take(event);
  if (!happened || *happened != Happened::deadline) {
    // everything before this frame has been read: timeouts are known up to here, even if frames
    // come faster than they can be read; but of one that waited nobody knows when it came
    const auto* received = std::get_if<can::Received>(&event);
    if (happened && received != nullptr && (received->is_timed || replay_)) {
      advance(received->at);
      return received->at >= deadline ? Happened::deadline : *happened;
    }
    return happened;
  }
  // The loop has delivered everything that came; otherwise a process that slept would give up on
  // responses that wait to be read.
  const Time now = loop_.now();
  if (acknowledge_deadline() <= now) {
    return end({Code::no_acknowledge, say<texts::nobody_acknowledges>(interface()),
                say<texts::nobody_acknowledges_hint>()});
  }
  if (give_up_at_ <= now) {
    return end(interrupted_by(signal_));
  }
  advance(now);
  return now >= deadline ? Happened::deadline : Happened::something;
}

Result<Session::Happened> Session::take(const can::Event& event) {
  if (const auto* received = std::get_if<can::Received>(&event)) {
    return take_frame(*received);
  }
  if (const auto* sent = std::get_if<can::Sent>(&event)) {
    node_.sent(sent->frame, sent->at);
    roster_.hear_own(sent->frame, sent->at);
    if (traffic_ != nullptr) {
      traffic_->hear_own(sent->frame, sent->at);
    }
  } else if (const auto* fault = std::get_if<can::BusFault>(&event)) {
    if (traffic_ != nullptr) {
      traffic_->hear(*fault);
    }
    if (fault->kind == can::FaultKind::bus_off && !replay_) {
      return end({Code::bus_off, say<texts::bus_is_off>(interface()), loop_.bus().bus_off_hint()});
    }
  } else if (const auto* overflow = std::get_if<can::Overflow>(&event)) {
    lost_ = overflow->lost;
    node_.echoes_lost(loop_.now()); // they may be among the lost ones
  } else if (const auto* opened = std::get_if<can::Opened>(&event)) {
    opening_note_ = opened->note;
  } else if (const auto* gone = std::get_if<can::Gone>(&event)) {
    return end(gone->error);
  } else if (const auto* away = std::get_if<can::Away>(&event)) {
    take_presence(away->error);
    if (breaks_off_when_away_) {
      return end(away->error);
    }
  } else if (std::holds_alternative<can::Back>(event)) {
    take_presence(std::nullopt);
  } else if (const auto* caught = std::get_if<can::Signal>(&event)) {
    return take_signal(caught->number);
  } else if (const auto* ready = std::get_if<can::Ready>(&event)) {
    if (!input_hook_ || ready->descriptor != input_) {
      return Happened::input;
    }
    input_hook_();
  } else if (replay_ && std::holds_alternative<can::Ended>(event)) {
    replay_->finish();
  } else {
    return Happened::deadline;
  }
  return Happened::something;
}

/// Frames on their way when the interface went away count as sent: their responses do not come.
void Session::take_presence(std::optional<Error> away) {
  away_ = std::move(away);
  node_.echoes_lost(loop_.now());
  if (away_hook_) {
    away_hook_();
  }
}

Error interrupted_by(int signal) {
  const std::string_view name = signal == SIGTERM  ? "SIGTERM"
                                : signal == SIGHUP ? "SIGHUP"
                                                   : "SIGINT";
  return {Code::interrupted, say<texts::interrupted>(name)};
}

/// The first signal ends what may be ended, the second one everything. The end of a terminal is
/// signalled by the kernel and by the shell: that is not impatience.
Result<Session::Happened> Session::take_signal(int number) {
  if (number == SIGWINCH) {
    if (resized_) {
      resized_();
    }
    return Happened::something;
  }
  if (number == SIGHUP && signal_ != 0) {
    return Happened::something;
  }
  const bool first = std::exchange(signal_, number) == 0;
  if (first) {
    node_.stop(loop_.now());
    give_up_at_ = loop_.now() + grace_;
  }
  if (!first || node_.jobs() == 0) {
    return end(interrupted_by(signal_));
  }
  if (stopping_) {
    stopping_();
  }
  return Happened::something;
}

Time Session::next_deadline() const {
  Time next = std::min({node_.next_deadline(), acknowledge_deadline(), give_up_at_});
  for (const dronecan::Service* service : services_) {
    next = std::min(next, service->next_deadline());
  }
  return next;
}

void Session::advance(Time now) {
  node_.advance(now);
  for (dronecan::Service* service : services_) {
    service->advance(now);
  }
}

Result<Session::Happened> Session::take_frame(const can::Received& received) {
  const auto header = received.frame.extended && received.frame.size > 0
                          ? dronecan::decode_id(received.frame.id)
                          : std::nullopt;
  if (header && local_ && header->source == local_->id()) {
    if (auto changed = give_way(); !changed) {
      return end(changed.error());
    }
  }
  if (traffic_ != nullptr) {
    traffic_->hear(received.frame, received.at);
    if (replay_) {
      traffic_->stamp(received.wall);
    }
  }
  if (!replay_) {
    roster_.be_late(!received.is_timed);
  } else if (!received.is_timed) {
    roster_.lose_time();
  }
  roster_.hear(received.frame, received.at);
  node_.receive(received.frame, received.at);
  heard_anything_ = heard_anything_ || header.has_value();
  return Happened::something;
}

/// Another node has our ID. The next one may be that of a node heard before.
Result<void> Session::give_way() {
  const auto is_taken = [this](NodeId id) {
    return roster_.heard(id) && loop_.now() - roster_.member(id).last_heard < offline_time;
  };
  Result<void> given;
  do {
    given = local_->give_way(interface());
  } while (given && is_taken(local_->id()));
  if (!given) {
    begin_as_node(); // with the last one: what was changed for the time being is put back
    return given;
  }
  if (new_id_) {
    new_id_(*local_);
  }
  if (auto filtered = loop_.bus().filter(filters(hearing_, local_->id())); !filtered) {
    return filtered;
  }
  begin_as_node();
  return {};
}

void Session::begin_as_node() {
  roster_.change_local(local_->id());
  node_.change_id(local_->id(), local_->transfer_ids(), loop_.now());
}

Result<void> Session::wait_until_open() {
  while (!loop_.bus().is_open()) {
    if (const auto happened = step(never); !happened) {
      return std::unexpected(happened.error());
    }
  }
  opened_ = loop_.now();
  if (!local_ || state::is_tool_id(local_->id())) {
    return {};
  }
  if (auto free = live_until(opened_ + bus_watch_time); !free) {
    return free;
  }
  begin_as_node();
  return {};
}

void Session::recall(const RecordedServo& recorded) {
  roster_.recall(recorded.servo);
  for (const auto& [address, raw] : recorded.values) {
    replay_->recall(recorded.servo.id, address, raw);
  }
  heard_anything_ = true;
}

void Session::start(dronecan::Job& job) {
  if (replay_) {
    replay_->start(job);
  } else {
    node_.start(job, loop_.now());
  }
}

/// Plays the rest of a recording. A pipe may be slow, so the loop waits for it.
Result<void> Session::play() {
  while (!replay_->finished()) {
    if (const auto happened = take(loop_.next(never)); !happened) {
      return std::unexpected(happened.error());
    }
  }
  return {};
}

Result<void> Session::live_until(Time deadline) {
  if (plays_at_once()) {
    return play();
  }
  for (;;) {
    const auto happened = step(deadline);
    if (!happened) {
      return std::unexpected(happened.error());
    }
    if (*happened == Happened::deadline) {
      return {};
    }
  }
}

Result<bool> Session::live_until(Time deadline, const std::function<bool()>& done) {
  if (plays_at_once()) {
    const auto played = play();
    return played ? Result<bool>(done()) : std::unexpected(played.error());
  }
  while (!done()) {
    const auto happened = step(deadline);
    if (!happened) {
      return std::unexpected(happened.error());
    }
    if (*happened == Happened::deadline) {
      return done();
    }
  }
  return true;
}

Result<void> Session::run(std::span<dronecan::Job* const> jobs) {
  for (dronecan::Job* job : jobs) {
    start(*job);
  }
  // called after every event; ended jobs do not start again
  return run_while([this, jobs]() mutable {
    while (!jobs.empty() && !node_.is_running(*jobs.front())) {
      jobs = jobs.subspan(1);
    }
    return !jobs.empty();
  });
}

Result<void> Session::run() {
  return run_while([this] { return node_.jobs() > 0; });
}

Result<void> Session::run_while(const std::function<bool()>& busy) {
  if (replay_) {
    return play();
  }
  while (busy()) {
    if (const auto happened = step(never); !happened) {
      return std::unexpected(happened.error());
    }
  }
  if (signal_ != 0) { // the jobs that had to be finished are
    return end(interrupted_by(signal_));
  }
  return {};
}

void Session::on_input(int descriptor, std::function<void()> hook) {
  if (input_hook_) {
    loop_.unwatch(input_);
  }
  input_ = descriptor;
  input_hook_ = std::move(hook);
  if (input_hook_) {
    loop_.watch(input_);
  }
}

Result<void> Session::wait_for_input(int descriptor) {
  loop_.watch(descriptor);
  auto happened = step(never);
  while (happened && *happened != Happened::input) {
    happened = step(never);
  }
  loop_.unwatch(descriptor);
  if (!happened) {
    return std::unexpected(happened.error());
  }
  return {};
}

} // namespace blactl::fleet
