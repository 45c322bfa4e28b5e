#pragma once
// What an alarm table must hold, checked while compiling: each floor puts `static_assert(alarm_table_is_sound(table, first, last))`
// next to its table.

#include "core/alarm.hpp"

namespace taktwerk {

/// "following_error": lower-case letters, digits and single underscores, a letter first, no underscore last.
[[nodiscard]] constexpr bool is_snake_case(std::string_view name) noexcept {
    if (name.empty() || name.front() < 'a' || name.front() > 'z' || name.back() == '_') return false;
    for (std::size_t i = 0; i < name.size(); ++i) {
        const char c = name[i];
        const bool letter_or_digit = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
        if (!letter_or_digit && !(c == '_' && name[i - 1] != '_')) return false;
    }
    return true;
}

enum class AlarmTableFlaw {
    none,
    id_out_of_range,
    duplicate_id,
    duplicate_name,
    name_not_snake_case,
    text_missing,  ///< english, chinese, cause or remedy
};

struct AlarmTableProblem {
    AlarmTableFlaw flaw = AlarmTableFlaw::none;
    std::size_t entry = 0;  ///< 0-based, the later one of a pair
};

/// The first flaw of a table, for a readable message; `first..last` is the floor's range of ids (core/alarm.hpp), id 0 is never one.
[[nodiscard]] constexpr AlarmTableProblem alarm_table_problem(std::span<const AlarmInfo> table, AlarmId first = 1,
                                                              AlarmId last = 0xFFFF) noexcept {
    for (std::size_t i = 0; i < table.size(); ++i) {
        const AlarmInfo& info = table[i];
        if (info.id == 0 || info.id < first || info.id > last) return {AlarmTableFlaw::id_out_of_range, i};
        if (!is_snake_case(info.name)) return {AlarmTableFlaw::name_not_snake_case, i};
        if (info.english.empty() || info.chinese.empty() || info.cause.empty() || info.remedy.empty())
            return {AlarmTableFlaw::text_missing, i};
        for (std::size_t j = 0; j < i; ++j) {
            if (table[j].id == info.id) return {AlarmTableFlaw::duplicate_id, i};
            if (table[j].name == info.name) return {AlarmTableFlaw::duplicate_name, i};
        }
    }
    return {};
}

[[nodiscard]] constexpr bool alarm_table_is_sound(std::span<const AlarmInfo> table, AlarmId first = 1, AlarmId last = 0xFFFF) noexcept {
    return alarm_table_problem(table, first, last).flaw == AlarmTableFlaw::none;
}

}  // namespace taktwerk
