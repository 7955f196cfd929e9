#include "blactl/can/loop.hpp"
#include "blactl/can/simbus.hpp"
#include "blactl/sim/bus/private_bus.hpp"
#include "blactl/sim/bus/server.hpp"

#include "unit/sim/support.hpp"

#include <poll.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdlib>
#include <fstream>
#include <future>
#include <thread>

using namespace blactl;
using namespace blactl::sim;
using namespace std::chrono_literals;
using can::SimBus;
using can::sim_wire::Kind;
using can::sim_wire::Message;
using testing::frame;
using testing::scenario;

namespace {

constexpr const char* real_servo = R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11}])";
constexpr const char* virtual_servos = R"("clock": "virtual", "servos": [
    {"model": "BLA21-12U-AB", "node_id": 11, "answer_delay": "2ms"},
    {"model": "BLA15-06U-A0", "node_id": 12}])";

/// A folder of this test's own.
class Folder {
 public:
  Folder() {
    std::array<char, 32> name{"/tmp/blactl-test-XXXXXX"};
    path = mkdtemp(name.data());
  }

  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  ~Folder() { std::filesystem::remove_all(path); }

  std::filesystem::path path;
};

std::unique_ptr<Server> open_server(const std::filesystem::path& path, std::string_view members) {
  auto server = Server::open(path, scenario(members));
  INFO((server ? "" : server.error().message));
  REQUIRE(server);
  return *std::move(server);
}

/// A server that runs in a thread of its own.
class Running {
 public:
  explicit Running(std::string_view members)
      : path(folder.path / "sim"), server_(open_server(path, members)) {}

  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  ~Running() {
    stop_ = true;
    if (thread_.joinable()) {
      thread_.join();
    }
  }

  void start() {
    thread_ = std::thread([this] {
      while (!stop_) {
        pollfd ready{server_->descriptor(), POLLIN, 0};
        const auto now = Time(std::chrono::duration_cast<Duration>(
            std::chrono::steady_clock::now().time_since_epoch()));
        const Time next = std::min(server_->next_deadline(now), now + 5ms);
        const auto wait = std::chrono::ceil<std::chrono::milliseconds>(next - now);
        poll(&ready, 1, static_cast<int>(std::max<std::int64_t>(0, wait.count())));
        server_->service();
        clients = server_->clients();
      }
    });
  }

  std::unique_ptr<SimBus> connect() {
    auto bus = SimBus::open(path, "sim:");
    INFO((bus ? "" : bus.error().message));
    REQUIRE(bus);
    return *std::move(bus);
  }

  void wait_for_clients(std::size_t count) const {
    for (int i = 0; i < 400 && clients != count; ++i) {
      std::this_thread::sleep_for(5ms);
    }
    CHECK(clients == count);
  }

  Folder folder;
  std::filesystem::path path;
  std::atomic<std::size_t> clients = 0;

