#pragma once
// A recipe: the wanted settings of every servo on a production line (contract, sections 6 and 7).
//
//   {
//     "schema": "blactl-recipe/1",
//     "name": "aileron",
//     "model": "BLA21-12U-AB",
//     "firmware_min": 1400,
//     "set": {
//       "servo_id": {"first": 1, "last": 8, "step": 1, "at_end": "again"},
//       "angle_limit_cw": "45.0deg"
//     }
//   }
//
// (schemas/recipe.schema.json)

#include "blactl/base/error.hpp"
#include "blactl/bla/assignment.hpp"
#include "blactl/bla/profile.hpp"
#include "blactl/fleet/bus/servo.hpp"
#include "blactl/fleet/bus/snapshot.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace blactl::json {
class Document;
} // namespace blactl::json

namespace blactl::fleet {

/// The schema at the start of a recipe.
inline constexpr std::string_view recipe_schema = "blactl-recipe/1";

/// IDs for successive servos: first, first + step, … up to last.
struct Counter {
  const bla::Parameter* parameter = nullptr; ///< servo_id (0x45) or static_node_id (0x46)
  std::int64_t first = 0;
  std::int64_t last = 0;     ///< not less than the first
  std::int64_t step = 1;     ///< 1 or more
  bool begins_again = false; ///< starts again with the first after the last; else there are no more

  /// The ID after `value`, whatever that is; empty: no more.
  [[nodiscard]] std::optional<std::int64_t> after(std::int64_t value) const;
};

struct Recipe {
  std::string name;  ///< of its counters: they continue when the file has changed
  std::string model; ///< like `-n model:`
  std::optional<std::int64_t> firmware_min{}; ///< 0x52
  std::vector<bla::Assignment> set{};         ///< by address
  std::vector<Counter> counters{};            ///< by address
};

/// `file` is the name for messages. Errors: bad_file with file, line, JSON pointer and reason of
/// each error: invalid JSON, unknown or repeated keys, values that the model does not accept,
/// registers that are not settings, counters for registers other than the two, or with an ID that
/// no servo accepts.
[[nodiscard]] Result<Recipe> parse_recipe(std::string_view text, std::string file,
                                          const bla::Profiles& profiles);

/// "-" reads stdin. Errors: the same.
[[nodiscard]] Result<Recipe> read_recipe(const std::filesystem::path& file,
                                         const bla::Profiles& profiles);

/// A file that was read as JSON already. Errors: the same, and those of the document.
[[nodiscard]] Result<Recipe> read_recipe(json::Document& document, const bla::Profiles& profiles);

/// The reason why the recipe is not for this servo; empty: it is. The message tells it of "it".
/// Errors: model_mismatch (also if the model is uncertain), firmware_too_old; timeout: the firmware
/// version could not be read.
[[nodiscard]] std::optional<Error> check_fit(const Servo& servo, const Recipe& recipe,
                                             const bla::Profiles& profiles);

/// The settings of one servo for all servos of its model, so without IDs.
[[nodiscard]] std::string recipe_file(const Snapshot& servo);

} // namespace blactl::fleet
