// blactl set: checks against the profile, writes, reads back.

#include "blactl/bla/assignment.hpp"
#include "blactl/bla/value.hpp"
#include "blactl/fleet/read_job.hpp"
#include "blactl/fleet/safety.hpp"
#include "blactl/fleet/texts.hpp"
#include "blactl/fleet/write_job.hpp"

#include "cli/commands.hpp"
#include "cli/confirm.hpp"
#include "cli/interface/bus_factory.hpp"
#include "cli/output/node_head.hpp"
#include "cli/set_outcome.hpp"
#include "cli/texts.hpp"

#include <algorithm>
#include <memory>
#include <utility>

namespace blactl::cli {
namespace {

using bla::Assignment;
using fleet::Change;
using fleet::ChangeStatus;
using fleet::Member;
using fleet::ReadJob;
using fleet::WriteJob;

using Assignments = std::vector<Assignment>;

Plan plan_changes(const ReadJob& job, Member& member, const Assignments& assignments) {
  Plan plan{&member, {}};
  for (const Assignment& assignment : assignments) {
    const bla::Address address = assignment.parameter->address;
    Change change{.parameter = member.identity.parameter(address),
                  .requested = assignment.value.raw};
    change.before = job.raw(address);
    if (change.before == change.requested) {
      change.status = ChangeStatus::unchanged;
      change.after = change.before;
    }
    plan.changes.push_back(std::move(change));
  }
  plan.mode_before = plan.mode_after = job.raw(bla::address::pwm_mode);
  for (const Change& change : plan.changes) {
    if (change.parameter->address == bla::address::pwm_mode) {
      plan.mode_after = change.requested;
    }
  }
  return plan;
}

/// The registers whose present value the checks need: those to be written, 0x37 for the unit of
/// 0x36, and what tells whether a change moves the shaft.
std::vector<const bla::Parameter*> to_read(const Assignments& assignments, const Member& servo) {
  std::vector<const bla::Parameter*> wanted;
  const auto add = [&](bla::Address address) {
    const bla::Parameter* parameter = servo.identity.parameter(address);
    const auto same = [&](const bla::Parameter* other) { return other->address == address; };
    if (parameter != nullptr && std::ranges::none_of(wanted, same)) {
      wanted.push_back(parameter);
    }
  };
  for (const Assignment& assignment : assignments) {
    add(assignment.parameter->address);
  }
  for (const Assignment& assignment : assignments) {
    if (assignment.parameter->address == bla::address::pwm_output_range) {
      add(bla::address::pwm_mode);
    }
    for (const bla::Address needed : fleet::values_needed(assignment.parameter->address)) {
      add(needed);
    }
  }
  return wanted;
}

/// For --save all is read that will be saved: after the restart it must be the same.
void add_configuration(std::vector<const bla::Parameter*>& wanted, const Member& servo,
                       const bla::Profiles& profiles) {
  for (const bla::Parameter* parameter : fleet::configuration(profiles, servo)) {
    if (std::ranges::find(wanted, parameter) == wanted.end()) {
      wanted.push_back(parameter);
    }
  }
}

/// Whether this servo takes every one of these values. Nothing has been written.
Result<std::vector<const bla::Parameter*>> admit(const Assignments& assignments,
                                                 const Member& servo) {
  for (const Assignment& assignment : assignments) {
    const auto allowed =
        servo.identity.may_write(assignment.parameter->address, assignment.value.raw);
    if (!allowed) {
      return std::unexpected(allowed.error());
    }
  }
  return to_read(assignments, servo);
}

/// 0x36 in deg or rpm is right only if 0x37 says so; without a 0x37 beside it, the servo's.
std::optional<Error> check_pwm_unit(const bla::Profiles& profiles, const Assignments& assignments,
                                    const ReadJob& job) {
  const auto sets_mode = [](const Assignment& assignment) {
    return assignment.parameter->address == bla::address::pwm_mode;
  };
  const auto mode = job.raw(bla::address::pwm_mode);
  if (!mode || std::ranges::any_of(assignments, sets_mode)) {
    return std::nullopt; // parse_assignments() has compared the two
  }
  for (const Assignment& assignment : assignments) {
    if (auto fits = bla::check_pwm_unit(profiles, assignment, *mode); !fits) {
      const std::uint8_t id = job.member().id.value();
      Error& error = fits.error();
      return Error{error.code, say<texts::about_node>(id, error.message), error.hint, id};
    }
  }
  return std::nullopt;
}

/// What the configuration of a servo is once the changes are made.
fleet::Values expected_after(const Plan& plan, const ReadJob& job) {
  fleet::Values expected;
  for (const bla::Parameter* parameter : plan.configuration) {
    if (const auto raw = job.raw(parameter->address)) {
      expected[parameter->address] = *raw;
    }
  }
  for (const Change& change : plan.changes) {
    if (change.parameter->saved) {
      expected[change.parameter->address] = change.requested;
    }
  }
  return expected;
}

/// The exit status of one servo, and its errors into the report.
int judge(const Plan& plan, bool dry_run, Report& report) {
  constexpr int would_change = 8;
  int status = 0;
  for (const Change& change : plan.changes) {
    if (change.error) {
      report.fail(*change.error);
      status = status == 0 ? exit_status(change.error->code) : status;
    } else if (dry_run && change.status == ChangeStatus::planned) {
      status = status == 0 ? would_change : status;
    }
  }
  if (plan.save_error) {
    report.fail(*plan.save_error);
    status = status == 0 ? exit_status(plan.save_error->code) : status;
  }
  return status;
}

/// The steps of the command; each may end it with errors in the report.
class Set {
 public:
  Set(const SetOptions& options, Context& context, Report& report)
      : options_(options), context_(context), report_(report) {}

