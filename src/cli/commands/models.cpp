// blactl models: the profiles as an offline reference.

#include "blactl/base/letter_case.hpp"
#include "blactl/bla/profile.hpp"
#include "blactl/fleet/bus/register_choice.hpp"

#include "cli/commands.hpp"
#include "cli/context.hpp"
#include "cli/models_texts.hpp"
#include "cli/output/data_sheet.hpp"
#include "cli/texts.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace blactl::cli {
namespace {

struct ModelsOptions {
  std::vector<std::string> words{}; ///< models and a parameter
  std::vector<std::string> groups{};
  std::string search{};
};

constexpr Option models_options[]{
    {.name = "--group",
     .value = "G",
     .kind = Kind::group,
     .repeat = Repeat::list,
     .help =
         {"the parameters of these groups only: command, status, operation, fault, config, "
          "control, pwm, limit, option, product, production",
          "指定グループのパラメータのみ: command、status、operation、fault、config、control、pwm、"
          "limit、option、product、production"},
     .store = into<&ModelsOptions::groups>},
    {.name = "--search",
     .value = "WORD",
     .kind = Kind::text,
     .help = {"the parameters with this in their name or explanation, English or Japanese",
              "名称または説明 (英語・日本語) にこの語を含むパラメータ"},
     .store = into<&ModelsOptions::search>},
};

constexpr Option models_arguments[]{
    {.name = "MODEL|PARAM",
     .kind = Kind::model_or_parameter,
     .repeat = Repeat::list,
     .help = {"models or their beginnings: BLA21-12U; all: every model side by side; and one PARAM",
              "機種名またはその先頭部分: BLA21-12U (all: 全機種を比較)。PARAM は 1 個"},
     .store = into<&ModelsOptions::words>},
};

using Models = std::vector<const bla::Profile*>;

bool begins_with(std::string_view word, std::string_view beginning) {
  return same_word(word.substr(0, beginning.size()), beginning);
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

/// The words that are no models; those that are models are chosen. Errors go to the report.
std::vector<std::string> choose_models(const ModelsOptions& options, const bla::Profiles& profiles,
                                       Sheet& sheet, Report& report) {
  std::vector<std::string> others;
  std::set<const bla::Profile*> chosen;
  for (const std::string& word : options.words) {
    const Models named = models_of(word, profiles);
    chosen.insert(named.begin(), named.end());
    if (named.empty() && begins_with(word, "bla")) {
      report.fail(unknown_model(word, profiles));
    } else if (named.empty()) {
      others.push_back(word);
    }
  }
  if (!chosen.empty()) {
    std::erase_if(sheet.models, [&](const bla::Profile* one) { return !chosen.contains(one); });
  }
  return others;
}

/// `models`: as typed.
void choose_parameter(const std::string& word, const std::string& models,
                      const bla::Profiles& profiles, Sheet& sheet, Report& report) {
  const auto found = profiles.find(word);
  if (!found) {
    report.fail(found.error());
    return;
  }
  sheet.parameter = *found;
  const auto has_it = [&](const bla::Profile* each) {
    return each->find((*found)->address) != nullptr;
  };
  if (std::ranges::none_of(sheet.models, has_it)) {
    report.fail(
        {Code::unsupported,
         say<texts::models_lack>(printable(models), (*found)->name, (*found)->address.name()),
         say<texts::models_lack_hint>((*found)->name)});
  }
}

/// Whether one of the models has a parameter that is shown.
bool shows_any(const Sheet& sheet) {
  return std::ranges::any_of(sheet.models, [&](const bla::Profile* model) {
    return std::ranges::any_of(model->parameters,
                               [&](const bla::Parameter& one) { return sheet.takes(one); });
  });
}

/// The sheet for the words and options. All errors go to the report.
Sheet choose(const ModelsOptions& options, const bla::Profiles& profiles, Report& report) {
  Sheet sheet{.models = all_models(profiles), .mentions = options.search};
  for (const std::string& list : options.groups) {
    sheet.groups.merge(fleet::parse_groups(list).value_or(std::set<bla::Group>()));
  }
  const auto others = choose_models(options, profiles, sheet, report);
  if (others.size() > 1) {
    report.fail({Code::usage, say<texts::models_one_parameter>(printable(others[1])),
                 say<texts::models_one_parameter_hint>()});
  } else if (!others.empty()) {
    std::string models;
    for (const std::string& word : options.words) {
      models += word == others.front() ? "" : (models.empty() ? "" : ", ") + word;
    }
    choose_parameter(others.front(), models, profiles, sheet, report);
  }
  if (!others.empty() && !sheet.is_whole()) {
    report.fail(
        {Code::usage, say<texts::models_group_of_one>(), say<texts::models_group_of_one_hint>()});
  } else if (!sheet.mentions.empty() && !shows_any(sheet)) {
    report.fail({Code::not_found, say<texts::models_nothing_mentions>(printable(options.search)),
                 say<texts::models_nothing_mentions_hint>()});
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
  const bool lists = options.words.empty() && sheet.is_whole();
  report.counts = {{"models", sheet.models.size()}};
  report.json = [&profiles, sheet](JsonWriter& json) { write_models(json, sheet, profiles); };
  report.text = [&profiles, sheet, lists](const Page& page) {
    return (lists ? list_text(sheet, page) : sheet_text(sheet, profiles, page)) +
           (sheet.mentions.empty() ? std::string() : say<texts::models_see_tuning>());
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
