#include "cli/output/alike.hpp"

#include "cli/texts.hpp"

#include <map>
#include <string_view>

namespace blactl::cli {
namespace {

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// `text` with a mark in place of every whole number that is this ID.
std::string without_id(std::string_view text, std::uint8_t id) {
  const std::string number = std::to_string(id);
  std::string out;
  while (!text.empty()) {
    std::size_t digits = 0;
    while (digits < text.size() && is_digit(text[digits])) {
      ++digits;
    }
    const std::string_view word = text.substr(0, digits > 0 ? digits : 1);
    out += word == number ? std::string(1, '\0') : std::string(word);
    text.remove_prefix(word.size());
  }
  return out;
}

} // namespace

std::vector<Alike> alike(std::span<const AboutNode> all) {
  std::vector<Alike> groups;
  std::map<std::string, std::size_t> known;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto& [id, text] = all[i];
    if (id) {
      const auto [group, is_new] = known.emplace(without_id(text, *id), groups.size());
      if (!is_new) {
        groups[group->second].others.push_back(*id);
        continue;
      }
    }
    groups.push_back({.first = i});
  }
  return groups;
}

std::string likewise(std::string text, std::span<const std::uint8_t> others) {
  std::string ids;
  for (const std::uint8_t id : others) {
    ids += (ids.empty() ? "" : ", ") + std::to_string(id);
  }
  return ids.empty() ? text : say<texts::true_of_others>(text, ids);
}

} // namespace blactl::cli
