// blactl save, erase, restart: what acts on whole servos.

#include "blactl/fleet/erase_job.hpp"
#include "blactl/fleet/read_job.hpp"
#include "blactl/fleet/safety.hpp"
#include "blactl/fleet/texts.hpp"
#include "blactl/fleet/write_job.hpp"

#include "cli/commands.hpp"
#include "cli/confirm.hpp"
#include "cli/lifecycle.hpp"
#include "cli/texts.hpp"

#include <algorithm>
#include <memory>
#include <utility>

namespace blactl::cli {
namespace {

using fleet::Member;
using fleet::ReadJob;
using fleet::RestartKind;
using fleet::Values;

/// The steps of the three commands; each may end the command with errors in the report.
class Life {
 public:
  Life(std::string_view command, Context& context, Report& report)
      : command_(command), context_(context), report_(report) {}

  /// Chooses the servos, reads their configuration, and hears what the others on the bus forbid.
  bool prepare() { return select() && read() && context_.hear_bus(report_) && check(); }

  /// Asks `question`, if there is one; then looks at the bus again.
  bool confirm(const std::string& question);

  void restart(RestartKind kind, const RestartTimes& times) {
    (void)pass_restart(*passages_, kind, times, context_, report_);
  }

  bool erase();
  bool restore_ids(const std::vector<Values>& before);
  void leave_unsaved();
  void conclude();

  [[nodiscard]] std::vector<Passage>& passages() { return *passages_; }

  [[nodiscard]] const bla::Profiles& profiles() const { return *profiles_; }

  bool stop(Error error) {
    report_.fail(std::move(error));
    return false;
  }

 private:
  bool select();
  bool read();
  bool check();
  bool send_erase();

