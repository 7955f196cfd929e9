#include "cli/context.hpp"

#include "blactl/can/replay_texts.hpp"
#include "blactl/fleet/bus/texts.hpp"
#include "blactl/fleet/files/fleet_replay.hpp"

#include "cli/interface/scheme.hpp"
#include "cli/texts.hpp"

#include <signal.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <system_error>
#include <utility>

namespace blactl::cli {

using state::LocalNodeId;

namespace {

/// Read once a process: that takes most of the time of a command.
const Result<bla::Profiles>& built_in_profiles() {
  static const Result<bla::Profiles> loaded = bla::Profiles::load(std::nullopt);
  return loaded;
}

} // namespace

Result<const bla::Profiles*> Context::profiles() {
  if (profiles_ != nullptr) {
    return profiles_;
  }
  if (shared_.profile_dir) {
    loaded_ = bla::Profiles::load(shared_.profile_dir);
  }
  const Result<bla::Profiles>& profiles = loaded_ ? *loaded_ : built_in_profiles();
  if (!profiles) {
    return std::unexpected(profiles.error());
  }
  profiles_ = &*profiles;
  for (const std::string& model : profiles_->replaced()) {
    reporter_.note(say<texts::profile_replaced>(model));
  }
  return profiles_;
}

Result<const bla::Profile*> Context::assumed_profile() {
  const auto known = profiles();
  if (!known) {
    return std::unexpected(known.error());
  }
  if (!shared_.profile) {
    return nullptr;
  }
  const auto matching = (*known)->matching(*shared_.profile);
  if (matching.size() != 1) {
    std::string models;
    for (const bla::Profile& profile : (*known)->all()) {
      models += (models.empty() ? "" : ", ") + profile.model;
    }
    const std::string typed = printable(*shared_.profile);
    return fail(Code::usage,
                matching.empty() ? say<texts::unknown_model>(typed)
                                 : say<texts::several_models>(typed),
                say<texts::known_models>(models));
  }
  return matching.front();
}

Result<fleet::Targets> Context::targets() const {
  return shared_.nodes ? fleet::parse_targets(*shared_.nodes) : fleet::Targets{};
}

Result<std::optional<LocalNodeId>> Context::take_node_id(bool listens) {
  if (listens) {
    reporter_.detail(say<texts::no_own_id>());
    return std::nullopt;
  }
  auto local = locks_.place.interface.empty()
                   ? Result<LocalNodeId>(LocalNodeId::unshared(own_ids()))
                   : LocalNodeId::acquire(locks_.place, own_ids());
  if (!local) {
    return std::unexpected(local.error());
  }
  tell(*local);
  return std::move(*local);
}

/// The node IDs that this process may use: the one from --local-node-id, else those for tools. IDs
/// of nodes in -n are excluded, as such a node could not be asked.
LocalNodeId::Candidates Context::own_ids() const {
  if (shared_.local_node_id) {
    return {dronecan::NodeId(*shared_.local_node_id)};
  }
  LocalNodeId::Candidates ids(state::tool_ids.begin(), state::tool_ids.end());
  if (const auto targets = this->targets()) {
    const std::set<dronecan::NodeId> named(targets->ids.begin(), targets->ids.end());
    std::erase_if(ids, [&](dronecan::NodeId id) { return named.contains(id); });
  }
  return ids;
}

/// Our node ID and the reason for it. An unusual one is worth a note.
void Context::tell(const LocalNodeId& local) const {
  const auto id = local.id().value();
  if (const std::string others = local.passed_over(); !others.empty()) {
    reporter_.note(say<texts::own_id_instead>(id, others));
  } else if (shared_.local_node_id) {
    reporter_.detail(say<texts::own_id_wanted>(id));
  } else {
    reporter_.detail(locks_.place.interface.empty() ? say<texts::own_id_private>(id)
                                                    : say<texts::own_id_free>(id));
  }
  if (!locks_.place.interface.empty() && local.lock_file().empty()) {
    reporter_.note(say<texts::no_lock_folder>(printable(locks_.place.interface)));
  }
  tell_lock(local.lock_file());
}

void Context::tell_lock(const std::string& path) const {
  if (!path.empty()) {
    reporter_.detail(say<texts::lock_taken>(printable(path)));
  }
}

Result<fleet::Session*> Context::open(fleet::Session::Hearing hearing) {
  const auto assumed = assumed_profile();
  if (!assumed) {
    return std::unexpected(assumed.error());
  }
  assumed_ = *assumed;
  auto bus = open_bare();
  if (!bus) {
    return std::unexpected(bus.error());
  }
  locks_.place = bus->place;
  auto local = take_node_id(shared_.listen_only || bus->bus->is_replay());
  if (!local) {
    return std::unexpected(local.error());
  }
  layers_.log = bus->log;
  layers_.adapter = bus->adapter;
  if (wishes_.waits_for_return && bus->reopen) {
    layers_.adapter = nullptr; // the next one is different
    bus->bus = std::make_unique<can::ReturningBus>(std::move(bus->bus), std::move(bus->reopen));
  }
  if (wishes_.plays_at_pace && layers_.log != nullptr) {
    auto paced = std::make_unique<can::PacedReplay>(std::move(bus->bus));
    layers_.pace = paced.get();
    bus->bus = std::move(paced);
  }
  auto recording = recorded(std::move(bus->bus));
  if (!recording) {
    return std::unexpected(recording.error());
  }
  auto session =
      fleet::Session::open(std::move(*recording), std::move(*local), hearing, *profiles_);
  if (!session) {
    return std::unexpected(session.error());
  }
  session_ = std::move(*session);
  session_->on_new_id([this](const LocalNodeId& other) { tell(other); });
  session_->on_stopping([this] { reporter_.note(say<texts::finishing>()); });
  session_->on_requests([this](const dronecan::Request& request, int) { requests_.asked(request); },
                        [this](const dronecan::Request& request, int tries) {
                          // one try to every ID is a search: no response is expected
                          if (request.retries > 0 || session_->roster().heard(request.server)) {
                            requests_.unanswered(request, tries);
                          }
                        });
  if (auto ready = session_->wait_until_open(); !ready) {
    return std::unexpected(ready.error());
  }
  if (auto recalled = bus->fleet ? recall(*bus->fleet) : Result<void>(); !recalled) {
    return std::unexpected(recalled.error());
  }
  if (!session_->opening_note().empty()) {
    reporter_.note(session_->opening_note());
  }
  return session_.get();
}

Result<OpenBus> Context::open_bare() {
  const auto known = profiles();
  if (!known) {
    return std::unexpected(known.error());
  }
  return opener_({.text = shared_.interface,
                  .profiles = **known,
                  .reporter = reporter_,
                  .inquires = wishes_.inquires});
}

/// The session responds from the contents of the file.
Result<void> Context::recall(const fleet::FleetFile& fleet) {
  const auto recording = fleet::recording_of(fleet, *profiles_, assumed_);
  if (!recording) {
    return std::unexpected(recording.error());
  }
  const auto join = [](std::string& list, const std::string& item) {
    list += (list.empty() ? "" : ", ") + item;
  };
  std::string of_many, without_id;
  for (const fleet::FleetEntry* entry : recording->of_many) {
    join(of_many, printable(entry->name));
  }
  auto entry = recording->without_id.begin();
  for (const fleet::RecordedServo& servo : recording->servos) {
    session_->recall(servo);
    if (!servo.servo.id_is_known) {
      join(without_id, fmt::format("{} ({})", printable((*entry++)->name), servo.servo.id.value()));
    }
  }
  if (!of_many.empty()) {
    reporter_.note(say<texts::file_entries_of_many>(of_many));
  }
  if (!without_id.empty()) {
    reporter_.note(say<texts::file_without_node_ids>(without_id));
  }
  return {};
}

Result<void> Context::wait_for_input(int descriptor) {
  if (session_) {
    return session_->wait_for_input(descriptor);
  }
  can::Loop loop(nullptr);
  loop.watch(descriptor);
  for (;;) {
    const can::Event event = loop.next(never);
    if (std::holds_alternative<can::Ready>(event)) {
      return {};
    }
    if (const auto* signal = std::get_if<can::Signal>(&event);
        signal != nullptr && signal->number != SIGWINCH) {
      signal_ = signal->number;
      return std::unexpected(fleet::interrupted_by(signal_));
    }
  }
}

Result<fleet::Session*> Context::open_for_writing(std::string_view command) {
  if (shared_.listen_only) {
    return fail(Code::usage, say<texts::listen_only_refused>(command),
                say<texts::listen_only_hint>());
  }
  if (auto refused = takes_no_frames(shared_.interface)) {
    return std::unexpected(std::move(*refused));
  }
  auto session = open(fleet::Session::Hearing::commands);
  if (!session || locks_.place.interface.empty()) {
    return session;
  }
  using state::InterfaceLock;
  auto lock = InterfaceLock::acquire(locks_.place, InterfaceLock::Right::write);
  if (!lock) {
    return std::unexpected(lock.error());
  }
  locks_.writing = std::move(*lock);
  tell_lock(locks_.writing->file());
  return session;
}

Result<fleet::Session*> Context::open_for_allocation() {
  auto session = open(fleet::Session::Hearing::all);
  if (!session) {
    return session;
  }
  if (auto locked = lock_allocation(); !locked) {
    return std::unexpected(locked.error());
  }
  return session;
}

Result<void> Context::lock_allocation() {
  if (locks_.place.interface.empty() || locks_.allocating) {
    return {};
  }
  using state::InterfaceLock;
  auto lock = InterfaceLock::acquire(locks_.place, InterfaceLock::Right::allocate);
  if (!lock) {
    return std::unexpected(lock.error());
  }
  locks_.allocating = std::move(*lock);
  tell_lock(locks_.allocating->file());
  return {};
}

Result<std::unique_ptr<can::Bus>> Context::recorded(std::unique_ptr<can::Bus> bus) {
  if (!wishes_.record) {
    return bus;
  }
  if (is_fleet_file()) {
    return fail(Code::usage, say<texts::file_without_frames>(printable(shared_.interface)),
                say<texts::file_without_frames_hint>());
  }
  const auto name = parse_interface(shared_.interface);
  if (layers_.log != nullptr && name) {
    std::error_code error;
    const std::string path = name->rest == "-" ? "/dev/stdin" : name->rest;
    if (std::filesystem::equivalent(path, *wishes_.record, error)) {
      return fail(Code::usage, say<texts::records_itself>(printable(*wishes_.record)),
                  say<texts::record_unopened_hint>());
    }
  }
  auto recorder = can::Recorder::open(std::move(bus), *wishes_.record);
  if (!recorder) {
    return std::unexpected(recorder.error());
  }
  layers_.recorder = recorder->get();
  return std::move(*recorder);
}

fleet::Identification::Options Context::identification() const {
  return {.patience = shared_.patience, .assumed = assumed_, .static_node_id = false};
}

void Context::tell_losses(Report& report) const {
  if (!session_) {
    return;
  }
  if (session_->away()) {
    report.fail(*session_->away());
  }
  if (session_->lost_frames() > 0) {
    reporter_.note(say<texts::frames_lost>(session_->lost_frames()));
  }
  if (session_->unreadable() > 0) {
    reporter_.note(say<texts::unreadable_frames>(session_->unreadable()));
  }
  if (layers_.log != nullptr && layers_.log->reader().bad_lines() > 0) {
    const can::LogReader& log = layers_.log->reader();
    reporter_.note(
        say<texts::lines_passed_over>(log.name(), log.bad_lines(), log.first_bad_line()));
  }
  check_recording(report);
}

namespace {

/// Removes these errors, and targets without anything else.
void drop(Report& report, const auto& is_meant) {
  std::erase_if(report.errors, is_meant);
  std::erase_if(report.targets, [&](Target& target) {
    return std::erase_if(target.errors, is_meant) > 0 && target.errors.empty();
  });
}

} // namespace

bool Context::is_fleet_file() const {
  return names(shared_.interface, Behind::fleet_file);
}

void Context::explain_file(Report& report) const {
  if (!session_ || !is_fleet_file()) {
    return;
  }
  const auto explain = [&](Error& error) {
    if (error.code == Code::not_recorded) {
      error.hint = say<texts::file_not_recorded_hint>();
    }
    const fleet::Member* node =
        error.node_id ? session_->roster().find(dronecan::NodeId(*error.node_id)) : nullptr;
    if (node != nullptr && !node->id_is_known) {
      error.node_id = std::nullopt;
    }
  };
  std::ranges::for_each(report.errors, explain);
  for (Target& target : report.targets) {
    std::ranges::for_each(target.errors, explain);
  }
}

void Context::explain_silence(Report& report) const {
  if (!session_ || session_->heard_anything() || signal() != 0) {
    return;
  }
  const auto reason = session_->silence();
  const auto is_absence = [](const Error& error) { return error.code == Code::not_found; };
  if (reason && reason->code == Code::interface) {
    drop(report, is_absence); // that is only its consequence
    if (std::ranges::find(report.errors, Code::interface, &Error::code) == report.errors.end()) {
      report.fail(*reason);
    }
    return;
  }
  const std::string hint =
      reason ? reason->hint : silence_hint(shared_.interface, session_->interface());
  const auto explain = [&](Error& error) {
    if (!hint.empty() && (is_absence(error) || error.code == Code::no_acknowledge)) {
      error.message += reason ? ": " + reason->message : "";
      error.hint = hint;
    }
  };
  std::ranges::for_each(report.errors, explain);
  for (Target& target : report.targets) {
    std::ranges::for_each(target.errors, explain);
  }
}

void Context::check_recording(Report& report) const {
  if (layers_.recorder != nullptr && layers_.recorder->error()) {
    report.fail(*layers_.recorder->error());
  }
}

void Context::broken(const Error& error, Report& report) const {
  // errors of jobs whose requests were cancelled repeat the cause
  const auto is_same = [](const Error& known) { return known.code == Code::interrupted; };
  std::erase_if(report.errors, is_same);
  for (Target& target : report.targets) {
    std::erase_if(target.errors, is_same);
  }
  report.errors.insert(report.errors.begin(), error);
  report.signal = signal();
}

void Context::ended(const Error& error, Report& report) const {
  if (error.code == Code::interrupted) {
    report.signal = signal();
  } else {
    broken(error, report);
  }
}

} // namespace blactl::cli
