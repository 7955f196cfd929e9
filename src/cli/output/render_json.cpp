#include "cli/output/reporter.hpp"

namespace blactl::cli {
namespace {

void write_error(JsonWriter& json, const Error& error) {
  json.member("node_id", error.node_id);
  json.member("code", name(error.code));
  json.member("message", error.message);
  json.member("hint", error.hint);
}

} // namespace

std::string render_json(const Report& report) {
  std::string out;
  JsonWriter json(out, report.is_stream ? JsonWriter::Layout::compact : JsonWriter::Layout::pretty);
  const auto or_null = [&](const char* key, const std::string& text) {
    json.key(key);
    text.empty() ? json.value(nullptr) : json.value(text);
  };
  json.begin_object();
  json.member("schema", "blactl/1");
  or_null("command", report.command);
  or_null("interface", report.interface);
  json.member("exit_status", report.exit_status());
  if (report.json) {
    report.json(json);
  } else if (!report.is_stream) {
    json.key("nodes");
    json.begin_array();
    json.end_array();
  }
  json.key("counts");
  json.begin_object();
  for (const auto& [what, count] : report.counts) {
    json.member(what, count);
  }
  json.end_object();
  json.objects("errors", report.all_errors(),
               [&](const Error& error) { write_error(json, error); });
  json.end_object();
  out += '\n';
  return out;
}

} // namespace blactl::cli
