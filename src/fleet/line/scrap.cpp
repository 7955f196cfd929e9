#include "blactl/fleet/line/scrap.hpp"

#include "blactl/base/hex.hpp"
#include "blactl/fleet/line/line_record.hpp"

#include "fleet/line/station_texts.hpp"

#include <algorithm>
#include <optional>
#include <tuple>
#include <utility>

namespace blactl::fleet {

using state::LedgerRecord;
using state::LedgerStore;

namespace {

/// The last record that fits; empty: none does.
Result<std::optional<LedgerRecord>> last_of(const LedgerStore& ledger,
                                            const state::LedgerQuery& query) {
  std::optional<LedgerRecord> last;
  const auto read = ledger.each(query, [&](const LedgerRecord& each) {
    last = each;
    return true;
  });
  return read ? Result<std::optional<LedgerRecord>>(std::move(last))
              : std::unexpected(read.error());
}

/// A unit that is at work keeps its IDs.
Result<void> check_idle(const LedgerStore& ledger, const LedgerRecord& record) {
  const auto begun = ledger.begun();
  if (!begun) {
    return std::unexpected(begun.error());
  }
  const auto found = std::ranges::find(*begun, record.unique_id, &LedgerRecord::unique_id);
  return found == begun->end()
             ? Result<void>()
             : fail(Code::busy, say<texts::scrap_at_work>(printable(found->station.value_or(""))),
                    say<texts::scrap_at_work_hint>());
}

/// Two units with one unique ID: the IDs are those of the one that has passed.
Result<void> check_unit(const LedgerStore& ledger, const LedgerRecord& record) {
  std::optional<std::int64_t> other;
  const auto read = ledger.each({.verdict = std::string(verdict::pass),
                                 .unique_id = record.unique_id,
                                 .recipe = record.recipe},
                                [&](const LedgerRecord& passed) {
                                  const bool is_other =
                                      record.serial_number && passed.serial_number &&
                                      passed.serial_number != record.serial_number;
                                  other = is_other ? passed.serial_number : other;
                                  return true;
                                });
  if (!read || !other) {
    return read;
  }
  return fail(Code::duplicate_unique_id, say<texts::scrap_of_twin>(*record.serial_number, *other),
              say<texts::scrap_of_twin_hint>());
}

LedgerRecord scrapped(const LedgerRecord& record, const LedgerRecord& common, std::string reason,
                      WallTime now) {
  LedgerRecord scrap = begun_record(common, now);
  scrap.verdict = std::string(verdict::scrap);
  scrap.attempt = record.attempt;
  scrap.serial_number = record.serial_number;
  scrap.unique_id = record.unique_id;
  scrap.model = record.model;
  scrap.firmware_version = record.firmware_version;
  scrap.hardware_version = record.hardware_version;
  scrap.production_date = record.production_date;
  scrap.work_order = record.work_order;
  scrap.recipe = record.recipe;
  scrap.recipe_sha256 = record.recipe_sha256;
  scrap.refers_to = record.record_id;
  scrap.reason = std::move(reason);
  return scrap;
}

} // namespace

Result<LedgerRecord> record_to_scrap(const LedgerStore& ledger, const std::string& record_id) {
  auto record = last_of(ledger, {.record_id = record_id});
  if (!record) {
    return std::unexpected(std::move(record.error()));
  }
  if (!*record) {
    return fail(Code::not_found, say<texts::scrap_no_record>(printable(record_id)),
                say<texts::scrap_no_record_hint>());
  }
  return (*record)->unique_id ? Result<LedgerRecord>(std::move(**record))
                              : fail(Code::state, say<texts::scrap_no_unit>());
}

Result<LedgerRecord> scrap(LedgerStore& ledger, state::CounterStore& counters,
                           const LedgerRecord& record, const LedgerRecord& common,
                           std::string reason, WallTime now) {
  constexpr std::size_t size = std::tuple_size_v<dronecan::UniqueId>;
  const auto unit = from_hex<size>(record.unique_id.value_or(""));
  if (!unit) {
    return fail(Code::state, say<texts::scrap_no_unit>());
  }
  auto idle = check_idle(ledger, record);
  idle = idle ? check_unit(ledger, record) : idle;
  auto last = idle ? last_of(ledger, {.unique_id = record.unique_id, .recipe = record.recipe})
                   : Result<std::optional<LedgerRecord>>(std::unexpected(idle.error()));
  if (!last) {
    return std::unexpected(std::move(last.error()));
  }
  const bool is_recorded = *last && (*last)->verdict == verdict::scrap;
  LedgerRecord scrap =
      is_recorded ? std::move(**last) : scrapped(record, common, std::move(reason), now);
  if (!is_recorded) {
    const auto number = ledger.end(scrap);
    if (!number) {
      return std::unexpected(number.error());
    }
    scrap.station_seq = *number;
  }
  const auto freed = counters.free(*unit, record.recipe.value_or(""));
  return freed ? Result<LedgerRecord>(std::move(scrap)) : std::unexpected(freed.error());
}

} // namespace blactl::fleet
