// A trace for people: one line per transfer.

#include "blactl/base/hex.hpp"
#include "blactl/bla/value.hpp"
#include "blactl/dronecan/fields.hpp"

#include "cli/trace/output.hpp"
#include "cli/trace/texts.hpp"
#include "cli/trace/time.hpp"
#include "cli/trace/type_name.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <iterator>
#include <optional>

namespace blactl::cli {
namespace {

using dronecan::Bytes;
using dronecan::FieldsResult;
using dronecan::GetSet;

/// `uptime_sec=1234 health=ok … software_version={major=1 minor=4}`.
class TextFields final : public dronecan::FieldSink {
 public:
  explicit TextFields(std::string& out) : out_(out) {}

  void begin_object() override { open(depth_ == 0 ? "" : "{"); }

  void end_object() override { close(depth_ == 1 ? "" : "}"); }

  void begin_array() override { open("["); }

  void end_array() override { close("]"); }

  void key(std::string_view name) override {
    separate();
    out_ += name;
    out_ += '=';
    after_key_ = true;
  }

  void natural(std::uint64_t value, std::string_view word) override {
    word.empty() ? put(fmt::to_string(value)) : put(word);
  }

  void integer(std::int64_t value) override { put(fmt::to_string(value)); }

  void truth(bool value) override { put(value ? "true" : "false"); }

  void real(float value) override { put(fmt::to_string(value)); }

  void text(std::string_view bytes) override { put('"' + printable(bytes) + '"'); }

  void bytes(Bytes bytes) override { put(hex(bytes)); }

 private:
  void open(std::string_view bracket) {
    separate();
    out_ += bracket;
    ++depth_;
    first_ = true;
  }

  void close(std::string_view bracket) {
    out_ += bracket;
    --depth_;
    first_ = false;
  }

  void put(std::string_view text) {
    separate();
    out_ += text;
  }

  void separate() {
    if (!after_key_ && !first_) {
      out_ += ' ';
    }
    after_key_ = first_ = false;
  }

