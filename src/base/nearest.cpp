#include "blactl/base/nearest.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace blactl {

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
  // Foreign text can be of any length; what is far longer than every word resembles none.
  constexpr std::size_t too_long = 64;
  if (typed.size() > too_long) {
    return {};
  }
  const std::size_t limit = std::max<std::size_t>(1, typed.size() / 3);
  std::vector<std::pair<std::size_t, std::string_view>> found;
  for (const std::string_view word : words) {
    const std::size_t distance = edit_distance(typed, word);
    const bool contains = typed.size() >= long_enough && word.find(typed) != std::string_view::npos;
    if (distance <= limit || contains) {
      found.emplace_back(distance, word);
    }
  }
  std::ranges::stable_sort(found, {}, &std::pair<std::size_t, std::string_view>::first);
  // Beside a word that is nearly right, far ones only distract.
  const std::size_t least = found.empty() ? 0 : found.front().first;
  std::erase_if(found, [&](const auto& each) { return least <= limit && each.first > least + 1; });
  std::vector<std::string_view> best;
  for (const auto& [distance, word] : found) {
    if (best.size() < at_most && std::ranges::find(best, word) == best.end()) {
      best.push_back(word);
    }
  }
  return best;
}

} // namespace blactl
