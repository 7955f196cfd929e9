#pragma once
// The text catalogue of the floor `base`: messages about files.

#include "blactl/base/text.hpp"

namespace blactl::texts {

inline constexpr Text did_you_mean{"did you mean {}?", "もしかして: {}"};
inline constexpr Text file_unreadable{"cannot read {}: {}", "{} を読み込めません: {}"};
inline constexpr Text file_hint{"check the file's name and permissions",
                                "ファイル名とアクセス権を確認して下さい"};
inline constexpr Text file_unwritable{"cannot write {}: {}", "{} に書き込めません: {}"};
inline constexpr Text file_unwritable_hint{
    "the previous file is unchanged; check the folder, its permissions and free space",
    "元のファイルは変更していません。フォルダとアクセス権、空き容量を確認して下さい"};
inline constexpr Text file_held{"another blactl is about to write {}",
                                "別の blactl が {} を更新しようとしています"};
inline constexpr Text file_held_hint{"run the same command again when it has ended",
                                     "終了してから同じコマンドを実行して下さい"};
inline constexpr Text file_too_large{"{} is larger than {} MiB", "{} は {} MiB を超えています"};
inline constexpr Text json_invalid{"not valid JSON: {}", "JSON として正しくありません: {}"};
inline constexpr Text json_trailing_comma{"trailing comma: there must be none after the last item",
                                          "末尾のカンマが余分です (最後の項目の後には不要)"};
inline constexpr Text json_comma_missing{"a comma is missing before {}",
                                         "{} の前にカンマがありません"};
inline constexpr Text json_colon_missing{"a colon is missing between a key and its value",
                                         "キーと値の間にコロンがありません"};
inline constexpr Text json_double_quotes{"keys and strings need double quotes",
                                         "キーと文字列は二重引用符で囲んで下さい"};
inline constexpr Text json_comment{"JSON has no comments", "JSON にコメントは書けません"};
inline constexpr Text json_open_string{"a string does not end in its line",
                                       "文字列が行内で閉じられていません"};
inline constexpr Text json_control_character{"a control character in a string",
                                             "文字列に制御文字があります"};
inline constexpr Text json_bad_escape{"a wrong escape sequence (\\) in a string",
                                      "文字列のエスケープ (\\) が正しくありません"};
inline constexpr Text json_bad_utf8{"bytes that are not UTF-8", "UTF-8 ではないバイトがあります"};
inline constexpr Text json_ends_early{"the file ends before it is complete",
                                      "ファイルが途中で終わっています"};
inline constexpr Text json_unexpected{"{} does not belong here", "ここに {} は書けません"};
inline constexpr Text json_zero_byte{"not valid JSON: it contains a zero byte",
                                     "JSON として正しくありません: 値 0 のバイトがあります"};
inline constexpr Text json_too_deep{"nested deeper than {} levels", "入れ子が {} 段を超えています"};
inline constexpr Text json_duplicate{"this key occurs twice; it is also in line {}",
                                     "キーが重複しています ({} 行目にもあります)"};
inline constexpr Text json_integer_too_big{"{} does not fit in 64 bits",
                                           "{} は 64 bit に収まりません"};
inline constexpr Text json_wrong_kind{"must be {}, not {}",
                                      "{}でなければなりません ({}になっています)"};
inline constexpr Text json_missing{"\"{}\" is missing", "\"{}\" がありません"};
inline constexpr Text json_unknown{"this key is not known; known here: {}",
                                   "不明なキーです。ここで使えるキー: {}"};
inline constexpr Text json_unknown_among_none{"this key is not known; none is expected here",
                                              "不明なキーです。ここにキーは置けません"};
inline constexpr Text json_below{"{} is less than {}", "{} は下限 {} より小さい値です"};
inline constexpr Text json_above{"{} is more than {}", "{} は上限 {} より大きい値です"};
inline constexpr Text json_no_such_word{"\"{}\" is none of: {}",
                                        "\"{}\" は次のいずれでもありません: {}"};
inline constexpr Text json_other_word{"must be \"{1}\", not \"{0}\"",
                                      "\"{1}\" でなければなりません (\"{0}\" になっています)"};
inline constexpr Text json_more_faults{"… and {} more", "… 他に {} 件"};
inline constexpr Text json_hint{"correct the file and try again",
                                "ファイルを修正してもう一度実行して下さい"};

// Each Japanese text ends in a Japanese character, so that no space follows it in the sentence.
inline constexpr Text kind_null{"null", "null 値"};
inline constexpr Text kind_boolean{"true or false", "true または false の値"};
inline constexpr Text kind_integer{"an integer", "整数"};
inline constexpr Text kind_number{"a number", "数値"};
inline constexpr Text kind_string{"a string", "文字列"};
inline constexpr Text kind_array{"an array", "配列"};
inline constexpr Text kind_object{"an object", "オブジェクト"};

} // namespace blactl::texts
