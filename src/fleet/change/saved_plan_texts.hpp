#pragma once
// Messages about saved plans.

#include "blactl/base/text.hpp"

namespace blactl::texts {

inline constexpr Text plan_not_finished{
    "this plan is not complete: the document reports errors; make it again",
    "計画が完成していません (エラーを含む文書です)。作り直して下さい"};
inline constexpr Text plan_no_unique_id{
    "a plan is for servos whose unique ID is known: 32 hexadecimal digits",
    "計画にはサーボの固有 ID が必要です (16 進数 32 桁)"};
inline constexpr Text plan_servo_twice{"this servo is in the plan twice, first in line {}",
                                       "このサーボは計画に 2 回あります (最初は {} 行目)"};
inline constexpr Text plan_no_setting{"a plan holds settings only: {} is not a setting",
                                      "{} は設定ではないため、計画に含められません"};
inline constexpr Text plan_other_name{"the name of {} is {}", "{} の名前は {} です"};
inline constexpr Text plan_other_unit{"it was a {} with firmware {}",
                                      "計画時は {}、ファームウェア {} でした"};
inline constexpr Text plan_set_twice{"{} is there twice", "{} が 2 回あります"};
inline constexpr Text plan_is_stale{"node {} is not as it was when the plan was made: {}",
                                    "ノード {} が計画の作成時から変わっています: {}"};
inline constexpr Text plan_is_stale_hint{"look at it, and plan again: blactl apply FILE --dry-run "
                                         "--json",
                                         "確認して計画を作り直して下さい: blactl apply FILE "
                                         "--dry-run --json"};
inline constexpr Text plan_register{"{} was {}, is {}", "{} は {} でしたが、現在は {} です"};
inline constexpr Text plan_rom_proven{"its ROM was proven since", "その後 ROM が確認されました"};
inline constexpr Text plan_rom_not_proven{"what its ROM holds is not known any more",
                                          "ROM の内容が不明になりました"};

} // namespace blactl::texts