  std::string_view command_;
  Context& context_;
  Report& report_;
  const bla::Profiles* profiles_ = nullptr;
  std::vector<Member*> servos_;
  std::shared_ptr<std::vector<Passage>> passages_ = std::make_shared<std::vector<Passage>>();
};

bool Life::select() {
  const auto profiles = context_.profiles();
  if (!profiles) {
    return stop(profiles.error());
  }
  profiles_ = *profiles;
  const auto targets = context_.targets();
  if (!targets) {
    return stop(targets.error());
  }
  if (auto session = context_.open_for_writing(command_); !session) {
    return stop(session.error());
  }
  report_.interface = context_.session().interface();
  servos_ = context_.select_for_writing(*targets, report_);
  return report_.errors.empty();
}

bool Life::read() {
  fleet::Session& session = context_.session();
  std::vector<std::unique_ptr<ReadJob>> jobs;
  for (Member* servo : servos_) {
    jobs.push_back(std::make_unique<ReadJob>(
        session.roster(), *servo, *profiles_, context_.identification(),
        [this](const Member& member) -> Result<std::vector<const bla::Parameter*>> {
          if (member.identity.model().empty()) { // unknown model: reading only
            return fail(Code::no_profile, say<texts::model_unknown>(),
                        say<texts::defaults_unknown_hint>());
          }
          return fleet::configuration(*profiles_, member);
        }));
    session.start(*jobs.back());
  }
  if (auto ran = session.run(); !ran) {
    context_.broken(ran.error(), report_);
    return false;
  }
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    auto error = fleet::compare(*jobs[i], {});
    if (error) {
      report_.statuses.push_back(exit_status(error->code));
      report_.fail(std::move(*error));
    } else {
      servos_[i]->static_node_id = jobs[i]->raw(bla::address::static_node_id);
      passages_->push_back({*servos_[i], servos_[i], fleet::values(*jobs[i])});
    }
  }
  return report_.errors.empty();
}

bool Life::check() {
  for (const Member* servo : servos_) {
    if (auto error =
            fleet::forbidden(context_.session(), *servo, true, context_.shared().while_driven)) {
      report_.fail(std::move(*error));
    }
  }
  return report_.errors.empty();
}

bool Life::confirm(const std::string& question) {
  if (question.empty()) {
    return true;
  }
  const auto agreed = blactl::cli::confirm(question, context_);
  if (!agreed && agreed.error().code == Code::not_confirmed) {
    return stop(agreed.error());
  }
  if (!agreed) {
    context_.broken(agreed.error(), report_);
    return false;
  }
  return check();
}

/// ERASE to each servo that has no error yet, once.
bool Life::send_erase() {
  std::vector<std::pair<Passage*, std::unique_ptr<fleet::EraseJob>>> jobs;
  for (Passage& passage : *passages_) {
    if (!passage.error && !passage.is_verified) {
      jobs.emplace_back(
          &passage, std::make_unique<fleet::EraseJob>(*passage.servo, context_.shared().patience));
      context_.session().start(*jobs.back().second);
    }
  }
  const auto ran = context_.session().run();
  for (auto& [passage, job] : jobs) {
    passage->error = job->error();
    passage->is_confirmed = job->is_confirmed();
  }
  if (!ran) {
    context_.broken(ran.error(), report_);
    return false;
  }
  return verify(*passages_, false, context_, report_);
}

/// Erases and reads back. Where the registers show that a request without an answer was not carried
/// out it is sent once more.
bool Life::erase() {
  if (!send_erase()) {
    return false;
  }
  bool again = false;
  for (Passage& passage : *passages_) {
    if (passage.error && passage.error->code == Code::mismatch && !passage.is_confirmed) {
      passage.error.reset();
      again = true;
    }
  }
  return !again || send_erase();
}

/// --keep-ids: 0x45 and 0x46 back into RAM.
bool Life::restore_ids(const std::vector<Values>& before) {
  std::vector<std::pair<Passage*, std::unique_ptr<fleet::WriteJob>>> jobs;
  for (std::size_t i = 0; i < passages_->size(); ++i) {
    Passage& passage = (*passages_)[i];
    std::vector<fleet::Change> changes;
    for (const bla::Address address : {bla::address::servo_id, bla::address::static_node_id}) {
      const auto kept = before[i].find(address);
      if (!passage.error && kept != before[i].end() && kept->second != 0) {
        changes.push_back({.parameter = passage.servo->identity.parameter(address),
                           .requested = kept->second,
                           .before = 0});
        passage.expected[address] = kept->second;
      }
    }
    if (!changes.empty()) {
      jobs.emplace_back(&passage, std::make_unique<fleet::WriteJob>(*passage.servo, changes,
                                                                    context_.shared().patience));
      context_.session().start(*jobs.back().second);
    }
  }
  const auto ran = context_.session().run();
  for (auto& [passage, job] : jobs) {
    for (const fleet::Change& change : job->changes()) {
      passage->error = passage->error ? passage->error : change.error;
    }
  }
  if (!ran) {
    context_.broken(ran.error(), report_);
  }
  return ran.has_value();
}

/// It came to an end before SAVE: what is in RAM now is gone with the next restart.
void Life::leave_unsaved() {
  for (Passage& passage : *passages_) {
    const std::uint8_t id = passage.before.id.value();
    if (!passage.error) {
      passage.error = Error{Code::interrupted, say<texts::not_saved>(id), {}, id};
    }
  }
}

void Life::conclude() {
  const bool broken = !report_.errors.empty();
  std::size_t done = 0;
  for (const Passage& passage : *passages_) {
    done += static_cast<std::size_t>(passage.is_done());
    if (passage.error) {
      report_.fail(*passage.error);
    }
    if (!broken) {
      report_.statuses.push_back(passage.error ? exit_status(passage.error->code) : 0);
    }
  }
  report_.counts = {{"nodes", passages_->size()}, {"done", done}};
  report_.json = [passages = passages_](JsonWriter& json) { write_json(json, *passages); };
  report_.text = [passages = passages_] { return text(*passages); };
}

std::string restart_questions(const std::vector<Passage>& passages) {
  std::string question;
  for (const Passage& passage : passages) {
    question += restart_question(passage.before, passage.expected);
  }
  return question;
}

Report restart_all(std::string_view command, RestartKind kind, const RestartTimes& times,
                   Context& context) {
  Report report{.interface = printable(context.shared().interface)};
  Life life(command, context, report);
  if (!life.prepare() || !life.confirm(restart_questions(life.passages()))) {
    return report;
  }
  life.restart(kind, times);
  life.conclude();
  return report;
}

/// What erasing this servo will do, from what to what.
std::string erase_question(const Passage& passage, bool keep_ids) {
  const auto id_text = [&](bla::Address address) {
    const auto it = passage.expected.find(address);
    return it != passage.expected.end() ? std::to_string(it->second) : say<texts::unknown_before>();
  };
  const std::uint8_t id = passage.before.id.value();
  return keep_ids ? say<texts::question_erase_keep>(id)
                  : say<texts::question_erase>(id, id_text(bla::address::servo_id),
                                               id_text(bla::address::static_node_id));
}

} // namespace

Report execute(const SaveOptions& options, Context& context) {
  return restart_all("save", RestartKind::save, options.times, context);
}

Report execute(const RestartOptions& options, Context& context) {
  return restart_all("restart", RestartKind::restart, options.times, context);
}

Report execute(const EraseOptions& options, Context& context) {
  Report report{.interface = printable(context.shared().interface)};
  Life life("erase", context, report);
  if (!life.prepare()) {
    return report;
  }
  std::string question;
  std::vector<Values> before;
  for (Passage& passage : life.passages()) {
    question += erase_question(passage, options.keep_ids);
    before.push_back(passage.expected);
    auto defaults = fleet::factory_defaults(life.profiles(), passage.before);
    if (!defaults) {
      report.fail(defaults.error());
      continue;
    }
    passage.expected = std::move(*defaults);
    if (options.save) {
      question += restart_question(passage.before, passage.expected);
    }
  }
  if (!report.errors.empty() || !life.confirm(question)) {
    return report;
  }
  const bool erased = life.erase() && (!options.keep_ids || life.restore_ids(before));
  if (options.save && erased) {
    life.restart(RestartKind::save, options.times);
  } else if (options.save) {
    life.leave_unsaved();
  }
  life.conclude();
  return report;
}

} // namespace blactl::cli
