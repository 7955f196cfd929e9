#pragma once
// The profiles as a data sheet: of a model, of a parameter, of all models side by side.

#include "blactl/bla/profile.hpp"

#include "cli/output/page.hpp"

#include <optional>
#include <string>
#include <vector>

namespace blactl::cli {

/// What of the profiles is shown.
struct Sheet {
  std::vector<const bla::Profile*> models;   ///< not empty
  const bla::Parameter* parameter = nullptr; ///< this one only; null: all
  std::optional<bla::Group> group{};         ///< those of this group only

  [[nodiscard]] bool takes(const bla::Parameter& one) const;
};

/// Which models there are.
[[nodiscard]] std::string list_text(const Sheet& sheet, const Page& page);

/// The parameter; the model; of several models what they have in common, and where they differ.
[[nodiscard]] std::string sheet_text(const Sheet& sheet, const bla::Profiles& profiles,
                                     const Page& page);

} // namespace blactl::cli
