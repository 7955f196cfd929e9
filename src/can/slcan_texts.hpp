#pragma once
// What serial ports and slcan adapters give to say to people.

#include "blactl/base/text.hpp"

namespace blactl::texts {

inline constexpr Text serial_adapters_here{"serial adapters of this machine: {}",
                                           "このマシンのシリアルアダプター: {}"};
inline constexpr Text no_serial_adapter_here{
    "this machine shows no serial adapter; plug it in and look at `ls -l /dev/serial/by-id`",
    "このマシンにはシリアルアダプターが見つかりません。接続してから `ls -l /dev/serial/by-id` で"
    "確認してください"};
inline constexpr Text no_such_port{"there is no serial port {}",
                                   "シリアルポート {} が見つかりません"};
inline constexpr Text not_a_serial_port{"{} is not a serial port",
                                        "{} はシリアルポートではありません"};
inline constexpr Text port_of_group{
    "opening {} is not permitted: it is for the group {}",
    "{} を開く権限がありません。グループ {} のメンバーに限られます"};
inline constexpr Text port_of_group_hint{
    "`sudo usermod -aG {} {}`, then log out and in again",
    "`sudo usermod -aG {} {}` を実行し、ログインし直してください"};
inline constexpr Text port_forbidden{"opening {} is not permitted", "{} を開く権限がありません"};
inline constexpr Text port_forbidden_hint{
    "look at `ls -l {}`: no group may use it; a udev rule of the administrator can change that",
    "`ls -l {}` で確認してください。どのグループにも許可されていません。管理者が udev ルールで変更"
    "できます"};
inline constexpr Text port_busy{"{} is in use by another program",
                                "{} は別のプログラムが使用しています"};
inline constexpr Text port_busy_hint{"find it with `sudo fuser -v {}` and end it",
                                     "`sudo fuser -v {}` で調べて終了させてください"};
inline constexpr Text port_busy_by{"{} is in use by {} (process {})",
                                   "{} は {}(プロセス {})が使用しています"};
inline constexpr Text port_busy_by_hint{"end that program, for example with `kill {}`",
                                        "そのプログラムを終了させてください。例: `kill {}`"};
inline constexpr Text port_failed{"serial port {} failed: {}",
                                  "シリアルポート {} でエラーが発生しました: {}"};
inline constexpr Text port_rate_failed{"serial port {} cannot be set to {} baud: {}",
                                       "シリアルポート {} を {} ボーに設定できません: {}"};
inline constexpr Text adapter_gone{"the adapter at {} is gone",
                                   "{} のアダプターが取り外されました"};
inline constexpr Text adapter_gone_hint{
    "plug it in again, look at `ls -l /dev/serial/by-id`, and run the command once more",
    "接続し直し、`ls -l /dev/serial/by-id` で確認してから、もう一度実行してください"};
inline constexpr Text adapter_refuses{
    "the adapter at {} refuses 1 Mbit/s and does not open its CAN channel",
    "{} のアダプターは 1 Mbit/s の設定を拒否し、CAN チャンネルを開きません"};
inline constexpr Text adapter_refuses_hint{
    "unplug it and plug it in again; if its bit rate is fixed, try `-i \"slcan:{}?open=plain\"`",
    "一度抜いて接続し直してください。ビットレートが固定のアダプターなら "
    "`-i \"slcan:{}?open=plain\"` を試してください"};
inline constexpr Text adapter_rate_fixed{
    "the adapter at {} refused the command for 1 Mbit/s; its bit rate is taken to be fixed",
    "{} のアダプターは 1 Mbit/s の設定を拒否しました。ビットレートが固定されているとみなします"};

} // namespace blactl::texts
