#pragma once
// A portal on two drives: one axis above, two fake drives below.

#include "axes/drives/gantry/gantry_port.hpp"
#include "tests/axes/axis/axis_rig.hpp"

namespace taktwerk::axes::test {

inline AxisConfig portal(double warning = 0.2, double error = 0.5) {
    auto config = plain_axis();
    config.limits.jerk = infinity;
    config.gantry = {.on = true, .warning = warning, .error = error};
    choose_for_gantry(config.reactions);
    return config;
}

struct Portal {
    static constexpr Duration cycle = 1ms;

    explicit Portal(bool mirrored = false, const AxisConfig& config = portal())
        : Portal(std::make_unique<FakeDrive>(cycle), std::make_unique<FakeDrive>(cycle), mirrored, config) {}
    Portal(std::unique_ptr<FakeDrive> one, std::unique_ptr<FakeDrive> other, bool mirrored, const AxisConfig& config)
        : left(one.get()), right(other.get()), port(std::move(one), std::move(other), mirrored), axis(config, port, cycle) {
        right->position = 5000;  // its encoder counts from somewhere else
    }
    void step() {
        now += cycle;
        axis.update(now);
        axis.supervise(now);
        AlarmFact fact;
        while (axis.fetch_alarm(fact)) alarms.push_back(fact.id);
        axis.power(enable, true, true, Owner::program);
        axis.plan(now, cycle);
        axis.encode(now);
    }
    void run(int cycles) {
        for (int i = 0; i < cycles; ++i) step();
    }
    bool run_until(const std::function<bool()>& condition, int most = 20000) {
        for (int i = 0; i < most && !condition(); ++i) step();
        return condition();
    }
    void power_on() {
        enable = true;
        ASSERT_TRUE(run_until([&] { return view().state == AxisState::Standstill; }, 1000));
    }
    void move_at(double velocity) { EXPECT_EQ(axis.submit(at_velocity(velocity), Owner::program).error, ErrorId::none); }
    [[nodiscard]] const AxisView& view() const { return axis.view(); }
    [[nodiscard]] bool raised(AxisAlarm alarm) const { return std::find(alarms.begin(), alarms.end(), id(alarm)) != alarms.end(); }
    /// Both stop along the same ramp, and power goes when they stand.
    void expect_ramp_then_off() {
        bool off_in_motion = false;
        ASSERT_TRUE(run_until([&] {
            const bool moves = view().set_velocity != 0;
            for (const auto* side : {left, right})  // of those that have it
                off_in_motion = off_in_motion || (moves && side->power == PowerState::enabled && side->last.power != PowerRequest::on);
            return left->power != PowerState::enabled && right->power != PowerState::enabled;
        }));
        EXPECT_FALSE(off_in_motion);
        EXPECT_EQ(view().state, AxisState::ErrorStop);
    }

    FakeDrive *left, *right;
    gantry::GantryPort port;
    Axis axis;
    Instant now{};
    bool enable = false;
    std::vector<AlarmId> alarms;
};

}  // namespace taktwerk::axes::test
