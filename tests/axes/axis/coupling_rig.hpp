#pragma once
// Several axes on fake drives in virtual time, planned in the order of their couplings, and a note of every step that each made.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "axes/axis/axis_core.hpp"
#include "axes/axis/plan_order.hpp"
#include "axes/planner/motion.hpp"
#include "tests/axes/axis/axis_rig.hpp"

namespace taktwerk::axes::test {

/// 1000 counts per u, feed 10; 100 u/s, 1000 u/s2, no jerk limit: hand calculations stay short.
inline AxisConfig plain_slave() {
    auto config = plain_axis();
    config.limits.jerk = std::numeric_limits<double>::infinity();
    return config;
}

struct CouplingRig {
    static constexpr Duration cycle = 1ms;

    explicit CouplingRig(std::vector<AxisConfig> configs) {
        for (std::size_t i = 0; i < configs.size(); ++i) drives.push_back(std::make_unique<FakeDrive>(cycle));
        axes.reserve(configs.size());
        for (std::size_t i = 0; i < configs.size(); ++i) {
            axes.emplace_back(configs[i], *drives[i], cycle, static_cast<std::uint16_t>(i));
            configs[i].name = "axis " + std::to_string(i);
            oracles.emplace_back(configs[i], cycle);
        }
        traces.resize(configs.size());
        enabled.assign(configs.size(), true);
        permits.assign(configs.size(), 3);
    }
    CouplingRig(const CouplingRig&) = delete;
    CouplingRig& operator=(const CouplingRig&) = delete;
    /// Whatever a test is about: what must always hold held.
    ~CouplingRig() { expect_clean(); }
    explicit CouplingRig(std::size_t count) : CouplingRig(std::vector<AxisConfig>(count, plain_slave())) {}

    /// Declares the tables before; then all axes to Standstill.
    void start() {
        for (auto& axis : axes) axis.bind({axes.data(), axes.size(), &tables, {}});
        for (int i = 0; i < 30; ++i) step();
        for (std::size_t i = 0; i < axes.size(); ++i)
            if (!axes[i].config().encoder) {
                ASSERT_EQ(view(i).state, AxisState::Standstill) << i;
            }
    }

    struct Trace {
        MotionState before{};
        bool seen = false;
        double largest_step = 0, largest_velocity = 0, largest_change = 0, largest_jump = 0;
    };

    void step() {
        now += cycle;
        if (!straight) disturb();
        for (auto& axis : axes) axis.update(now);
        for (auto& axis : axes) axis.supervise(now);
        fetch_alarms();
        for (std::size_t i = 0; i < axes.size(); ++i)
            if (!axes[i].config().encoder) axes[i].power(enabled[i], (permits[i] & 1) != 0, (permits[i] & 2) != 0, view(i).owner);
        if (program) program();
        if (!straight) disturb();
        count_straight();
        plan_axes(axes, now, cycle);
        if (!straight) disturb();
        for (auto& axis : axes) axis.encode(now);
        fetch_alarms();
        for (std::size_t i = 0; i < axes.size(); ++i) {
            oracles[i].observe(view(i), axes[i].drive_command(), axes[i].config().limits);
            digest.observe(view(i), axes[i].drive_command());
            note(i);
        }
    }
    void run(int cycles) {
        for (int i = 0; i < cycles; ++i) step();
    }
    bool run_until(const std::function<bool()>& condition, int most = 20000) {
        for (int i = 0; i < most; ++i) {
            if (condition()) return true;
            step();
        }
        return condition();
    }

    [[nodiscard]] const AxisView& view(std::size_t axis) const { return axes[axis].view(); }
    [[nodiscard]] static AxisRef ref(std::size_t axis) { return {static_cast<std::uint16_t>(axis)}; }
    CommandId accept(std::size_t axis, const AxisCommand& command) {
        const auto answer = axes[axis].submit(command, Owner::program);
        EXPECT_EQ(answer.error, ErrorId::none) << "axis " << axis;
        return answer.id;
    }
    ErrorId refuse(std::size_t axis, const AxisCommand& command) {
        const auto before = view(axis);
        const auto answer = axes[axis].submit(command, Owner::program);
        EXPECT_EQ(answer.id, 0u);
        EXPECT_EQ(view(axis).active, before.active);  // untouched
        EXPECT_EQ(view(axis).state, before.state);
        return answer.error;
    }
    [[nodiscard]] CommandStatus status(std::size_t axis, CommandId id) const { return view(axis).status(id); }
    [[nodiscard]] ErrorId error_of(std::size_t axis, CommandId id) const {
        ErrorId error = ErrorId::none;
        (void)view(axis).status(id, &error);
        return error;
    }
    bool run_to_sync(std::size_t axis, CommandId id, int most = 20000) {
        return run_until([&] { return status(axis, id) == CommandStatus::in_target; }, most);
    }
    [[nodiscard]] bool raised(std::size_t axis, AxisAlarm alarm) const {
        for (const auto& fact : alarms)
            if (fact.id == id(alarm) && fact.index == axis) return true;
        return false;
    }
    /// Never more than the axis' own limits in any cycle: neither the velocity, nor its change, nor the place against the velocity.
    void expect_no_jump() const {
        expect_clean();
        for (std::size_t i = 0; i < axes.size(); ++i) {
            if (axes[i].config().encoder) continue;
            const auto& limits = axes[i].config().limits;
            const double period = to_seconds(cycle);
            const double change = std::max({limits.acceleration, limits.deceleration, limits.stop_deceleration}) * period;
            EXPECT_LE(traces[i].largest_velocity, limits.velocity * (1 + 1e-8)) << "axis " << i;
            EXPECT_LE(traces[i].largest_step, limits.velocity * period * (1 + 1e-6)) << "axis " << i;
            EXPECT_LE(traces[i].largest_change, change * (1 + 1e-6)) << "axis " << i;
            EXPECT_LE(traces[i].largest_jump, change * period) << "axis " << i;
        }
    }

