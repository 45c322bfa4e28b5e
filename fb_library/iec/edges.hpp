#pragma once
// R_TRIG, F_TRIG: IEC 61131-3 ed. 3, 6.6.3.5.3. Real-time safe.
//
// First call of a new instance, by the equations with M initially FALSE: R_TRIG with CLK TRUE gives a pulse, F_TRIG with CLK
// FALSE gives a pulse. A retained instance (warm start) compares with the CLK of its last call and gives neither.

#include <array>
#include <string_view>

#include "core/cycle_context.hpp"
#include "fb_library/pins/pin.hpp"

namespace taktwerk::fb {

struct R_TRIG {
    bool CLK = false;
    bool Q = false;
    bool M = false;  ///< CLK of the last call; not a pin

    static constexpr std::string_view summary = "Rising edge: Q is TRUE for one call when CLK has become TRUE.";
    template <class Self>
    static consteval auto pins() {
        return std::array{
            in<&R_TRIG::CLK>("", "signal"),
            out<&R_TRIG::Q>("", "edge, for one call"),
        };
    }

    constexpr void operator()(const CycleContext&) noexcept {
        Q = CLK && !M;
        M = CLK;
    }
};

struct F_TRIG {
    bool CLK = false;
    bool Q = false;
    bool M = false;  ///< NOT CLK of the last call; not a pin

    static constexpr std::string_view summary = "Falling edge: Q is TRUE for one call when CLK has become FALSE.";
    template <class Self>
    static consteval auto pins() {
        return std::array{
            in<&F_TRIG::CLK>("", "signal"),
            out<&F_TRIG::Q>("", "edge, for one call"),
        };
    }

    constexpr void operator()(const CycleContext&) noexcept {
        Q = !CLK && !M;
        M = !CLK;
    }
};

}  // namespace taktwerk::fb
