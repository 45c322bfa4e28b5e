#pragma once
// One homing run of a simulated drive: a velocity demand with the homing acceleration, switch edges, the reference found.

#include <cstdint>
#include <optional>

#include "axes/sim/homing_method.hpp"

namespace taktwerk::axes::sim {

struct HomingSettings {
    std::int64_t method = 0;
    double fast = 0, slow = 0;  ///< counts/s (6099h:01, :02)
    double acceleration = 0;    ///< counts/s2 (609Ah)
};

struct SwitchStates {
    bool negative_limit = false, positive_limit = false, home = false;
};

class HomingRun {
public:
    enum class State : std::uint8_t { idle, moving, stopping, attained, failed };

    /// An unknown method or a zero speed fails at once.
    void start(const HomingSettings& settings, const SwitchStates& switches) noexcept;
    void abort() noexcept { state_ = State::idle; }

    /// One inner step of `dt` seconds; `position` is where the edge is taken (counts). Updates the demanded velocity.
    void step(double dt, const SwitchStates& switches, double position) noexcept;

    [[nodiscard]] State state() const noexcept { return state_; }
    [[nodiscard]] double velocity() const noexcept { return velocity_; }          ///< counts/s
    [[nodiscard]] double acceleration() const noexcept { return acceleration_; }  ///< counts/s2, of the last step
    /// Position of the final edge; valid once stopping or attained.
    [[nodiscard]] double reference() const noexcept { return reference_; }

private:
    [[nodiscard]] bool level(const SwitchStates& switches) const noexcept;
    void ramp(double target, double dt) noexcept;

    HomingSettings settings_;
    const HomingMethod* method_ = nullptr;
    bool from_active_ = false, level_ = false;
    std::uint8_t move_ = 0;
    State state_ = State::idle;
    double velocity_ = 0, acceleration_ = 0, reference_ = 0;
};

}  // namespace taktwerk::axes::sim
