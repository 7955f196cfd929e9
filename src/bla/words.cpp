#include "bla/words.hpp"

#include "bla/texts.hpp"

namespace blactl::bla {

std::string either(const std::vector<std::string>& words) {
  std::string all;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const bool last = i + 1 == words.size();
    all += i == 0 ? "" : last ? say<texts::list_or>() : say<texts::list_and_more>();
    all += words[i];
  }
  return all;
}

} // namespace blactl::bla