 private:
  std::unique_ptr<Server> server_;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

/// Frames until `end`, with their times; DeadlineReached ends it.
std::vector<std::string> listen(can::Loop& loop, Time end) {
  std::vector<std::string> lines;
  for (;;) {
    const can::Event event = loop.next(end);
    if (const auto* received = std::get_if<can::Received>(&event)) {
      lines.push_back(fmt::format("{} {}", received->at.time_since_epoch().count(),
                                  testing::text(received->frame)));
    } else if (const auto* sent = std::get_if<can::Sent>(&event)) {
      lines.push_back("sent " + testing::text(sent->frame));
    } else {
      return lines;
    }
  }
}

/// A socket without a client behind it.
int raw_connection(const std::filesystem::path& path) {
  const int socket = ::socket(AF_UNIX, SOCK_SEQPACKET, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  path.string().copy(address.sun_path, sizeof address.sun_path - 1);
  const void* raw = &address;
  REQUIRE(connect(socket, static_cast<const sockaddr*>(raw), sizeof address) == 0);
  return socket;
}

/// Whether the other side ends the connection.
bool ended(int socket) {
  Message message;
  ssize_t size = 0;
  do {
    size = recv(socket, &message, sizeof message, 0);
  } while (size > 0);
  close(socket);
  return true;
}

/// A process that does `work` and then waits to be killed.
template <class Work> pid_t child(Work work) {
  const pid_t pid = fork();
  if (pid == 0) {
    work();
    for (;;) {
      pause();
    }
  }
  return pid;
}

void kill_hard(pid_t pid) {
  kill(pid, SIGKILL);
  waitpid(pid, nullptr, 0);
}

} // namespace

TEST_CASE("a client hears the servos, asks one and is answered") {
  Running server(real_servo);
  server.start();
  can::Loop loop(server.connect());
  (void)listen(loop, loop.now() + 300ms);
  loop.send(frame("1E0B8BFF#000030783338C5"));
  const auto heard = listen(loop, loop.now() + 300ms);
  const auto count = [&](std::string_view part) {
    return std::ranges::count_if(
        heard, [&](const std::string& line) { return line.find(part) != std::string::npos; });
  };
  CHECK(count("sent 1E0B8BFF#") == 1);
  CHECK(count(" 1E0B7F8B#") == 3);
  CHECK(count(" 1003F30B#") >= 4);
}

TEST_CASE("two clients hear each other and the same servos") {
  Running server(real_servo);
  server.start();
  can::Loop first(server.connect());
  can::Loop second(server.connect());
  first.send(frame("1401557F#00000000000000C0"));
  const auto heard = listen(second, second.now() + 300ms);
  CHECK(std::ranges::any_of(
      heard, [](const std::string& line) { return line.ends_with("1401557F#00000000000000C0"); }));
  CHECK(listen(first, first.now()).front() == "sent 1401557F#00000000000000C0");
}

TEST_CASE("servos keep their state while clients come and go") {
  Running server(real_servo);
  server.start();
  const auto ask = [&](std::string_view answer, std::initializer_list<const char*> request) {
    can::Loop loop(server.connect());
    (void)listen(loop, loop.now() + 200ms);
    for (const char* text : request) {
      loop.send(frame(text));
    }
    const auto heard = listen(loop, loop.now() + 100ms);
    return std::ranges::any_of(heard,
                               [&](const std::string& line) { return line.ends_with(answer); });
  };
  CHECK(ask("1E0B7F8B#FF06018403000086",
            {"1E0B8BFF#B477000184030086", "1E0B8BFF#0000000000307826", "1E0B8BFF#333846"}));
  CHECK(ask("1E0B7F8B#FF06018403000087", {"1E0B8BFF#000030783338C7"}));
}

TEST_CASE("on the virtual clock a minute passes at once, and frames are those of a private bus") {
  Running server(virtual_servos);
  server.start();
  can::Loop loop(server.connect());
  CHECK(loop.now() == Time{});
  const auto began = std::chrono::steady_clock::now();
  const auto lines = listen(loop, Time{} + 60s);
  CHECK(loop.now() == Time{} + 60s);
  CHECK(std::chrono::steady_clock::now() - began < 30s);
  CHECK(lines.size() > 2400);
  CHECK(loop.wall() == virtual_epoch + 60s);

  can::Loop alone(std::make_unique<PrivateBus>("sim:", scenario(virtual_servos)));
  CHECK(listen(alone, Time{} + 60s) == lines);
}

TEST_CASE("on the virtual clock time stands still while a client works") {
  Running server(virtual_servos);
  server.start();
  can::Loop loop(server.connect());
  (void)listen(loop, Time{} + 1s);
  auto busy = server.connect(); // it says nothing: it works
  CHECK(busy->now() == Time{} + 1s);
  auto waiting = std::async(std::launch::async, [&] { return listen(loop, Time{} + 2s).size(); });
  CHECK(waiting.wait_for(200ms) == std::future_status::timeout);
  std::this_thread::sleep_for(50ms);
  busy.reset(); // it leaves
  CHECK(waiting.wait_for(5s) == std::future_status::ready);
  CHECK(waiting.get() > 20);
}

TEST_CASE("two clients in lock step hear the same frames at the same times") {
  Running server(virtual_servos);
  server.start();
  auto first_bus = server.connect();
  auto second_bus = server.connect();
  const auto run = [](std::unique_ptr<SimBus> bus, bool asks) {
    can::Loop loop(std::move(bus));
    std::vector<std::string> answers;
    for (int i = 1; i <= 20; ++i) {
      if (asks) {
        loop.send(frame(fmt::format("1E0B8BFF#000030783338{:02X}", 0xC0 + i)));
      }
      const auto lines = listen(loop, Time{} + i * 100ms);
      std::ranges::copy_if(lines, std::back_inserter(answers), [](const std::string& line) {
        return line.find(" 1E0B7F8B#") != std::string::npos;
      });
    }
    return answers;
  };
  auto asking = std::async(std::launch::async, run, std::move(first_bus), true);
  const auto overheard = run(std::move(second_bus), false);
  const auto answers = asking.get();
  CHECK(answers.size() >= 57);
  CHECK(answers == overheard);
}

TEST_CASE("a client that is killed lets time go on and harms nobody") {
  Running server(virtual_servos);
  const pid_t killed = child([&] { (void)SimBus::open(server.path, "sim:").value().release(); });
  server.start();
  server.wait_for_clients(1);
  can::Loop loop(server.connect());
  auto waiting = std::async(std::launch::async, [&] { return listen(loop, Time{} + 1s).size(); });
  CHECK(waiting.wait_for(100ms) == std::future_status::timeout); // the other one holds time
  kill_hard(killed);
  CHECK(waiting.wait_for(5s) == std::future_status::ready);
  server.wait_for_clients(1);
}

TEST_CASE("a client that does not read for a while hears it all later, even on a silent bus") {
  Running server(R"("foreign": [{"kind": "node", "node_id": 30,
                    "commands": {"servo_ids": [1, 2], "rate": 1000}}])");
  server.start();
  auto lazy = server.connect();
  can::Loop eager(server.connect());
  const auto heard = listen(eager, eager.now() + 700ms);
  REQUIRE(heard.size() > 1000);
  can::Loop loop(std::move(lazy));
  const auto later = listen(loop, loop.now() + 100ms);
  REQUIRE(later.size() >= heard.size());
  const auto first = std::ranges::find(later, heard.front());
  REQUIRE(static_cast<std::size_t>(later.end() - first) >= heard.size());
  CHECK(std::equal(heard.begin(), heard.end(), first));
}

