#pragma once
// Power: whether it is wanted, its steps, and the set-point that follows the motor while there is none.

#include <cstdint>

#include "axes/axis/axis_body.hpp"
#include "axes/axis/axis_motion.hpp"
#include "axes/axis/homing_runs.hpp"
#include "axes/axis/measured.hpp"
#include "axes/axis/mode_state.hpp"

namespace taktwerk::axes {

class Aim;
class Conduct;

class AxisPower {
public:
    AxisPower(AxisBody& body, const Measured& measured, AxisMotion& motion, Aim& aim, HomingRuns& runs, ModeState& modes,
              Conduct& conduct) noexcept
        : body_(body), measured_(measured), motion_(motion), aim_(aim), runs_(runs), modes_(modes), conduct_(conduct) {}

    /// True: what waits has its turn.
    [[nodiscard]] bool run() noexcept;
    void follow_actual(Duration period) noexcept;
    ErrorId request(bool enable, bool positive, bool negative) noexcept {
        if (++body_.power_calls > 1) return ErrorId::power_conflict;
        if (enable && !connected(body_.presence)) {
            if (body_.power_wish) give_up();
            return ErrorId::not_connected;
        }
        if (enable && !body_.driven) return body_.config.encoder ? ErrorId::not_supported : ErrorId::drive_not_ready;
        body_.permit_positive = positive;
        body_.permit_negative = negative;
        if (!enable && body_.power_wish) {
            give_up();
            return ErrorId::none;
        }
        body_.power_wish = enable;
        return enable && body_.emergency != EmergencyStop::none ? ErrorId::interlocked : ErrorId::none;
    }

    /// The drive is taken away with all that was powered. True: it had power, was getting it, or has just stopped for its feedback.
    bool goes_with(AlarmId reason) noexcept;
    /// A cycle begins: whoever holds MC_Power speaks once in it.
    void begin_cycle() noexcept { body_.power_calls = 0; }

private:
    void give_up() noexcept;
    [[nodiscard]] bool wanted() const noexcept;
    [[nodiscard]] bool turns_by_itself() const noexcept;

    AxisBody& body_;
    const Measured& measured_;
    AxisMotion& motion_;
    Aim& aim_;
    HomingRuns& runs_;
    ModeState& modes_;
    Conduct& conduct_;
    /// Of the axis' velocity: a motor that turns faster without power is not held by switching it on.
    static constexpr double turning_by_itself = 0.1;
    bool aligned_ = false;  // the set-point is where the motor is
};

}  // namespace taktwerk::axes
