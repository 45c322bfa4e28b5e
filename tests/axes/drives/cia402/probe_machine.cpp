// A touch probe the whole way: an axis, the CiA 402 port, real frames, and a simulated drive that latches between two cycles. Objects and
// mapping are those of the SV33-E (manual 7.3; config/drives/sv33-e.yaml: 1600h, 1A00h), its encoder 2^17 counts a turn.
#include <gtest/gtest.h>

#include <cmath>

#include "axes/axis/axis.hpp"
#include "axes/drives/cia402/cia402_drive.hpp"
#include "axes/sim/cia402_device.hpp"
#include "ecat/master.hpp"
#include "ecat/sim/sim_network.hpp"
#include "ecat/transport/loopback.hpp"
#include "tests/axes/drives/cia402/puppet_device.hpp"

namespace taktwerk::axes::cia402 {
namespace {

using namespace std::chrono_literals;

constexpr std::int64_t turn = 1 << 17;
constexpr double counts_per_mm = turn / 10.0;  // 10 mm a turn
constexpr double edge = 34.5678;               // mm: where the probe's signal begins, between two counts

std::shared_ptr<ecat::DeviceDescription> sv33() {
    return test::device(
        "SV33-E", {{0x6040, 0}, {0x607A, 0}, {0x60FF, 0}, {0x6071, 0}, {0x6060, 0}, {0x60B8, 0}},
        {{0x6041, 0}, {0x6064, 0}, {0x606C, 0}, {0x6077, 0}, {0x6061, 0}, {0x603F, 0}, {0x60FD, 0}, {0x60B9, 0}, {0x60BA, 0}, {0x60BB, 0}});
}

/// One axis of 10 mm a turn on the bus, in virtual time, 1 ms a cycle. Signal of probe 1 from 34.5678 mm to 40 mm.
struct Machine {
    Machine() : network(Instant{}), transport(network) {
        profile.name = "SV33-E";
        profile.modes = {DriveMode::cyclic_position};
        profile.probes = 2;
        const auto description = sv33();
        ecat::BusConfig bus;
        bus.cycle = cycle;
        ecat::SlaveConfig slave;
        slave.name = "x_drive";
        slave.device = description;
        slave.dc = true;
        bus.slaves = {slave};
        sim::PlantConfig plant;
        plant.counts_per_revolution = turn;
        plant.probe[0] = {edge * counts_per_mm, 40 * counts_per_mm};
        sim::SimulatedMotor motor;
        motor.counts_per_revolution = turn;
        network.add(description, std::make_unique<sim::Cia402Device>(profile, std::vector<sim::Cia402Device::AxisSetup>{{plant, motor}}),
                    {});
        master = std::make_unique<ecat::Master>(transport, bus);
        master->start();
        for (int i = 0; i < 20'000 && master->phase() != ecat::Master::Phase::operational; ++i) step();
        EXPECT_EQ(master->phase(), ecat::Master::Phase::operational) << master->failure().text();
        drive = std::make_unique<Cia402Drive>(*master, 0, 0, std::make_shared<DriveProfile>(profile), cycle);
        const auto resolved = drive->resolve();
        EXPECT_TRUE(resolved.ok()) << resolved.error().text();

        AxisConfig config;
        config.name = "x";
        config.gearing = {.counts_per_revolution = turn, .feed = 10};
        config.limits = {.velocity = 500, .acceleration = 5000, .deceleration = 5000, .jerk = 100000};
        config.require_homed = false;
        axis = std::make_unique<Axis>(config, *drive, cycle);
        EXPECT_TRUE(until([&] { return axis->view().state == AxisState::Standstill; }));
    }
    void step() {
        now += cycle;
        master->receive(now);
        if (axis) {
            axis->update(now);
            axis->supervise(now);
            axis->power(true, true, true, Owner::program);
            axis->plan(now, cycle);
            axis->encode(now);
        }
        master->send(now);
        if (drive) drive->step(now);
        master->step(now);
    }
    bool until(const std::function<bool()>& condition, int most = 10'000) {
        for (int i = 0; i < most && !condition(); ++i) step();
        return condition();
    }
    CommandId accept(const AxisCommand& command) {
        const auto answer = axis->submit(command, Owner::program);
        EXPECT_EQ(answer.error, ErrorId::none);
        return answer.id;
    }
    void go_to(double position) {
        const auto id = accept({.kind = CommandKind::move_absolute, .position = position, .velocity = 500});
        ASSERT_TRUE(until([&] { return axis->view().status(id) == CommandStatus::done; }));
        for (int i = 0; i < 200; ++i) step();
    }

    static constexpr Duration cycle = 1ms;
    ecat::sim::SimNetwork network;
    ecat::LoopbackTransport transport;
    DriveProfile profile;
    std::unique_ptr<ecat::Master> master;
    std::unique_ptr<Cia402Drive> drive;
    std::unique_ptr<Axis> axis;
    Instant now{};
};

AxisCommand probe(const TriggerRef& trigger) { return {.kind = CommandKind::touch_probe, .details = ProbeDetails{.trigger = trigger}}; }

// 500 mm/s are 0.5 mm a cycle; the latch is exact to one of 13107 counts a millimetre. P1-245, P1-249
TEST(ProbeOnTheBus, RecordsTheEdgeToTheCount) {
    Machine m;
    const auto id = m.accept(probe({.source = TriggerSource::probe1}));
    m.go_to(60);
    ASSERT_EQ(m.axis->view().status(id), CommandStatus::done);
    const double recorded = m.axis->view().probe_position[0];
    EXPECT_LE(recorded, edge);
    EXPECT_GT(recorded, edge - 1 / counts_per_mm) << "the count in which the edge lies";
}

TEST(ProbeOnTheBus, TheFallingEdgeAndTheWayBack) {
    Machine m;
    const auto falling = m.accept(probe({.source = TriggerSource::probe1, .falling = true}));
    m.go_to(60);
    ASSERT_EQ(m.axis->view().status(falling), CommandStatus::done);
    EXPECT_NEAR(m.axis->view().probe_position[0], 40, 1 / counts_per_mm);
    const auto rising = m.accept(probe({.source = TriggerSource::probe1}));
    m.go_to(0);
    ASSERT_EQ(m.axis->view().status(rising), CommandStatus::done);
    EXPECT_NEAR(m.axis->view().probe_position[0], 40, 1 / counts_per_mm) << "downwards the signal begins at its upper end";
}

TEST(ProbeOnTheBus, AnEventOutsideTheWindowIsPassedOver) {  // P1-246
    Machine m;
    auto command = probe({.source = TriggerSource::probe1});
    auto& details = std::get<ProbeDetails>(command.details);
    details.window_only = true;
    details.first = 39;
    details.last = 41;
    const auto id = m.accept(command);
    m.go_to(60);
    EXPECT_EQ(m.axis->view().status(id), CommandStatus::active);
    m.go_to(0);
    EXPECT_EQ(m.axis->view().status(id), CommandStatus::done);
    EXPECT_NEAR(m.axis->view().probe_position[0], 40, 1 / counts_per_mm);
}

TEST(ProbeOnTheBus, TheIndexPulseIsAWholeTurn) {
    Machine m;
    m.go_to(3);
    const auto id = m.accept(probe({.source = TriggerSource::index_pulse}));
    m.go_to(17);
    ASSERT_EQ(m.axis->view().status(id), CommandStatus::done);
    EXPECT_NEAR(m.axis->view().probe_position[0], 10, 1 / counts_per_mm);
}

// The positions of probe 2 are not in this mapping.
TEST(ProbeOnTheBus, WhatIsNotMappedIsRefused) {
    Machine m;
    EXPECT_EQ(m.axis->submit(probe({.source = TriggerSource::probe2}), Owner::program).error, ErrorId::no_such_probe);
}

}  // namespace
}  // namespace taktwerk::axes::cia402
