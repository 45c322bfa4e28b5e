#pragma once
// One axis on a fake drive in virtual time: cycles as the runtime runs them, and a note of every step the set-point made.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "axes/axis/axis.hpp"
#include "tests/axes/axis/fake_drive.hpp"
#include "tests/axes/axis/motion_digest.hpp"
#include "tests/axes/axis/motion_oracle.hpp"

namespace taktwerk::axes::test {

using namespace std::chrono_literals;

/// 1000 counts per u; 100 u/s, 1000 u/s2, 20000 u/s3.
inline AxisConfig plain_axis() {
    AxisConfig config;
    config.name = "x";
    config.gearing = {.counts_per_revolution = 10000, .motor_revolutions = 1, .load_revolutions = 1, .feed = 10};
    config.limits = {.velocity = 100, .acceleration = 1000, .deceleration = 1000, .jerk = 20000};
    config.require_homed = false;
    return config;
}

inline constexpr double infinity = std::numeric_limits<double>::infinity();

/// plain_axis() with ramps of constant acceleration.
inline AxisConfig trapezoids(double velocity = 1000, double ramp = 1000) {
    auto config = plain_axis();
    config.limits = {.velocity = velocity, .acceleration = ramp, .deceleration = ramp, .jerk = infinity};
    return config;
}

inline AxisConfig homing_by(HomingKind kind, Duration timeout = 10s) {
    auto config = plain_axis();
    config.homing.kind = kind;
    config.homing.search_velocity = 20;
    config.homing.latch_velocity = 1;
    config.homing.timeout = timeout;
    config.following.window = 0.5;
    return config;
}

/// A way added to whatever the axis does.
inline AxisCommand on_top(double distance, double velocity) {
    return {.kind = CommandKind::move_superimposed, .position = distance, .velocity = velocity};
}

struct Rig {
    static constexpr Duration cycle = 1ms;

    explicit Rig(const AxisConfig& config = plain_axis(), const std::function<void(FakeDrive&)>& prepare = {})
        : drive(prepared(prepare)), axis(config, drive, cycle), oracle(config, cycle, drive.caps.mode_change_delay) {}
    Rig(const Rig&) = delete;
    Rig& operator=(const Rig&) = delete;
    /// Whatever a test is about: what must always hold held.
    ~Rig() { EXPECT_TRUE(oracle.clean()) << oracle.report(); }

    static FakeDrive prepared(const std::function<void(FakeDrive&)>& prepare) {
        FakeDrive made(cycle);
        if (prepare) prepare(made);
        return made;
    }

    FakeDrive drive;
    Axis axis;
    MotionOracle oracle;
    MotionDigest digest;
    Instant now{};
    bool enable = false;
    bool permit_positive = true;
    bool jog_alive = true;
    std::vector<AlarmFact> alarms;
    double largest_step = 0;      ///< of the set position in the view, u
    double largest_velocity = 0;  ///< u/s
    double largest_acceleration = 0;
    std::function<void()> program;  ///< called in step 6 of each cycle

    [[nodiscard]] const AxisView& view() const { return axis.view(); }

    void step() {
        now += cycle;
        axis.update(now);
        axis.supervise(now);
        fetch_alarms();
        axis.power(enable, permit_positive, true, view().owner);
        if (program) program();
        const double before = view().set_position;
        const bool homed = view().homed;
        axis.plan(now, cycle);
        axis.encode(now);
        oracle.observe(view(), axis.drive_command(), axis.config().limits);
        digest.observe(view(), axis.drive_command());
        fetch_alarms();
        // Homing gives the same place another number: no step.
        if (seen_++ > 0 && homed == view().homed) largest_step = std::max(largest_step, std::abs(view().set_position - before));
        largest_velocity = std::max(largest_velocity, std::abs(view().set_velocity));
        largest_acceleration = std::max(largest_acceleration, std::abs(view().set_acceleration));
    }
    void fetch_alarms() {
        AlarmFact fact;
        while (axis.fetch_alarm(fact)) alarms.push_back(fact);
    }
    void run(int cycles) {
        for (int i = 0; i < cycles; ++i) step();
    }
    /// False when it did not come true in `most` cycles.
    bool run_until(const std::function<bool()>& condition, int most = 20000) {
        for (int i = 0; i < most; ++i) {
            if (condition()) return true;
            step();
        }
        return condition();
    }
    bool run_to(AxisState state, int most = 20000) {
        return run_until([&] { return view().state == state; }, most);
    }
    void power_on() {
        enable = true;
        ASSERT_TRUE(run_to(AxisState::Standstill, 1000));
    }
    CommandId accept(const AxisCommand& command, Owner owner = Owner::program) {
        const auto answer = axis.submit(command, owner);
        EXPECT_EQ(answer.error, ErrorId::none);
        return answer.id;
    }
    ErrorId refuse(const AxisCommand& command, Owner owner = Owner::program) {
        const auto answer = axis.submit(command, owner);
        EXPECT_EQ(answer.id, 0u);
        return answer.error;
    }
    [[nodiscard]] CommandStatus status(CommandId id) const { return view().status(id); }
    [[nodiscard]] ErrorId error_of(CommandId id) const {
        ErrorId error = ErrorId::none;
        (void)view().status(id, &error);
        return error;
    }
    [[nodiscard]] bool raised(AxisAlarm alarm) const {
        for (const auto& fact : alarms)
            if (fact.id == id(alarm)) return true;
        return false;
    }
    /// What must hold in every cycle; and what a drive would feel: never more than the velocity limit allows in a cycle (plus the rounding
    /// to counts).
    void expect_no_jump() const {
        EXPECT_TRUE(oracle.clean()) << oracle.report();
        EXPECT_LE(largest_step, axis.config().limits.velocity * to_seconds(cycle) * 1.0000001);
        EXPECT_LE(drive.largest_step, static_cast<std::int64_t>(axis.config().limits.velocity * to_seconds(cycle) * 1000) + 1);
    }

private:
    std::uint64_t seen_ = 0;
};

inline AxisCommand absolute(double position, double velocity = 100, MC_BufferMode mode = mcAborting) {
    return {.kind = CommandKind::move_absolute, .buffer_mode = mode, .position = position, .velocity = velocity};
}
inline AxisCommand relative(double distance, double velocity = 100, MC_BufferMode mode = mcAborting) {
    return {.kind = CommandKind::move_relative, .buffer_mode = mode, .position = distance, .velocity = velocity};
}
inline AxisCommand at_velocity(double velocity, MC_BufferMode mode = mcAborting) {
    return {.kind = CommandKind::move_velocity, .buffer_mode = mode, .velocity = velocity};
}
inline AxisCommand halt(MC_BufferMode mode = mcAborting) { return {.kind = CommandKind::halt, .buffer_mode = mode}; }
inline AxisCommand stop() { return {.kind = CommandKind::stop}; }
inline AxisCommand home(double position) { return {.kind = CommandKind::home, .position = position}; }
inline AxisCommand jog(double velocity) { return {.kind = CommandKind::jog, .velocity = velocity}; }

}  // namespace taktwerk::axes::test
