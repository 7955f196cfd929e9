#include "blactl/state/proof_store.hpp"

#include "state/boot.hpp"
#include "state/formats.hpp"
#include "state/register_bytes.hpp"
#include "state/sqlite.hpp"
#include "state/state_file.hpp"
#include "state/texts.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

namespace blactl::state {

using dronecan::UniqueId;

namespace {

/// The index repeats whole rows, so the check of the file detects any change. `started`, `clock`:
/// microseconds since 1970, UTC, negative if the clock was not set; within bounds for the
/// arithmetic of holds(). `uptime`: seconds, as in NodeStatus. `boot`: of the machine.
const std::string proof_columns =
    "unique_id BLOB PRIMARY KEY NOT NULL CHECK (length(unique_id) = 16), "
    "rom BLOB NOT NULL, "
    "started INTEGER NOT NULL CHECK (started BETWEEN "
    "-253402300799999999 AND 253402300799999999), "
    "uptime INTEGER NOT NULL CHECK (uptime BETWEEN 0 AND 4294967295), ";

const std::string proof_clock_columns = "clock INTEGER NOT NULL CHECK (clock BETWEEN "
                                        "-253402300799999999 AND 253402300799999999), "
                                        "boot TEXT NOT NULL, ";

const std::string proofs_schema =
    "CREATE TABLE proofs (" + proof_columns + proof_clock_columns +
    "serial_number INTEGER, "
    "UNIQUE (unique_id, rom, started, uptime, clock, boot, serial_number)) STRICT";

/// What was proven for older versions is proven anew.
OlderFormat older_proofs(const std::string& schema) {
  return {.schema = schema, .upgrade = "DROP TABLE proofs; " + proofs_schema};
}

/// It did not tell one boot of the machine from another.
OlderFormat first_version() {
  return older_proofs("CREATE TABLE proofs (" + proof_columns +
                      "UNIQUE (unique_id, rom, started, uptime)) STRICT");
}

/// It did not tell a unit from another with its unique ID.
OlderFormat second_version() {
  return older_proofs("CREATE TABLE proofs (" + proof_columns + proof_clock_columns +
                      "UNIQUE (unique_id, rom, started, uptime, clock, boot)) STRICT");
}

} // namespace

const DatabaseFormat& proofs_format() {
  static const DatabaseFormat format{.application_id = 0x626C6170, // "blap"
                                     .version = 3,
                                     .schema = proofs_schema,
                                     .file = "proofs.db",
                                     .what = texts::rom_record,
                                     .way_back = texts::rom_record_back,
                                     .older = {first_version(), second_version()}};
  return format;
}

namespace {

constexpr std::int64_t last_uptime = 0xFFFFFFFF;

Result<void> put_one(const Database& database, const RomProof& proof) {
  const std::vector<std::uint8_t> rom = bytes_of(proof.rom);
  Statement statement(database, "INSERT OR REPLACE INTO proofs (unique_id, rom, started, uptime, "
                                "clock, boot, serial_number) VALUES (?, ?, ?, ?, ?, ?, ?)");
  statement.bind(proof.unique_id)
      .bind(rom)
      .bind(proof.started.time_since_epoch().count())
      .bind(proof.uptime.count())
      .bind(proof.clock.time_since_epoch().count())
      .bind(boot_id());
  proof.serial_number ? statement.bind(*proof.serial_number) : statement.bind(std::nullopt);
  return statement.run();
}

/// The columns that proof_of() reads.
constexpr std::string_view proof_row = "rom, started, uptime, clock, serial_number";

RomProof proof_of(const UniqueId& unique_id, Statement& row) {
  return {.unique_id = unique_id,
          .rom = registers_in(row, 0),
          .started = WallTime(Duration(row.integer(1, -last_time, last_time))),
          .uptime = std::chrono::seconds(row.integer(2, 0, last_uptime)),
          .clock = WallTime(Duration(row.integer(3, -last_time, last_time))),
          .serial_number = row.is_null(4) ? std::nullopt : std::optional(row.integer(4))};
}

} // namespace

bool holds(const RomProof& proof, std::chrono::seconds uptime, WallTime now, WallTime clock) {
  return uptime >= proof.uptime && std::chrono::abs(clock - proof.clock) <= clock_tolerance &&
         std::chrono::abs(now - uptime - proof.started) <= uptime_tolerance;
}

RomProof renewed(RomProof proof, std::chrono::seconds uptime, WallTime now) {
  proof.started = now - uptime;
  proof.uptime = uptime;
  return proof;
}

ProofStore::ProofStore(std::unique_ptr<StateFile> file) : file_(std::move(file)) {}

ProofStore::ProofStore(ProofStore&&) noexcept = default;
ProofStore& ProofStore::operator=(ProofStore&&) noexcept = default;
ProofStore::~ProofStore() = default;

Result<ProofStore> ProofStore::open(const std::string& folder, Access access,
                                    std::chrono::milliseconds patience) {
  return store_on<ProofStore>(StateFile::open(folder, proofs_format(), access, patience));
}

Result<ProofStore> ProofStore::unshared() {
  return store_on<ProofStore>(StateFile::unshared(proofs_format()));
}

Result<void> ProofStore::put(std::span<const RomProof> proofs) {
  return file_->transact([&](const Database& database) -> Result<void> {
    for (const RomProof& proof : proofs) {
      if (auto put = put_one(database, proof); !put) {
        return put;
      }
    }
    return {};
  });
}

Result<std::optional<RomProof>> ProofStore::find(const UniqueId& unique_id) const {
  const Database* database = file_->database();
  if (database == nullptr) {
    return std::nullopt;
  }
  Statement statement(*database, "SELECT " + std::string(proof_row) +
                                     " FROM proofs WHERE unique_id = ? AND boot = ? "
                                     "AND boot <> ''");
  return statement.bind(unique_id).bind(boot_id()).first(
      [&] { return proof_of(unique_id, statement); });
}

Result<std::vector<RomProof>> ProofStore::proofs() const {
  std::vector<RomProof> proofs;
  const Database* database = file_->database();
  if (database == nullptr) {
    return proofs;
  }
  Statement statement(*database, "SELECT " + std::string(proof_row) + ", unique_id FROM proofs");
  const auto read = statement.each([&] {
    proofs.push_back(proof_of(statement.array<std::tuple_size_v<UniqueId>>(5), statement));
    return true;
  });
  return read ? Result<std::vector<RomProof>>(std::move(proofs)) : std::unexpected(read.error());
}

Result<void> ProofStore::clear() {
  return file_->transact(
      [](const Database& database) { return Statement(database, "DELETE FROM proofs").run(); });
}

Result<void> ProofStore::drop(std::span<const UniqueId> units) {
  return file_->transact([&](const Database& database) -> Result<void> {
    for (const UniqueId& unique_id : units) {
      Statement drop(database, "DELETE FROM proofs WHERE unique_id = ?");
      if (auto dropped = drop.bind(unique_id).run(); !dropped) {
        return dropped;
      }
    }
    return {};
  });
}

} // namespace blactl::state
