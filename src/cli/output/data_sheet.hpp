#pragma once
// The profiles as a data sheet: for a model, for a parameter, or for all models side by side.

#include "blactl/base/json_writer.hpp"
#include "blactl/bla/profile.hpp"

#include "cli/output/page.hpp"

#include <set>
#include <string>
#include <vector>

namespace blactl::cli {

/// The selected part of the profiles.
struct Sheet {
  std::vector<const bla::Profile*> models;   ///< not empty
  const bla::Parameter* parameter = nullptr; ///< the only one; null: all
  std::set<bla::Group> groups{};             ///< only the parameters of these groups; empty: all
  std::string mentions{};                    ///< only those that have it in a text; empty: all

  [[nodiscard]] bool takes(const bla::Parameter& one) const;

  [[nodiscard]] bool is_whole() const { return groups.empty() && mentions.empty(); }
};

[[nodiscard]] std::string list_text(const Sheet& sheet, const Page& page);

/// The sheet of the parameter, or of the model; for several models the common values and the
/// differences.
[[nodiscard]] std::string sheet_text(const Sheet& sheet, const bla::Profiles& profiles,
                                     const Page& page);

/// As JSON (contract, section 5): models[], fault_bits[], firmware[], cross_checks[], members of
/// the document.
void write_models(JsonWriter& json, const Sheet& sheet, const bla::Profiles& profiles);

} // namespace blactl::cli
