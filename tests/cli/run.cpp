#include "run.hpp"

#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace blactl::test {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int large_pipe = 1 << 20; // what any user may have

[[noreturn]] void fail(const std::string& what) {
  throw std::system_error(errno, std::generic_category(), what);
}

class Fd {
 public:
  explicit Fd(int fd = -1) : fd_(fd) {
    if (fd_ >= 0) {
      fcntl(fd_, F_SETFD, FD_CLOEXEC);
    }
  }

  Fd(Fd&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}

  Fd& operator=(Fd&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }

  Fd(const Fd&) = delete;
  Fd& operator=(const Fd&) = delete;

  ~Fd() { close(); }

  void close() {
    if (fd_ >= 0) {
      ::close(std::exchange(fd_, -1));
    }
  }

  [[nodiscard]] int get() const { return fd_; }

  [[nodiscard]] bool open() const { return fd_ >= 0; }

 private:
  int fd_;
};

/// Two ends of one line: the test holds `ours`, the child gets `theirs`.
struct Line {
  Fd ours;
  Fd theirs;
};

Line pipe_from_child() {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) {
    fail("pipe");
  }
  return {Fd(ends[0]), Fd(ends[1])};
}

Line pipe_to_child() {
  auto line = pipe_from_child();
  return {std::move(line.theirs), std::move(line.ours)};
}

Line terminal(unsigned short columns) {
  int ours = -1;
  int theirs = -1;
  winsize size{};
  size.ws_row = 40;
  size.ws_col = columns;
  if (openpty(&ours, &theirs, nullptr, nullptr, &size) != 0) {
    fail("openpty");
  }
  // What a test compares is what the program wrote: no echo of the answers, no CR before the LF.
  termios mode{};
  tcgetattr(theirs, &mode);
  mode.c_lflag &= ~static_cast<tcflag_t>(ECHO);
  mode.c_oflag &= ~static_cast<tcflag_t>(OPOST);
  tcsetattr(theirs, TCSANOW, &mode);
  return {Fd(ours), Fd(theirs)};
}

Line file(const std::string& path) {
  Fd theirs(open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600));
  if (!theirs.open()) {
    fail(path);
  }
  return {Fd(), std::move(theirs)};
}

Fd duplicate(const Fd& fd) {
  Fd copy(fcntl(fd.get(), F_DUPFD_CLOEXEC, 3));
  if (!copy.open()) {
    fail("fcntl");
  }
  return copy;
}

std::vector<std::string> environment(const std::filesystem::path& folder, const Options& options) {
  constexpr std::array changes_output{"NO_COLOR", "CLICOLOR", "CLICOLOR_FORCE", "COLUMNS",
                                      "LINES",    "LANG",     "LANGUAGE",       "TERM"};
  std::map<std::string, std::optional<std::string>> variables;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string_view text = *entry;
    const auto name = std::string(text.substr(0, text.find('=')));
    if (!name.starts_with("BLACTL_") && !name.starts_with("LC_") &&
        std::ranges::find(changes_output, name) == changes_output.end()) {
      variables[name] = text.substr(std::min(name.size() + 1, text.size()));
    }
  }
  variables["HOME"] = folder;
  variables["XDG_RUNTIME_DIR"] = folder / "run";
  variables["XDG_STATE_HOME"] = folder / "state";
  variables["LC_ALL"] = "C.UTF-8";
  variables["TERM"] = "xterm-256color";
  for (const auto& [name, value] : options.env) {
    variables[name] = value;
  }
  std::vector<std::string> result;
  for (const auto& [name, value] : variables) {
    if (value) {
      result.push_back(name + "=" + *value);
    }
  }
  return result;
}

/// The array of pointers that execve wants; valid as long as `strings` is.
std::vector<char*> pointers(std::vector<std::string>& strings) {
  std::vector<char*> result;
  for (auto& text : strings) {
    result.push_back(text.data());
  }
  result.push_back(nullptr);
  return result;
}

} // namespace

/// One child with its three lines. Every wait of the harness is the poll() in pump().
class Background::Process {
 public:
  Process(const std::filesystem::path& folder, const Arguments& arguments, const Options& options)
      : options_(options), command_("blactl"), typed_(options.stdin_text) {
    // A child that does not read its input must fail a test, not end the test program.
    static const auto ignored = std::signal(SIGPIPE, SIG_IGN);
    static_cast<void>(ignored);

    for (const auto& argument : arguments) {
      command_ += " " + argument;
    }
    std::vector<std::string> words{BLACTL_BINARY};
    words.insert(words.end(), arguments.begin(), arguments.end());
    start(std::move(words), environment(folder, options));
  }

  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  ~Process() { kill(); }

  [[nodiscard]] pid_t pid() const { return pid_; }

