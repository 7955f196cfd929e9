#include "cli/options.hpp"

#include "blactl/dronecan/transfer.hpp"

#include "cli/interface/scheme.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace blactl::cli {
namespace {

using namespace std::chrono_literals;

// In the order of Colour and Language.
constexpr std::array<std::string_view, 3> colours{"auto", "always", "never"};
constexpr std::array<std::string_view, 2> languages{"en", "ja"};

/// The forms of every kind of interface, and what they end with.
consteval std::array<char, 256> all_forms(std::string_view between, std::string_view end) {
  std::array<char, 256> text{};
  auto* at = text.begin();
  for (const Scheme& scheme : schemes) {
    at = &scheme == &schemes.front() ? at : std::ranges::copy(between, at).out;
    at = std::ranges::copy(scheme.form, at).out;
  }
  std::ranges::copy(end, at);
  return text;
}

constexpr auto interface_en = all_forms(", ", " (default: the only CAN interface that is up)");
constexpr auto interface_ja = all_forms("、", " (省略時: 起動している唯一の CAN インターフェース)");

constexpr Option shared[]{
    {.name = "--interface",
     .letter = 'i',
     .value = "IFACE",
     .kind = Kind::interface,
     .help = {interface_en.data(), interface_ja.data()},
     .store = into<&Shared::interface>},
    {.name = "--node",
     .letter = 'n',
     .value = "LIST",
     .kind = Kind::nodes,
     .repeat = Repeat::list,
     .help = {"servos: 12, 10-14,20, all, uid:…, serial:…, servo:…, model:…",
              "対象のサーボ: 12、10-14,20、all、uid:…、serial:…、servo:…、model:…"},
     .store = into<&Shared::nodes>},
    {.name = "--json",
     .letter = 'j',
     .kind = Kind::flag,
     .help = {"output as one JSON document; streams: one object a line",
              "結果を 1 つの JSON 文書で出力 (ストリームは 1 行に 1 オブジェクト)"},
     .store = into<&Shared::json>},
    {.name = "--csv",
     .kind = Kind::flag,
     .help = {"output as CSV (scan, get, monitor, command)",
              "結果を CSV で出力 (scan、get、monitor、command)"},
     .store = into<&Shared::csv>},
    {.name = "--quiet",
     .letter = 'q',
     .kind = Kind::flag,
     .help = {"no notes on stderr", "標準エラー出力に補足を表示しない"},
     .store = into<&Shared::output, &Reporter::Options::quiet>},
    {.name = "--verbose",
     .letter = 'v',
     .kind = Kind::flag,
     .help = {"on stderr: own node ID, lock files, repeated requests, what the adapter says",
              "自ノード ID、ロックファイル、再要求、アダプターとのやり取りを標準エラー出力に表示"},
     .store = into<&Shared::output, &Reporter::Options::verbosity>},
    {.name = "--color",
     .value = "WHEN",
     .kind = Kind::word,
     .words = colours,
     .help = {"colour of states, warnings and errors", "状態・警告・エラーの色付け"},
     .store = into<&Shared::output, &Reporter::Options::colour>},
    {.name = "--lang",
     .value = "LANG",
     .kind = Kind::word,
     .words = languages,
     .help = {"language of messages (default: of the locale)",
              "メッセージの言語 (省略時: ロケールに従う)"},
     .store = into<&Shared::language>},
    {.name = "--yes",
     .letter = 'y',
     .kind = Kind::flag,
     .help = {"agree to questions beforehand", "確認の質問に事前に同意"},
     .store = into<&Shared::yes>},
    {.name = "--timeout",
     .value = "SEC",
     .kind = Kind::seconds,
     .seconds = {1ms, 1min},
     .help = {"how long an answer may take (default 0.5)", "応答を待つ時間 (省略時 0.5)"},
     .store = into<&Shared::patience, &fleet::Patience::timeout>},
    {.name = "--retries",
     .value = "N",
     .kind = Kind::whole,
     .whole = {0, 100},
     .help = {"how often a request is repeated (default 2)", "要求の再試行回数 (省略時 2)"},
     .store = into<&Shared::patience, &fleet::Patience::retries>},
    {.name = "--listen-only",
     .kind = Kind::flag,
     .help = {"send nothing, take no node ID", "送信せず、ノード ID も使用しない"},
     .store = into<&Shared::listen_only>},
    {.name = "--local-node-id",
     .value = "ID",
     .kind = Kind::whole,
     .whole = {1, dronecan::NodeId::max},
     .help = {"own node ID (default 127, else 126)", "自ノードの ID (省略時 127、使用中なら 126)"},
     .store = into<&Shared::local_node_id>},
    {.name = "--while-driven",
     .kind = Kind::flag,
     .help = {"even while another node drives the servo", "他のノードがサーボに動作指令中でも実行"},
     .store = into<&Shared::while_driven>},
    {.name = "--overwrite-rom",
     .kind = Kind::flag,
     .help = {"save although the servo could not read its ROM",
              "サーボが ROM を読み出せない場合も保存"},
     .store = into<&Shared::overwrite_rom>},
    {.name = "--profile-dir",
     .value = "DIR",
     .kind = Kind::folder,
     .help = {"further model profiles", "追加の機種プロファイルのディレクトリ"},
     .store = into<&Shared::profile_dir>},
    {.name = "--profile",
     .value = "MODEL",
     .kind = Kind::model,
     .help = {"read as this model if no profile fits",
              "該当するプロファイルが無いサーボをこの機種として読出し"},
     .store = into<&Shared::profile>},
    {.name = "--record",
     .value = "FILE",
     .kind = Kind::file,
     .help = {"write every frame to a candump log", "全フレームを candump ログに記録"},
     .store = into<&Shared::record>},
    {.name = "--help",
     .letter = 'h',
     .kind = Kind::flag,
     .help = {"this text, and the options of a command: blactl COMMAND --help",
              "このヘルプ (コマンドのオプション: blactl COMMAND --help)"},
     .store = into<&Shared::help>},
    {.name = "--version",
     .letter = 'V',
     .kind = Kind::flag,
     .help = {"name and version", "名前とバージョン"},
     .store = into<&Shared::version>},
    {.name = "--dump-cli",
     .kind = Kind::flag,
     .hidden = true,
     .help = {"every command and option as JSON", "全コマンドとオプションを JSON で出力"},
     .store = into<&Shared::dump_cli>},
};

} // namespace

std::span<const Option> shared_options() {
  return shared;
}

} // namespace blactl::cli
