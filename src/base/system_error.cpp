#include "blactl/base/system_error.hpp"

#include "blactl/base/text.hpp"

#include "base/system_texts.hpp"

#include <algorithm>
#include <iterator>
#include <system_error>

namespace blactl {

std::string system_reason(int error) {
  const auto* const known =
      std::ranges::find(texts::system_errors, error, &texts::SystemError::number);
  if (known != std::end(texts::system_errors)) {
    return std::string(choose(known->text.en, known->text.ja));
  }
  return say<texts::system_error_unknown>(std::generic_category().message(error), error);
}

} // namespace blactl