    void expect_clean() const {
        for (const auto& oracle : oracles) EXPECT_TRUE(oracle.clean()) << oracle.report();
    }
    [[nodiscard]] bool clean() const {
        return std::all_of(oracles.begin(), oracles.end(), [](const auto& oracle) { return oracle.clean(); });
    }

    std::vector<std::unique_ptr<FakeDrive>> drives;
    MotionTables tables;
    std::vector<Axis> axes;
    std::vector<MotionOracle> oracles;
    MotionDigest digest;
    std::vector<Trace> traces;
    std::vector<char> enabled;
    std::vector<std::uint8_t> permits;  ///< bit 0: EnablePositive, bit 1: EnableNegative
    std::vector<AlarmFact> alarms;
    std::function<void()> program;
    Instant now{};
    bool straight = true;              ///< false: every step of every axis goes the whole way (axes/axis/plain_cycle.hpp)
    long calm = 0, planned_plain = 0;  ///< axes and cycles in which the straight way was open: at all, and for the plan

private:
    void disturb() {
        for (auto& axis : axes) AxisCore::plain_cycle_of(axis).disturb();
    }
    void count_straight() {
        for (auto& axis : axes) {
            const auto& plain = AxisCore::plain_cycle_of(axis);
            calm += plain.calm() ? 1 : 0;
            planned_plain += plain.plans() ? 1 : 0;
        }
    }
    void fetch_alarms() {
        AlarmFact fact;
        for (auto& axis : axes)
            while (axis.fetch_alarm(fact)) alarms.push_back(fact);
    }
    void note(std::size_t i) {
        auto& trace = traces[i];
        const MotionState at{view(i).set_position, view(i).set_velocity, view(i).set_acceleration};
        // A modulo axis wraps: no step.
        const double modulo = view(i).modulo;
        double way = at.position - trace.before.position;
        if (modulo > 0) way -= modulo * std::round(way / modulo);
        if (trace.seen && view(i).powered) {
            trace.largest_step = std::max(trace.largest_step, std::abs(way));
            trace.largest_velocity = std::max(trace.largest_velocity, std::abs(at.velocity));
            trace.largest_change = std::max(trace.largest_change, std::abs(at.velocity - trace.before.velocity));
            trace.largest_jump =
                std::max(trace.largest_jump, std::abs(way - (at.velocity + trace.before.velocity) / 2 * to_seconds(cycle)));
        }
        trace.before = at;
        trace.seen = view(i).powered;
    }
};

inline AxisCommand gear_in(std::size_t master, std::int32_t numerator = 1, std::int32_t denominator = 1, MC_BufferMode mode = mcAborting) {
    return {.kind = CommandKind::gear_in,
            .buffer_mode = mode,
            .details = GearDetails{.master = CouplingRig::ref(master), .ratio = {numerator, denominator}}};
}
inline AxisCommand gear_in_pos(std::size_t master, double master_sync, double slave_sync, double distance, std::int32_t numerator = 1,
                               std::int32_t denominator = 1) {
    return {.kind = CommandKind::gear_in_pos,
            .details = GearInPosDetails{.master = CouplingRig::ref(master),
                                        .ratio = {numerator, denominator},
                                        .master_sync_position = master_sync,
                                        .slave_sync_position = slave_sync,
                                        .master_start_distance = distance}};
}
inline AxisCommand cam_in(std::size_t master, CamId table, MC_StartMode start = mcAbsolute, MC_BufferMode mode = mcAborting) {
    return {.kind = CommandKind::cam_in,
            .buffer_mode = mode,
            .details = CamDetails{.master = CouplingRig::ref(master), .table = table, .start = start}};
}
inline AxisCommand combine(std::size_t one, std::size_t two, MC_CombineMode how = mcAddAxes, GearRatio first = {}, GearRatio second = {}) {
    return {.kind = CommandKind::combine,
            .details = CombineDetails{
                .master1 = CouplingRig::ref(one), .master2 = CouplingRig::ref(two), .ratio1 = first, .ratio2 = second, .mode = how}};
}
inline AxisCommand gear_out() { return {.kind = CommandKind::gear_out}; }
inline AxisCommand cam_out() { return {.kind = CommandKind::cam_out}; }
inline AxisCommand phasing(CommandKind kind, double shift, double velocity = 0, MC_BufferMode mode = mcAborting) {
    return {.kind = kind, .buffer_mode = mode, .position = shift, .velocity = velocity};
}

}  // namespace taktwerk::axes::test
