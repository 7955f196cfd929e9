#include "blactl/fleet/files/settings_file.hpp"

#include "blactl/base/json_reader.hpp"
#include "blactl/base/read_file.hpp"
#include "blactl/fleet/files/params_file.hpp"
#include "blactl/fleet/files/recipe.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

namespace blactl::fleet {

namespace {

bool is_json(std::string_view text, const std::filesystem::path& file) {
  constexpr std::string_view before = "\xEF\xBB\xBF \t\r\n"; // the mark of some editors
  const std::size_t first = text.find_first_not_of(before);
  return file.extension() == ".json" || (first != std::string_view::npos && text[first] == '{');
}

bool is_recipe(const json::Value& root) {
  constexpr std::string_view any_version = "blactl-recipe/";
  return std::ranges::any_of(root.items, [&](const json::Value* member) {
    return member->key == "schema" && member->text.starts_with(any_version);
  });
}

Result<FleetFile> read_json(std::string_view text, std::string file,
                            const bla::Profiles& profiles) {
  auto document = json::parse(text, file);
  if (!document) {
    return std::unexpected(document.error());
  }
  if (!is_recipe(document->root())) {
    return read_fleet_file(*document, profiles);
  }
  auto recipe = read_recipe(*document, profiles);
  if (!recipe) {
    return std::unexpected(recipe.error());
  }
  return FleetFile{.file = std::move(file),
                   .servos = {{.name = {}, .match = {}, .set = recipe->set, .about = {}}},
                   .recipe = std::move(*recipe)};
}

} // namespace

Result<FleetFile> read_settings_file(const std::filesystem::path& file,
                                     const bla::Profiles& profiles) {
  const auto text = read_file(file, json::max_file_bytes);
  if (!text) {
    return std::unexpected(text.error());
  }
  return is_json(*text, file) ? read_json(*text, file.string(), profiles)
                              : parse_params_file(*text, file.string(), profiles);
}

} // namespace blactl::fleet
