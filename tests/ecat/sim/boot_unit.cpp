// BOOT as a simulated slave with firmware plays it. Source: ETG.1000.6 (ESM, AL status codes), ETG.2010 (words 14h to 17h).
#include <gtest/gtest.h>

#include "ecat/wire/sii.hpp"
#include "tests/ecat/sim/bus_probe.hpp"

namespace taktwerk::ecat::sim {
namespace {

class BootState : public ::testing::Test {
protected:
    BootState() {
        auto description = small_drive();
        description.mailbox->foe = true;
        description.mailbox->bootstrap = BootstrapDescription{0x1000, 0x100, 0x1100, 0x100};
        slave = &bus.add_drive({}, std::move(description));
    }
    void boot_mailboxes(std::uint16_t position = 0) {
        for (const unsigned n : {0u, 1u}) bus.set_sync_manager(position, n, 0, 0, 0, 0);  // while one is on its place is frozen
        bus.set_sync_manager(position, 0, 0x1000, 0x100, 0x26);
        bus.set_sync_manager(position, 1, 0x1100, 0x100, 0x22);
    }
    BusProbe bus;
    SimSlave* slave = nullptr;
};

TEST_F(BootState, IsReachedFromInitWithItsOwnMailboxes) {
    EXPECT_EQ(bus.request(0, 3), 0x11);
    EXPECT_EQ(bus.code(0), 0x0015) << "no mailboxes";
    bus.mailboxes(0);
    EXPECT_EQ(bus.request(0, 0x13), 0x11);
    EXPECT_EQ(bus.code(0), 0x0015) << "those of PREOP";
    boot_mailboxes();
    EXPECT_EQ(bus.request(0, 0x13), 3);
    EXPECT_EQ(bus.code(0), 0);
}

TEST_F(BootState, LeadsToInitAndNowhereElseAndFromInitAlone) {
    boot_mailboxes();
    ASSERT_EQ(bus.request(0, 3), 3);
    EXPECT_EQ(bus.request(0, 2), 0x13);
    EXPECT_EQ(bus.code(0), 0x0011);
    EXPECT_EQ(bus.request(0, 0x14), 0x13);
    EXPECT_EQ(bus.request(0, 0x11), 1);
    bus.wait(100ms);
    bus.to_preop(0);
    ASSERT_EQ(slave->state(), EsmState::preop);
    EXPECT_EQ(bus.request(0, 3), 0x12);
    EXPECT_EQ(bus.code(0), 0x0011);
}

TEST_F(BootState, FallsToInitWhenItsMailboxIsTakenAway) {
    boot_mailboxes();
    ASSERT_EQ(bus.request(0, 3), 3);
    bus.set_sync_manager(0, 1, 0x1100, 0x100, 0x22, 0);
    bus.wait(1ms);
    EXPECT_EQ(bus.value<std::uint16_t>(0, reg::al_status), 0x11);
    EXPECT_EQ(bus.code(0), 0x0015);
}

TEST_F(BootState, ItsEepromSaysWhereTheMailboxesAre) {
    const auto sii = parse_sii(slave->controller().eeprom().image());
    EXPECT_EQ(sii.boot_mailbox_out, (SiiMailbox{0x1000, 0x100}));
    EXPECT_EQ(sii.boot_mailbox_in, (SiiMailbox{0x1100, 0x100}));
    EXPECT_EQ(sii.mailbox_protocols, sii_protocol::coe | sii_protocol::foe);
}

// Nothing sound in its flash: INIT and BOOT are what is left.
TEST_F(BootState, WithoutFirmwareThereIsNoPreop) {
    slave->files()->flash().begin(bus.now);
    FirmwareOptions one;
    one.banks = 1;
    auto description = small_drive();
    description.mailbox->foe = true;
    description.mailbox->bootstrap = BootstrapDescription{0x1000, 0x100, 0x1100, 0x100};
    SlaveOptions options;
    options.firmware = one;
    auto& single = bus.add_drive(options, description);
    single.files()->flash().begin(bus.now);
    for (const std::size_t n : {0u, 1u}) {
        bus.network.set_power(n, false);
        bus.network.set_power(n, true);
    }
    bus.to_preop(0);
    EXPECT_EQ(slave->state(), EsmState::preop) << "its other bank holds the old one";
    bus.mailboxes(1);
    EXPECT_EQ(bus.request(1, 2), 0x11);
    EXPECT_EQ(bus.code(1), 0x0014);
    boot_mailboxes(1);
    EXPECT_EQ(bus.request(1, 0x13), 3);
}

}  // namespace
}  // namespace taktwerk::ecat::sim
