// The EtherCAT state machine of a simulated slave: transitions, checks and status codes. Source: ETG.1000.6 (ESM),
// AL status codes of ETG.1020.

#include <gmock/gmock.h>

#include "tests/ecat/sim/bus_probe.hpp"

namespace taktwerk::ecat::sim {
namespace {

using testing::ElementsAre;

TEST(AlState, ClimbsStepByStepAndTellsTheModel) {
    BusProbe bus;
    bus.add_drive();
    bus.mailboxes(0);
    EXPECT_EQ(bus.request(0, 2), 2);
    bus.process_managers(0);
    EXPECT_EQ(bus.request(0, 4), 4);
    EXPECT_EQ(bus.request(0, 8), 8);

    EXPECT_EQ(bus.code(0), 0);
    EXPECT_THAT(bus.recorders[0]->states, ElementsAre(EsmState::init, EsmState::preop, EsmState::safeop, EsmState::op));
    EXPECT_EQ(bus.recorders[0]->last_settings.output_bytes, 6);
    EXPECT_EQ(bus.recorders[0]->last_settings.input_bytes, 6);
}

TEST(AlState, ChangesOnlyAfterTheTransitionTime) {
    BusProbe bus;
    bus.add_drive({.transition_time = 300us});
    bus.mailboxes(0);

    bus.write(0, 0x0120, le<std::uint16_t>(2));
    bus.wait(299us);
    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0130), 1);
    bus.wait(1us);
    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0130), 2);
}

TEST(AlState, AnotherRequestIsNotTakenBeforeTheFirstWasRead) {
    BusProbe bus;
    bus.add_drive({.transition_time = 300us});
    bus.mailboxes(0);

    EXPECT_EQ(bus.write(0, 0x0120, le<std::uint16_t>(2)).wkc, 1);
    EXPECT_EQ(bus.write(0, 0x0120, le<std::uint16_t>(1)).wkc, 0);
    bus.wait(400us);
    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0130), 2);
    EXPECT_EQ(bus.write(0, 0x0120, le<std::uint16_t>(1)).wkc, 1);
}

TEST(AlState, MayFallAnyNumberOfSteps) {
    for (const std::uint16_t to : {std::uint16_t{4}, std::uint16_t{2}, std::uint16_t{1}}) {
        BusProbe bus;
        bus.add_drive();
        bus.to_safeop(0);
        ASSERT_EQ(bus.request(0, 8), 8);
        EXPECT_EQ(bus.request(0, to), to);
        EXPECT_EQ(bus.code(0), 0);
    }
}

TEST(AlState, SkippingAStepUpwardsIs0011) {
    BusProbe bus;
    bus.add_drive();
    bus.mailboxes(0);

    EXPECT_EQ(bus.request(0, 4), 0x11);
    EXPECT_EQ(bus.code(0), 0x0011);
    EXPECT_EQ(bus.request(0, 0x11), 1);
    EXPECT_EQ(bus.request(0, 8), 0x11);
}

TEST(AlState, UnknownStatesAndBootstrapAreRefused) {
    BusProbe bus;
    bus.add_drive();

    EXPECT_EQ(bus.request(0, 5), 0x11);
    EXPECT_EQ(bus.code(0), 0x0012);
    EXPECT_EQ(bus.request(0, 0x13), 0x11);
    EXPECT_EQ(bus.code(0), 0x0013);
}

TEST(AlState, AnErrorWantsAnAcknowledgement) {
    BusProbe bus;
    bus.add_drive();
    bus.request(0, 2);  // no mailboxes: refused
    ASSERT_EQ(bus.code(0), 0x0016);

    bus.mailboxes(0);
    EXPECT_EQ(bus.request(0, 2), 0x11) << "without acknowledgement nothing moves";
    EXPECT_EQ(bus.request(0, 0x12), 2) << "acknowledge and go on in one";
    EXPECT_EQ(bus.code(0), 0);
}

