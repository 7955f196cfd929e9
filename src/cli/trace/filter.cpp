#include "cli/trace/filter.hpp"

#include "blactl/base/nearest.hpp"
#include "blactl/base/texts.hpp"
#include "blactl/dronecan/standard_types.hpp"
#include "blactl/fleet/bus/target.hpp"

#include "cli/trace/texts.hpp"
#include "cli/trace/type_name.hpp"

#include <algorithm>
#include <charconv>
#include <string_view>
#include <utility>

namespace blactl::cli {
namespace {

using dronecan::DataType;

std::vector<std::string_view> words_of(std::string_view list) {
  std::vector<std::string_view> words;
  for (;;) {
    const auto comma = list.find(',');
    words.push_back(list.substr(0, comma));
    if (comma == std::string_view::npos) {
      return words;
    }
    list.remove_prefix(comma + 1);
  }
}

Error unknown_type(std::string_view typed) {
  std::vector<std::string_view> known;
  for (const DataType& type : dronecan::standard_types()) {
    known.push_back(short_name(type));
  }
  std::ranges::sort(known);
  known.erase(std::ranges::unique(known).begin(), known.end());
  std::string similar;
  for (const std::string_view name : nearest(typed, known)) {
    similar += (similar.empty() ? "" : ", ") + std::string(name);
  }
  return {Code::usage, say<texts::unknown_type>(printable(typed)),
          similar.empty() ? say<texts::unknown_type_hint>() : say<texts::did_you_mean>(similar),
          std::nullopt};
}

} // namespace

std::expected<TraceFilter, std::vector<Error>>
TraceFilter::make(const Wish& wish, const std::optional<std::string>& nodes) {
  TraceFilter filter;
  std::vector<Error> faults;
  if (wish.types) {
    filter.take_types(*wish.types, faults);
  }
  if (wish.kinds) {
    filter.take_kinds(*wish.kinds);
  }
  if (nodes) {
    filter.take_nodes(*nodes, faults);
  }
  if (!faults.empty()) {
    return std::unexpected(std::move(faults));
  }
  return filter;
}

void TraceFilter::take_types(const std::string& list, std::vector<Error>& faults) {
  for (const std::string_view word : words_of(list)) {
    std::uint16_t id{};
    const char* end = std::to_address(word.end());
    if (const auto [stop, error] = std::from_chars(std::to_address(word.begin()), end, id);
        error == std::errc() && stop == end) {
      types_.push_back({id, std::nullopt});
      continue;
    }
    const auto before = types_.size();
    for (const DataType& type : dronecan::standard_types()) {
      if (means(word, type.name)) {
        types_.push_back({type.id, type.service});
      }
    }
    if (types_.size() == before) {
      faults.push_back(unknown_type(word));
    }
  }
}

void TraceFilter::take_kinds(const std::string& list) {
  constexpr std::array<std::string_view, 3> words{"message", "request", "response"};
  kinds_.fill(false);
  for (const std::string_view word : words_of(list)) {
    const auto it = std::ranges::find(words, word);
    if (it != words.end()) { // the declaration of --kind allows no other word
      kinds_[static_cast<std::size_t>(it - words.begin())] = true;
    }
  }
}

void TraceFilter::take_nodes(const std::string& list, std::vector<Error>& faults) {
  const auto targets = fleet::parse_targets(list);
  if (!targets) {
    faults.push_back(targets.error());
    return;
  }
  if (targets->all || !targets->selectors.empty()) {
    faults.push_back({Code::usage, say<texts::trace_takes_node_ids>(printable(list)),
                      say<texts::trace_takes_node_ids_hint>(), std::nullopt});
    return;
  }
  nodes_.emplace();
  for (const dronecan::NodeId id : targets->ids) {
    nodes_->set(id.value());
  }
}

bool TraceFilter::passes(const dronecan::Header& header) const {
  const bool service = header.kind != dronecan::Kind::message;
  const auto is_it = [&](const Type& type) {
    return type.id == header.data_type_id && type.service.value_or(service) == service;
  };
  return kinds_[std::to_underlying(header.kind)] &&
         (types_.empty() || std::ranges::any_of(types_, is_it)) &&
         (!nodes_ || nodes_->test(header.source.value()) ||
          (service && nodes_->test(header.destination.value())));
}

} // namespace blactl::cli