  void run() {
    if (understand() && select() && read() && watch() && check() && confirm() && check()) {
      if (!options_.dry_run && write() && options_.save) {
        save();
      }
      conclude();
      return;
    }
    for (Error& error : report_.errors) {
      if (error.code == Code::interrupted) {
        error.hint = say<texts::nothing_written_hint>();
      }
    }
  }

 private:
  bool stop(Error error) {
    report_.fail(std::move(error));
    return false;
  }

  /// Everything that every model would refuse: not one frame is sent.
  bool understand();
  bool select();
  /// Identifies the servos and reads what they hold; their refusals come here.
  bool read();
  /// Hears the bus for long enough to know who drives, is armed, or shares an ID.
  bool watch();
  /// What the others on the bus forbid; once more after a question, which may take its time.
  bool check();
  bool confirm();
  /// False: the bus broke or the user interrupted.
  bool write();
  /// RAM to ROM, for the servos that took every value.
  void save();
  void conclude();

  const SetOptions& options_;
  Context& context_;
  Report& report_;
  const bla::Profiles* profiles_ = nullptr;
  Assignments assignments_;
  std::vector<Member*> members_;
  std::vector<std::unique_ptr<ReadJob>> reads_;
  std::shared_ptr<Outcome> outcome_ = std::make_shared<Outcome>();
};

bool Set::understand() {
  const auto profiles = context_.profiles();
  if (!profiles) {
    return stop(profiles.error());
  }
  profiles_ = *profiles;
  auto assignments = bla::parse_assignments(*profiles_, options_.assignments);
  if (!assignments) {
    return stop(assignments.error());
  }
  assignments_ = std::move(*assignments);
  const auto commands = std::ranges::count_if(assignments_, [](const Assignment& assignment) {
    return assignment.parameter->can_be_inactive;
  });
  if (commands > 1) { // each makes the others inactive (4.1-4.3)
    return stop({Code::cross_check, say<texts::one_command_only>(),
                 say<texts::one_command_only_hint>(), std::nullopt});
  }
  return true;
}

bool Set::select() {
  const auto targets = context_.targets();
  if (!targets) {
    return stop(targets.error());
  }
  if (auto session = context_.open_for_writing("set"); !session) {
    return stop(session.error());
  }
  report_.interface = context_.session().interface();
  members_ = context_.select_for_writing(*targets, report_);
  if (!report_.errors.empty()) {
    return false;
  }
  const bool gives_node_id = std::ranges::any_of(assignments_, [](const Assignment& assignment) {
    return assignment.parameter->address == bla::address::static_node_id &&
           assignment.value.raw != 0;
  });
  if (gives_node_id && members_.size() > 1) {
    return stop({Code::duplicate_node_id, say<texts::one_id_for_several>(members_.size()),
                 say<texts::one_id_for_several_hint>(members_.front()->id.value()), std::nullopt});
  }
  return true;
}

bool Set::read() {
  fleet::Session& session = context_.session();
  for (Member* member : members_) {
    reads_.push_back(std::make_unique<ReadJob>(
        session.roster(), *member, *profiles_, context_.identification(),
        [this](const Member& servo) -> Result<std::vector<const bla::Parameter*>> {
          auto wanted = admit(assignments_, servo);
          if (wanted && options_.save) {
            add_configuration(*wanted, servo, *profiles_);
          }
          return wanted;
        }));
    session.start(*reads_.back());
  }
  if (auto ran = session.run(); !ran) {
    context_.broken(ran.error(), report_);
    return false;
  }
  for (std::size_t i = 0; i < reads_.size(); ++i) {
    const ReadJob& job = *reads_[i];
    std::optional<Error> error = job.error();
    for (const auto& reading : job.readings()) {
      if (!error && !reading.raw) {
        error = reading.raw.error();
      }
    }
    if (!error) {
      error = check_pwm_unit(*profiles_, assignments_, job);
    } else if (context_.session().roster().is_doubled(members_[i]->id)) {
      error = fleet::doubled(members_[i]->id); // two that answer at once answer nothing
    }
    // If one servo refuses, none is written: the others are no success.
    if (error) {
      report_.statuses.push_back(exit_status(error->code));
      report_.fail(std::move(*error));
    } else {
      outcome_->plans.push_back(plan_changes(job, *members_[i], assignments_));
      if (options_.save) {
        members_[i]->static_node_id = job.raw(bla::address::static_node_id);
        outcome_->plans.back().configuration = fleet::configuration(*profiles_, *members_[i]);
      }
    }
  }
  return report_.errors.empty();
}

bool Set::watch() {
  const bool nothing_to_write = std::ranges::none_of(
      outcome_->plans, [](const Plan& plan) { return fleet::needs_watch(plan.changes); });
  return (nothing_to_write && !options_.save) || context_.hear_bus(report_);
}

bool Set::check() {
  report_.statuses.clear();
  for (std::size_t i = 0; i < reads_.size(); ++i) {
    if (auto error = fleet::forbidden(context_.session(), outcome_->plans[i].changes, *reads_[i],
                                      context_.shared().while_driven)) {
      report_.fail(std::move(*error));
    } else if (options_.save) {
      if (auto refused = fleet::forbidden(context_.session(), reads_[i]->member(), true,
                                          context_.shared().while_driven)) {
        report_.fail(std::move(*refused));
      }
    }
  }
  return report_.errors.empty();
}

bool Set::confirm() {
  if (options_.dry_run) {
    return true;
  }
  std::string question;
  for (std::size_t i = 0; i < outcome_->plans.size(); ++i) {
    const Plan& plan = outcome_->plans[i];
    if (options_.save) {
      question += restart_question(*plan.member, expected_after(plan, *reads_[i]));
    }

    for (const Change& change : plan.changes) {
      if (change.status == ChangeStatus::planned && fleet::may_move(change, *reads_[i])) {
        const auto& parameter = *change.parameter;
        question += say<texts::question_change>(
            plan.member->id.value(), parameter.name,
            change.before ? register_text(parameter, *change.before, plan.mode_before)
                          : say<texts::unknown_before>(),
            register_text(parameter, change.requested, plan.mode_after));
      }
    }
  }
  if (question.empty()) {
    return true;
  }
  const auto agreed = blactl::cli::confirm(say<texts::question_may_move>() + question, context_);
  if (agreed) {
    return true;
  }
  if (agreed.error().code == Code::not_confirmed) {
    return stop(agreed.error());
  }
  context_.broken(agreed.error(), report_);
  return false;
}

bool Set::write() {
  fleet::Session& session = context_.session();
  std::vector<std::unique_ptr<WriteJob>> jobs;
  for (Plan& plan : outcome_->plans) {
    jobs.push_back(
        std::make_unique<WriteJob>(*plan.member, plan.changes, context_.shared().patience));
    session.start(*jobs.back());
  }
  const auto ran = session.run();
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    outcome_->plans[i].changes = jobs[i]->changes();
  }
  if (!ran) {
    context_.broken(ran.error(), report_);
  }
  if (const std::size_t frames = session.unsent(); frames > 0) {
    report_.fail({Code::no_acknowledge,
                  say<texts::not_written>(frames, session.interface()),
                  {},
                  std::nullopt});
  }
  return report_.errors.empty();
}

void Set::save() {
  for (std::size_t i = 0; i < reads_.size(); ++i) {
    const Plan& plan = outcome_->plans[i];
    const auto has_failed = [](const Change& change) { return change.error.has_value(); };
    if (std::ranges::none_of(plan.changes, has_failed)) {
      outcome_->saves.push_back({*plan.member, plan.member, expected_after(plan, *reads_[i])});
    }
  }
  (void)pass_restart(outcome_->saves, fleet::RestartKind::save, options_.times, context_, report_);
  for (Plan& plan : outcome_->plans) {
    const auto passage = std::ranges::find_if(outcome_->saves, [&](const Passage& candidate) {
      return candidate.before.id == plan.member->id;
    });
    plan.saved = passage != outcome_->saves.end() && passage->is_done();
    if (passage != outcome_->saves.end() && passage->error) {
      plan.save_error = passage->error;
    }
  }
}

void Set::conclude() {
  const bool broken = !report_.errors.empty();
  std::size_t written = 0;
  for (const Plan& plan : outcome_->plans) {
    const int status = judge(plan, options_.dry_run, report_);
    if (!broken) {
      report_.statuses.push_back(status);
    }
    written += static_cast<std::size_t>(
        std::ranges::count(plan.changes, ChangeStatus::written, &Change::status));
  }
  report_.counts = {{"nodes", outcome_->plans.size()}, {"written", written}};
  report_.json = [outcome = outcome_](JsonWriter& json) { write_json(json, *outcome); };
  report_.text = [outcome = outcome_] { return text(*outcome); };
}

} // namespace

Report execute(const SetOptions& options, Context& context) {
  Report report{.interface = printable(context.shared().interface)};
  Set(options, context, report).run();
  return report;
}

} // namespace blactl::cli
