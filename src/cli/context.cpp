#include "cli/context.hpp"

#include "blactl/can/replay_texts.hpp"
#include "blactl/fleet/texts.hpp"

#include "cli/interface/bus_factory.hpp"
#include "cli/texts.hpp"

#include <algorithm>
#include <filesystem>
#include <set>
#include <system_error>
#include <utility>

namespace blactl::cli {

using fleet::Member;
using state::LocalNodeId;

Result<const bla::Profiles*> Context::profiles() {
  if (!profiles_) {
    auto loaded = bla::Profiles::load(shared_.profile_dir);
    if (!loaded) {
      return std::unexpected(loaded.error());
    }
    profiles_ = std::move(*loaded);
    for (const std::string& model : profiles_->replaced()) {
      reporter_.note(say<texts::profile_replaced>(model));
    }
  }
  return &*profiles_;
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
      models += models.empty() ? "" : ", ";
      models += profile.model;
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

Result<fleet::Session*> Context::open(fleet::Session::Hearing hearing) {
  const auto assumed = assumed_profile();
  if (!assumed) {
    return std::unexpected(assumed.error());
  }
  assumed_ = *assumed;
  auto bus = open_bus(shared_.interface, *profiles_, reporter_);
  if (!bus) {
    return std::unexpected(bus.error());
  }
  const auto wanted = shared_.local_node_id
                          ? std::optional(dronecan::NodeId(*shared_.local_node_id))
                          : std::nullopt;
  std::optional<LocalNodeId> local;
  const bool listens = shared_.listen_only || bus->bus->is_recording();
  if (!listens && bus->lock_name.empty()) {
    local = LocalNodeId::unshared(wanted);
  } else if (!listens) {
    auto acquired = LocalNodeId::acquire(bus->lock_name, wanted, bus->lock_folder);
    if (!acquired) {
      return std::unexpected(acquired.error());
    }
    local = std::move(*acquired);
  }
  lock_name_ = bus->lock_name;
  lock_folder_ = bus->lock_folder;
  log_ = bus->log;
  auto recording = recorded(std::move(bus->bus));
  if (!recording) {
    return std::unexpected(recording.error());
  }
  auto session = fleet::Session::open(std::move(*recording), std::move(local), hearing);
  if (!session) {
    return std::unexpected(session.error());
  }
  session_ = std::move(*session);
  session_->on_stopping([this] { reporter_.note(say<texts::finishing>()); });
  if (auto ready = session_->wait_until_open(); !ready) {
    return std::unexpected(ready.error());
  }
  if (!session_->opening_note().empty()) {
    reporter_.note(session_->opening_note());
  }
  opened_ = session_->now();
  return session_.get();
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
  if (!session || lock_name_.empty()) {
    return session;
  }
  using state::InterfaceLock;
  auto lock = InterfaceLock::acquire(lock_name_, InterfaceLock::Right::write, lock_folder_);
  if (!lock) {
    return std::unexpected(lock.error());
  }
  writing_ = std::move(*lock);
  return session;
}

bool Context::may_allocate() {
  if (lock_name_.empty() || allocating_) {
    return true;
  }
  using state::InterfaceLock;
  if (auto lock =
          InterfaceLock::acquire(lock_name_, InterfaceLock::Right::allocate, lock_folder_)) {
    allocating_ = std::move(*lock);
  }
  return allocating_.has_value();
}

Result<std::unique_ptr<can::Bus>> Context::recorded(std::unique_ptr<can::Bus> bus) {
  if (!shared_.record) {
    return bus;
  }
  const auto name = parse_interface(shared_.interface);
  if (log_ != nullptr && name) {
    std::error_code error;
    const std::string path = name->rest == "-" ? "/dev/stdin" : name->rest;
    if (std::filesystem::equivalent(path, *shared_.record, error)) {
      return fail(Code::usage, say<texts::records_itself>(printable(*shared_.record)),
                  say<texts::record_unopened_hint>());
    }
  }
  auto recorder = can::Recorder::open(std::move(bus), *shared_.record);
  if (!recorder) {
    return std::unexpected(recorder.error());
  }
  recorder_ = recorder->get();
  return std::move(*recorder);
}

fleet::Identification::Options Context::identification() const {
  return {.patience = shared_.patience, .assumed = assumed_, .static_node_id = false};
}

void Context::tell_losses(Report& report) const {
  if (!session_) {
    return;
  }
  if (session_->lost_frames() > 0) {
    reporter_.note(say<texts::frames_lost>(session_->lost_frames()));
  }
  if (session_->unreadable() > 0) {
    reporter_.note(say<texts::unreadable_frames>(session_->unreadable()));
  }
  if (log_ != nullptr && log_->reader().bad_lines() > 0) {
    const can::CandumpReader& log = log_->reader();
    reporter_.note(
        say<texts::lines_passed_over>(log.name(), log.bad_lines(), log.first_bad_line()));
  }
  check_recording(report);
}

void Context::check_recording(Report& report) const {
  if (recorder_ != nullptr && recorder_->error()) {
    report.fail(*recorder_->error());
  }
}

void Context::broken(const Error& error, Report& report) const {
  // What the jobs say of their cancelled questions is the same news.
  std::erase_if(report.errors, [](const Error& known) { return known.code == Code::interrupted; });
  report.errors.insert(report.errors.begin(), error);
  report.statuses.clear();
  report.signal = signal();
}

/// Hears who is there and identifies every servo.
void Context::search(Duration time, Report& report, bool failures_count) {
  if (auto lived = session_->live_until(session_->now() + time); !lived) {
    broken(lived.error(), report);
    return;
  }
  std::vector<std::unique_ptr<fleet::IdentifyJob>> jobs;
  for (auto& [id, member] : session_->roster().members()) {
    if (member.sends_actuator_status()) {
      jobs.push_back(std::make_unique<fleet::IdentifyJob>(session_->roster(), member, *profiles_,
                                                          identification()));
      session_->start(*jobs.back());
    }
  }
  if (auto ran = session_->run(); !ran) {
    broken(ran.error(), report);
    return;
  }
  for (const auto& job : jobs) {
    if (const auto& error = job->identification().error(); error && failures_count) {
      report.fail(*error);
      report.statuses.push_back(exit_status(error->code));
    }
  }
}

std::vector<Member*> Context::matching(const fleet::Targets& targets, Report& report) {
  std::set<dronecan::NodeId> chosen(targets.ids.begin(), targets.ids.end());
  const auto& members = session_->roster().members();
  for (const auto& [id, member] : members) {
    if (targets.mean(member, *profiles_)) {
      chosen.insert(id);
    }
  }
  for (const fleet::Selector& selector : targets.selectors) {
    if (std::ranges::none_of(members, [&](const auto& entry) {
          return selector.matches(entry.second, *profiles_);
        })) {
      report.fail({Code::not_found, say<texts::nothing_matches>(printable(selector.text)),
                   say<texts::node_not_found_hint>(), std::nullopt});
      report.statuses.push_back(exit_status(Code::not_found));
    }
  }
  std::vector<Member*> servos;
  servos.reserve(chosen.size());
  for (const dronecan::NodeId id : chosen) {
    servos.push_back(&session_->roster().member(id));
  }
  return servos;
}

std::vector<Member*> Context::select(const fleet::Targets& targets, Duration time, Report& report) {
  if (targets.need_search()) {
    search(time, report, targets.selectors.empty());
    if (report.signal != 0 || (!report.errors.empty() && report.statuses.empty())) {
      return {}; // the bus broke
    }
  }
  auto servos = matching(targets, report);
  if (servos.empty() && report.errors.empty()) {
    report.fail({Code::not_found, say<texts::no_servo_found>(), say<texts::no_servo_found_hint>(),
                 std::nullopt});
  }
  return servos;
}

std::vector<Member*> Context::select_for_writing(const fleet::Targets& targets, Report& report) {
  auto servos = select(targets, targets.given ? servo_search_time : bus_watch_time, report);
  if (!report.errors.empty()) {
    return {};
  }
  if (!targets.given && servos.size() > 1) {
    std::string ids;
    for (const Member* servo : servos) {
      ids += (ids.empty() ? "" : ", ") + std::to_string(servo->id.value());
    }
    report.fail({Code::usage, say<texts::several_servos>(ids),
                 say<texts::several_servos_hint>(servos.front()->id.value()), std::nullopt});
    return {};
  }
  return servos;
}

bool Context::hear_bus(Report& report) {
  if (auto lived = session_->live_until(opened_ + bus_watch_time); !lived) {
    broken(lived.error(), report);
    return false;
  }
  if (session_->lost_frames() > 0) {
    report.fail({Code::state, say<texts::lost_while_listening>(), say<texts::run_again_hint>(),
                 std::nullopt});
    return false;
  }
  return true;
}

} // namespace blactl::cli
