#include "blactl/fleet/bus/register_access.hpp"

#include "blactl/fleet/bus/texts.hpp"

#include <utility>

namespace blactl::fleet {

using dronecan::GetSet;
using dronecan::Outcome;

namespace {

/// A response bears the parameter's name; a failure may come without one (errata C7).
bool answers(const std::string& name, dronecan::Bytes payload) {
  const auto response = GetSet::Response::decode(payload);
  if (!response) {
    return false;
  }
  const bool failure = std::holds_alternative<GetSet::Empty>(response->value);
  return response->name == name || (failure && response->name.empty());
}

dronecan::Request get_set(dronecan::NodeId server, bla::Address address, GetSet::Value value,
                          const Patience& patience) {
  GetSet::Request request;
  request.value = std::move(value);
  request.name = address.name();
  auto question = ask(server, GetSet::type, request.encode(), patience);
  question.accepts = [name = address.name()](dronecan::Bytes payload) {
    return answers(name, payload);
  };
  return question;
}

} // namespace

dronecan::Request ask(dronecan::NodeId server, const dronecan::DataType& type,
                      const dronecan::Payload& payload, const Patience& patience) {
  dronecan::Request request;
  request.server = server;
  request.type = &type;
  request.payload = payload;
  request.timeout = patience.timeout;
  request.retries = patience.retries;
  return request;
}

dronecan::Request read_register(dronecan::NodeId server, bla::Address address,
                                const Patience& patience) {
  return get_set(server, address, GetSet::Empty{}, patience);
}

dronecan::Request write_register(dronecan::NodeId server, bla::Address address, std::int64_t raw,
                                 const Patience& patience) {
  return get_set(server, address, raw, patience);
}

Error no_answer(const Outcome& outcome, dronecan::NodeId server, std::string_view subject) {
  const std::uint8_t node = server.value();
  switch (outcome.kind) {
  case Outcome::Kind::not_sent:
    return {Code::no_acknowledge, say<texts::not_sent>(node, subject),
            say<texts::nobody_acknowledges_hint>(), node};
  case Outcome::Kind::cancelled:
    return {Code::interrupted, say<texts::cancelled>(node, subject), {}, node};
  case Outcome::Kind::not_recorded:
    return {Code::not_recorded, say<texts::not_recorded>(node, subject),
            say<texts::not_recorded_hint>(), node};
  default:
    return {Code::timeout, say<texts::no_answer>(node, subject), say<texts::no_answer_hint>(),
            node};
  }
}

Result<std::int64_t> register_value(const Outcome& outcome, dronecan::NodeId server,
                                    bla::Address address, bla::Width width) {
  const std::string name = address.name();
  if (!outcome.answered()) {
    return std::unexpected(no_answer(outcome, server, name));
  }
  const std::uint8_t node = server.value();
  const auto response = GetSet::Response::decode(outcome.payload);
  if (!response || std::holds_alternative<GetSet::Empty>(response->value)) {
    return std::unexpected(Error{Code::refused, say<texts::register_refused>(node, name),
                                 say<texts::register_refused_hint>(node), node});
  }
  const auto* value = std::get_if<std::int64_t>(&response->value);
  if (value == nullptr || !width.holds(*value)) {
    return std::unexpected(Error{Code::refused, say<texts::no_register_value>(node, name),
                                 say<texts::not_taken_hint>(node), node});
  }
  return width.narrow(*value);
}

} // namespace blactl::fleet