  std::string& out_;
  int depth_ = 0;
  bool first_ = true;
  bool after_key_ = false;
};

constexpr std::int64_t million = 1'000'000;

/// " 0.000000": may be negative, as the times of a log may go back.
std::string relative_text(Duration since) {
  const std::int64_t micros = since.count();
  const std::int64_t size = micros < 0 ? -micros : micros;
  return fmt::format("{:>5}.{:06}", fmt::format("{}{}", micros < 0 ? "-" : "", size / million),
                     size % million);
}

std::string explanation(TraceError error) {
  switch (error) {
  case TraceError::crc: return say<texts::trace_crc>();
  case TraceError::toggle: return say<texts::trace_toggle>();
  case TraceError::missing_start: return say<texts::trace_missing_start>();
  case TraceError::transfer_id: return say<texts::trace_transfer_id>();
  case TraceError::truncated: return say<texts::trace_truncated>();
  case TraceError::timeout: return say<texts::trace_timeout>();
  case TraceError::too_short: return say<texts::trace_short>();
  }
  return {};
}

/// "900 (90.0 deg)", "0 (on)", "40".
std::string register_value(const bla::Parameter& parameter, std::int64_t wire) {
  if (!parameter.width.holds(wire)) {
    return fmt::to_string(wire);
  }
  const auto raw = parameter.width.narrow(wire);
  const auto shown = bla::display(parameter, raw);
  const auto number = fmt::to_string(raw);
  return shown == number ? number : fmt::format("{} ({})", number, shown);
}

/// The register of a BLA servo and the access to it; empty: none, or not the access of a BLA servo.
std::optional<std::string> register_text(const bla::Profiles& profiles, const std::string& name,
                                         const GetSet::Value& value, std::string_view sign,
                                         std::string_view without_value) {
  const auto address = bla::find_address(name);
  const auto* parameter = address ? profiles.find(*address) : nullptr;
  if (parameter == nullptr || value.index() > 1) {
    return std::nullopt;
  }
  const auto* number = std::get_if<std::int64_t>(&value);
  return fmt::format("{} {} {}", address->name(), parameter->name,
                     number != nullptr
                         ? fmt::format("{} {}", sign, register_value(*parameter, *number))
                         : std::string(without_value));
}

std::optional<std::string> register_text(const bla::Profiles& profiles,
                                         const dronecan::Transfer& transfer) {
  if (transfer.header.kind == dronecan::Kind::request) {
    const auto request = GetSet::Request::decode(transfer.payload);
    return request ? register_text(profiles, request->name, request->value, ":=", "?")
                   : std::nullopt;
  }
  const auto response = GetSet::Response::decode(transfer.payload);
  return response ? register_text(profiles, response->name, response->value, "=",
                                  say<texts::trace_no_value>())
                  : std::nullopt;
}

/// The angle of a BLA servo, which sends degrees / 100 where the data type says rad (errata C10).
std::string angle_text(const dronecan::Transfer& transfer) {
  const auto& header = transfer.header;
  const bool is_one = header.kind == dronecan::Kind::message &&
                      header.data_type_id == dronecan::ActuatorStatus::type.id;
  const auto status = is_one ? dronecan::ActuatorStatus::decode(transfer.payload) : std::nullopt;
  return status && std::isfinite(status->position)
             ? "  " + say<texts::trace_bla_angle>(fmt::format("{:.1f}", status->position * 100))
             : std::string();
}

} // namespace

std::string TextTrace::time_text(WallTime at) const {
  return clock_ == Clock::wall ? wall_text(at) : relative_text(at - first_.value_or(at));
}

void TextTrace::begin_line(const Occasion& occasion, const dronecan::Header& header) {
  const bool service = header.kind != dronecan::Kind::message;
  fmt::format_to(std::back_inserter(out_), "{}  {}  {:>3} > {:<3}  {:<22}  ",
                 time_text(occasion.at), printable(occasion.interface), header.source.value(),
                 service ? fmt::to_string(header.destination.value()) : "*",
                 type_text(header.kind, header.data_type_id));
}

bool TextTrace::transfer(const Occasion& occasion, const dronecan::Transfer& transfer) {
  const auto& header = transfer.header;
  const auto line = out_.size();
  begin_line(occasion, header);
  fmt::format_to(std::back_inserter(out_), "{:>2}  ", transfer.transfer_id);
  if (!write_value(transfer)) {
    const auto fields = out_.size();
    TextFields sink(out_);
    const auto result =
        dronecan::write_fields(sink, header.kind, header.data_type_id, transfer.payload);
    if (result == FieldsResult::too_short) {
      out_.resize(line);
      return false;
    }
    if (result != FieldsResult::complete) {
      out_.resize(fields);
      append_hex(out_, transfer.payload);
    }
  }
  out_ += angle_text(transfer);
  if (!transfer.crc_checked) {
    out_ += "  " + say<texts::trace_crc_unchecked>();
  }
  out_.erase(out_.find_last_not_of(' ') + 1);
  out_ += '\n';
  return true;
}

/// Registers of BLA servos are shown by name and in their unit.
bool TextTrace::write_value(const dronecan::Transfer& transfer) {
  const auto& header = transfer.header;
  const auto text = header.kind != dronecan::Kind::message && header.data_type_id == GetSet::type.id
                        ? register_text(profiles_, transfer)
                        : std::nullopt;
  out_ += text.value_or("");
  return text.has_value();
}

void TextTrace::broken(const Occasion& occasion, TraceError error, std::uint32_t can_id) {
  begin_line(occasion, dronecan::decode_id(can_id).value_or(dronecan::Header()));
  fmt::format_to(std::back_inserter(out_), "!!  {}: {} ({:08X})\n", name(error), explanation(error),
                 can_id);
}

} // namespace blactl::cli
