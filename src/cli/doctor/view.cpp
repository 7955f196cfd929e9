#include "cli/doctor/view.hpp"

#include "cli/doctor/texts.hpp"
#include "cli/output/alike.hpp"
#include "cli/output/faults_view.hpp"
#include "cli/output/node_head.hpp"
#include "cli/output/progress_view.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cstdint>
#include <iterator>
#include <optional>
#include <ranges>
#include <span>
#include <string>
#include <vector>

namespace blactl::cli {
namespace {

using fleet::Diagnosis;

void join(std::string& line, const std::string& part) {
  line += (line.empty() ? "" : ", ") + part;
}

std::string link_text(const can::Link& link) {
  std::string line = printable(link.name) + ' ' +
                     (link.is_up ? say<texts::doctor_up>() : say<texts::doctor_down>());
  if (link.bit_rate && link.sample_point) {
    join(line, say<texts::doctor_bit_timing>(*link.bit_rate, *link.sample_point / 10,
                                             *link.sample_point % 10));
  }
  if (link.restart_after) {
    join(line, say<texts::doctor_restart_after>(link.restart_after->count()));
  }
  join(line, say<texts::doctor_queue>(link.queue_length));
  if (link.errors) {
    join(line, say<texts::doctor_errors>(link.errors->transmit, link.errors->receive));
  }
  return line;
}

std::string interface_text(const Examination& examination) {
  std::string line =
      examination.link ? link_text(*examination.link) : std::string(examination.interface);
  const can::SlcanAnswers said = examination.adapter.value_or(can::SlcanAnswers());
  if (!said.version.empty()) {
    join(line, say<texts::doctor_adapter_version>(printable(said.version)));
  }
  if (!said.serial_number.empty()) {
    join(line, say<texts::doctor_adapter_serial_number>(printable(said.serial_number)));
  }
  if (said.status) {
    join(line, say<texts::doctor_adapter_status>(fmt::format("{:02X}", *said.status)));
  }
  return line;
}

std::string traffic_text(const fleet::Traffic& traffic) {
  const auto load = traffic.load_permille();
  if (!load) {
    return traffic.frames() == 0 ? say<texts::doctor_no_traffic>()
                                 : say<texts::doctor_frames>(traffic.frames());
  }
  return say<texts::doctor_traffic>(traffic.frames(), whole_seconds(*traffic.duration()),
                                    *load / 10, *load % 10);
}

/// "11: 32, 12: 32"
std::string senders_text(const fleet::Traffic& traffic) {
  std::string line;
  const auto us = std::chrono::duration_cast<std::chrono::microseconds>(
                      traffic.duration().value_or(Duration::zero()))
                      .count();
  for (const auto& [id, sender] : traffic.senders()) {
    if (us > 0 && id.is_unicast()) {
      join(line, fmt::format("{}: {}", id.value(),
                             sender.frames * 1000000 / static_cast<std::uint64_t>(us)));
    }
  }
  return line;
}

std::string nodes_text(const fleet::Findings& findings) {
  std::size_t servos = 0, others = 0;
  std::string tools;
  for (const fleet::Finding& node : findings.nodes) {
    const bool is_tool = fleet::is_tool(node);
    servos += node.servo.is_servo ? 1U : 0U;
    others += !node.servo.is_servo && !is_tool ? 1U : 0U;
    if (is_tool) {
      join(tools, std::to_string(node.servo.id.value()));
    }
  }
  std::string line = say<texts::doctor_found>(servos, others);
  if (!tools.empty()) {
    join(line, say<texts::doctor_tools>(tools));
  }
  return line;
}

/// Of the servos that are asked about, and who else was heard.
std::string named_text(const fleet::Findings& findings) {
  const auto others = std::ranges::count_if(findings.roster->members(), [&](const auto& member) {
    return findings.roster->heard(member.first) &&
           std::ranges::none_of(findings.nodes, [&](const fleet::Finding& node) {
             return node.servo.id == member.first;
           });
  });
  std::string line = say<texts::doctor_found_named>(findings.nodes.size(), others);
  std::vector<dronecan::NodeId> commanders;
  std::ranges::copy(findings.roster->commanders() | std::views::keys,
                    std::back_inserter(commanders));
  if (!commanders.empty()) {
    join(line, say<texts::doctor_commanders>(fleet::id_list(commanders)));
  }
  return line;
}

std::string row(const std::string& what, const std::string& said) {
  constexpr std::size_t column = 16;
  const std::size_t width = display_width(what);
  return what + std::string(width < column ? column - width : 1, ' ') + said + '\n';
}

Tone tone(bla::Level level) {
  return level == bla::Level::failure ? Tone::bad : Tone::warning;
}

/// A fix of one node as one of several: "-n 11" becomes "-n 11,12".
std::string fix_of_all(const Diagnosis& diagnosis, std::span<const std::uint8_t> others) {
  std::string fix = diagnosis.fix;
  const std::string option =
      diagnosis.node ? fmt::format("-n {}", diagnosis.node->value()) : std::string();
  const std::size_t at = option.empty() ? std::string::npos : fix.find(option);
  if (at != std::string::npos && !others.empty()) {
    fix.insert(at + option.size(), fmt::format(",{}", fmt::join(others, ",")));
  }
  return fix;
}

/// What is true of several nodes is told once.
std::string findings_text(const fleet::Diagnoses& all, const Page& page) {
  std::vector<AboutNode> told;
  for (const Diagnosis& each : all) {
    told.push_back({each.node ? std::optional(each.node->value()) : std::nullopt,
                    fmt::format("{}\n{}\n{}", each.code, each.text, each.fix)});
  }
  std::string out;
  for (const auto& [first, others] : alike(told)) {
    const Diagnosis& diagnosis = all[first];
    out +=
        fmt::format("{}  [{}] {}\n", page.paint(tone(diagnosis.level), level_word(diagnosis.level)),
                    diagnosis.code, likewise(diagnosis.text, others));
    if (!diagnosis.fix.empty()) {
      out += page.fit_hint("    " + say<texts::doctor_fix>(fix_of_all(diagnosis, others))) + '\n';
    }
  }
  return out;
}

} // namespace

void write_json(JsonWriter& json, const Examination& examination) {
  json.objects("nodes",
               examination.nodes ? examination.nodes->nodes : std::vector<fleet::Finding>(),
               [&](const fleet::Finding& node) { write_head(json, node.servo); });
  if (examination.adapter) {
    json.key("adapter");
    json.begin_object();
    json.member("version", examination.adapter->version);
    json.member("serial_number", examination.adapter->serial_number);
    json.key("status");
    examination.adapter->status ? json.value(*examination.adapter->status) : json.value(nullptr);
    json.end_object();
  }
  json.objects("fixed", examination.fixed, [&](const Diagnosis& diagnosis) {
    json.member("code", diagnosis.code);
    json.member("text", diagnosis.text);
  });
  json.objects("findings", examination.diagnoses, [&](const Diagnosis& diagnosis) {
    json.member("code", diagnosis.code);
    json.member("level", name(diagnosis.level));
    json.member("node_id", diagnosis.node ? std::optional(diagnosis.node->value()) : std::nullopt);
    json.member("text", diagnosis.text);
    json.member("fix", diagnosis.fix);
  });
  json.objects("not_judged", examination.unjudged, [&](const Unjudged& each) {
    json.member("node_id", each.node ? std::optional(each.node->value()) : std::nullopt);
    json.member("text", each.text);
  });
}

std::string text(const Examination& examination, const Page& page) {
  std::string out = row(say<texts::doctor_interface>(), interface_text(examination));
  if (examination.nodes) {
    out += row(say<texts::doctor_bus>(), traffic_text(examination.traffic));
    if (const auto senders = senders_text(examination.traffic); !senders.empty()) {
      out += row("", say<texts::doctor_senders>(senders));
    }
    out += row(say<texts::doctor_nodes>(), examination.are_named ? named_text(*examination.nodes)
                                                                 : nodes_text(*examination.nodes));
  }
  for (const Diagnosis& diagnosis : examination.fixed) {
    out += page.paint(Tone::good, say<texts::doctor_fixed>()) + "  " + diagnosis.text + '\n';
  }
  out += findings_text(examination.diagnoses, page);
  for (const Unjudged& each : examination.unjudged) {
    out += say<texts::doctor_not_judged>() + "  " + each.text + '\n';
  }
  if (examination.diagnoses.empty() && examination.is_whole) {
    out += page.paint(Tone::good, examination.unjudged.empty() ? say<texts::doctor_nothing>()
                                                               : say<texts::doctor_nothing_else>());
  }
  return out;
}

} // namespace blactl::cli
