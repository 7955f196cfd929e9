#pragma once
// Messages of `blactl models`.

#include "blactl/base/text.hpp"

namespace blactl::texts {

inline constexpr Text column_models{"MODELS", "機種"};
inline constexpr Text models_pwm{"with PWM input", "PWM 入力対応"};
inline constexpr Text models_no_pwm{"without PWM input", "PWM 入力未対応"};
inline constexpr Text column_voltage{"VOLTAGE CLASS", "電圧クラス"};
inline constexpr Text column_numbers{"MODEL NUMBER / HARDWARE", "機種番号 / ハードウェア"};
inline constexpr Text column_access{"ACCESS", "R/W"};
inline constexpr Text column_shipped{"SHIPPED", "出荷時期"};
inline constexpr Text column_changes{"CHANGES", "変更内容"};
inline constexpr Text models_unit_by_mode{
    "unit deg in steps of 0.1, or rpm in steps of 1, as pwm_mode says",
    "単位 deg (分解能 0.1) または rpm (分解能 1)、動作モードによる"};
inline constexpr Text models_unit{"unit {}, in steps of {}", "単位 {}、分解能 {}"};
inline constexpr Text models_unit_year{"unit year", "単位 年"};
inline constexpr Text models_unit_month{"unit month", "単位 月"};
inline constexpr Text models_unit_day{"unit day", "単位 日"};
inline constexpr Text models_unit_hour{"unit hour", "単位 時"};
inline constexpr Text models_unit_minute{"unit minute", "単位 分"};
inline constexpr Text models_bit_output_off{", holds the output off", "、モータ出力 OFF"};
inline constexpr Text models_bit_latched{", stays until the next start", "、次回起動時まで保持"};
inline constexpr Text models_bit_pwm_only{", models with a PWM input only",
                                          "、PWM 入力対応機種のみ"};
inline constexpr Text models_since{"firmware {} or later", "ファームウェア {} 以降"};
inline constexpr Text models_vendor_label{"manufacturer's program: {}",
                                          "メーカー製ツールの表示: {}"};
inline constexpr Text models_section{"specification: section {}", "仕様書: {}"};
inline constexpr Text models_no_title{
    "  (titles: in a wider terminal, or one by `blactl models PARAM`)\n",
    "  (名称は表示幅を広げるか、`blactl models PARAM` で確認できます)\n"};
inline constexpr Text models_all{"all models", "全機種"};
inline constexpr Text models_same{"What they have in common:", "共通のパラメータ:"};
inline constexpr Text models_differ{"Where they differ (default, range, models):",
                                    "機種により異なるパラメータ (初期値、範囲、機種):"};
inline constexpr Text models_checks{"When it is changed, where this applies:",
                                    "変更時 (該当する場合のみ):"};
inline constexpr Text models_refusal{"refused", "拒否"};
inline constexpr Text models_question{"asked first", "確認"};
inline constexpr Text models_warning{"warning", "警告"};
inline constexpr Text models_see{"See also: {}", "関連: {}"};
inline constexpr Text models_group_of_one{"a parameter, or --group and --search: not both",
                                          "パラメータと --group、--search は同時に指定できません"};
inline constexpr Text models_group_of_one_hint{"type one of them", "どちらか一方を指定して下さい"};
inline constexpr Text models_one_parameter{"one parameter only: {} is another one",
                                           "指定できるパラメータは 1 つです: {}"};
inline constexpr Text models_one_parameter_hint{
    "several: `blactl models --search WORD`, or `--group G`",
    "複数を表示: `blactl models --search WORD`、または `--group G`"};
inline constexpr Text models_nothing_mentions{"no parameter has '{}' in its name or explanation",
                                              "名称や説明に '{}' を含むパラメータはありません"};
inline constexpr Text models_nothing_mentions_hint{
    "all of them: blactl models all; to make a servo slower, softer, stiffer, further or quieter: "
    "man blactl-tuning",
    "すべて表示: blactl models all。動作を遅く、柔らかく、硬く、広く、静かにする設定: "
    "man blactl-tuning"};
inline constexpr Text models_see_tuning{
    "\nto make a servo slower, softer, stiffer, further or quieter: man blactl-tuning\n",
    "\n動作を遅く、柔らかく、硬く、広く、静かにする設定: man blactl-tuning (英語)\n"};
inline constexpr Text models_lack{"{} has no parameter {} ({})",
                                  "{} にパラメータ {} ({}) はありません"};
inline constexpr Text models_lack_hint{"which models have it: blactl models all {}",
                                       "対応機種: blactl models all {}"};
inline constexpr Text models_read_only{"can only be read", "読出し専用"};
inline constexpr Text models_write_only{"an operation, cannot be read", "操作 (読出し不可)"};
inline constexpr Text models_saved{"stored in ROM by save", "save で ROM に保存されます"};
inline constexpr Text models_not_saved{"not stored in ROM", "ROM には保存されません"};

} // namespace blactl::texts
