#pragma once
// An axis over an XP200 in virtual time: the axis' cycle of 1 ms, the line beside it, the simulated drive at its end. 10 mm a turn, 10000 counts:
// 1 r/min is 1/6 mm/s.

#include <gtest/gtest.h>

#include <memory>

#include "axes/axis/axis.hpp"
#include "axes/drives/xp200/drive_line.hpp"
#include "axes/sim/xp200/station.hpp"
#include "modbus/line/virtual_line.hpp"
#include "tests/axes/drives/xp200/plain_profile.hpp"

namespace taktwerk::axes::xp200 {

using namespace std::chrono_literals;

struct AxisRig {
    static constexpr Duration cycle = 1ms;
    static constexpr modbus::LineSettings fast{38400, modbus::Parity::even, 1};

    explicit AxisRig(std::vector<ParameterSetting> parameters = {{97, 33}, {108, 9}, {136, 1}, {164, 1}, {63, 200}},
                     sim::PlantConfig plant = {}, HomingKind homing = HomingKind::set_here, sim::xp200::Options options = {},
                     double window = 10)
        : profile(plain_profile()),
          drive(*profile, plant, options),
          port({.name = "u_drive", .station = 1, .profile = profile, .parameters = std::move(parameters)}, fast),
          lines(line),
          axis(config(homing, window), port, cycle) {
        for (const auto& [number, value] : {std::pair{181, 1}, {182, 3}, {4, 1}})
            drive.servo().parameters().commission(static_cast<std::uint16_t>(number), value);
        line.connect(drive);
        lines.add(port);
    }
    static AxisConfig config(HomingKind homing, double window) {
        AxisConfig c;
        c.name = "u";
        c.gearing = {.counts_per_revolution = 10000, .feed = 10};
        c.limits = {.velocity = 100,
                    .acceleration = 200,
                    .deceleration = 200,
                    .jerk = std::numeric_limits<double>::infinity(),
                    .stop_deceleration = 400};
        c.control = {.mode = ControlMode::velocity, .kv = 3};
        c.windows = {.in_position = 0.05, .in_position_time = 10ms, .standstill_velocity = 0.1};
        c.following = {.window = window, .time = 50ms};
        c.homing = {.kind = homing, .search_velocity = 20, .latch_velocity = 2, .acceleration = 100, .negative = true};
        return c;
    }
    void step() {
        now += cycle;
        axis.update(now);
        axis.supervise(now);
        axis.plan(now, cycle);
        axis.encode(now);
        lines.step(now);
    }
    void run(Duration time) {
        for (const auto until = now + time; now < until;) step();
    }
    template <class Condition>
    bool until(Condition condition, Duration patience) {
        for (const auto end = now + patience; now < end;) {
            step();
            if (condition()) return true;
        }
        return false;
    }
    void power(bool on = true) {
        axis.update(now);
        EXPECT_EQ(axis.power(on, true, true, Owner::program), ErrorId::none);
    }
    /// Mains on, line up, axis enabled.
    void go() {
        drive.servo().power_on(now);
        ASSERT_TRUE(until([&] { return axis.view().online; }, 5s)) << "the line";
        power();
        ASSERT_TRUE(until([&] { return axis.view().state == AxisState::Standstill; }, 5s)) << "enabling";
    }
    Submitted submit(CommandKind kind, double position, double velocity, double acceleration = 0) {
        AxisCommand command;
        command.kind = kind;
        command.position = position;
        command.velocity = velocity;
        command.acceleration = command.deceleration = acceleration;
        return axis.submit(command, Owner::program);
    }
    [[nodiscard]] double millimetres() const { return drive.servo().plant().position() / 1000; }
    [[nodiscard]] double rpm() const { return drive.servo().speed(); }

    std::shared_ptr<const DriveProfile> profile;
    sim::xp200::Drive drive;
    modbus::VirtualLine line{fast};
    Xp200Drive port;
    DriveLine lines;
    Axis axis;
    Instant now{1s};
};

}  // namespace taktwerk::axes::xp200