TEST(AlState, PreopNeedsBothMailboxesAsTheSlaveHasThem) {
    const auto code_with = [](auto prepare) {
        BusProbe bus;
        bus.add_drive();
        prepare(bus);
        bus.request(0, 2);
        return bus.code(0);
    };
    EXPECT_EQ(code_with([](BusProbe& bus) { bus.mailboxes(0); }), 0);
    EXPECT_EQ(code_with([](BusProbe& bus) { bus.set_sync_manager(0, 0, 0x1000, 0x80, 0x26); }), 0x0016);
    EXPECT_EQ(code_with([](BusProbe& bus) {
                  bus.set_sync_manager(0, 0, 0x1000, 0x40, 0x26);
                  bus.set_sync_manager(0, 1, 0x1400, 0x80, 0x22);
              }),
              0x0016);
    EXPECT_EQ(code_with([](BusProbe& bus) {
                  bus.set_sync_manager(0, 0, 0x1000, 0x80, 0x24);  // buffered
                  bus.set_sync_manager(0, 1, 0x1400, 0x80, 0x22);
              }),
              0x0016);
}

std::uint16_t safeop_code(const std::function<void(BusProbe&)>& managers, const DeviceDescription& description = small_drive()) {
    BusProbe bus;
    bus.add_drive({}, description);
    bus.to_preop(0);
    managers(bus);
    bus.request(0, 4);
    return bus.code(0);
}

TEST(AlState, SafeopNeedsSyncManagersThatFitTheMapping) {
    EXPECT_EQ(safeop_code([](BusProbe& bus) { bus.process_managers(0, 6, 6); }), 0);
    EXPECT_EQ(safeop_code([](BusProbe& bus) { bus.process_managers(0, 7, 6); }), 0x001D);
    EXPECT_EQ(safeop_code([](BusProbe& bus) { bus.process_managers(0, 6, 5); }), 0x001E);
    EXPECT_EQ(safeop_code([](BusProbe& bus) { bus.process_managers(0, 0, 6); }), 0x001D);
    EXPECT_EQ(safeop_code([](BusProbe&) {}), 0x001D);
    EXPECT_EQ(safeop_code([](BusProbe& bus) {
                  bus.set_sync_manager(0, 2, 0x1900, 6, 0x64);  // not where the slave has it
                  bus.set_sync_manager(0, 3, 0x1C00, 6, 0x20);
              }),
              0x001D);
    EXPECT_EQ(safeop_code([](BusProbe& bus) {
                  bus.set_sync_manager(0, 2, 0x1800, 6, 0x64);
                  bus.set_sync_manager(0, 3, 0x1C00, 6, 0x24);  // the wrong direction
              }),
              0x001E);
}

TEST(AlState, SafeopFollowsAChangedMapping) {
    EXPECT_EQ(safeop_code([](BusProbe& bus) {
                  bus.download(0, 0x1C12, 0, 1, 0);
                  bus.download(0, 0x1C12, 1, 2, 0x1701);  // 7 bytes
                  bus.download(0, 0x1C12, 0, 1, 1);
                  bus.process_managers(0, 7, 6);
              }),
              0);
    EXPECT_EQ(safeop_code([](BusProbe& bus) {
                  bus.download(0, 0x1C12, 0, 1, 0);  // no outputs at all
                  bus.process_managers(0, 0, 6);
              }),
              0);
}

TEST(AlState, ThreeBuffersMustNotReachIntoTheNextManager) {
    auto description = small_drive();
    description.sync_managers[3].start = 0x1800 + 2 * 6;  // room for two buffers of SM2 only
    EXPECT_EQ(safeop_code(
                  [](BusProbe& bus) {
                      bus.set_sync_manager(0, 2, 0x1800, 6, 0x64);
                      bus.set_sync_manager(0, 3, 0x180C, 6, 0x20);
                  },
                  description),
              0x001D);
}

TEST(AlState, TheModelMayRefuse) {
    BusProbe bus;
    bus.add_drive();
    bus.recorders[0]->refused = EsmState::op;
    bus.recorders[0]->refusal = 0x8001;
    bus.to_safeop(0);

    EXPECT_EQ(bus.request(0, 8), 0x14);
    EXPECT_EQ(bus.code(0), 0x8001);
}

