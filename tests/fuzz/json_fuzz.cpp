// Files that people write and programs read: fleet files, parameter files, recipes, profiles,
// scenarios, facts. The first byte says which; the rest is the file.

#include "blactl/base/json_reader.hpp"
#include "blactl/fleet/files/fleet_file.hpp"
#include "blactl/fleet/files/params_file.hpp"
#include "blactl/fleet/files/recipe.hpp"
#include "blactl/sim/scenario/facts.hpp"
#include "blactl/sim/scenario/scenario.hpp"

#include "bla/embedded_profiles.hpp"
#include "bla/profile_reader.hpp"
#include "fuzz.hpp"

using namespace blactl;

namespace {

bla::Family built_in_family() {
  for (const bla::EmbeddedProfile& file : bla::embedded_profiles()) {
    auto document = json::parse(file.text, std::string(file.file));
    if (!bla::describes_series(*document)) {
      return bla::read_family(*document);
    }
  }
  std::abort();
}

void read_profile(std::string_view text) {
  static const bla::Family family = built_in_family();
  auto document = json::parse(text, "profile.json");
  if (!document) {
    return;
  }
  if (bla::describes_series(*document)) {
    (void)bla::read_series(*document, family);
  } else {
    (void)bla::read_family(*document);
  }
  (void)document->faults().result();
}

} // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) {
    return 0;
  }
  const bla::Profiles& profiles = fuzz::built_in();
  const std::string_view text = fuzz::as_text(data + 1, size - 1);
  switch (*data) {
  case 'f': (void)fleet::parse_fleet_file(text, "fleet.json", profiles); break;
  case 'p': (void)fleet::parse_params_file(text, "servo.parm", profiles); break;
  case 'r': (void)fleet::parse_recipe(text, "recipe.json", profiles); break;
  case 'm': read_profile(text); break;
  case 's': (void)sim::parse_scenario(text, "scenario.json", profiles); break;
  case 'b': (void)sim::parse_facts(text, "facts.json"); break;
  default: return -1; // no use to remember
  }
  return 0;
}
