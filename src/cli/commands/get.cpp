// blactl get: reads parameters.

#include "blactl/bla/value.hpp"
#include "blactl/fleet/read_job.hpp"
#include "blactl/fleet/safety.hpp"
#include "blactl/fleet/texts.hpp"

#include "cli/commands.hpp"
#include "cli/interface/bus_factory.hpp"
#include "cli/output/node_head.hpp"
#include "cli/output/table.hpp"
#include "cli/texts.hpp"

#include <algorithm>
#include <memory>
#include <set>
#include <utility>

namespace blactl::cli {
namespace {

using bla::Parameter;
using fleet::Reading;
using fleet::ReadJob;

/// What was asked for, before any servo is known.
struct Wish {
  std::vector<const Parameter*> named; ///< in the order asked
  std::set<bla::Group> groups;
  bool changed_only = false;

  [[nodiscard]] bool everything() const { return named.empty() && groups.empty(); }

  [[nodiscard]] bool means(const Parameter& parameter) const {
    const auto same = [&](const Parameter* other) { return other->address == parameter.address; };
    return everything() || groups.contains(parameter.group) || std::ranges::any_of(named, same);
  }
};

/// What one servo answered, ready to be shown.
struct Answer {
  const ReadJob* job;
  std::vector<const Reading*> shown;
};

Result<bla::Group> find_group(const std::string& word) {
  if (const auto group = bla::find_group(word)) {
    return *group;
  }
  std::string known;
  for (const auto group :
       {bla::Group::command, bla::Group::status, bla::Group::operation, bla::Group::fault,
        bla::Group::config, bla::Group::control, bla::Group::pwm, bla::Group::limit,
        bla::Group::option, bla::Group::product, bla::Group::production}) {
    known += known.empty() ? "" : " ";
    known += bla::name(group);
  }
  return fail(Code::usage, say<texts::unknown_group>(printable(word)),
              say<texts::known_groups>(known));
}

/// Everything that can be refused without a servo.
Result<Wish> understand(const GetOptions& options, const bla::Profiles& profiles) {
  Wish wish;
  wish.changed_only = options.changed;
  for (const std::string& text : options.parameters) {
    const auto parameter = profiles.find(text);
    if (!parameter) {
      return std::unexpected(parameter.error());
    }
    if (!(*parameter)->readable()) {
      return fail(Code::unsupported, say<texts::write_only>((*parameter)->name),
                  say<texts::write_only_hint>());
    }
    wish.named.push_back(*parameter);
  }
  for (const std::string& word : options.groups) {
    const auto group = find_group(word);
    if (!group) {
      return std::unexpected(group.error());
    }
    wish.groups.insert(*group);
  }
  if (options.all) {
    wish.named.clear();
    wish.groups.clear();
  }
  return wish;
}

/// The registers to read of this servo. Named ones must be there; others are left out if not.
Result<std::vector<const Parameter*>> plan(const Wish& wish, const bla::Profiles& profiles,
                                           const fleet::Member& servo) {
  std::vector<const Parameter*> wanted;
  const bla::Identity& identity = servo.identity;
  for (const Parameter* parameter : wish.named) {
    const Parameter* of_model = identity.parameter(parameter->address);
    if (of_model == nullptr || !identity.has(*of_model)) {
      const std::uint8_t id = servo.id.value();
      const auto firmware = identity.readings().firmware_version.value_or(0);
      return fail(Code::unsupported,
                  say<texts::firmware_lacks>(parameter->name,
                                             version_text(parameter->min_firmware.value_or(0)),
                                             version_text(firmware)),
                  say<texts::firmware_lacks_hint>(id));
    }
    wanted.push_back(of_model);
  }
  for (const Parameter& parameter : profiles.registers()) {
    const Parameter* of_model = identity.parameter(parameter.address);
    if ((wish.everything() || wish.groups.contains(parameter.group)) && of_model != nullptr &&
        of_model->readable() && identity.has(*of_model)) {
      wanted.push_back(of_model);
    }
  }
  // The unit of 0x36 hangs on 0x37: that is read too, and not shown.
  const Parameter* mode = identity.parameter(bla::address::pwm_mode);
  const auto at = [](bla::Address address) {
    return [=](const Parameter* parameter) { return parameter->address == address; };
  };
  if (mode != nullptr && std::ranges::any_of(wanted, at(bla::address::pwm_output_range)) &&
      std::ranges::none_of(wanted, at(bla::address::pwm_mode))) {
    wanted.push_back(mode);
  }
  return wanted;
}

bool is_inactive(const Parameter& parameter, std::int64_t raw) {
  return parameter.can_be_inactive && raw == bla::not_active;
}

std::vector<const Reading*> shown(const ReadJob& job, const Wish& wish) {
  std::vector<const Reading*> chosen;
  for (const Reading& reading : job.readings()) {
    const Parameter& parameter = *reading.parameter;
    // Where the model, and so the default, is not known for sure, nothing is left out.
    const bool differs =
        reading.raw && parameter.writable() && reading.raw != parameter.default_raw;
    if (reading.raw && wish.means(parameter) && (!wish.changed_only || differs)) {
      chosen.push_back(&reading);
    }
  }
  return chosen;
}

/// The number in the parameter's unit; empty for "not active".
std::optional<std::string> number(const Answer& answer, const Reading& reading) {
  if (is_inactive(*reading.parameter, *reading.raw)) {
    return std::nullopt;
  }
  return bla::value_text(*reading.parameter, *reading.raw, answer.job->raw(bla::address::pwm_mode));
}

void write_reading(JsonWriter& json, const Answer& answer, const Reading& reading) {
  const Parameter& parameter = *reading.parameter;
  const auto mode = answer.job->raw(bla::address::pwm_mode);
  json.begin_object();
  json.member("address", parameter.address.name());
  json.member("name", parameter.name);
  json.member("raw", *reading.raw);
  json.key("value");
  const auto value = number(answer, reading);
  value ? json.number(*value) : json.value(nullptr);
  json.member("unit", bla::unit_text(parameter, mode));
  json.member("text", bla::display(parameter, *reading.raw, mode));
  json.member("default", parameter.default_raw);
  json.member("min", parameter.min);
  json.member("max", parameter.max);
  json.member("access", bla::name(parameter.access));
  json.end_object();
}

void write_json(JsonWriter& json, const std::vector<Answer>& answers) {
  json.key("nodes");
  json.begin_array();
  for (const Answer& answer : answers) {
    json.begin_object();
    write_head(json, answer.job->member());
    json.key("params");
    json.begin_array();
    for (const Reading* reading : answer.shown) {
      write_reading(json, answer, *reading);
    }
    json.end_array();
    json.end_object();
  }
  json.end_array();
}

std::string csv(const std::vector<Answer>& answers) {
  auto columns = head_columns();
  for (const char* name :
       {"address", "name", "raw", "value", "unit", "text", "default", "min", "max", "access"}) {
    columns.emplace_back(name);
  }
  std::string out = csv_line(columns);
  for (const Answer& answer : answers) {
    const auto mode = answer.job->raw(bla::address::pwm_mode);
    for (const Reading* reading : answer.shown) {
      const Parameter& parameter = *reading->parameter;
      auto cells = head_cells(answer.job->member());
      for (std::string cell :
           {parameter.address.name(), parameter.name, std::to_string(*reading->raw),
            number(answer, *reading).value_or(""), std::string(bla::unit_text(parameter, mode)),
            bla::display(parameter, *reading->raw, mode), or_text(parameter.default_raw, ""),
            or_text(parameter.min, ""), or_text(parameter.max, ""),
            std::string(bla::name(parameter.access))}) {
        cells.push_back(std::move(cell));
      }
      out += csv_line(cells);
    }
  }
  return out;
}

std::string text(const std::vector<Answer>& answers, const Wish& wish) {
  std::string out;
  for (const Answer& answer : answers) {
    out += out.empty() ? "" : "\n";
    out += head_line(answer.job->member());
    if (answer.shown.empty()) {
      out += wish.changed_only ? say<texts::nothing_changed>() : "";
      continue;
    }
    const auto mode = answer.job->raw(bla::address::pwm_mode);
    Table table({"", say<texts::column_parameter>(), say<texts::column_value>(),
                 say<texts::column_default>()});
    for (const Reading* reading : answer.shown) {
      const Parameter& parameter = *reading->parameter;
      table.add({parameter.address.name(), parameter.name,
                 register_text(parameter, *reading->raw, mode),
                 parameter.default_raw && parameter.writable()
                     ? bla::display(parameter, *parameter.default_raw, mode)
                     : ""});
    }
    out += table.text("  ");
  }
  return out;
}

/// One error for all that a recording lacks: of a servo that was never read it is everything.
std::optional<Error> not_recorded(const ReadJob& job) {
  constexpr std::size_t most_names = 8;
  std::string names;
  std::size_t count = 0;
  for (const Reading& reading : job.readings()) {
    if (reading.raw || reading.raw.error().code != Code::not_recorded) {
      continue;
    }
    if (count++ < most_names) {
      names += names.empty() ? "" : ", ";
      names += reading.parameter->name;
    }
  }
  if (count == 0) {
    return std::nullopt;
  }
  const std::string list =
      count > most_names ? say<texts::and_more>(names, count - most_names) : names;
  const std::uint8_t id = job.member().id.value();
  return Error{Code::not_recorded, say<texts::not_recorded>(id, list),
               say<texts::not_recorded_hint>(), id};
}

/// The worst that happened to one servo: 0, or the status of its first error.
int judge(const ReadJob& job, const fleet::Roster& roster, Report& report) {
  int status = 0;
  const auto failed = [&](const Error& error) {
    report.fail(error);
    status = status == 0 ? exit_status(error.code) : status;
  };
  if (roster.is_doubled(job.member().id)) {
    failed(fleet::doubled(job.member().id)); // what was read is a mixture of two
  } else if (job.error()) {
    failed(*job.error());
  }
  for (const Reading& reading : job.readings()) {
    if (!reading.raw && reading.raw.error().code != Code::not_recorded) {
      failed(reading.raw.error());
    }
  }
  if (const auto error = not_recorded(job)) {
    failed(*error);
  }
  return status;
}

} // namespace

Report execute(const GetOptions& options, Context& context) {
  Report report{.interface = printable(context.shared().interface)};
  const auto stop = [&](Error error) {
    report.fail(std::move(error));
    return std::move(report);
  };
  const auto profiles = context.profiles();
  if (!profiles) {
    return stop(profiles.error());
  }
  const auto wish = understand(options, **profiles);
  if (!wish) {
    return stop(wish.error());
  }
  const bool must_send = !takes_no_frames(context.shared().interface);
  if (context.shared().listen_only && must_send) {
    return stop({Code::usage, say<texts::listen_only_refused>("get"),
                 say<texts::listen_only_hint>(), std::nullopt});
  }
  const auto targets = context.targets();
  if (!targets) {
    return stop(targets.error());
  }
  if (auto session = context.open(fleet::Session::Hearing::answers); !session) {
    return stop(session.error());
  }
  report.interface = context.session().interface();

  auto answers = std::make_shared<std::vector<Answer>>();
  auto jobs = std::make_shared<std::vector<std::unique_ptr<ReadJob>>>();
  for (fleet::Member* member : context.select(*targets, servo_search_time, report)) {
    jobs->push_back(std::make_unique<ReadJob>(
        context.session().roster(), *member, **profiles, context.identification(),
        [&](const fleet::Member& servo) { return plan(*wish, **profiles, servo); }));
    context.session().start(*jobs->back());
  }
  const auto ran = context.session().run();
  for (const auto& job : *jobs) {
    report.statuses.push_back(judge(*job, context.session().roster(), report));
    if (!job->error() && !context.session().roster().is_doubled(job->member().id)) {
      answers->push_back({job.get(), shown(*job, *wish)});
    }
  }
  if (!ran) {
    context.broken(ran.error(), report);
  }
  const auto failed = static_cast<std::uint64_t>(
      std::ranges::count_if(report.statuses, [](int status) { return status != 0; }));
  report.counts = {{"nodes", report.statuses.size()}, {"failed", failed}};
  report.json = [answers, jobs](JsonWriter& json) { write_json(json, *answers); };
  report.csv = [answers, jobs] { return csv(*answers); };
  report.text = [answers, jobs, wish = *wish] { return text(*answers, wish); };
  return report;
}

} // namespace blactl::cli
