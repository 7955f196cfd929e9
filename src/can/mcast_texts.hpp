#pragma once
// Messages of CAN over UDP multicast.

#include "blactl/base/text.hpp"

namespace blactl::texts {

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
