#include "blactl/sim/scenario/facts.hpp"

#include "blactl/base/json_reader.hpp"

#include "sim/scenario/member_tables.hpp"

#include <utility>

namespace blactl::sim {
namespace {

constexpr std::string_view facts_schema = "blactl-facts/1";

/// The servo measured: for people only, but a mistyped key is an error.
void read_about(json::Object object) {
  for (const auto* key : {"model", "name", "software", "hardware", "time", "tool_version"}) {
    (void)object.optional_string(key);
  }
  for (const auto* key : {"serial_number", "firmware_version", "hardware_version"}) {
    (void)object.optional_integer(key);
  }
  object.finish();
}

Result<Behaviour> from_document(Result<json::Document> document) {
  if (!document) {
    return std::unexpected(document.error());
  }
  json::Faults& faults = document->faults();
  json::Object root(document->root(), faults);
  (void)root.optional_string("$schema"); // for editors
  (void)root.word("schema", {facts_schema});
  Behaviour behaviour;
  read_whole(root.object("behaviour"), behaviour_members, behaviour, faults);
  read_about(root.optional_object("about"));
  root.finish();
  if (const auto fine = faults.result(); !fine) {
    return std::unexpected(fine.error());
  }
  return behaviour;
}

} // namespace

Result<Behaviour> read_facts(const std::filesystem::path& file) {
  return from_document(json::parse_file(file));
}

Result<Behaviour> parse_facts(std::string_view text, std::string file) {
  return from_document(json::parse(text, std::move(file)));
}

} // namespace blactl::sim
