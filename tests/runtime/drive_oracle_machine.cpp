// The oracle behind every machine of the tests sees what it is there for: a clean run passes, and each lie to a drive is told.

#include "tests/runtime/drive_oracle.hpp"

#include <functional>
#include <utility>
#include <vector>

#include "tests/runtime/test_machine.hpp"

namespace taktwerk::runtime::testing {
namespace {

using axes::AxisState;

/// A machine that moves, and beside its own oracle a second one that is lied to.
struct Lies : ::testing::Test {
    using Alter = std::function<void(axes::AxisView&, ToldDrive&)>;

    void SetUp() override {
        ASSERT_TRUE(m.up());
        m.enable(0);
        m.home(0);
    }
    /// What the oracle says of `alter` in each cycle of a move, after so many cycles of truth.
    std::string told_of(const Alter& alter, int truth = 100) {
        DriveOracle oracle(m.machine->config().axes[0], m.machine->config().cycle);
        int cycle = 0;
        m.on_cycle = [&] {
            auto view = m.axis(0);
            auto told = m.told(0);
            if (++cycle > truth) alter(view, told);
            oracle.observe(view, told, true);
        };
        EXPECT_EQ(m.command(OperatorAction::move_absolute, 0, false, m.axis(0).set_position > 400 ? 10 : 790, 150).answer,
                  Answer::accepted);
        m.run(900ms);
        m.on_cycle = {};
        EXPECT_GT(oracle.motion().compared(), truth / 2);
        EXPECT_EQ(m.command(OperatorAction::stop, 0).answer, Answer::accepted);
        EXPECT_TRUE(m.until([&] { return m.axis(0).state == AxisState::Standstill; }, 2s));
        return oracle.report();
    }

    static MachineConfig machine() {
        auto config = machine_config(1);
        config.axes[0].axis.homing.kind = axes::HomingKind::set_here;
        return config;
    }
    TestMachine m{machine()};
};

TEST_F(Lies, ATrueStoryPassesAndWasLookedAt) {
    EXPECT_EQ(told_of([](auto&, auto&) {}), "");
    EXPECT_GT(m.oracles[0].motion().compared(), 300);
    EXPECT_GT(m.oracles[0].compared(), 300);
}

TEST_F(Lies, EachKindIsSeen) {
    int cycles = 0;
    const std::vector<std::pair<const char*, Alter>> lies{
        {"is told a way", [&](auto&, auto& told) { *told.position += 3 * ++cycles; }},             // runs away from the view
        {"is told a way", [&](auto&, auto& told) { *told.position += ++cycles == 20 ? 40 : 0; }},  // one step and back
        {"off by", [&](auto& view, auto&) { view.set_position += 0.004 * ++cycles; }},             // the view alone
        {"is in DiscreteMotion, its drive is told 0007h", [](auto&, auto& told) { told.control = 7; }},
        {"its drive is told 0006h", [](auto&, auto& told) { told.control = 6; }},
        {"its drive is told to reset", [](auto&, auto& told) { told.control |= 0x80; }},
        {"in mode 8", [](auto&, auto& told) { told.control |= 0x10; }},
        {"its drive is told mode 6", [](auto&, auto& told) { told.mode = 6; }},
        {"its drive is told mode 10", [](auto&, auto& told) { told.mode = 10; }},
        {"tells its drive mode 0", [](auto&, auto& told) { told.mode = 0; }},
        {"60FFh 5 in mode 8", [](auto&, auto& told) { told.velocity = 5; }},
        {"6071h -5 in mode 8", [](auto&, auto& told) { told.torque = -5; }},
        {"beside its position", [](auto&, auto& told) { told.velocity_offset = 12345; }},
        {"its target 607Ah is",
         [](auto& view, auto&) { view.drive_state = axes::PowerState::switched_on; }},  // not enabled, and led on all the same
        {"is Disabled, its drive runs",
         [](auto& view, auto&) {
             view = {};
             view.online = true;
             view.drive_state = axes::PowerState::enabled;
         }},
    };
    for (const auto& [words, alter] : lies) {
        cycles = 0;
        const auto report = told_of(alter);
        EXPECT_NE(report.find(words), std::string::npos) << words << "\n" << report;
    }
}

// What was sent and what the slave has are two things.
TEST_F(Lies, WhatDoesNotArriveIsSeen) {
    DriveOracle oracle(m.machine->config().axes[0], m.machine->config().cycle);
    int cycle = 0;
    m.on_cycle = [&] {
        auto there = m.told(0);
        if (++cycle == 50) *there.position += 1000;
        oracle.arrived(there, m.told(0), true);
        if (cycle == 49) {
            EXPECT_TRUE(oracle.clean()) << oracle.report();
        }
    };
    m.run(60ms);
    EXPECT_NE(oracle.report().find("it was sent"), std::string::npos) << oracle.report();
}

}  // namespace
}  // namespace taktwerk::runtime::testing
