#pragma once
// One homing run of a simulated drive: a velocity demand with the homing acceleration, until the reference is found. Sources as in
// homing_method.hpp. What no manual says, and what is done here:
//  * a limit switch met on the way that the method neither looks for nor turns at fails the run: going on would be worse;
//  * the speeds of the moves that methods 19 to 22 make at once are the slow one (SV33-E states it, SE-808X not);
//  * a speed or acceleration of zero fails the run at once; method 35 needs none;
//  * a block is there at 95 % of the torque limit and at standstill for 50 ms.

#include <cstdint>

#include "axes/sim/homing_method.hpp"
#include "axes/sim/index_pulse.hpp"

namespace taktwerk::axes::sim {

struct HomingSettings {
    std::int64_t method = 0;
    double fast = 0, slow = 0;  ///< counts/s (6099h:01, :02)
    double acceleration = 0;    ///< counts/s2 (609Ah)
    double time_limit = 0;      ///< s; 0 = none
};

struct SwitchStates {
    bool negative_limit = false, positive_limit = false, home = false;
};

/// What the drive sees of motor and switches at one inner step.
struct HomingView {
    SwitchStates switches;
    double position = 0;  ///< counts
    double torque = 0;    ///< of the torque limit, without sign
    bool stands = false;
    IndexPulses pulses;
};

class HomingRun {
public:
    enum class State : std::uint8_t {
        idle,
        moving,
        stopping,  ///< the reference is found
        attained,
        breaking_off,  ///< taken back, or failed: it comes to rest
        failed,
    };
    enum class Failure : std::uint8_t { none, method, speed, limit, time };

    /// From the speed that the run before may still have. The settings are those of the whole run.
    void start(const HomingSettings& settings, const HomingMethod& method, const HomingView& view) noexcept;
    /// Comes to rest with the homing acceleration; a run that is over is forgotten.
    void abort() noexcept;
    /// Forgets it at once: the motor has no power, or another mode.
    void cancel() noexcept;
    /// One inner step of `dt` seconds.
    void step(double dt, const HomingView& view) noexcept;

    [[nodiscard]] State state() const noexcept { return state_; }
    [[nodiscard]] bool busy() const noexcept { return state_ == State::moving || state_ == State::stopping; }
    [[nodiscard]] Failure failure() const noexcept { return failure_; }
    [[nodiscard]] double velocity() const noexcept { return velocity_; }  ///< counts/s
    /// Position of the final edge or pulse; valid once stopping or attained.
    [[nodiscard]] double reference() const noexcept { return reference_; }
    /// It runs against a block: the demanded position must not run ahead of the motor.
    [[nodiscard]] bool presses() const noexcept { return state_ == State::moving && move_.until == Until::block; }

private:
    [[nodiscard]] bool level(const SwitchStates& switches) const noexcept;
    [[nodiscard]] bool at_limit(Switch limit, const SwitchStates& switches) const noexcept;
    [[nodiscard]] bool over(double dt, const HomingView& view) noexcept;
    void next() noexcept;
    void ramp(double target, double dt) noexcept;
    void fail(Failure failure) noexcept;

    HomingSettings settings_;
    HomingMethod method_;
    HomingMove move_;
    std::uint8_t next_ = 0;  ///< of method_.moves
    bool turned_ = false, level_ = false;
    double before_ = 0, elapsed_ = 0, pressed_ = 0;
    State state_ = State::idle;
    Failure failure_ = Failure::none;
    double velocity_ = 0, reference_ = 0;
};

}  // namespace taktwerk::axes::sim
