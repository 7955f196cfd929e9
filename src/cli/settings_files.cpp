#include "cli/settings_files.hpp"

#include "blactl/fleet/files/params_file.hpp"

#include "cli/fleet_texts.hpp"

#include <utility>

namespace blactl::cli {

std::optional<fleet::FleetFile> read_settings(const std::string& file, const Context& context,
                                              Report& report) {
  auto settings = fleet::read_settings_file(file, context.known());
  if (!settings) {
    report.fail(settings.error());
    return std::nullopt;
  }
  std::string passed_over;
  for (const bla::Address address : settings->passed_over) {
    passed_over += (passed_over.empty() ? "" : ", ") + address.name();
  }
  if (!passed_over.empty()) {
    context.reporter().note(say<texts::params_passed_over>(printable(file), passed_over));
  }
  return std::move(*settings);
}

} // namespace blactl::cli
