#pragma once
// Inputs of a simulated XP200: contacts at DI1 to DI6 through the common filter, their functions, and what the words Pr120 to Pr124 force
// on besides (manual 5.2, 5.4.2). Forcing only ever adds.

#include <array>
#include <cstdint>
#include <cstdlib>

#include "axes/sim/xp200/parameters.hpp"
#include "core/time.hpp"

namespace taktwerk::axes::sim::xp200 {

using axes::xp200::Input;

class Inputs {
public:
    /// Wired contact of DI1 (0) to DI6 (5): true = conducting.
    void contact(int input, bool conducting) noexcept { raw_[static_cast<std::size_t>(input)] = conducting; }

    void step(const Parameters& parameters, Instant now) noexcept {
        const Duration filter = std::chrono::milliseconds{parameters[axes::xp200::pr::input_filter]};
        for (std::size_t i = 0; i < raw_.size(); ++i) {
            if (raw_[i] == filtered_[i]) since_[i] = now;
            else if (now - since_[i] >= filter) filtered_[i] = raw_[i];
        }
        on_ = {};
        for (std::size_t i = 0; i < filtered_.size(); ++i) {
            const auto function = parameters[static_cast<std::uint16_t>(axes::xp200::pr::input_function + i)];
            const auto number = static_cast<std::size_t>(std::abs(function));
            if (number > 0 && number < on_.size() && filtered_[i] == (function > 0)) on_[number] = true;
        }
        for (std::size_t word = 0; word < forced.size(); ++word) {
            auto digits = parameters[static_cast<std::uint16_t>(axes::xp200::pr::force_1 + word)];
            for (std::size_t digit = 0; digit < 5; ++digit, digits /= 10) {
                const auto function = static_cast<std::size_t>(forced[word][digit]);
                if (digits % 10 != 0 && function != 0) on_[function] = true;
            }
        }
    }

    [[nodiscard]] bool operator[](Input function) const noexcept { return on_[static_cast<std::size_t>(function)]; }
    [[nodiscard]] bool conducting(int input) const noexcept { return filtered_[static_cast<std::size_t>(input)]; }

private:
    /// Dec1 to Dec5 of Pr120 to Pr124; `none` where the manual names nothing that the model has.
    static constexpr std::array<std::array<Input, 5>, 5> forced{{
        {Input::none, Input::servo_on, Input::alarm_clear, Input::ccw_allowed, Input::cw_allowed},
        {Input::ccw_torque_limit, Input::cw_torque_limit, Input::zero_clamp, Input::zero_command, Input::invert},
        {Input::speed_1, Input::speed_2, Input::speed_3, Input::torque_1, Input::torque_2},
        {Input::emergency, Input::mode, Input::gain, Input::gear_1, Input::gear_2},
        {Input::clear_deviation, Input::inhibit_pulses, Input::none, Input::none, Input::none},
    }};
    std::array<bool, axes::xp200::input_count> raw_{}, filtered_{};
    std::array<Instant, axes::xp200::input_count> since_{};
    std::array<bool, axes::xp200::input_functions> on_{};
};

}  // namespace taktwerk::axes::sim::xp200
