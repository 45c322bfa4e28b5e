#pragma once
// SR, RS: IEC 61131-3 ed. 3, 6.6.3.5.2. Real-time safe. The dominant input is the one with the 1.

#include <array>
#include <string_view>

#include "core/cycle_context.hpp"
#include "fb_library/pins/pin.hpp"

namespace taktwerk::fb {

struct SR {
    bool S1 = false, R = false;
    bool Q1 = false;

    static constexpr std::string_view summary = "Bistable, set dominant: Q1 := S1 OR (NOT R AND Q1).";
    template <class Self>
    static consteval auto pins() {
        return std::array{
            in<&SR::S1>("", "set, dominant"),
            in<&SR::R>("", "reset"),
            out<&SR::Q1>("", "state"),
        };
    }

    constexpr void operator()(const CycleContext&) noexcept { Q1 = S1 || (!R && Q1); }
};

struct RS {
    bool S = false, R1 = false;
    bool Q1 = false;

    static constexpr std::string_view summary = "Bistable, reset dominant: Q1 := NOT R1 AND (S OR Q1).";
    template <class Self>
    static consteval auto pins() {
        return std::array{
            in<&RS::S>("", "set"),
            in<&RS::R1>("", "reset, dominant"),
            out<&RS::Q1>("", "state"),
        };
    }

    constexpr void operator()(const CycleContext&) noexcept { Q1 = !R1 && (S || Q1); }
};

}  // namespace taktwerk::fb
