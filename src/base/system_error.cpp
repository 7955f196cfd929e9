#include "blactl/base/system_error.hpp"

#include "blactl/base/text.hpp"

#include <algorithm>
#include <cerrno>
#include <iterator>
#include <system_error>

// The English texts are those of strerror(), so that a search finds them.
namespace blactl::texts {

struct SystemError {
  int number;
  Text text;
};

inline constexpr SystemError system_errors[]{
    {EACCES, {"Permission denied", "アクセス権がありません"}},
    {EADDRINUSE, {"Address already in use", "アドレスは既に使用されています"}},
    {EADDRNOTAVAIL, {"Cannot assign requested address", "アドレスを使用できません"}},
    {EAGAIN, {"Resource temporarily unavailable", "一時的に使用できません"}},
    {EBADF, {"Bad file descriptor", "ファイルディスクリプタが不正です"}},
    {EBUSY, {"Device or resource busy", "使用中です"}},
    {ECONNREFUSED, {"Connection refused", "接続を拒否されました"}},
    {ECONNRESET, {"Connection reset by peer", "相手が接続を切断しました"}},
    {EDQUOT, {"Disk quota exceeded", "ディスクの割当て容量を超えています"}},
    {EEXIST, {"File exists", "既に存在します"}},
    {EFBIG, {"File too large", "ファイルが大きすぎます"}},
    {EINVAL, {"Invalid argument", "引数が不正です"}},
    {EIO, {"Input/output error", "入出力エラーです"}},
    {EISDIR, {"Is a directory", "ディレクトリです"}},
    {ELOOP, {"Too many levels of symbolic links", "シンボリックリンクの段数が多すぎます"}},
    {EMFILE, {"Too many open files", "開いているファイルが多すぎます"}},
    {ENAMETOOLONG, {"File name too long", "ファイル名が長すぎます"}},
    {ENETDOWN, {"Network is down", "ネットワークが停止しています"}},
    {ENETUNREACH, {"Network is unreachable", "ネットワークに到達できません"}},
    {ENFILE, {"Too many open files in system", "システム全体で開いているファイルが多すぎます"}},
    {ENOBUFS, {"No buffer space available", "バッファの空きがありません"}},
    {ENODEV, {"No such device", "デバイスがありません"}},
    {ENOENT, {"No such file or directory", "ファイルまたはディレクトリがありません"}},
    {ENOMEM, {"Cannot allocate memory", "メモリを確保できません"}},
    {ENOSPC, {"No space left on device", "空き容量がありません"}},
    {ENOTCONN, {"Transport endpoint is not connected", "接続されていません"}},
    {ENOTDIR, {"Not a directory", "ディレクトリではありません"}},
    {ENOTSUP, {"Operation not supported", "この操作には対応していません"}},
    {ENOTTY, {"Inappropriate ioctl for device", "シリアルポートではありません"}},
    {ENXIO, {"No such device or address", "デバイスまたはアドレスがありません"}},
    {EPERM, {"Operation not permitted", "操作が許可されていません"}},
    {EPIPE, {"Broken pipe", "受け側が閉じています"}},
    {EROFS, {"Read-only file system", "読出し専用のファイルシステムです"}},
    {ETIMEDOUT, {"Connection timed out", "タイムアウトしました"}},
    {ETXTBSY, {"Text file busy", "実行中のファイルです"}},
};

inline constexpr Text system_error_unknown{"{} (error {})", "エラー {1} ({0})"};

} // namespace blactl::texts

namespace blactl {

std::string system_reason(int error) {
  const auto* const known =
      std::ranges::find(texts::system_errors, error, &texts::SystemError::number);
  if (known != std::end(texts::system_errors)) {
    return std::string(choose(known->text.en, known->text.ja));
  }
  return say<texts::system_error_unknown>(std::generic_category().message(error), error);
}

} // namespace blactl
