#pragma once
// MC_StepLimitSwitch: the limit switch at one end as the reference. It cannot be passed, so its falling edge is had by coming back.
// Real-time safe.
//
//   on       towards it until it is on         off      away from it until it is off
//   rising   towards it; starting on it, away first      falling  towards it until it is on, then away: the edge is on the way back

#include "axes/homing/search.hpp"
#include "axes/words/types.hpp"

namespace taktwerk::axes {

class LimitSearch {
public:
    LimitSearch() = default;
    /// `mode`: on, off, rising or falling edge.
    LimitSearch(MC_SwitchMode mode, bool positive) noexcept : mode_(mode), positive_(positive) {}

    [[nodiscard]] SearchMove step(const SearchInput& in) noexcept;

private:
    [[nodiscard]] bool reached() const noexcept;

    MC_SwitchMode mode_ = MC_SwitchMode::mcOn;
    bool positive_ = false, begun_ = false;
    bool towards_ = true;
    EdgeWatch edge_;
};

}  // namespace taktwerk::axes
