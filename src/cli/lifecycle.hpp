#pragma once
// What save, erase and restart of several servos did, and the steps they share.

#include "blactl/base/json_writer.hpp"
#include "blactl/fleet/configuration.hpp"
#include "blactl/fleet/restart.hpp"

#include "cli/context.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace blactl::cli {

/// One servo through a save, erase or restart.
struct Passage {
  fleet::Member before;           ///< as it was identified; servo_id as it was read last
  fleet::Member* servo = nullptr; ///< under its present node ID
  fleet::Values expected;         ///< what its configuration must be in the end
  std::optional<Error> error{};
  bool is_confirmed = false;   ///< it answered ERASE
  bool is_back = false;        ///< after its restart
  bool is_verified = false;    ///< what it had to show it has shown
  std::size_t values_read = 0; ///< and compared, at the end
  Duration duration{};

  [[nodiscard]] bool is_done() const { return !error && is_verified; }
};

/// The question before a save or restart of this servo; empty: nothing will move (contract,
/// section 4). `values` holds its configuration.
[[nodiscard]] std::string restart_question(const fleet::Member& servo, const fleet::Values& values);

/// Restarts the servos that have no error yet. After a save the configuration of those that are
/// back is read and compared; after a mere restart ROM may hold anything, to be back is all.
/// False: the bus broke or the user interrupted; `report` has the error.
[[nodiscard]] bool pass_restart(std::vector<Passage>& passages, fleet::RestartKind kind,
                                const RestartTimes& times, Context& context, Report& report);

/// Reads the configuration of the servos without an error and compares it with what is expected;
/// `after_save` also whether they could read their ROM at their start.
[[nodiscard]] bool verify(std::vector<Passage>& passages, bool after_save, Context& context,
                          Report& report);

// The views.
void write_json(JsonWriter& json, const std::vector<Passage>& passages);
[[nodiscard]] std::string text(const std::vector<Passage>& passages);

} // namespace blactl::cli
