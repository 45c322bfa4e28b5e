#pragma once
// The drive's own terminals for switches: which switch hangs on which, their polarity, and the time that a signal must last to be seen. The
// simulated switches are contacts that close where the plant says. Sources: SE-808X 2.3 (an active signal must last longer than 1 ms; input 1
// home, 2 reverse limit, 3 forward limit), 4.4 (2000h:1A).

#include <array>

#include "axes/port/drive_setting.hpp"
#include "axes/sim/homing_run.hpp"
#include "core/time.hpp"

namespace taktwerk::axes::sim {

class SwitchInputs {
public:
    static constexpr std::size_t most = 8;

    /// Without it the contacts themselves are seen. `polarity`: bit 0 is input 1; 1 takes an open contact for active.
    void wire(const InputObjects& inputs, std::int64_t polarity) noexcept {
        count_ = std::min(inputs.terminals.size(), most);
        filter_ = inputs.filter;
        for (std::size_t i = 0; i < count_; ++i) terminals_[i] = {inputs.terminals[i], (polarity >> i & 1) != 0};
    }
    /// The contacts `dt` later. A contact that opens is seen at once: the manual bounds the active signal only.
    void step(const SwitchStates& contacts, Duration dt) noexcept {
        states_ = contacts;
        for (std::size_t i = 0; i < count_; ++i) {
            auto& terminal = terminals_[i];
            bool& state = of(states_, terminal.use);
            terminal.closed = state ? terminal.closed + dt : Duration{};
            state = (terminal.closed > filter_) != terminal.inverted;
        }
    }
    [[nodiscard]] const SwitchStates& states() const noexcept { return states_; }

private:
    struct Terminal {
        InputUse use = InputUse::home;
        bool inverted = false;
        Duration closed{};
    };
    [[nodiscard]] static bool& of(SwitchStates& states, InputUse use) noexcept {
        switch (use) {
            case InputUse::negative_limit: return states.negative_limit;
            case InputUse::positive_limit: return states.positive_limit;
            case InputUse::home: break;
        }
        return states.home;
    }

    std::array<Terminal, most> terminals_{};
    std::size_t count_ = 0;
    Duration filter_{};
    SwitchStates states_;
};

}  // namespace taktwerk::axes::sim
