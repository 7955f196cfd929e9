#include "cli/doctor/report_file.hpp"

#include "blactl/base/replace_file.hpp"
#include "blactl/base/rfc3339.hpp"
#include "blactl/fleet/bus/read_job.hpp"
#include "blactl/fleet/bus/register_choice.hpp"
#include "blactl/fleet/live/fault_job.hpp"

#include "cli/alloc/actions.hpp"
#include "cli/doctor/texts.hpp"
#include "cli/doctor/view.hpp"
#include "cli/log_target.hpp"
#include "cli/output/faults_view.hpp"
#include "cli/output/parameter_view.hpp"

#include <fstream>
#include <sstream>
#include <utility>
#include <vector>

namespace blactl::cli {
namespace {

/// Makes every line a comment, which readers of logs skip.
std::string as_comment(const std::string& text) {
  std::istringstream lines(text);
  std::string out;
  for (std::string line; std::getline(lines, line);) {
    out += line.empty() ? "#\n" : "# " + line + '\n';
  }
  return out;
}

std::string section(const std::string& title, const std::string& text) {
  return "#\n" + as_comment("== " + title) + as_comment(text);
}

std::vector<dronecan::NodeId> servos(const Examination& examination) {
  std::vector<dronecan::NodeId> ids;
  for (const fleet::Finding& node : examination.nodes->nodes) {
    const bool is_one = !examination.nodes->roster->is_doubled(node.servo.id);
    if (node.servo.is_servo && is_one && !node.is_offline) {
      ids.push_back(node.servo.id);
    }
  }
  return ids;
}

/// Unreadable parameters are left out: the findings give the reasons.
std::string parameters(const std::vector<dronecan::NodeId>& ids, Context& context) {
  const auto all = fleet::RegisterChoice::parse(context.known(), {}, {});
  if (!all) {
    return {};
  }
  auto snapshots =
      fleet::take_snapshots(context.session(), context.known(), ids, context.identification(),
                            [&](const fleet::Servo& servo) { return all->registers_of(servo); });
  std::vector<ServoValues> values;
  for (fleet::Snapshot& snapshot : snapshots.servos) {
    auto readings = snapshot.readings;
    std::erase_if(readings, [](const fleet::Reading& reading) { return !reading.raw; });
    values.push_back({.snapshot = std::move(snapshot), .shown = std::move(readings)});
  }
  return text(values, context.known(), false, Page{});
}

std::string allocations(Context& context) {
  const Report listed = list_allocations(context);
  return listed.text ? listed.text(Page{}) : listed.errors.front().message;
}

std::string faults(const std::vector<dronecan::NodeId>& ids, Context& context) {
  const auto read =
      fleet::read_faults(context.session(), context.known(), ids, context.identification());
  return text(read.servos, bla::Level::notice, Page{});
}

std::string content_of(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream content;
  content << stream.rdbuf();
  return content.str();
}

} // namespace

Result<void> prepare_report(const std::string& file, Context& context) {
  if (context.shared().record) {
    return fail(Code::usage, say<texts::doctor_report_and_record>(),
                say<texts::doctor_report_and_record_hint>());
  }
  if (file == "-") {
    return fail(Code::usage, say<texts::doctor_to_stdout_no>(file));
  }
  if (auto fit = check_target(file, Content::log, "--report"); !fit) {
    return fit;
  }
  if (auto ready = check_replaceable(file); !ready) {
    return ready;
  }
  context.record_to(file);
  return {};
}

void write_report(const std::string& file, const Examination& examination, Context& context,
                  Report& report) {
  const auto ids = servos(examination);
  std::string all = as_comment(say<texts::doctor_report_head>(
      BLACTL_VERSION, rfc3339(context.session().wall()), report.interface));
  all += as_comment(text(examination, Page{}));
  all += section(say<texts::doctor_report_faults>(), faults(ids, context));
  all += section(say<texts::doctor_report_parameters>(), parameters(ids, context));
  all += section(say<texts::doctor_report_allocations>(), allocations(context));
  all += section(say<texts::doctor_report_traffic>(), {});
  if (const auto written = replace_file(file, all + content_of(file)); !written) {
    report.fail(written.error());
    return;
  }
  context.reporter().note(say<texts::doctor_written>(printable(file), printable(file)));
}

} // namespace blactl::cli
