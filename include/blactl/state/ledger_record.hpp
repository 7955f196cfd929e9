#pragma once
// The record of one servo of a production line (contract, section 5, "provision", "ledger").

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

namespace blactl::state {

/// Integers are register numbers unless noted otherwise. Empty: unknown, or not requested.
struct LedgerRecord {
  using Integer = std::optional<std::int64_t>;
  using Real = std::optional<double>;
  using Text = std::optional<std::string>;

  Text record_id{};  ///< unique among the records of all machines
  Text time{};       ///< of the verdict, RFC 3339 UTC, whole seconds
  Text start_time{}; ///< when the unit was recognised, likewise
  Text verdict{};    ///< pass, fail, error, skip or scrap; empty: begun, not ended
  Text code{};       ///< of the error that it ended with
  Integer attempt{}; ///< from 1, of this unit by this recipe
  Integer serial_number{};
  Text unique_id{}; ///< 32 hexadecimal digits
  Text model{};
  Integer firmware_version{}, hardware_version{};
  Text production_date{}; ///< as `export` writes it
  Text label{};           ///< as read
  Integer node_id{};      ///< on arrival; 0: it asked for one
  Integer node_id_after{};
  Integer static_node_id{}, servo_id{};
  Text parameter{};             ///< the first that was not as it should be: its name
  Integer expected{}, actual{}; ///< its values
  Text config_sha256{};         ///< over all configuration as read after the restart
  Integer changed_count{};
  Real voltage_v{};
  Integer temperature_c{};
  Text faults{}; ///< "0x1A.4;0x19.8"
  Real duration_s{};
  Text station{};
  Integer station_seq{}; ///< counts the records of a station without holes, from 1
  Text machine{};        ///< the name of the host
  Text operator_name{}, work_order{};
  Text refers_to{}; ///< of a scrap: the record_id of what it takes back
  Text reason{};    ///< by a person, or what the record has to tell beside its verdict
  Text recipe{}, recipe_sha256{}, profile_sha256{};
  Text tool_version{};

  friend bool operator==(const LedgerRecord&, const LedgerRecord&) = default;
};

/// One key of a record.
struct LedgerColumn {
  using Member =
      std::variant<LedgerRecord::Integer LedgerRecord::*, LedgerRecord::Real LedgerRecord::*,
                   LedgerRecord::Text LedgerRecord::*>;

  std::string_view name; ///< of the contract
  Member member;
};

/// All columns, in the order of the contract.
inline constexpr std::array<LedgerColumn, 37> ledger_columns{{
    {"record_id", &LedgerRecord::record_id},
    {"time", &LedgerRecord::time},
    {"start_time", &LedgerRecord::start_time},
    {"verdict", &LedgerRecord::verdict},
    {"code", &LedgerRecord::code},
    {"attempt", &LedgerRecord::attempt},
    {"serial_number", &LedgerRecord::serial_number},
    {"unique_id", &LedgerRecord::unique_id},
    {"model", &LedgerRecord::model},
    {"firmware_version", &LedgerRecord::firmware_version},
    {"hardware_version", &LedgerRecord::hardware_version},
    {"production_date", &LedgerRecord::production_date},
    {"label", &LedgerRecord::label},
    {"node_id", &LedgerRecord::node_id},
    {"node_id_after", &LedgerRecord::node_id_after},
    {"static_node_id", &LedgerRecord::static_node_id},
    {"servo_id", &LedgerRecord::servo_id},
    {"parameter", &LedgerRecord::parameter},
    {"expected", &LedgerRecord::expected},
    {"actual", &LedgerRecord::actual},
    {"config_sha256", &LedgerRecord::config_sha256},
    {"changed_count", &LedgerRecord::changed_count},
    {"voltage_v", &LedgerRecord::voltage_v},
    {"temperature_c", &LedgerRecord::temperature_c},
    {"faults", &LedgerRecord::faults},
    {"duration_s", &LedgerRecord::duration_s},
    {"station", &LedgerRecord::station},
    {"station_seq", &LedgerRecord::station_seq},
    {"machine", &LedgerRecord::machine},
    {"operator", &LedgerRecord::operator_name},
    {"work_order", &LedgerRecord::work_order},
    {"refers_to", &LedgerRecord::refers_to},
    {"reason", &LedgerRecord::reason},
    {"recipe", &LedgerRecord::recipe},
    {"recipe_sha256", &LedgerRecord::recipe_sha256},
    {"profile_sha256", &LedgerRecord::profile_sha256},
    {"tool_version", &LedgerRecord::tool_version},
}};

} // namespace blactl::state
