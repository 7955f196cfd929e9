#pragma once
// Profile files into profiles: the family's file and the files of its series.

#include "blactl/base/json_reader.hpp"
#include "blactl/bla/profile.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace blactl::bla {

/// The schema version named in the files, and the family they all describe.
inline constexpr std::string_view profile_schema = "blactl-profile/1";
inline constexpr std::string_view profile_family = "BLA";

/// The data common to all models.
struct Family {
  std::vector<Parameter> parameters; ///< ascending; those of table 3-12 without default and range
  std::vector<FaultBit> fault_bits;
  std::vector<FaultBit> summary_bits; ///< of 0x18
  std::vector<FirmwareRelease> firmware;
};

/// One series file.
struct Series {
  struct Model {
    Profile profile;
    const json::Value* place = nullptr; ///< its position in the file, for faults
  };

  Choice number; ///< of 0x50: the model number in words
  std::vector<Model> models;
};

/// Whether the file describes a series rather than the family.
[[nodiscard]] bool describes_series(const json::Document& document);

/// Adds faults to the document; the result is usable only if there are none.
[[nodiscard]] Family read_family(json::Document& document);
[[nodiscard]] Series read_series(json::Document& document, Family family);

// Parts of both kinds of files.

[[nodiscard]] bool has_key(const json::Value& object, std::string_view key);

/// Adds the register that `item` describes to those known, which are ascending and stay so.
void add_parameter(const json::Value& item, std::vector<Parameter>& known, json::Faults& faults);

/// "$schema", "schema" and "family".
void read_head(json::Object& root);

/// A text that must not be empty.
[[nodiscard]] std::string read_text(json::Object& object, std::string_view key,
                                    json::Faults& faults);

/// "default", "min", "max" of `parameter`, within its width and consistent with each other.
void read_range(json::Object& object, Parameter& parameter, json::Faults& faults);

} // namespace blactl::bla
