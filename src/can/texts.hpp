#pragma once
// Messages of the CAN floor.

#include "blactl/base/text.hpp"

namespace blactl::texts {

// Interfaces of SocketCAN.

inline constexpr Text kernel_without_can{
    "this kernel has no CAN (SocketCAN): {} cannot be opened",
    "このカーネルには CAN 機能(SocketCAN)がないため、{} を開けません"};
inline constexpr Text kernel_without_can_hint{
    "load it with `sudo modprobe can_raw`; in a container the host has to do that, and some hosts "
    "lack it; the simulated bus works without: `-i sim:`",
    "`sudo modprobe can_raw` で読み込んで下さい。コンテナではホスト側で行う必要があり、対応して"
    "いないホストもあります。シミュレーション用のバス `-i sim:` はそのまま使えます"};
inline constexpr Text can_not_permitted{"opening {} is not permitted ({})",
                                        "{} を開く権限がありません({})"};
inline constexpr Text can_not_permitted_hint{
    "a sandbox or container policy forbids CAN sockets; allow the address family AF_CAN there",
    "サンドボックスまたはコンテナの設定で CAN ソケットが禁止されています。アドレスファミリー "
    "AF_CAN "
    "を許可して下さい"};
inline constexpr Text no_such_interface{"there is no interface {}",
                                        "インターフェース {} が見つかりません"};
inline constexpr Text not_a_can_interface{"{} is not a CAN interface",
                                          "{} は CAN インターフェースではありません"};
inline constexpr Text interface_down{"interface {} is down",
                                     "インターフェース {} は停止しています"};
inline constexpr Text interface_gone{"interface {} is gone",
                                     "インターフェース {} がなくなりました"};
inline constexpr Text interface_gone_hint{
    "check the adapter and its cable, then list the interfaces with `ip -br link show`",
    "アダプターとケーブルを確認し、`ip -br link show` でインターフェースを確認して下さい"};
inline constexpr Text bus_off_hint{
    "check wiring, termination and bit rate, then run the command again",
    "配線、終端抵抗、ビットレートを確認後、もう一度実行して下さい"};
inline constexpr Text bus_off_of_kernel_hint{
    "check wiring and bit rate, then: sudo ip link set {0} down; sudo ip link set {0} up",
    "配線とビットレートを確認後: sudo ip link set {0} down; sudo ip link set {0} up"};
inline constexpr Text interface_failed{"interface {} failed: {}",
                                       "インターフェース {} でエラーが発生しました: {}"};
inline constexpr Text bring_up_hint{"bring it up with `{}`", "`{}` で起動して下さい"};
inline constexpr Text can_interfaces_here{"CAN interfaces of this machine: {}",
                                          "このマシンの CAN インターフェース: {}"};
inline constexpr Text no_can_interface_here{
    "this machine has no CAN interface; plug the adapter in, or try the simulated bus: `-i sim:`",
    "このマシンには CAN インターフェースがありません。アダプターを接続するか、シミュレーション用の"
    "バス `-i sim:` をお使い下さい"};
inline constexpr Text link_is_up{"{} (up)", "{}(動作中)"};
inline constexpr Text link_is_down{"{} (down)", "{}(停止中)"};
inline constexpr Text links_unreadable{"the network interfaces cannot be listed: {}",
                                       "ネットワークインターフェースの一覧を取得できません: {}"};
inline constexpr Text link_setup_not_permitted{
    "setting up {} is not permitted: that takes root (CAP_NET_ADMIN)",
    "{} を設定する権限がありません。root 権限 (CAP_NET_ADMIN) が必要です"};
inline constexpr Text link_setup_not_permitted_hint{"a user with that permission can run: {}",
                                                    "権限のあるユーザーで実行: {}"};
inline constexpr Text link_setup_failed{"{} does not accept the settings: {}",
                                        "{} を設定できません: {}"};
inline constexpr Text link_setup_failed_hint{
    "try it by hand: {}; the kernel may say more: sudo dmesg | tail",
    "手動で試して下さい: {}。カーネルのログに詳細があることもあります: sudo dmesg | tail"};

// Of CAN over UDP multicast.

inline constexpr Text ip_links_here{"interfaces of this machine: {}",
                                    "このマシンのインターフェース: {}"};
inline constexpr Text mcast_no_address{"interface {} has no IPv4 address",
                                       "インターフェース {} に IPv4 アドレスがありません"};
inline constexpr Text mcast_no_address_hint{
    "give it one, for example `sudo ip addr add 192.168.144.2/24 dev {}`",
    "例えば `sudo ip addr add 192.168.144.2/24 dev {}` で割り当てて下さい"};
inline constexpr Text mcast_port_taken{"{}: another program keeps UDP port {} for itself",
                                       "{}: 別のプログラムが UDP ポート {} を占有しています"};
inline constexpr Text mcast_port_taken_hint{"see which one with `sudo ss -lunp 'sport = :{}'`",
                                            "`sudo ss -lunp 'sport = :{}'` で確認して下さい"};
inline constexpr Text mcast_not_permitted{"{}: UDP multicast is not permitted ({})",
                                          "{}: UDP マルチキャストが許可されていません({})"};
inline constexpr Text mcast_not_permitted_hint{
    "a firewall or a sandbox forbids it: allow UDP to 239.65.82.0/24, port {}",
    "ファイアウォールまたはサンドボックスで禁止されています。239.65.82.0/24、ポート {} への UDP を"
    "許可して下さい"};
inline constexpr Text mcast_failed{"{} failed: {}", "{} でエラーが発生しました: {}"};

} // namespace blactl::texts
