#include "cli/trace/type_name.hpp"

#include "blactl/base/letter_case.hpp"
#include "blactl/dronecan/standard_types.hpp"

#include <algorithm>

namespace blactl::cli {
namespace {

bool ends_with(std::string_view name, std::string_view end) {
  return name.size() >= end.size() && same_word(name.substr(name.size() - end.size()), end);
}

} // namespace

bool means(std::string_view typed, std::string_view name) {
  return !typed.empty() && ends_with(name, typed) &&
         (name.size() == typed.size() || name[name.size() - typed.size() - 1] == '.');
}

std::string_view short_name(const dronecan::DataType& type) {
  const std::string_view name = type.name;
  auto dot = name.rfind('.');
  while (dot != std::string_view::npos) {
    const std::string_view end = name.substr(dot + 1);
    const bool is_shared =
        std::ranges::any_of(dronecan::standard_types(), [&](const dronecan::DataType& other) {
          return other.name != name && means(end, other.name);
        });
    if (!is_shared) {
      return end;
    }
    dot = dot == 0 ? std::string_view::npos : name.rfind('.', dot - 1);
  }
  return name;
}

std::string type_text(dronecan::Kind kind, std::uint16_t data_type_id) {
  const auto* type = dronecan::find_standard_type(kind, data_type_id);
  std::string name =
      type != nullptr ? std::string(short_name(*type)) : std::to_string(data_type_id);
  switch (kind) {
  case dronecan::Kind::request: return name + ".Request";
  case dronecan::Kind::response: return name + ".Response";
  case dronecan::Kind::message: break;
  }
  return name;
}

} // namespace blactl::cli
