#pragma once
// Messages of `blactl characterize`.

#include "blactl/base/text.hpp"

namespace blactl::texts {

inline constexpr Text characterize_column_setting{"SETTING", "項目"};
inline constexpr Text characterize_column_value{"VALUE", "値"};
inline constexpr Text characterize_column_what{"MEANING", "意味"};
inline constexpr Text characterize_column_why{"WHY NOT", "理由"};
inline constexpr Text characterize_measured{"measured:\n", "測定結果:\n"};
inline constexpr Text characterize_seen{"seen beside that:\n", "その他の観測:\n"};
inline constexpr Text characterize_not_measured{"not measured:\n", "測定できなかった項目:\n"};
inline constexpr Text characterize_as_before{"the servo holds what it held before\n",
                                             "サーボの設定は測定前の状態に戻しました\n"};
inline constexpr Text characterize_written{
    "{} settings written to {}: blactl sim --facts {}\n",
    "{} 項目を {} に書き込みました: blactl sim --facts {}\n"};
inline constexpr Text characterize_putting_back{
    "putting back what was changed, 10 s at most (Ctrl-C again: at once)",
    "変更した設定を元に戻しています (最大 10 秒。もう一度 Ctrl-C で即時終了)"};
inline constexpr Text characterize_put_back_hint{"what was changed has been put back",
                                                 "変更した設定は元に戻しました"};
inline constexpr Text characterize_not_put_back_hint{"see below what was not put back",
                                                     "元に戻せなかった設定は次の通りです"};

} // namespace blactl::texts
