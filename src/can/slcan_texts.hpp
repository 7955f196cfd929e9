#pragma once
// Messages about serial ports and slcan adapters.

#include "blactl/base/text.hpp"

namespace blactl::texts {

inline constexpr Text serial_adapters_here{"serial adapters of this machine: {}",
                                           "このマシンのシリアルアダプター: {}"};
inline constexpr Text no_serial_adapter_here{
    "this machine shows no serial adapter; plug it in and look at `ls -l /dev/serial/by-id`",
    "このマシンにはシリアルアダプターが見つかりません。接続してから `ls -l /dev/serial/by-id` で"
    "確認して下さい"};
inline constexpr Text no_such_port{"there is no serial port {}",
                                   "シリアルポート {} が見つかりません"};
inline constexpr Text not_a_serial_port{"{} is not a serial port",
                                        "{} はシリアルポートではありません"};
inline constexpr Text port_of_group{
    "opening {} is not permitted: it is for the group {}",
    "{} を開く権限がありません。グループ {} のメンバーに限られます"};
inline constexpr Text port_of_group_hint{
    "`sudo usermod -aG {} {}`, then log out and in again",
    "`sudo usermod -aG {} {}` を実行し、ログインし直して下さい"};
inline constexpr Text port_forbidden{"opening {} is not permitted", "{} を開く権限がありません"};
inline constexpr Text port_forbidden_hint{
    "look at `ls -l {}`: no group may use it; a udev rule of the administrator can change that",
    "`ls -l {}` で確認して下さい。どのグループにも許可されていません。管理者が udev ルールで変更"
    "できます"};
inline constexpr Text port_busy{"{} is in use by another program",
                                "{} は別のプログラムが使用しています"};
inline constexpr Text port_busy_hint{"find it with `sudo fuser -v {}` and end it",
                                     "`sudo fuser -v {}` で調べて終了させて下さい"};
inline constexpr Text port_busy_by{"{} is in use by {} (process {})",
                                   "{} は {}(プロセス {})が使用しています"};
inline constexpr Text port_busy_by_hint{"end that program, for example with `kill {}`",
                                        "そのプログラムを終了させて下さい。例: `kill {}`"};
inline constexpr Text port_failed{"serial port {} failed: {}",
                                  "シリアルポート {} でエラーが発生しました: {}"};
inline constexpr Text port_rate_failed{"serial port {} cannot be set to {} baud: {}",
                                       "シリアルポート {} を {} ボーに設定できません: {}"};
inline constexpr Text adapter_gone{"the adapter at {} is gone",
                                   "{} のアダプターが取り外されました"};
inline constexpr Text adapter_gone_hint{
    "plug it in again, look at `ls -l /dev/serial/by-id`, and run the command once more",
    "接続し直し、`ls -l /dev/serial/by-id` で確認してから、もう一度実行して下さい"};
inline constexpr Text adapter_refuses{
    "the adapter at {} refuses 1 Mbit/s and does not open its CAN channel",
    "{} のアダプターは 1 Mbit/s の設定を拒否し、CAN チャンネルを開きません"};
inline constexpr Text adapter_refuses_hint{
    "unplug it and plug it in again; if its bit rate is fixed, try `-i \"slcan:{}?open=plain\"`",
    "一度抜いて接続し直して下さい。ビットレートが固定のアダプターなら "
    "`-i \"slcan:{}?open=plain\"` を試して下さい"};
inline constexpr Text adapter_stays_closed{
    "the adapter at {} refuses to open its CAN channel",
    "{} のアダプターは CAN チャンネルを開くことを拒否しています"};
inline constexpr Text adapter_stays_closed_hint{
    "unplug it and plug it in again; if it accepts no other command first, try "
    "`-i \"slcan:{}?open=plain\"`",
    "一度抜いて接続し直して下さい。直前に他のコマンドを受け付けないアダプターなら "
    "`-i \"slcan:{}?open=plain\"` を試して下さい"};
inline constexpr Text adapter_takes_no_frames{
    "the adapter at {} refuses to send: frames refused {}, none taken",
    "{} のアダプターは送信を拒否しています: 拒否されたフレーム {}、送信できたフレームなし"};
inline constexpr Text adapter_takes_no_frames_hint{
    "does anybody acknowledge: is a servo powered and connected, the bus terminated? is the "
    "adapter set to listen only? unplug it and plug it in again, or try "
    "`-i \"slcan:{}?open=plain\"`",
    "ACK を返す相手がいるか (サーボの電源と接続、終端抵抗)、アダプターが受信専用になっていないか"
    "確認して下さい。接続し直すか、`-i \"slcan:{}?open=plain\"` を試して下さい"};
inline constexpr Text adapter_speaks_no_slcan{
    "the data from {} at {} baud is not slcan",
    "{} から {} ボーで受信したデータは slcan ではありません"};
inline constexpr Text adapter_speaks_no_slcan_hint{
    "is it a CAN adapter? if it has another baud rate: `-i \"slcan:{}?baud=115200\"`",
    "CAN アダプターか確認して下さい。ボーレートが異なる場合: `-i \"slcan:{}?baud=115200\"`"};
inline constexpr Text port_speaks_mavlink{
    "{} speaks MAVLink: it is the telemetry port of an autopilot, not a CAN adapter",
    "{} は MAVLink を送信しています。オートパイロットのテレメトリポートで、CAN アダプターでは"
    "ありません"};
inline constexpr Text port_speaks_mavlink_hint{
    "use another port: `ls -l /dev/serial/by-id`; ArduPilot gives one to slcan by CAN_SLCAN_CPORT "
    "and CAN_SLCAN_SERNUM",
    "別のポートを指定して下さい: `ls -l /dev/serial/by-id`。ArduPilot では CAN_SLCAN_CPORT と "
    "CAN_SLCAN_SERNUM で slcan 用のポートを設定できます"};
inline constexpr Text port_speaks_text{"{} sends text that is not slcan",
                                       "{} は slcan ではないテキストを送信しています"};
inline constexpr Text adapter_is_mute{"no data came from the adapter at {}",
                                      "{} のアダプターから 1 バイトも受信していません"};
inline constexpr Text adapter_is_mute_hint{
    "is the supply on, and the bit rate of the bus 1000000? if it is, the adapter may want another "
    "opening or baud rate: `-i \"slcan:{0}?open=plain\"`, `-i \"slcan:{0}?baud=115200\"`",
    "サーボの電源とバスのビットレート 1000000 を確認して下さい。問題なければ、アダプターの開き方か"
    "ボーレートが異なる可能性があります: `-i \"slcan:{0}?open=plain\"`、"
    "`-i \"slcan:{0}?baud=115200\"`"};
inline constexpr Text adapter_rate_fixed{
    "the adapter at {} refused the command for 1 Mbit/s; its bit rate is presumably fixed",
    "{} のアダプターは 1 Mbit/s の設定を拒否しました。ビットレートが固定されているとみなします"};

} // namespace blactl::texts
