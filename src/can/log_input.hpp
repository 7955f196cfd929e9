#pragma once
// The bytes of a log from a file or a pipe, unpacked if it is a gzip file.

#include "can/gunzip.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace blactl::can {

/// Its first bytes decide whether it is packed, not its name. Never waits.
class LogInput {
 public:
  enum class Fault : std::uint8_t {
    none,
    unreadable, ///< see error_number()
    cut_off,    ///< it ends in the middle of gzip data
    damaged,    ///< its gzip data is not valid
  };

  /// Takes over the descriptor.
  explicit LogInput(int descriptor) : descriptor_(descriptor) {}

  ~LogInput();
  LogInput(const LogInput&) = delete;
  LogInput& operator=(const LogInput&) = delete;

  /// Returns the number of bytes put into `room`, which is not empty. 0: it has ended, or a pipe
  /// has nothing for now.
  [[nodiscard]] std::size_t read(std::span<char> room);

  /// Whether nothing more comes; the reason is fault(), if there is one.
  [[nodiscard]] bool ended() const { return ended_; }

  [[nodiscard]] Fault fault() const { return fault_; }

  /// The errno of an unreadable log.
  [[nodiscard]] int error_number() const { return error_number_; }

  [[nodiscard]] int descriptor() const { return descriptor_; }

 private:
  /// The packed input after the first bytes.
  struct Packed {
    Gunzip gunzip{};
    std::vector<char> buffer{};
  };

  [[nodiscard]] std::size_t read_file(std::span<char> room);
  [[nodiscard]] std::size_t read_plain(std::span<char> room);
  [[nodiscard]] std::size_t read_packed(std::span<char> room);
  [[nodiscard]] bool knows_format();
  void end(Fault fault);

  int descriptor_;
  std::array<char, Gunzip::magic.size()> head_{}; ///< its first bytes
  std::size_t head_size_ = 0, head_given_ = 0;
  bool knows_format_ = false;
  bool file_ended_ = false;
  bool ended_ = false;
  Fault fault_ = Fault::none;
  int error_number_ = 0;
  std::unique_ptr<Packed> packed_; ///< null: plain
};

} // namespace blactl::can