  [[nodiscard]] bool ended() const { return !process_.open(); }

  void signal(int number) const {
    if (!ended()) {
      ::kill(pid_, number);
    }
  }

  void kill() {
    if (!ended()) {
      reap();
    }
  }

  void expect(std::string_view text) {
    const auto seen = [&] { return shown_.find(text) != std::string::npos; };
    if (!pump(options_.timeout, [&] { return seen() || finished(); }) || !seen()) {
      give_up("did not show '" + std::string(text) + "'");
    }
  }

  std::string ask(std::string_view line, std::string_view until) {
    typed_ += std::string(line) + '\n';
    std::size_t end = 0; // behind the line that tells the end
    const auto answered = [&] {
      const auto at = out_.text.find(until, asked_);
      end = at == std::string::npos ? 0 : out_.text.find('\n', at) + 1;
      return end > 0;
    };
    if (!pump(options_.timeout, [&] { return answered() || finished(); }) || end == 0) {
      give_up("did not show '" + std::string(until) + "'");
    }
    const std::size_t begin = std::exchange(asked_, end);
    return out_.text.substr(begin, end - begin);
  }

  Result wait() {
    if (!pump(options_.timeout, [&] { return finished(); })) {
      give_up("did not end");
    }
    return {status_, out_.text, err_.text};
  }

  bool wait_for(std::chrono::milliseconds time) {
    return pump(time, [&] { return finished(); });
  }

 private:
  struct Output {
    Fd fd;
    std::string text;
  };

  void start(std::vector<std::string> words, std::vector<std::string> variables) {
    Line in;
    Line err;
    if (options_.terminal) {
      err = terminal(options_.columns);
      in = {duplicate(err.ours), duplicate(err.theirs)};
    } else {
      err = pipe_from_child();
      in = pipe_to_child();
    }
    Line out = !options_.stdout_file.empty() ? file(options_.stdout_file)
               : options_.terminal_stdout    ? terminal(options_.columns)
                                             : pipe_from_child();
    if (options_.asks && fcntl(out.ours.get(), F_SETPIPE_SZ, large_pipe) < 0) {
      fail("F_SETPIPE_SZ");
    }

    const auto argv = pointers(words);
    const auto envp = pointers(variables);
    const pid_t parent = getpid();
    pid_ = fork();
    if (pid_ < 0) {
      fail("fork");
    }
    if (pid_ == 0) { // only calls that are safe after fork
      setsid();      // no hold on the terminal that the tests were started from
      prctl(PR_SET_PDEATHSIG, SIGKILL);
      std::signal(SIGPIPE, SIG_DFL);
      if (getppid() == parent && dup2(in.theirs.get(), STDIN_FILENO) >= 0 &&
          dup2(out.theirs.get(), STDOUT_FILENO) >= 0 &&
          dup2(err.theirs.get(), STDERR_FILENO) >= 0 &&
          (!options_.close_stdout || close(STDOUT_FILENO) == 0) &&
          (!options_.terminal || ioctl(STDIN_FILENO, TIOCSCTTY, 0) == 0)) {
        execve(argv.front(), argv.data(), envp.data());
      }
      _exit(127);
    }
    process_ = Fd(static_cast<int>(syscall(SYS_pidfd_open, pid_, 0)));
    if (!process_.open()) {
      fail("pidfd_open");
    }
    in_ = std::move(in.ours);
    out_.fd = std::move(out.ours);
    err_.fd = std::move(err.ours);
    for (const Fd* fd : {&in_, &out_.fd, &err_.fd}) {
      if (fd->open()) {
        fcntl(fd->get(), F_SETFL, fcntl(fd->get(), F_GETFL) | O_NONBLOCK);
      }
    }
    feed();
  }

  /// The end of the process may come before the last of its output.
  [[nodiscard]] bool finished() const { return ended() && !out_.fd.open() && !err_.fd.open(); }

