#include "blactl/base/json_writer.hpp"
#include "blactl/bla/cross_check.hpp"
#include "blactl/dronecan/standard_types.hpp"

#include "cli/commands.hpp"
#include "cli/help.hpp"
#include "cli/interface/scheme.hpp"
#include "cli/trace/type_name.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <set>
#include <string_view>

namespace blactl::cli {
namespace {

void write(JsonWriter& json, const Text& text) {
  json.member("help_en", std::string_view(text.en));
  json.member("help_ja", std::string_view(text.ja));
}

double seconds(Duration duration) {
  return std::chrono::duration<double>(duration).count();
}

void write_words(JsonWriter& json, const Option& option) {
  json.key("words");
  json.begin_array();
  for (const std::string_view word : option.words) {
    json.value(word);
  }
  if (option.kind == Kind::group) {
    for (const bla::Group group : bla::all_groups()) {
      json.value(bla::name(group));
    }
  }
  if (option.kind == Kind::data_types) {
    std::set<std::string_view> names;
    for (const dronecan::DataType& type : dronecan::standard_types()) {
      names.insert(short_name(type));
    }
    std::ranges::for_each(names, [&](std::string_view name) { json.value(name); });
  }
  json.end_array();
}

void write_range(JsonWriter& json, const Option& option) {
  if (option.kind == Kind::seconds) {
    json.key("min");
    json.real(seconds(option.seconds.min));
    json.key("max");
    json.real(seconds(option.seconds.max));
  } else if (option.kind == Kind::whole) {
    json.member("min", option.whole.min);
    json.member("max", option.whole.max);
  }
}

void write(JsonWriter& json, std::string_view key, std::span<const Option> options) {
  json.array(key, options, [&](const Option& option) {
    if (option.hidden) {
      return;
    }
    json.begin_object();
    json.member("name", option.name);
    json.key("letter");
    option.letter != 0 ? json.value(std::string_view(&option.letter, 1)) : json.value(nullptr);
    json.member("value", option.value);
    json.member("kind", name(option.kind));
    json.member("repeat", option.repeat == Repeat::list ? "list" : "last");
    json.member("required", option.required);
    write_words(json, option);
    write_range(json, option);
    write(json, option.help);
    json.end_object();
  });
}

void write(JsonWriter& json, const Command& command) {
  json.begin_object();
  json.member("name", command.name);
  json.key("traits");
  json.begin_object();
  json.member("writes", command.traits.writes);
  json.member("streams", command.traits.streams);
  json.member("tables", command.traits.tables);
  json.member("session", command.traits.session);
  json.member("recordings", command.traits.recordings);
  json.end_object();
  write(json, command.help);
  write(json, "arguments", command.arguments);
  write(json, "options", command.options);
  json.end_object();
}

void write(JsonWriter& json, const Scheme& scheme) {
  // In the order of Operand.
  constexpr std::array<std::string_view, 4> operands{"link", "serial_port", "file", "other"};
  json.begin_object();
  json.member("name", scheme.name);
  json.member("operand", operands[static_cast<std::size_t>(scheme.operand)]);
  json.member("example", scheme.example);
  json.end_object();
}

void write(JsonWriter& json, const bla::CrossCheck& check) {
  json.member("code", check.code);
  json.member("kind", name(check.kind));
  json.array("addresses", check.of, [&](bla::Address address) { json.value(address.name()); });
  write(json, check.reason);
}

} // namespace

std::string dump_cli() {
  std::string out;
  JsonWriter json(out, JsonWriter::Layout::pretty);
  json.begin_object();
  json.member("schema", "blactl-cli/1");
  json.member("version", BLACTL_VERSION);
  write(json, "options", shared_options());
  json.array("interfaces", schemes, [&](const Scheme& scheme) { write(json, scheme); });
  json.array("commands", all_commands(), [&](const Command* command) { write(json, *command); });
  json.objects("cross_checks", bla::cross_checks(),
               [&](const bla::CrossCheck& check) { write(json, check); });
  json.end_object();
  return out + '\n';
}

} // namespace blactl::cli
