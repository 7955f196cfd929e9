#include "cli/lifecycle.hpp"

#include "blactl/fleet/read_job.hpp"
#include "blactl/fleet/texts.hpp"

#include "cli/output/node_head.hpp"
#include "cli/texts.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace blactl::cli {

namespace {

constexpr bla::Address soft_start{0x21};

std::string seconds(Duration duration) {
  return fmt::format("{:.3f}", std::chrono::duration<double>(duration).count());
}

/// The configuration; after a save also whether ROM could be read.
Result<std::vector<const bla::Parameter*>> to_verify(const bla::Profiles& profiles,
                                                     const fleet::Member& servo, bool after_save) {
  auto parameters = fleet::configuration(profiles, servo);
  if (const auto* rom_state = fleet::rom_state(servo); after_save && rom_state != nullptr) {
    parameters.push_back(rom_state);
  }
  return parameters;
}

/// What RAM has shown before and does not show now, ROM has not taken.
void check_after_save(const fleet::ReadJob& job, std::optional<Error>& error) {
  if (auto unreadable = fleet::check_rom(job)) {
    error = std::move(unreadable);
  } else if (error && error->code == Code::mismatch) {
    error->hint = say<texts::rom_differs_hint>();
  }
}

} // namespace

std::string restart_question(const fleet::Member& servo, const fleet::Values& values) {
  const auto is = [&](bla::Address address, std::int64_t raw) {
    const auto it = values.find(address);
    return it == values.end() || it->second == raw; // what is not known may be
  };
  constexpr std::int64_t on = 0; // 0x20 counts upside down (4.13)
  if (!is(bla::address::torque_output, on)) {
    return {};
  }
  return is(soft_start, 1) ? say<texts::question_restart_soft>(servo.id.value())
                           : say<texts::question_restart_hard>(servo.id.value());
}

bool verify(std::vector<Passage>& passages, bool after_save, Context& context, Report& report) {
  const auto profiles = context.profiles();
  if (!profiles) {
    report.fail(profiles.error());
    return false;
  }

  std::vector<std::pair<Passage*, std::unique_ptr<fleet::ReadJob>>> reads;
  for (Passage& passage : passages) {
    if (passage.error) {
      continue;
    }
    reads.emplace_back(&passage, std::make_unique<fleet::ReadJob>(
                                     context.session().roster(), *passage.servo, **profiles,
                                     context.identification(), [&](const fleet::Member& servo) {
                                       return to_verify(**profiles, servo, after_save);
                                     }));
    context.session().start(*reads.back().second);
  }
  const auto ran = context.session().run();
  for (auto& [passage, job] : reads) {
    passage->error = fleet::compare(*job, passage->expected);
    if (after_save) {
      check_after_save(*job, passage->error);
    }
    passage->before.servo_id =
        job->raw(bla::address::servo_id).or_else([&] { return passage->before.servo_id; });
    passage->is_verified = !passage->error;
    passage->values_read = passage->expected.size();
    passage->servo->static_node_id = job->raw(bla::address::static_node_id);
  }
  if (!ran) {
    context.broken(ran.error(), report);
  }
  return ran.has_value();
}

bool pass_restart(std::vector<Passage>& passages, fleet::RestartKind kind,
                  const RestartTimes& times, Context& context, Report& report) {
  std::vector<fleet::Member*> servos;
  std::vector<Passage*> passing;
  for (Passage& passage : passages) {
    if (!passage.error) {
      // Where it begins anew hangs on what was written last.
      if (const auto id = passage.expected.find(bla::address::static_node_id);
          id != passage.expected.end()) {
        passage.servo->static_node_id = id->second;
      }
      servos.push_back(passage.servo);
      passing.push_back(&passage);
      passage.is_verified = false;
    }
  }
  fleet::RestartPlan plan;
  plan.kind = kind;
  plan.stagger = times.stagger;
  plan.come_back = times.wait;
  plan.patience = context.shared().patience;
  // A servo that finds its ROM unreadable asks as well, whatever it was given.
  plan.may_allocate = context.may_allocate();
  const auto result = fleet::restart(context.session(), servos, plan);
  for (std::size_t i = 0; i < passing.size(); ++i) {
    const fleet::Restarted& restarted = result.servos[i];
    passing[i]->error = restarted.error;
    passing[i]->duration = restarted.duration;
    passing[i]->is_back = restarted.after != nullptr;
    if (restarted.after != nullptr) {
      passing[i]->servo = restarted.after;
    }
  }
  if (result.broken) {
    for (Passage* passage : passing) {
      if (!passage->error) {
        const std::uint8_t id = passage->before.id.value();
        passage->error = Error{Code::interrupted, say<texts::back_not_verified>(id), {}, id};
      }
    }
    context.broken(*result.broken, report);
    return false;
  }

  if (kind == fleet::RestartKind::restart) {
    for (Passage* passage : passing) {
      passage->is_verified = !passage->error;
    }
    return true;
  }
  return verify(passages, true, context, report);
}

void write_json(JsonWriter& json, const std::vector<Passage>& passages) {
  json.key("nodes");
  json.begin_array();
  for (const Passage& passage : passages) {
    json.begin_object();
    write_head(json, passage.before);
    json.member("status", passage.is_done() ? "done" : "failed");
    json.key("node_id_after");
    // A servo that is away has none.
    const bool is_there = passage.is_back || passage.is_verified;
    is_there ? json.value(passage.servo->id.value()) : json.value(nullptr);
    json.key("duration_s");
    json.number(seconds(passage.duration));
    json.end_object();
  }
  json.end_array();
}

std::string text(const std::vector<Passage>& passages) {
  std::string out;
  for (const Passage& passage : passages) {
    out += head_line(passage.before) + "  ";
    if (!passage.is_done()) {
      out += passage.is_back ? say<texts::passage_back_failed>(passage.servo->id.value())
                             : say<texts::passage_failed>();
    } else if (passage.is_back) {
      out += say<texts::passage_back>(passage.servo->id.value(), seconds(passage.duration));
    } else {
      out += say<texts::passage_done>();
    }
    if (passage.is_done() && passage.values_read > 0) {
      out += say<texts::passage_values>(passage.values_read);
    }
    out += '\n';
  }
  return out;
}

} // namespace blactl::cli
