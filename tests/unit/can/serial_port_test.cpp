#include "blactl/can/serial_adapters.hpp"
#include "blactl/can/serial_port.hpp"

#include "catch.hpp"
#include "slcan_adapter.hpp"

#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

using namespace blactl;
using namespace blactl::can;
namespace fs = std::filesystem;

namespace {

struct Folder {
  Folder() {
    std::string name = (fs::temp_directory_path() / "blactl-serial-XXXXXX").string();
    REQUIRE(mkdtemp(name.data()) != nullptr);
    path = name;
  }

  ~Folder() { fs::remove_all(path); }

  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  fs::path path;
};

Error error_of(const fs::path& device) {
  const auto port = SerialPort::open(device, 1'000'000);
  REQUIRE_FALSE(port);
  return port.error();
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

} // namespace

TEST_CASE("all rates up to 4,000,000 baud are known") {
  for (const unsigned baud :
       {9600U, 115200U, 921600U, 1'000'000U, 2'000'000U, 3'000'000U, 4'000'000U}) {
    CHECK(is_baud_rate(baud));
    const test::SlcanAdapter adapter(test::lawicel());
    CHECK(SerialPort::open(adapter.path(), baud));
  }
  for (const unsigned baud : {0U, 1U, 1'000'001U, 5'000'000U}) {
    CHECK_FALSE(is_baud_rate(baud));
  }
}

TEST_CASE("a port that is not there is told with a hint") {
  const Error error = error_of("/dev/no-such-port\x1b");
  CHECK(error.code == Code::interface);
  CHECK(contains(error.message, "there is no serial port /dev/no-such-port\\x1b"));
  CHECK_FALSE(error.hint.empty());
  CHECK(error_of("/dev/null/port").code == Code::interface);
}

TEST_CASE("what is no serial port is refused") {
  const Folder folder;
  std::ofstream(folder.path / "file") << "x";
  for (const fs::path& path : {folder.path / "file", folder.path, fs::path("/dev/null")}) {
    const Error error = error_of(path);
    CHECK(error.code == Code::interface);
    CHECK(contains(error.message, "is not a serial port"));
    CHECK_FALSE(error.hint.empty());
  }
  std::ifstream file(folder.path / "file");
  CHECK(file.get() == 'x'); // nothing was written to it
}

TEST_CASE("a port is of one user only, and free again after him") {
  const test::SlcanAdapter adapter(test::lawicel());
  {
    const auto first = SerialPort::open(adapter.path(), 1'000'000);
    REQUIRE(first);
    const Error error = error_of(adapter.path());
    CHECK(error.code == Code::interface);
    CHECK(contains(error.message, "is in use by another program"));
    CHECK(contains(error.hint, "fuser -v " + adapter.path()));
  }
  CHECK(SerialPort::open(adapter.path(), 1'000'000));
}

TEST_CASE("a port of a group is a matter of permission, and how to join the group is told",
          "[root][may-skip]") {
  if (geteuid() != 0) {
    WARN("skipped: only root can become somebody else");
    return;
  }
  const test::SlcanAdapter adapter(test::lawicel());
  const gid_t dialout = 20; // Debian
  REQUIRE(chown(adapter.path().c_str(), 0, dialout) == 0);
  const auto as_nobody = [&](mode_t mode) {
    REQUIRE(chmod(adapter.path().c_str(), mode) == 0);
    std::array<int, 2> ends{};
    REQUIRE(pipe(ends.data()) == 0);
    const pid_t child = fork();
    REQUIRE(child >= 0);
    if (child == 0) {
      std::string said = "it could be opened";
      if (setgid(65534) == 0 && setuid(65534) == 0) {
        if (const auto port = SerialPort::open(adapter.path(), 1'000'000); !port) {
          said = std::string(name(port.error().code)) + '\n' + port.error().message + '\n' +
                 port.error().hint;
        }
      }
      const auto written = write(ends[1], said.data(), said.size());
      _exit(written > 0 ? 0 : 1);
    }
    close(ends[1]);
    std::array<char, 1000> text{};
    const auto size = read(ends[0], text.data(), text.size());
    close(ends[0]);
    waitpid(child, nullptr, 0);
    return std::string(text.data(), size > 0 ? static_cast<std::size_t>(size) : 0);
  };
  const std::string group = as_nobody(0660);
  CHECK(contains(group, "permission\n"));
  CHECK(contains(group, "it is for the group dialout"));
  CHECK(contains(group, "`sudo usermod -aG dialout nobody`"));
  const std::string nobody_may = as_nobody(0600);
  CHECK(contains(nobody_may, "permission\n"));
  CHECK_FALSE(contains(nobody_may, "usermod"));
}

TEST_CASE("adapters are listed by product, and those without such a name by their port") {
  const Folder devices;
  CHECK(serial_adapters(devices.path).empty());
  CHECK(describe(std::vector<fs::path>{}).empty());
  const fs::path by_id = devices.path / "serial" / "by-id";
  fs::create_directories(by_id);
  for (const char* name : {"ttyACM0", "ttyUSB0", "ttyUSB1", "ttyS0", "null"}) {
    std::ofstream(devices.path / name) << "";
  }
  fs::create_symlink("../../ttyUSB1", by_id / "usb-FTDI_FT232R-if00-port0");
  const auto found = serial_adapters(devices.path);
  CHECK(found == std::vector<fs::path>{by_id / "usb-FTDI_FT232R-if00-port0",
                                       devices.path / "ttyACM0", devices.path / "ttyUSB0"});
  CHECK(contains(describe(found), "slcan:" + (devices.path / "ttyACM0").string() + ", slcan:"));
}
