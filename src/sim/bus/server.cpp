#include "blactl/sim/bus/server.hpp"

#include "blactl/base/system_error.hpp"

#include "sim/bus/listening_socket.hpp"
#include "sim/bus/server_client.hpp"
#include "sim/scenario/texts.hpp"

#include <sys/epoll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

namespace blactl::sim {
namespace {

constexpr std::size_t max_clients = 64;

/// Maximum number of virtual clock events per call of service(), so that new clients do not wait.
constexpr int max_steps = 1000;

/// Maximum bus time per call of service() on the real clock, so that clients and signals do not
/// wait when this process did not run for a while or the machine is too slow.
constexpr Duration longest_slice = std::chrono::milliseconds(20);

} // namespace

struct Server::State {
  State(const Scenario& scenario, const EventSink& sink, std::unique_ptr<ListeningSocket> socket)
      : clock(scenario.clock), listening(std::move(socket)),
        simulator(scenario, clock == Clock::simulated ? Time{} : monotonic_now(), sink),
        epoll(epoll_create1(EPOLL_CLOEXEC)) {}

  State(const State&) = delete;
  State& operator=(const State&) = delete;

  ~State() {
    if (epoll >= 0) {
      close(epoll);
    }
  }

  [[nodiscard]] bool watch(int descriptor) const;
  void watch_for_room();
  void serve(int descriptor, std::uint32_t events);
  void accept_clients();
  void remove_gone();
  void pass_time();
  bool step();

  Clock clock;
  std::unique_ptr<ListeningSocket> listening;
  Simulator simulator;
  std::vector<std::unique_ptr<ServerClient>> clients;
  std::set<int> full; ///< descriptors of clients whose sockets are full
  int epoll;
  std::size_t held_for = 0; ///< virtual clock: time stands until this number of clients is attached
  Duration behind{};        ///< real clock: elapsed time that the bus has yet to catch up with
  bool more = false;        ///< time could pass further at once
};

bool Server::State::watch(int descriptor) const {
  epoll_event event{};
  event.events = EPOLLIN;
  event.data.fd = descriptor;
  return epoll_ctl(epoll, EPOLL_CTL_ADD, descriptor, &event) == 0;
}

/// Looks at clients with full sockets again when they have room.
void Server::State::watch_for_room() {
  for (const auto& client : clients) {
    const int socket = client->descriptor();
    if (client->has_backlog() == full.contains(socket)) {
      continue;
    }
    epoll_event event{};
    event.events = EPOLLIN | (client->has_backlog() ? EPOLLOUT : 0U);
    event.data.fd = socket;
    if (epoll_ctl(epoll, EPOLL_CTL_MOD, socket, &event) == 0) {
      client->has_backlog() ? (void)full.insert(socket) : (void)full.erase(socket);
    }
  }
}

void Server::State::serve(int descriptor, std::uint32_t events) {
  const auto client = std::ranges::find(clients, descriptor, &ServerClient::descriptor);
  if (client == clients.end()) {
    accept_clients();
    return;
  }
  if ((events & EPOLLOUT) != 0) {
    (*client)->flush();
  }
  if ((events & ~std::uint32_t{EPOLLOUT}) != 0) {
    (*client)->serve();
  }
}

void Server::State::accept_clients() {
  for (;;) {
    const int socket =
        accept4(listening->descriptor(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (socket < 0) {
      return;
    }
    if (clients.size() >= max_clients || !watch(socket)) {
      close(socket);
    } else {
      clients.push_back(std::make_unique<ServerClient>(socket, simulator, clock));
    }
  }
}

void Server::State::remove_gone() {
  for (const auto& client : clients) {
    if (client->gone()) {
      full.erase(client->descriptor()); // another client may get this descriptor
    }
  }
  std::erase_if(clients, [](const auto& client) { return client->gone(); });
}

void Server::State::pass_time() {
  if (clock == Clock::real) {
    const Time now = monotonic_now();
    simulator.advance_to(std::min(now, simulator.now() + longest_slice));
    behind = now - simulator.now();
    more = behind > Duration::zero();
    return;
  }
  int steps = 0;
  while (steps < max_steps && step()) {
    ++steps;
  }
  more = steps == max_steps;
}

/// Goes to the next event of the virtual clock; false: a client is working, or there is none.
bool Server::State::step() {
  Time first = simulator.next_event();
  std::size_t attached = 0;
  for (const auto& client : clients) {
    if (!client->attached() || client->gone()) {
      continue;
    }
    const auto deadline = client->waits_until();
    if (!deadline) {
      return false;
    }
    ++attached;
    first = std::min(first, *deadline);
  }
  if (attached == 0 || attached < held_for || first == never) {
    return false;
  }
  held_for = 0;
  simulator.advance_to(std::max(first, simulator.now()));
  for (const auto& client : clients) {
    const auto deadline = client->attached() ? client->waits_until() : std::nullopt;
    if (deadline && *deadline <= simulator.now()) {
      client->tick(simulator.now());
    }
  }
  return true;
}

Server::Server(std::unique_ptr<State> state) : state_(std::move(state)) {}

Server::~Server() = default;

Result<std::unique_ptr<Server>> Server::open(const std::filesystem::path& socket,
                                             const Scenario& scenario, const EventSink& sink) {
  auto listening = ListeningSocket::open(socket);
  if (!listening) {
    return std::unexpected(listening.error());
  }
  auto state = std::make_unique<State>(scenario, sink, *std::move(listening));
  if (state->epoll < 0 || !state->watch(state->listening->descriptor())) {
    const std::string reason = system_reason(errno);
    return fail(Code::interface, say<texts::sim_cannot_serve>(printable(socket.string()), reason));
  }
  return std::unique_ptr<Server>(new Server(std::move(state)));
}

int Server::descriptor() const {
  return state_->epoll;
}

void Server::service() {
  state_->pass_time();
  std::array<epoll_event, max_clients + 1> events{};
  const int count = epoll_wait(state_->epoll, events.data(), static_cast<int>(events.size()), 0);
  for (int i = 0; i < count; ++i) {
    const epoll_event& event = events[static_cast<std::size_t>(i)];
    state_->serve(event.data.fd, event.events);
  }
  state_->remove_gone();
  state_->pass_time();
  state_->remove_gone();
  state_->watch_for_room();
}

Time Server::next_deadline(Time now) const {
  if (state_->more) {
    return now;
  }
  return state_->clock == Clock::real ? state_->simulator.next_event() : never;
}

Duration Server::behind() const {
  return state_->behind;
}

void Server::hold(std::size_t clients) {
  state_->held_for = clients;
  state_->more = true; // check at once whether time can pass now
}

Simulator& Server::simulator() {
  return state_->simulator;
}

std::size_t Server::clients() const {
  return state_->clients.size();
}

} // namespace blactl::sim
