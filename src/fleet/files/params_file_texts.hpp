#pragma once
// Messages about parameter files.

#include "blactl/base/text.hpp"

namespace blactl::texts {

inline constexpr Text params_no_pair{
    "a line must hold the address of a register and its number, such as: 0x38 900",
    "1 行にレジスタのアドレスと値を 1 つずつ記述して下さい (例: 0x38 900)"};
inline constexpr Text params_decimal_name{
    "is it 0x{0}, or the decimal number {0}? addresses are hexadecimal here, such as 0x38",
    "0x{0} と 10 進数の {0} のどちらか判別できません。アドレスは 16 進数で記述して下さい "
    "(例: 0x38)"};
inline constexpr Text params_own_name{
    "write the address {0}: the values of a parameter file are register numbers, whose unit a name "
    "leaves open",
    "アドレス {0} を記述して下さい。パラメータファイルの値はレジスタ値のため、名前では単位が"
    "判別できません"};
inline constexpr Text params_unknown_name{
    "no register of a BLA servo: they go by their address here, such as 0x38",
    "BLA サーボのレジスタではありません。アドレスを記述して下さい (例: 0x38)"};
inline constexpr Text params_not_whole{
    "'{}' is not a register number: those are integers without a unit",
    "'{}' はレジスタ値ではありません (レジスタ値は単位の無い整数です)"};
inline constexpr Text params_twice{"this register is also in line {}",
                                   "このレジスタは {} 行目にもあります"};
inline constexpr Text params_empty{"no setting of a BLA servo is in this file",
                                   "BLA サーボの設定がありません"};
inline constexpr Text params_several{
    "{} does not say which servo it is for, and there are several: nodes {}",
    "{} には対象のサーボの記述が無く、サーボが複数あります: ノード {}"};
inline constexpr Text params_several_hint{"name one of them: -n {}", "1 台を指定して下さい: -n {}"};

} // namespace blactl::texts