TEST(AlState, ATestMayMakeAStateFailAndLetItGoAgain) {
    BusProbe bus;
    auto& slave = bus.add_drive();
    bus.mailboxes(0);
    slave.refuse_state(EsmState::preop, 0x0051);
    EXPECT_EQ(bus.request(0, 2), 0x11);
    EXPECT_EQ(bus.code(0), 0x0051);

    slave.refuse_state(EsmState::preop, 0);
    EXPECT_EQ(bus.request(0, 0x12), 2);
}

DeviceDescription clocked_drive() {
    auto description = small_drive();
    description.dc.supported = description.dc.required = true;
    description.dc.minimum_cycle = 125us;
    description.dc.cycle_multiple = 125us;
    return description;
}

std::uint16_t code_with_sync0(std::int64_t start_in_ns, std::uint32_t cycle) {
    return safeop_code(
        [&](BusProbe& bus) {
            bus.process_managers(0);
            if (cycle == 0) return;
            bus.write(0, 0x0990, le<std::int64_t>(bus.value<std::int64_t>(0, 0x0910) + start_in_ns));
            bus.write(0, 0x09A0, le<std::uint32_t>(cycle));
            bus.write(0, 0x0981, bytes({0x03}));
        },
        clocked_drive());
}

TEST(AlState, ADriveThatNeedsSync0WantsItBeforeSafeop) {
    EXPECT_EQ(code_with_sync0(0, 0), 0x002D) << "not activated";
    EXPECT_EQ(code_with_sync0(-1000, 1'000'000), 0x002D) << "the start has passed: no pulse will ever come";
    EXPECT_EQ(code_with_sync0(10'000'000, 62'500), 0x0036) << "below the minimum";
    EXPECT_EQ(code_with_sync0(10'000'000, 1'000'001), 0x0036) << "no multiple of 125 us";
    EXPECT_EQ(code_with_sync0(10'000'000, 1'000'000), 0);
}

// SV-DA200 2.1: 250 us, 500 us, 1 ms, 2 ms, 4 ms and 8 ms are the only cycles.
TEST(AlState, ADriveThatKnowsSomeCyclesOnlyRefusesAllOthers) {
    const auto code = [](std::uint32_t cycle) {
        auto description = clocked_drive();
        description.dc.cycles = {250us, 500us, 1ms, 2ms, 4ms, 8ms};
        return safeop_code(
            [&](BusProbe& bus) {
                bus.process_managers(0);
                bus.write(0, 0x0990, le<std::int64_t>(bus.value<std::int64_t>(0, 0x0910) + 10'000'000));
                bus.write(0, 0x09A0, le<std::uint32_t>(cycle));
                bus.write(0, 0x0981, bytes({0x03}));
            },
            description);
    };
    EXPECT_EQ(code(750'000), 0x0036) << "a multiple of 125 us, but no cycle of this drive";
    EXPECT_EQ(code(500'000), 0);
    EXPECT_EQ(code(8'000'000), 0);
}

TEST(AlState, ForAMasterWithoutClocksTheNeedOfSync0MayBeWaived) {
    BusProbe bus;
    auto description = small_drive();
    description.dc = {.supported = true, .required = true, .clock_64bit = true, .minimum_cycle = {}, .cycle_multiple = {}};
    SimSlave& drive = bus.add_drive({}, description);
    drive.require_sync0(SyncRequirement::waived);
    bus.to_safeop(0);
    EXPECT_EQ(drive.state(), EsmState::safeop);
    EXPECT_TRUE(drive.runs_without_required_sync0());
}

TEST(AlState, OutputsThatTheDeviceWantsSupervisedMustTriggerTheWatchdog) {
    EXPECT_EQ(safeop_code([](BusProbe& bus) {
                  bus.set_sync_manager(0, 2, 0x1800, 6, 0x24);  // without bit 6
                  bus.set_sync_manager(0, 3, 0x1C00, 6, 0x20);
              }),
              0x001F);
}

TEST(AlState, ASyncManagerTheDeviceDoesNotKnowIsRefused) {
    EXPECT_EQ(safeop_code([](BusProbe& bus) {
                  bus.process_managers(0);
                  bus.set_sync_manager(0, 4, 0x1F00, 4, 0x20);
              }),
              0x0017);
}

TEST(AlState, WhatChangedWhileTheFirmwareHungIsSeenWhenItGoesOn) {
    BusProbe bus;
    auto& slave = bus.add_drive();
    bus.to_safeop(0);
    slave.hang(true);
    bus.write(0, 0x0816, bytes({0}));
    slave.hang(false);

    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0130), 0x12);
    EXPECT_EQ(bus.code(0), 0x001D);
}

TEST(AlState, ASyncManagerTurnedOffInOpEndsIt) {
    BusProbe bus;
    bus.add_drive();
    bus.to_safeop(0);
    bus.request(0, 8);

    bus.write(0, 0x081E, bytes({0}));  // the inputs
    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0130), 0x12);
    EXPECT_EQ(bus.code(0), 0x001E);
    bus.write(0, 0x0806, bytes({0}));  // a mailbox: the error stands until it is acknowledged
    EXPECT_EQ(bus.request(0, 0x11), 1);
}

TEST(AlState, AMailboxTurnedOffIsTheWayToInit) {
    BusProbe bus;
    bus.add_drive();
    bus.to_preop(0);

    bus.write(0, 0x0806, bytes({0}));

    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0130), 0x11);
    EXPECT_EQ(bus.code(0), 0x0016);
}

