#include "blactl/base/nearest.hpp"

#include "blactl/base/letter_case.hpp"

#include <algorithm>
#include <compare>
#include <string>
#include <utility>

namespace blactl {
namespace {

/// The characters that separate the parts of a word: "angle_limit_cw", "param.GetSet", "--dry-run".
bool is_separator(char c) {
  return c == '_' || c == '-' || c == '.' || c == ' ';
}

/// Lower case without separators: people leave them out, and mix the case.
std::string squeezed(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (!is_separator(c)) {
      out += lower(c);
    }
  }
  return out;
}

std::vector<std::string> parts_of(std::string_view word) {
  std::vector<std::string> parts;
  while (!word.empty()) {
    const auto length =
        static_cast<std::size_t>(std::ranges::find_if(word, is_separator) - word.begin());
    if (length > 0) {
      parts.push_back(squeezed(word.substr(0, length)));
    }
    word.remove_prefix(std::min(length + 1, word.size()));
  }
  return parts;
}

/// The distance to the run of neighbouring parts that is most like `typed`: "nodeid" is near the
/// end of "static_node_id".
std::size_t distance_to_parts(std::string_view typed, const std::vector<std::string>& parts) {
  std::size_t least = typed.size();
  for (std::size_t first = 0; first < parts.size(); ++first) {
    std::string run;
    for (std::size_t last = first; last < parts.size(); ++last) {
      run += parts[last];
      least = std::min(least, edit_distance(typed, run));
    }
  }
  return least;
}

/// How far a word is from the typed one; smaller is nearer.
struct Nearness {
  std::size_t rank = 0;     ///< a whole word ranks before an equally near part
  std::size_t distance = 0; ///< of the whole word
  friend auto operator<=>(const Nearness&, const Nearness&) = default;
};

} // namespace

std::size_t edit_distance(std::string_view a, std::string_view b) {
  // Three rows of the table: two letters back (swaps), one back, and the present one.
  std::vector<std::size_t> before(b.size() + 1);
  std::vector<std::size_t> last(b.size() + 1);
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) {
    row[j] = j;
  }
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::swap(before, last);
    std::swap(last, row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, replaced});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        row[j] = std::min(row[j], before[j - 2] + 1);
      }
    }
  }
  return row[b.size()];
}

std::vector<std::string_view> nearest(std::string_view typed,
                                      std::span<const std::string_view> words) {
  constexpr std::size_t at_most = 3;
  constexpr std::size_t long_enough = 3;
  // Foreign text can be of any length; one far longer than every word resembles none.
  constexpr std::size_t too_long = 64;
  if (typed.size() > too_long) {
    return {};
  }
  const std::string wanted = squeezed(typed);
  const std::size_t limit = std::max<std::size_t>(1, wanted.size() / 3);
  std::vector<std::pair<Nearness, std::string_view>> found;
  for (const std::string_view word : words) {
    const std::string whole = squeezed(word);
    const std::size_t distance = edit_distance(wanted, whole);
    const bool has_length = wanted.size() >= long_enough;
    const std::size_t to_part = has_length ? distance_to_parts(wanted, parts_of(word)) : distance;
    const bool contains = has_length && whole.find(wanted) != std::string::npos;
    if (distance <= limit || to_part <= limit || contains) {
      found.push_back({{std::min(distance, to_part + 1), distance}, word});
    }
  }
  std::ranges::stable_sort(found, {}, &std::pair<Nearness, std::string_view>::first);
  // Beside a word that is nearly right, far ones only distract.
  const std::size_t least = found.empty() ? 0 : found.front().first.rank;
  std::erase_if(found,
                [&](const auto& each) { return least <= limit && each.first.rank > least + 1; });
  std::vector<std::string_view> best;
  for (const auto& [nearness, word] : found) {
    if (best.size() < at_most && std::ranges::find(best, word) == best.end()) {
      best.push_back(word);
    }
  }
  return best;
}

} // namespace blactl
