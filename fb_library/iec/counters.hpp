#pragma once
// CTU, CTD, CTUD and their typed variants (_DINT _LINT _UDINT _ULINT): IEC 61131-3 ed. 3, 6.6.3.5.4. Real-time safe.
//
// All count rising edges, to the limits of their type (not of PV: an overshoot stays visible, a CTUD may go below 0). Edges are
// sampled in every call, so one that comes while R or LD is TRUE is lost, not counted later. Priority in one call: R, then LD,
// then counting; CTUD with both edges in one call counts nothing.

#include <array>
#include <cstdint>
#include <limits>
#include <string_view>

#include "core/cycle_context.hpp"
#include "fb_library/pins/pin.hpp"

namespace taktwerk::fb {

namespace detail {

/// "CTU", "CTU_DINT", ...: names of the variants for INT, DINT, LINT, UDINT, ULINT.
template <class T>
consteval std::string_view variant(const std::array<std::string_view, 5>& names) {
    switch (PinTypeOf<T>::value.kind) {
        case PinKind::INT: return names[0];
        case PinKind::DINT: return names[1];
        case PinKind::LINT: return names[2];
        case PinKind::UDINT: return names[3];
        case PinKind::ULINT: return names[4];
        default: throw "the standard has no such counter";
    }
}

/// Rising edge against the call before.
constexpr bool rising(bool level, bool& before) noexcept {
    const bool edge = level && !before;
    before = level;
    return edge;
}

}  // namespace detail

template <class T>
struct CountUp {
    bool CU = false, R = false;
    T PV = 0;
    bool Q = false;
    T CV = 0;
    bool cu_before = false;  ///< not a pin

    static constexpr std::string_view block_name = detail::variant<T>({"CTU", "CTU_DINT", "CTU_LINT", "CTU_UDINT", "CTU_ULINT"});
    static constexpr std::string_view summary = "Counts rising edges up; Q when CV has reached PV.";
    template <class Self>
    static consteval auto pins() {
        return std::array{
            in<&CountUp::CU>("", "count, rising edge"),
            in<&CountUp::R>("", "CV := 0, dominant"),
            in<&CountUp::PV>("", "preset"),
            out<&CountUp::Q>("", "CV >= PV"),
            out<&CountUp::CV>("", "count; stops at the type's largest value"),
        };
    }

    constexpr void operator()(const CycleContext&) noexcept {
        const bool up = detail::rising(CU, cu_before);
        if (R) CV = 0;
        else if (up && CV < std::numeric_limits<T>::max()) ++CV;
        Q = CV >= PV;
    }
};

template <class T>
struct CountDown {
    bool CD = false, LD = false;
    T PV = 0;
    bool Q = false;
    T CV = 0;
    bool cd_before = false;  ///< not a pin

    static constexpr std::string_view block_name = detail::variant<T>({"CTD", "CTD_DINT", "CTD_LINT", "CTD_UDINT", "CTD_ULINT"});
    static constexpr std::string_view summary = "Counts rising edges down from PV; Q when CV has reached 0.";
    template <class Self>
    static consteval auto pins() {
        return std::array{
            in<&CountDown::CD>("", "count, rising edge"),
            in<&CountDown::LD>("", "CV := PV, dominant"),
            in<&CountDown::PV>("", "preset"),
            out<&CountDown::Q>("", "CV <= 0"),
            out<&CountDown::CV>("", "count; stops at the type's smallest value"),
        };
    }

    constexpr void operator()(const CycleContext&) noexcept {
        const bool down = detail::rising(CD, cd_before);
        if (LD) CV = PV;
        else if (down && CV > std::numeric_limits<T>::min()) --CV;
        Q = CV <= 0;
    }
};

template <class T>
struct CountUpDown {
    bool CU = false, CD = false, R = false, LD = false;
    T PV = 0;
    bool QU = false, QD = false;
    T CV = 0;
    bool cu_before = false, cd_before = false;  ///< not pins

    static constexpr std::string_view block_name = detail::variant<T>({"CTUD", "CTUD_DINT", "CTUD_LINT", "CTUD_UDINT", "CTUD_ULINT"});
    static constexpr std::string_view summary = "Counts up and down; QU when CV has reached PV, QD when it has reached 0.";
    template <class Self>
    static consteval auto pins() {
        return std::array{
            in<&CountUpDown::CU>("", "count up, rising edge"),
            in<&CountUpDown::CD>("", "count down, rising edge"),
            in<&CountUpDown::R>("", "CV := 0, dominant over LD"),
            in<&CountUpDown::LD>("", "CV := PV"),
            in<&CountUpDown::PV>("", "preset"),
            out<&CountUpDown::QU>("", "CV >= PV"),
            out<&CountUpDown::QD>("", "CV <= 0"),
            out<&CountUpDown::CV>("", "count; stops at the type's limits"),
        };
    }

    constexpr void operator()(const CycleContext&) noexcept {
        const bool up = detail::rising(CU, cu_before), down = detail::rising(CD, cd_before);
        if (R) CV = 0;
        else if (LD) CV = PV;
        else if (up && !down && CV < std::numeric_limits<T>::max()) ++CV;
        else if (down && !up && CV > std::numeric_limits<T>::min()) --CV;
        QU = CV >= PV;
        QD = CV <= 0;
    }
};

using CTU = CountUp<std::int16_t>;
using CTU_DINT = CountUp<std::int32_t>;
using CTU_LINT = CountUp<std::int64_t>;
using CTU_UDINT = CountUp<std::uint32_t>;
using CTU_ULINT = CountUp<std::uint64_t>;
using CTD = CountDown<std::int16_t>;
using CTD_DINT = CountDown<std::int32_t>;
using CTD_LINT = CountDown<std::int64_t>;
using CTD_UDINT = CountDown<std::uint32_t>;
using CTD_ULINT = CountDown<std::uint64_t>;
using CTUD = CountUpDown<std::int16_t>;
using CTUD_DINT = CountUpDown<std::int32_t>;
using CTUD_LINT = CountUpDown<std::int64_t>;
using CTUD_UDINT = CountUpDown<std::uint32_t>;
using CTUD_ULINT = CountUpDown<std::uint64_t>;

}  // namespace taktwerk::fb
