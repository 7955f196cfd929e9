// blactl models: the profiles as an offline reference.

#include "blactl/bla/profile.hpp"

#include "cli/commands.hpp"
#include "cli/context.hpp"
#include "cli/models_texts.hpp"
#include "cli/output/data_sheet.hpp"
#include "cli/texts.hpp"

#include <algorithm>
#include <utility>

namespace blactl::cli {
namespace {

struct ModelsOptions {
  std::string model{};
  std::string parameter{};
  std::string group{};
};

constexpr Option models_options[]{
    {.name = "--group",
     .value = "G",
     .kind = Kind::group,
     .help =
         {"the parameters of one group only: command, status, operation, fault, config, "
          "control, pwm, limit, option, product, production",
          "1 グループのパラメータのみ: command、status、operation、fault、config、control、pwm、"
          "limit、option、product、production"},
     .store = into<&ModelsOptions::group>},
};

constexpr Option models_arguments[]{
    {.name = "MODEL",
     .kind = Kind::model_or_parameter,
     .help = {"a model or its beginning: BLA21-12U; all: every model side by side; or a PARAM",
              "機種名またはその先頭部分: BLA21-12U (all: 全機種を比較)、または PARAM"},
     .store = into<&ModelsOptions::model>},
    {.name = "PARAM",
     .kind = Kind::parameter,
     .help = {"one parameter: a name or an address", "パラメータ 1 個 (名前またはアドレス)"},
     .store = into<&ModelsOptions::parameter>},
};

using Models = std::vector<const bla::Profile*>;

bool begins_with(std::string_view word, std::string_view beginning) {
  return word.size() >= beginning.size() &&
         std::ranges::equal(word.substr(0, beginning.size()), beginning,
                            [](char a, char b) { return a == b || a == b - 'a' + 'A'; });
}

Models all_models(const bla::Profiles& profiles) {
  Models models;
  for (const bla::Profile& profile : profiles.all()) {
    models.push_back(&profile);
  }
  return models;
}

/// The models matching a word; none: it does not match.
Models models_of(const std::string& word, const bla::Profiles& profiles) {
  return word.size() == 3 && begins_with(word, "all") ? all_models(profiles)
                                                      : profiles.matching(word);
}

Error unknown_model(const std::string& word, const bla::Profiles& profiles) {
  std::string known;
  for (const bla::Profile& profile : profiles.all()) {
    known += (known.empty() ? "" : ", ") + profile.model;
  }
  return {Code::usage, say<texts::unknown_model>(printable(word)), say<texts::known_models>(known)};
}

/// The sheet for the arguments; the first one may be a parameter. All errors go to the report.
Sheet choose(const ModelsOptions& options, const bla::Profiles& profiles, Report& report) {
  Sheet sheet{.models = all_models(profiles)};
  std::string model = options.model, parameter = options.parameter;
  if (models_of(model, profiles).empty() && !models_of(parameter, profiles).empty()) {
    std::swap(model, parameter); // the two cannot be confused
  }
  if (!model.empty()) {
    const Models named = models_of(model, profiles);
    if (!named.empty()) {
      sheet.models = named;
    } else if (parameter.empty() && !begins_with(model, "bla")) {
      parameter = model;
    } else {
      report.fail(unknown_model(model, profiles));
    }
  }
  if (!model.empty() && !models_of(parameter, profiles).empty()) {
    report.fail(
        {Code::usage, say<texts::models_one>(printable(parameter)), say<texts::models_one_hint>()});
  } else if (!parameter.empty()) {
    const auto found = profiles.find(parameter);
    found ? void(sheet.parameter = *found) : report.fail(found.error());
    const auto has_it = [&](const bla::Profile* each) {
      return each->find((*found)->address) != nullptr;
    };
    if (found && std::ranges::none_of(sheet.models, has_it)) {
      report.fail(
          {Code::unsupported,
           say<texts::models_lack>(printable(model), (*found)->name, (*found)->address.name()),
           say<texts::models_lack_hint>((*found)->name)});
    }
  }
  sheet.group = bla::find_group(options.group);
  if (sheet.group && sheet.parameter != nullptr) {
    report.fail({Code::usage, say<texts::models_group_of_one>(),
                 say<texts::models_group_of_one_hint>(options.group)});
  }
  return sheet;
}

Report execute(const ModelsOptions& options, Context& context) {
  Report report;
  const auto loaded = context.profiles();
  if (!loaded) {
    report.fail(loaded.error());
    return report;
  }
  const bla::Profiles& profiles = **loaded;
  const Sheet sheet = choose(options, profiles, report);
  if (!report.errors.empty()) {
    return report;
  }
  const bool lists = options.model.empty() && !sheet.group;
  report.counts = {{"models", sheet.models.size()}};
  report.json = [&profiles, sheet](JsonWriter& json) { write_models(json, sheet, profiles); };
  report.text = [&profiles, sheet, lists](const Page& page) {
    return lists ? list_text(sheet, page) : sheet_text(sheet, profiles, page);
  };
  return report;
}

} // namespace

constinit const Command commands::models{
    .name = "models",
    .traits = {.offline = true},
    .help = {"what the profiles know, without any servo", "プロファイルの内容を表示 (サーボ不要)"},
    .options = models_options,
    .arguments = models_arguments,
    .action = action<ModelsOptions, execute>,
};

} // namespace blactl::cli