TEST_CASE("garbage ends its own connection only") {
  Running server(real_servo);
  server.start();
  can::Loop loop(server.connect());
  const auto say = [&](const void* bytes, std::size_t size) {
    const int socket = raw_connection(server.path);
    REQUIRE(::send(socket, bytes, size, MSG_NOSIGNAL) == static_cast<ssize_t>(size));
    return ended(socket);
  };
  const std::string text = "GET / HTTP/1.1\r\n\r\n";
  CHECK(say(text.data(), text.size()));
  const std::vector<char> large(100'000, 'x');
  CHECK(say(large.data(), large.size()));
  for (std::uint32_t kind = 0; kind < 20; ++kind) { // nothing goes before the greeting
    const Message message{.kind = static_cast<Kind>(kind)};
    CHECK(say(&message, sizeof message));
  }
  const Message stranger{.kind = Kind::hello, .value = 99};
  CHECK(say(&stranger, sizeof stranger));
  CHECK(listen(loop, loop.now() + 300ms).size() >= 4);
}

TEST_CASE("after the greeting a second one, or an answer of the simulator's, ends it") {
  Running server(real_servo);
  server.start();
  for (const Kind kind : {Kind::hello, Kind::welcome, Kind::tick, Kind::received}) {
    const int socket = raw_connection(server.path);
    const Message hello{.kind = Kind::hello, .value = can::sim_wire::version};
    const Message wrong{.kind = kind, .value = can::sim_wire::version};
    REQUIRE(::send(socket, &hello, sizeof hello, 0) > 0);
    REQUIRE(::send(socket, &wrong, sizeof wrong, 0) > 0);
    CHECK(ended(socket));
  }
}

TEST_CASE("when the simulator ends its clients are told") {
  auto server = std::make_unique<Running>(real_servo);
  server->start();
  can::Loop loop(server->connect());
  server.reset();
  for (;;) {
    const can::Event event = loop.next(loop.now() + 2s);
    if (const auto* gone = std::get_if<can::Gone>(&event)) {
      CHECK(gone->error.code == Code::interface);
      break;
    }
    REQUIRE_FALSE(std::holds_alternative<can::DeadlineReached>(event));
  }
}

TEST_CASE("without a simulator the client says how to start one") {
  const Folder folder;
  const auto bus = SimBus::open(folder.path / "sim", "sim:");
  REQUIRE_FALSE(bus);
  CHECK(bus.error().code == Code::interface);
  CHECK(bus.error().message.find((folder.path / "sim").string()) != std::string::npos);
  CHECK(bus.error().hint == "start `blactl sim` in another terminal");
  const auto long_path = SimBus::open(folder.path / std::string(200, 'x'), "sim:");
  REQUIRE_FALSE(long_path);
  CHECK(long_path.error().message.find("too long") != std::string::npos);
}

TEST_CASE("a second simulator at one place is refused, by name") {
  const Folder folder;
  const auto path = folder.path / "sim";
  const auto first = open_server(path, real_servo);
  const auto second = Server::open(path, scenario(real_servo));
  REQUIRE_FALSE(second);
  CHECK(second.error().code == Code::busy);
  CHECK(second.error().message.find(path.string()) != std::string::npos);
  CHECK_FALSE(second.error().hint.empty());
}

TEST_CASE("the socket of a simulator that was killed is replaced") {
  const Folder folder;
  const auto path = folder.path / "sim";
  std::array<int, 2> ready{};
  REQUIRE(pipe(ready.data()) == 0);
  const pid_t dead = child([&] {
    (void)Server::open(path, scenario(real_servo)).value().release();
    (void)!write(ready[1], "x", 1);
  });
  char byte = 0;
  REQUIRE(read(ready[0], &byte, 1) == 1);
  close(ready[0]);
  close(ready[1]);
  kill_hard(dead);
  CHECK(std::filesystem::is_socket(path));
  (void)open_server(path, real_servo);
  CHECK_FALSE(std::filesystem::exists(path)); // and a server that ends takes its socket along
}

TEST_CASE("what is no socket is left alone") {
  const Folder folder;
  const auto path = folder.path / "sim";
  std::ofstream(path) << "precious";
  const auto server = Server::open(path, scenario(real_servo));
  REQUIRE_FALSE(server);
  CHECK(server.error().code == Code::interface);
  CHECK(std::filesystem::file_size(path) == 8);
}

TEST_CASE("the default place is a folder of this user alone") {
  const Folder folder;
  const char* before = std::getenv("XDG_RUNTIME_DIR");
  const std::string saved = before != nullptr ? before : "";
  setenv("XDG_RUNTIME_DIR", folder.path.c_str(), 1);
  const auto own = folder.path / "blactl";
  const auto path = can::default_socket_path();
  CHECK(path == own / "sim");

  {
    const auto server = open_server(path, real_servo);
    struct stat status{};
    REQUIRE(stat(own.c_str(), &status) == 0);
    CHECK((status.st_mode & 0777U) == 0700U);
    REQUIRE(stat(path.c_str(), &status) == 0);
    CHECK((status.st_mode & 0777U) == 0600U);
  }
  chmod(own.c_str(), 0777);
  const auto refused = [&] {
    const auto server = Server::open(path, scenario(real_servo));
    const auto bus = SimBus::open(path, "sim:");
    return !server && server.error().code == Code::interface && !server.error().hint.empty() &&
           !bus && bus.error().code == Code::interface;
  };
  CHECK(refused());
  std::filesystem::remove_all(own);
  std::filesystem::create_directory(folder.path / "elsewhere");
  std::filesystem::create_symlink(folder.path / "elsewhere", own);
  CHECK(refused());

  unsetenv("XDG_RUNTIME_DIR");
  CHECK(can::default_socket_path() == fmt::format("/tmp/blactl-{}/sim", geteuid()));
  if (before != nullptr) {
    setenv("XDG_RUNTIME_DIR", saved.c_str(), 1);
  }
}
