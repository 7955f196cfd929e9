#include "blactl/base/read_file.hpp"

#include "blactl/base/system_error.hpp"
#include "blactl/base/text.hpp"
#include "blactl/base/texts.hpp"

#include <cerrno>
#include <cstdio>
#include <memory>

namespace blactl {
namespace {

Result<std::string> read_all(std::FILE& stream, const std::string& name, std::size_t most) {
  std::string text;
  std::string block(1U << 16U, '\0');
  while (std::feof(&stream) == 0) {
    const std::size_t count = std::fread(block.data(), 1, block.size(), &stream);
    if (std::ferror(&stream) != 0) {
      return fail(Code::bad_file,
                  say<texts::file_unreadable>(printable(name), system_reason(errno)),
                  say<texts::file_hint>());
    }
    text.append(block, 0, count);
    if (text.size() > most) {
      return fail(Code::bad_file, say<texts::file_too_large>(printable(name), most >> 20U),
                  say<texts::file_hint>());
    }
  }
  return text;
}

} // namespace

Result<std::string> read_file(const std::filesystem::path& path, std::size_t most) {
  const std::string name = path.string();
  if (name == "-") {
    return read_all(*stdin, name, most);
  }
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(name.c_str(), "rb"),
                                                               std::fclose);
  if (!stream) {
    return fail(Code::bad_file, say<texts::file_unreadable>(printable(name), system_reason(errno)),
                say<texts::file_hint>());
  }
  return read_all(*stream, name, most);
}

} // namespace blactl
