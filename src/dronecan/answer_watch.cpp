#include "blactl/dronecan/answer_watch.hpp"

#include "blactl/base/crc16.hpp"

#include "dronecan/tail.hpp"

#include <algorithm>
#include <span>

namespace blactl::dronecan {
namespace {

/// The longest valid answer, that to GetNodeInfo, with its CRC.
constexpr std::size_t most_bytes = 400;

/// The data type of a watched answer; null: it is not watched.
const DataType* watched(const Header& header) {
  for (const DataType* type : {&GetNodeInfo::type, &GetSet::type}) {
    if (header.kind == Kind::response && header.data_type_id == type->id) {
      return type;
    }
  }
  return nullptr;
}

/// The payload of a transfer of several frames, if its CRC is right.
std::optional<std::span<const std::uint8_t>> checked(const DataType& type,
                                                     std::span<const std::uint8_t> bytes) {
  if (bytes.size() < crc_size) {
    return std::nullopt;
  }
  const auto payload = bytes.subspan(crc_size);
  const unsigned crc = crc16(payload, base_crc(type.signature));
  const unsigned sent = bytes[0] | static_cast<unsigned>(bytes[1]) << 8U;
  return crc == sent ? std::optional(payload) : std::nullopt;
}

} // namespace

void AnswerWatch::receive(const Header& header, const can::Frame& frame, Time at) {
  const DataType* type = watched(header);
  if (type == nullptr) {
    return;
  }
  const Tail tail = Tail::decode(frame.data[frame.size - 1U]);
  Assembly& assembly = assemblies_[{header.source, header.data_type_id}];
  if (tail.start) {
    if (is_another(assembly, header, frame, at)) {
      report_(header.source, {});
    }
    assembly.transfer_id = tail.transfer_id;
    assembly.client = header.destination;
    assembly.start = at;
    assembly.toggle = false;
    assembly.bytes.clear();
  } else if (assembly.bytes.empty() || tail.transfer_id != assembly.transfer_id ||
             tail.toggle != assembly.toggle) {
    return;
  }
  assembly.toggle = !assembly.toggle;
  const auto data = frame.payload().first(frame.size - 1U);
  assembly.bytes.insert(assembly.bytes.end(), data.begin(), data.end());
  if (assembly.bytes.size() > most_bytes) {
    assembly.bytes.clear();
  } else if (tail.end) {
    complete(assembly, *type, header, at);
    assembly.bytes.clear();
  }
}

bool AnswerWatch::is_another(const Assembly& begun, const Header& header, const can::Frame& frame,
                             Time at) {
  const auto data = frame.payload().first(frame.size - 1U);
  const bool is_same_question =
      !begun.bytes.empty() && begun.client == header.destination &&
      begun.transfer_id == Tail::decode(frame.data[frame.size - 1U]).transfer_id &&
      at - begun.start < Receiver::transfer_timeout;
  return is_same_question &&
         !std::ranges::equal(
             data, std::span(begun.bytes).first(std::min(data.size(), begun.bytes.size())));
}

void AnswerWatch::forget(NodeId server) {
  std::erase_if(assemblies_, [&](const auto& entry) { return entry.first.first == server; });
}

std::optional<AnswerWatch::Trait> AnswerWatch::trait(const DataType& type, Bytes payload) const {
  if (type.id == GetNodeInfo::type.id) {
    const auto info = GetNodeInfo::Response::decode(payload);
    return info ? std::optional(Trait{.value = info->unique_id}) : std::nullopt;
  }
  const auto told = GetSet::Response::decode(payload);
  return told && settled_.contains(told->name)
             ? std::optional(Trait{.name = told->name, .value = told->value})
             : std::nullopt;
}

void AnswerWatch::complete(Assembly& assembly, const DataType& type, const Header& header,
                           Time at) {
  const auto payload = checked(type, assembly.bytes);
  const auto trait = payload ? this->trait(type, *payload) : std::nullopt;
  Answer& first = assembly.answers[assembly.transfer_id];
  const bool is_second = trait && first.trait && first.trait->name == trait->name &&
                         first.client == header.destination &&
                         at - first.at < Receiver::transfer_timeout;
  if (is_second && first.trait->value != trait->value) {
    const auto* one = std::get_if<UniqueId>(&first.trait->value);
    const auto* other = std::get_if<UniqueId>(&trait->value);
    report_(header.source,
            one != nullptr && other != nullptr ? std::set{*one, *other} : std::set<UniqueId>{});
  }
  forget_last_lap(assembly, header.destination);
  if (trait) {
    first = {trait, header.destination, at};
  }
}

void AnswerWatch::forget_last_lap(Assembly& assembly, NodeId client) {
  for (unsigned ahead = 1; ahead <= transfer_id_modulus / 2U; ++ahead) {
    Answer& answer = assembly.answers[(assembly.transfer_id + ahead) % transfer_id_modulus];
    if (answer.client == client) {
      answer = {};
    }
  }
}

} // namespace blactl::dronecan
