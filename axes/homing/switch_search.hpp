#pragma once
// MC_StepAbsoluteSwitch: a switch somewhere on the way, limit switches at the ends. Real-time safe.
//
//   search    the way asked for, until what MC_SwitchMode names. The modes by level and those of a named edge take it in either direction;
//             rising and falling edge count in the direction of the search only, so that it is always the same edge
//   leave     a search that starts on the switch goes the other way first, where its edge can be had only so
//   pass      when a limit switch comes first: back, over the whole switch, then search again. Once only
// Edges seen while the axis still turns around do not count.

#include "axes/homing/search.hpp"
#include "axes/words/types.hpp"

namespace taktwerk::axes {

class SwitchSearch {
public:
    SwitchSearch() = default;
    SwitchSearch(MC_SwitchMode mode, MC_HomeDirection direction) noexcept : mode_(mode), direction_(direction) {}

    [[nodiscard]] SearchMove step(const SearchInput& in) noexcept;

private:
    enum class Phase : std::uint8_t { start, search, leave, pass_on, pass_off };

    void begin(bool on) noexcept;
    [[nodiscard]] bool reached() const noexcept;
    [[nodiscard]] SearchMove search(const SearchInput& in, bool limit_ahead) noexcept;
    [[nodiscard]] bool one_way() const noexcept { return mode_ == MC_SwitchMode::mcRisingEdge || mode_ == MC_SwitchMode::mcFallingEdge; }
    void turn(Phase phase, int sense) noexcept {
        phase_ = phase;
        sense_ = sense;
    }

    MC_SwitchMode mode_ = MC_SwitchMode::mcRisingEdge;
    MC_HomeDirection direction_ = MC_HomeDirection::mcPositiveDirection;
    Phase phase_ = Phase::start;
    int way_ = 1, sense_ = 1;
    bool reversed_ = false;
    EdgeWatch edge_;
};

}  // namespace taktwerk::axes
