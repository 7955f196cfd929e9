#include "cli/settings_files.hpp"

#include "blactl/fleet/files/settings_file.hpp"

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

std::optional<Error> refuse_counters(const fleet::FleetFile& file) {
  if (!file.recipe || file.recipe->counters.empty()) {
    return std::nullopt;
  }
  std::string counted;
  for (const fleet::Counter& counter : file.recipe->counters) {
    counted += (counted.empty() ? "" : ", ") + std::string(counter.parameter->name);
  }
  return Error{Code::usage, say<texts::recipe_has_counters>(printable(file.file), counted),
               say<texts::recipe_has_counters_hint>(), std::nullopt};
}

std::optional<Error> refuse_without_targets(const fleet::FleetFile& file,
                                            const fleet::Targets& targets) {
  if (!file.recipe || targets.given) {
    return std::nullopt;
  }
  return Error{Code::usage, say<texts::recipe_for_whom>(printable(file.file)),
               say<texts::recipe_for_whom_hint>(), std::nullopt};
}

std::vector<std::string> notes(const fleet::FleetFile& file, const fleet::FleetMatch& match) {
  std::string names;
  for (const std::string_view name : match.ids_left_out) {
    names += (names.empty() ? "" : ", ") + std::string(name);
  }
  return names.empty() ? std::vector<std::string>()
                       : std::vector{say<texts::params_without_ids>(printable(file.file), names)};
}

} // namespace blactl::cli