TEST(DeviceIdentification, IsShownWhileAlControlAsksForIt) {
    BusProbe bus;
    bus.add_drive({.device_id = std::uint16_t{0x0042}});
    bus.add_drive();

    EXPECT_EQ(bus.request(0, 0x21), 0x21);
    EXPECT_EQ(bus.code(0), 0x0042);
    EXPECT_EQ(bus.request(0, 0x01), 0x01);
    EXPECT_EQ(bus.code(0), 0);
    EXPECT_EQ(bus.request(1, 0x21), 0x01) << "this one has no switch";
    EXPECT_EQ(bus.code(1), 0);
}

TEST(DeviceIdentification, IsHiddenByAnError) {
    BusProbe bus;
    bus.add_drive({.device_id = std::uint16_t{0x0042}});

    EXPECT_EQ(bus.request(0, 0x28), 0x11) << "OP from INIT";
    EXPECT_EQ(bus.code(0), 0x0011);
}

/// Outputs over SM2 and SM4, inputs over SM3 and SM5.
DeviceDescription four_windows() {
    auto description = small_drive();
    description.sync_managers.push_back({SmUse::outputs, 0x1A00, 0, 0x64});
    description.sync_managers.push_back({SmUse::inputs, 0x1E00, 0, 0x20});
    description.rx_pdos.push_back({0x1610, true, {{0x6060, 0, 8}}, std::uint8_t{4}});
    description.tx_pdos.push_back({0x1A10, true, {{0x6098, 0, 8}}, std::uint8_t{5}});
    description.rx_assigned = {0x1600, 0x1610};
    description.tx_assigned = {0x1A00, 0x1A10};
    return description;
}

TEST(SeveralSyncManagers, CarryEachItsOwnPdos) {
    BusProbe bus;
    auto& slave = bus.add_drive({}, four_windows());
    bus.to_preop(0);
    bus.process_managers(0);
    bus.set_sync_manager(0, 4, 0x1A00, 1, 0x64);
    bus.set_sync_manager(0, 5, 0x1E00, 1, 0x20);
    ASSERT_EQ(bus.request(0, 4), 4) << bus.code(0);
    ASSERT_EQ(bus.request(0, 8), 8);
    slave.dictionary().find(0x6098, 0)->set(17);

    bus.write(0, 0x1800, bytes({0x0F, 0, 1, 0, 0, 0}));
    bus.write(0, 0x1A00, bytes({8}));

    EXPECT_EQ(slave.dictionary().value(0x6040, 0), 0x000F);
    EXPECT_EQ(slave.dictionary().value(0x6060, 0), 8);
    EXPECT_EQ(bus.read(0, 0x1E00, 1).data, bytes({17}));
    EXPECT_EQ(bus.recorders[0]->last_settings.output_bytes, 7);
}