  /// Moves input and output until `done`, or until the time is over (false).
  template <typename Done> bool pump(std::chrono::milliseconds time, Done done) {
    const auto deadline = Clock::now() + time;
    while (!done()) {
      const auto left =
          std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now()).count();
      std::array<pollfd, 4> waits{{{in_.get(), POLLOUT, 0},
                                   {out_.fd.get(), POLLIN, 0},
                                   {err_.fd.get(), POLLIN, 0},
                                   {process_.get(), POLLIN, 0}}};
      if (typed_.empty()) {
        waits[0].fd = -1;
      }
      if (poll(waits.data(), waits.size(), static_cast<int>(std::max<long>(left, 0))) < 0 &&
          errno != EINTR) {
        fail("poll");
      }
      for (Output* output : {&out_, &err_}) {
        read(*output);
      }
      if (options_.leave_after && out_.text.find(*options_.leave_after) != std::string::npos) {
        out_.fd.close();
      }
      feed();
      if (waits[3].revents != 0) {
        reap();
      }
      if (Clock::now() >= deadline) {
        return done();
      }
    }
    return true;
  }

  void read(Output& output) {
    std::array<char, 4096> buffer{};
    while (output.fd.open()) {
      const auto count = ::read(output.fd.get(), buffer.data(), buffer.size());
      if (count > 0) {
        const std::string_view text(buffer.data(), static_cast<std::size_t>(count));
        output.text += text;
        shown_ += text;
      } else if (count < 0 && (errno == EAGAIN || errno == EINTR)) {
        return;
      } else { // the end; of a terminal EIO
        output.fd.close();
      }
    }
  }

  /// Types what is due, and ends the input when nothing more will come.
  void feed() {
    while (answered_ < options_.answers.size()) {
      const auto& answer = options_.answers[answered_];
      const auto at = shown_.find(answer.after, seen_);
      if (at == std::string::npos) {
        break;
      }
      seen_ = shown_.size();
      typed_ += answer.type;
      ++answered_;
    }
    if (in_.open() && !typed_.empty()) {
      const auto count = write(in_.get(), typed_.data(), typed_.size());
      if (count > 0) {
        typed_.erase(0, static_cast<std::size_t>(count));
      } else if (errno != EAGAIN && errno != EINTR) {
        typed_.clear();
        in_.close();
      }
    }
    if (typed_.empty() && answered_ == options_.answers.size() && !options_.terminal &&
        !options_.asks) {
      in_.close();
    }
  }

  /// The child leads a group of its own, of which nothing stays behind.
  void reap() {
    ::kill(-pid_, SIGKILL);
    siginfo_t info{};
    while (waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED) != 0 && errno == EINTR) {
    }
    status_ = info.si_code == CLD_EXITED ? info.si_status : 128 + info.si_status;
    process_.close();
  }

  [[noreturn]] void give_up(const std::string& what) {
    const auto how = ended()
                         ? "ended with status " + std::to_string(status_)
                         : "was killed after " + std::to_string(options_.timeout.count()) + " ms";
    kill();
    throw std::runtime_error("`" + command_ + "` " + what + " and " + how +
                             "\nstdout: " + out_.text + "\nstderr: " + err_.text);
  }

  Options options_;
  std::string command_;
  pid_t pid_ = -1;
  Fd process_; // open as long as the child is not reaped
  int status_ = -1;
  Fd in_;
  Output out_;
  Output err_;
  std::string shown_; // both outputs in the order they came
  std::string typed_; // not yet written
  std::size_t answered_ = 0;
  std::size_t seen_ = 0;  // output that no answer waits for any more
  std::size_t asked_ = 0; // stdout that belongs to earlier questions
};

Bench::Bench() {
  auto name = (std::filesystem::temp_directory_path() / "blactl-test-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) {
    fail(name);
  }
  folder_ = name;
  for (const auto* part : {"run", "state"}) {
    std::filesystem::create_directory(folder_ / part);
    std::filesystem::permissions(folder_ / part, std::filesystem::perms::owner_all);
  }
}

Bench::~Bench() {
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

Result Bench::run(const Arguments& arguments, const Options& options) const {
  return Background::Process(folder_, arguments, options).wait();
}

std::string Bench::file(std::string_view name, std::string_view text) const {
  const auto path = folder_ / name;
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

Result run(const Arguments& arguments, const Options& options) {
  return Bench().run(arguments, options);
}

Background::Background(const Bench& bench, const Arguments& arguments, const Options& options,
                       std::string_view until)
    : process_(std::make_unique<Process>(bench.folder(), arguments, options)) {
  process_->expect(until);
}

Background::~Background() {
  process_->signal(SIGTERM);
  process_->wait_for(2s); // what still runs then is killed by the Process
}

pid_t Background::pid() const {
  return process_->pid();
}

void Background::expect(std::string_view text) {
  process_->expect(text);
}

std::string Background::ask(std::string_view line, std::string_view until) {
  return process_->ask(line, until);
}

Result Background::wait() {
  return process_->wait();
}

Result Background::stop(int signal) {
  process_->signal(signal);
  return wait();
}

void Background::kill() {
  process_->kill();
}

nlohmann::json json(std::string_view text) {
  try {
    return nlohmann::json::parse(text);
  } catch (const nlohmann::json::parse_error& error) {
    throw std::runtime_error(std::string(error.what()) + "\nin: " + std::string(text));
  }
}

std::vector<nlohmann::json> json_lines(std::string_view text) {
  std::vector<nlohmann::json> lines;
  while (!text.empty()) {
    const auto end = std::min(text.find('\n'), text.size());
    lines.push_back(json(text.substr(0, end)));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

} // namespace blactl::test
