// A trace as JSON lines.

#include "blactl/base/hex.hpp"
#include "blactl/dronecan/fields.hpp"
#include "blactl/dronecan/standard_types.hpp"

#include "cli/trace/output.hpp"
#include "cli/trace/time.hpp"

namespace blactl::cli {
namespace {

using dronecan::Bytes;
using dronecan::FieldsResult;

class JsonFields final : public dronecan::FieldSink {
 public:
  /// `scratch` holds the digits of one byte array.
  JsonFields(JsonWriter& json, std::string& scratch) : json_(json), scratch_(scratch) {}

  void begin_object() override { json_.begin_object(); }

  void end_object() override { json_.end_object(); }

  void begin_array() override { json_.begin_array(); }

  void end_array() override { json_.end_array(); }

  void key(std::string_view name) override { json_.key(name); }

  void natural(std::uint64_t value, std::string_view) override { json_.value(value); }

  void integer(std::int64_t value) override { json_.value(value); }

  void truth(bool value) override { json_.value(value); }

  void real(float value) override { json_.real(static_cast<double>(value)); }

  void text(std::string_view bytes) override { json_.value(bytes); }

  void bytes(Bytes bytes) override {
    scratch_.clear();
    append_hex(scratch_, bytes);
    json_.value(scratch_);
  }

 private:
  JsonWriter& json_;
  std::string& scratch_;
};

void begin_line(JsonWriter& json, const Occasion& occasion) {
  json.begin_object();
  json.key("time");
  json.number(UnixTime(occasion.at).text());
  json.member("interface", occasion.interface);
}

void write_destination(JsonWriter& json, const dronecan::Header& header) {
  json.key("destination");
  header.kind == dronecan::Kind::message ? json.value(nullptr)
                                         : json.value(header.destination.value());
}

} // namespace

bool JsonTrace::transfer(const Occasion& occasion, const dronecan::Transfer& transfer) {
  const auto& header = transfer.header;
  const auto* type = dronecan::find_standard_type(header.kind, header.data_type_id);
  const auto line = out_.size();
  JsonWriter json(out_);
  begin_line(json, occasion);
  json.member("kind", name(header.kind));
  json.member("type", type != nullptr ? std::optional(type->name) : std::nullopt);
  json.member("data_type_id", header.data_type_id);
  json.member("priority", header.priority);
  json.member("source", header.source.value());
  write_destination(json, header);
  json.member("transfer_id", transfer.transfer_id);
  hex_.clear();
  append_hex(hex_, transfer.payload);
  json.member("payload", hex_);
  json.key("fields");

  const auto fields = out_.size();
  JsonWriter inner = json;
  JsonFields sink(inner, hex_);
  const auto result =
      dronecan::write_fields(sink, header.kind, header.data_type_id, transfer.payload);
  if (result == FieldsResult::too_short) {
    out_.resize(line);
    return false;
  }
  JsonWriter rest = result == FieldsResult::complete ? inner : json;
  if (result != FieldsResult::complete) {
    out_.resize(fields);
    rest.value(nullptr);
  }
  if (!transfer.crc_checked) {
    rest.member("crc_checked", false);
  }
  rest.end_object();
  out_ += '\n';
  return true;
}

void JsonTrace::broken(const Occasion& occasion, TraceError error, std::uint32_t can_id) {
  JsonWriter json(out_);
  begin_line(json, occasion);
  json.member("error", name(error));
  json.member("can_id", can_id);
  if (const auto header = dronecan::decode_id(can_id)) {
    json.member("data_type_id", header->data_type_id);
    json.member("source", header->source.value());
    write_destination(json, *header);
  }
  json.end_object();
  out_ += '\n';
}

} // namespace blactl::cli