TEST(SeveralSyncManagers, AreCheckedEach) {
    EXPECT_EQ(safeop_code(
                  [](BusProbe& bus) {
                      bus.process_managers(0);
                      bus.set_sync_manager(0, 4, 0x1A00, 2, 0x64);
                      bus.set_sync_manager(0, 5, 0x1E00, 1, 0x20);
                  },
                  four_windows()),
              0x001D);
    EXPECT_EQ(safeop_code(
                  [](BusProbe& bus) {
                      bus.process_managers(0);
                      bus.set_sync_manager(0, 4, 0x1A00, 1, 0x64);
                  },
                  four_windows()),
              0x001E);
}

TEST(SeveralSyncManagers, AreAssignedEachByItsOwnObject) {
    BusProbe bus;
    bus.add_drive({}, four_windows());
    bus.to_preop(0);

    const auto assigned = bus.upload(0, 0x1C14, 1);
    ASSERT_EQ(assigned.size(), 10u);
    EXPECT_EQ(load_le<std::uint16_t>(assigned, 6), 0x1610);
    bus.download(0, 0x1C14, 0, 1, 0);
    EXPECT_EQ(bus.download(0, 0x1C14, 1, 2, 0x1600), 0u) << "it names no sync manager of its own";
    bus.download(0, 0x1C12, 0, 1, 0);
    EXPECT_EQ(bus.download(0, 0x1C12, 1, 2, 0x1610), 0x06090030u) << "it belongs to sync manager 4";
}

TEST(SmWatchdog, ExpiresInOpAndTakesTheSlaveToSafeop) {
    BusProbe bus;
    auto& slave = bus.add_drive();
    bus.to_safeop(0);
    bus.write(0, 0x0420, le<std::uint16_t>(100));  // 10 ms
    bus.write(0, 0x1800, Bytes(6));
    bus.request(0, 8);
    bus.write(0, 0x1800, Bytes(6));
    const Instant last = bus.now;
    bus.wait(9'999us);
    EXPECT_EQ(slave.state(), EsmState::op);

    bus.wait(2us);

    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0130), 0x14);
    EXPECT_EQ(bus.code(0), 0x001B);
    EXPECT_EQ(bus.value<std::uint8_t>(0, 0x0442), 1);
    EXPECT_EQ(bus.value<std::uint8_t>(0, 0x0440) & 1, 0);
    // The frame reached the slave 50 ns of cable after it was sent.
    EXPECT_THAT(bus.recorders[0]->lost, ElementsAre(last + 50ns + 10ms));
}

TEST(SmWatchdog, IsFedByOutputsAndOffAtZero) {
    BusProbe bus;
    auto& slave = bus.add_drive();
    bus.to_safeop(0);
    bus.request(0, 8);
    for (int i = 0; i < 20; ++i) {
        bus.write(0, 0x1800, Bytes(6));
        bus.wait(90ms);
    }
    EXPECT_EQ(slave.state(), EsmState::op);

    bus.write(0, 0x0420, le<std::uint16_t>(0));
    bus.wait(10s);
    EXPECT_EQ(slave.state(), EsmState::op);
}

TEST(SmWatchdog, CatchesAMasterThatGoesToOpAndSendsNothing) {
    BusProbe bus;
    auto& slave = bus.add_drive();
    bus.to_safeop(0);
    bus.request(0, 8);
    bus.wait(100ms);

    EXPECT_EQ(slave.state(), EsmState::safeop);
    EXPECT_EQ(bus.code(0), 0x001B);
}

}  // namespace
}  // namespace taktwerk::ecat::sim
