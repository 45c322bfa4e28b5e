#pragma once
// One answer line of a machine's socket, not taken apart: what a page asked for goes to it as it came, up to 4 MiB, and reading that as JSON would hold up
// everybody else's stop. Not real-time.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/result.hpp"

namespace taktwerk::hmi::web {

struct MachineAnswer {
    static constexpr std::size_t longest = 4 * 1024 * 1024 + 4096;  ///< bytes of a line; the machine drops who leaves more unread
    static constexpr int deepest = 64;                              ///< levels; what is plain is not looked into

    bool ok = false;
    std::string keys;  ///< the object's members but `id`, as text: "ok":true,"state":{...}

    /// The value of the one key behind "ok":true, as text; empty where the answer is another.
    [[nodiscard]] std::string_view value_of(std::string_view key) const;
};

struct NumberedAnswer {
    std::optional<std::int64_t> id;  ///< nothing: said to nobody's request, or null
    MachineAnswer answer;
};

/// Nothing: no answer of a machine.
[[nodiscard]] std::optional<NumberedAnswer> read_machine_answer(std::string_view line);
[[nodiscard]] MachineAnswer failed_answer(const Error& error);

/// `cycle` of a state's text, -1 where there is none.
[[nodiscard]] std::int64_t cycle_of(std::string_view state);

}  // namespace taktwerk::hmi::web
