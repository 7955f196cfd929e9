#include "blactl/fleet/files/recipe.hpp"

#include "blactl/base/json_reader.hpp"
#include "blactl/bla/value.hpp"
#include "blactl/fleet/bus/texts.hpp"

#include "fleet/files/settings_reader.hpp"
#include "fleet/files/texts.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace blactl::fleet {

namespace {

/// A counter and its place in the file.
struct CounterSetting {
  Counter counter;
  const json::Value* where = nullptr;
};

/// Empty: invalid, with an error.
std::optional<Counter> read_counter(const json::Value& member, const bla::Profiles& profiles,
                                    json::Faults& faults) {
  json::Object object(member, faults);
  constexpr std::int64_t most = 0xFF;
  Counter counter{.first = object.integer("first", 0, most),
                  .last = object.integer("last", 0, most),
                  .step = object.optional_integer("step", 1, most).value_or(1),
                  .begins_again =
                      object.optional_word("at_end", {"stop", "again"}).value_or("stop") ==
                      "again"};
  const bool is_whole = object.has("first") && object.has("last");
  object.finish();
  const auto parameter = bla::make_assignment(profiles, member.key, "1");
  if (!parameter) {
    faults.add(member, fault_text(parameter.error()));
    return std::nullopt;
  }
  counter.parameter = parameter->parameter;
  if (!bla::is_id(counter.parameter->address)) {
    faults.add(member, say<texts::recipe_counter_of>(counter.parameter->name));
    return std::nullopt;
  }
  if (!is_whole) {
    return std::nullopt;
  }
  if (counter.last < counter.first) {
    faults.add(member, say<texts::recipe_counter_ends>(counter.last, counter.first));
  }
  const bool are_ids = check_id(member, counter.parameter->name, counter.first, profiles, faults) &&
                       check_id(member, counter.parameter->name, counter.last, profiles, faults);
  return are_ids ? std::optional(counter) : std::nullopt;
}

/// The contents of "set": values, and counters.
struct RecipeSet {
  std::vector<Setting> values{};
  std::vector<CounterSetting> counters{};
};

RecipeSet read_recipe_set(json::Object& object, const bla::Profiles& profiles,
                          json::Faults& faults) {
  std::vector<const json::Value*> values;
  RecipeSet set;
  for (const json::Value* member : object.members()) {
    if (member->kind != json::Kind::object) {
      values.push_back(member);
    } else if (const auto counter = read_counter(*member, profiles, faults)) {
      set.counters.push_back({*counter, member});
    }
  }
  set.values = read_settings(values, profiles, faults);
  const auto address = [](const Counter& counter) { return counter.parameter->address; };
  for (std::size_t i = 0; i < set.counters.size(); ++i) {
    const Counter& counter = set.counters[i].counter;
    const bool is_twice =
        find(set.values, address(counter)) != nullptr ||
        std::any_of(set.counters.begin(), set.counters.begin() + static_cast<std::ptrdiff_t>(i),
                    [&](const CounterSetting& other) {
                      return address(other.counter) == address(counter);
                    });
    if (is_twice) {
      faults.add(*set.counters[i].where, say<texts::fleet_set_twice>(counter.parameter->name));
    }
  }
  return set;
}

void take_set(RecipeSet set, Recipe& recipe) {
  std::ranges::transform(set.values, std::back_inserter(recipe.set), &Setting::assignment);
  std::ranges::sort(recipe.set, {}, [](const bla::Assignment& assignment) {
    return assignment.parameter->address;
  });
  std::ranges::transform(set.counters, std::back_inserter(recipe.counters),
                         &CounterSetting::counter);
  std::ranges::sort(recipe.counters, {},
                    [](const Counter& counter) { return counter.parameter->address; });
}

Recipe read_root(const json::Value& root, const bla::Profiles& profiles, json::Faults& faults) {
  json::Object object(root, faults);
  (void)object.optional_string("$schema"); // for editors
  (void)object.word("schema", {recipe_schema});
  constexpr std::int64_t most_of_16_bits = 0xFFFF;
  Recipe recipe{.name = object.string("name"),
                .model = object.string("model"),
                .firmware_min = object.optional_integer("firmware_min", 0, most_of_16_bits)};
  RecipeSet set;
  if (json::Object values = object.object("set"); values.exists()) {
    set = read_recipe_set(values, profiles, faults);
  }
  object.finish();
  if (object.has("name") && recipe.name.empty()) {
    faults.add(root, say<texts::fleet_no_name>());
  }
  const auto models = profiles.matching(recipe.model);
  if (object.has("model") && models.empty()) {
    faults.add(root, say<texts::fleet_no_model>(printable(recipe.model)));
  } else if (object.has("model")) {
    check_model(set.values, models, faults);
  }
  check_pwm(set.values, profiles, faults);
  take_set(std::move(set), recipe);
  return recipe;
}

Result<Recipe> read_recipe_document(Result<json::Document> document,
                                    const bla::Profiles& profiles) {
  return document ? read_recipe(*document, profiles) : std::unexpected(document.error());
}

/// For people; "?" if there was no response.
std::string shown_version(const Servo& servo, const std::optional<std::int64_t>& raw) {
  const bla::Parameter* version = servo.identity.parameter(bla::address::firmware_version);
  return raw && version != nullptr ? bla::display(*version, *raw) : std::string("?");
}

std::optional<Error> check_model_of(const Servo& servo, const Recipe& recipe,
                                    const bla::Profiles& profiles) {
  const auto models = profiles.matching(recipe.model);
  const bla::Profile* profile = servo.identity.profile();
  if (profile != nullptr && std::ranges::find(models, profile) != models.end()) {
    return std::nullopt;
  }
  const std::string model = servo.identity.model();
  return Error{
      Code::model_mismatch,
      say<texts::recipe_other_model>(model.empty() ? say<texts::recipe_unknown_model>() : model,
                                     printable(recipe.model)),
      say<texts::recipe_other_model_hint>(), servo.id.value()};
}

std::optional<Error> check_firmware_of(const Servo& servo, const Recipe& recipe) {
  const auto version = servo.identity.readings().firmware_version;
  if (!recipe.firmware_min || (version && *version >= *recipe.firmware_min)) {
    return std::nullopt;
  }
  if (!version) {
    return Error{Code::timeout, say<texts::servo_silent_on>("firmware_version"),
                 say<texts::run_again_hint>(), servo.id.value()};
  }
  return Error{Code::firmware_too_old,
               say<texts::recipe_needs_newer>(shown_version(servo, version),
                                              shown_version(servo, recipe.firmware_min)),
               say<texts::recipe_needs_newer_hint>(), servo.id.value()};
}

} // namespace

std::optional<std::int64_t> Counter::after(std::int64_t value) const {
  const std::int64_t next = value + step;
  if (next <= last) {
    return next;
  }
  return begins_again ? std::optional(first) : std::nullopt;
}

Result<Recipe> parse_recipe(std::string_view text, std::string file,
                            const bla::Profiles& profiles) {
  return read_recipe_document(json::parse(text, std::move(file)), profiles);
}

Result<Recipe> read_recipe(const std::filesystem::path& file, const bla::Profiles& profiles) {
  return read_recipe_document(json::parse_file(file), profiles);
}

Result<Recipe> read_recipe(json::Document& document, const bla::Profiles& profiles) {
  Recipe recipe = read_root(document.root(), profiles, document.faults());
  if (const auto fine = document.faults().result(); !fine) {
    return std::unexpected(fine.error());
  }
  return recipe;
}

std::optional<Error> check_fit(const Servo& servo, const Recipe& recipe,
                               const bla::Profiles& profiles) {
  auto wrong = check_model_of(servo, recipe, profiles);
  return wrong ? wrong : check_firmware_of(servo, recipe);
}

} // namespace blactl::fleet
