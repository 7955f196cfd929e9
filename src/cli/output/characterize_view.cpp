#include "cli/output/characterize_view.hpp"

#include "cli/output/node_head.hpp"
#include "cli/output/table.hpp"
#include "cli/texts.hpp"

#include <variant>

namespace blactl::cli {
namespace {

using fleet::Fact;
using fleet::FactValue;

std::string words(const FactValue& value) {
  const auto* flag = std::get_if<bool>(&value);
  return flag == nullptr ? std::get<std::string>(value) : *flag ? "true" : "false";
}

std::string meaning(const fleet::OpenQuestion& question) {
  return std::string(choose(question.what.en, question.what.ja));
}

std::string measured_table(const fleet::Characterization& measured, const Page& page) {
  Table table({say<texts::characterize_column_setting>(), say<texts::characterize_column_value>(),
               say<texts::characterize_column_what>()});
  for (std::size_t i = 0; i < measured.facts.size(); ++i) {
    if (const Fact& fact = measured.facts[i]; fact.value) {
      table.add({std::string(fact.setting), page.paint(Tone::good, words(*fact.value)),
                 meaning(fleet::open_questions()[i])});
    }
  }
  return say<texts::characterize_measured>() + table.text("  ", page);
}

std::string open_table(const fleet::Characterization& measured, const Page& page) {
  Table table({say<texts::characterize_column_setting>(), say<texts::characterize_column_what>(),
               say<texts::characterize_column_why>()});
  for (std::size_t i = 0; i < measured.facts.size(); ++i) {
    if (const Fact& fact = measured.facts[i]; !fact.value) {
      table.add({std::string(fact.setting), meaning(fleet::open_questions()[i]), fact.reason});
    }
  }
  return say<texts::characterize_not_measured>() + table.text("  ", page);
}

std::string observations_text(const fleet::Characterization& measured) {
  std::string out = say<texts::characterize_seen>();
  for (const fleet::Observation& seen : measured.observations) {
    out += "  " + seen.what + ": " + seen.value + '\n';
  }
  return out;
}

void write_measurements(JsonWriter& json, const fleet::Characterization& measured) {
  json.objects("measurements", measured.facts, [&](const Fact& fact) {
    json.member("setting", fact.setting);
    json.key("value");
    if (fact.value) {
      std::visit([&](const auto& value) { json.value(value); }, *fact.value);
    } else {
      json.value(nullptr);
    }
    json.key("reason");
    fact.value ? json.value(nullptr) : json.value(fact.reason);
  });
}

} // namespace

std::string characterize_text(const fleet::Characterization& measured, const Page& page) {
  return head_line(measured.servo) + measured_table(measured, page) + observations_text(measured) +
         open_table(measured, page);
}

void write_characterization(JsonWriter& json, const fleet::Characterization& measured,
                            const std::optional<std::string>& file, bool is_done) {
  json.key("nodes");
  json.begin_array();
  json.begin_object();
  write_head(json, measured.servo);
  json.member("file", file);
  json.member("status", is_done ? "done" : "failed");
  if (measured.is_done()) {
    write_measurements(json, measured);
  }
  json.end_object();
  json.end_array();
}

} // namespace blactl::cli
