#pragma once
// Blocks on a real axis over a fake drive, in virtual time: scans as a base task runs them. One u is 1000 counts.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <span>

#include "axes/axis/direct_requests.hpp"
#include "fb_library/motion/power.hpp"
#include "tests/axes/axis/fake_drive.hpp"
#include "tests/axes/axis/motion_oracle.hpp"

namespace taktwerk::fb {

using namespace std::chrono_literals;

/// A ramp or move of `expected` took `measured`: one scan to start, one to see the end, and the rounding to whole scans.
inline void expect_time(Duration measured, Duration expected) {
    EXPECT_GE(measured, expected - 1ms);
    EXPECT_LE(measured, expected + 3ms);
}

class Plc {
public:
    static constexpr Duration period = 1ms;

    static axes::AxisConfig roomy_axis() {
        axes::AxisConfig config;
        config.name = "x";
        config.gearing = {.counts_per_revolution = 1000, .motor_revolutions = 1, .load_revolutions = 1, .feed = 1};
        config.limits = {.velocity = 10000, .acceleration = 10000, .deceleration = 10000, .jerk = std::numeric_limits<double>::infinity()};
        config.require_homed = false;
        return config;
    }

    explicit Plc(const axes::AxisConfig& config = roomy_axis())
        : drive(period), axis(config, drive, period), oracle(config, period), requests_({&axis, 1}) {
        power.Axis = x;
        power.Enable = true;
        run_until([this] { return power.Status; }, 1s);
    }
    Plc(const Plc&) = delete;
    Plc& operator=(const Plc&) = delete;
    /// Whatever a test is about: what must always hold held.
    ~Plc() { EXPECT_TRUE(oracle.clean()) << oracle.report(); }

    /// One cycle; the program sees the views of its beginning, as copies.
    void scan() {
        now_ += period;
        axis.update(now_);
        axis.supervise(now_);
        const axes::AxisView seen = axis.view();
        MotionContext ctx;
        ctx.now = now_;
        ctx.period = period;
        ctx.cycle = ++cycle_;
        ctx.axes = {&seen, 1};
        ctx.requests = &requests_;
        if (calls_blocks) {
            power(ctx);
            if (program) program(ctx);
        }
        axis.plan(now_, period);
        axis.encode(now_);
        oracle.observe(axis.view(), axis.drive_command(), axis.config().limits);
    }
    /// The time it took; `most` + 1 period when it did not come true.
    Duration run_until(const std::function<bool()>& condition, Duration most) {
        Duration t{};
        for (; t <= most && !condition(); t += period) scan();
        return t;
    }
    void run_for(Duration time) {
        for (Duration t{}; t < time; t += period) scan();
    }
    double position() const { return axis.view().set_position; }
    double velocity() const { return axis.view().set_velocity; }
    axes::AxisState state() const { return axis.view().state; }

    static constexpr AxisRef x{0};
    axes::test::FakeDrive drive;
    axes::Axis axis;
    axes::test::MotionOracle oracle;
    MC_Power power{};
    std::function<void(const MotionContext&)> program;
    bool calls_blocks = true;

private:
    axes::DirectRequests requests_;
    Instant now_{};
    std::uint64_t cycle_ = 0;
};

}  // namespace taktwerk::fb
