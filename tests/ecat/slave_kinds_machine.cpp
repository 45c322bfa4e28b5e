// Slaves of every kind on their way to OP: what they map, what is written to them, what is only noted.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/bytes.hpp"
#include "ecat/description/module_pdos.hpp"
#include "ecat/exchange/acyclic_channel.hpp"
#include "tests/ecat/test_bus.hpp"

namespace taktwerk::ecat::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

/// A slave that exchanges whatever its PDOs carry.
class QuietModel final : public sim::DeviceModel {
public:
    void power_on(sim::ObjectDictionary&, Instant) override {}
    void exchange(Instant) override {}
    void raw_outputs(std::span<const std::byte> outputs) override { got.assign(outputs.begin(), outputs.end()); }
    void raw_inputs(std::span<std::byte> inputs) override {
        for (auto& byte : inputs) byte = std::byte{0xA5};
    }
    std::vector<std::byte> got;
};

/// One slave: `played` is what the simulator is, `told` what the master believes.
void add(TestBus& bus, std::shared_ptr<DeviceDescription> played, std::shared_ptr<DeviceDescription> told,
         std::unique_ptr<sim::DeviceModel> model) {
    SlaveConfig slave;
    slave.name = "x";
    slave.device = std::move(told);
    slave.position = static_cast<std::uint16_t>(bus.config.slaves.size());
    slave.dc = slave.device->dc.required;
    bus.config.slaves.push_back(slave);
    bus.network.add(std::move(played), std::move(model), {});
}

/// A word of a slave's registers, read over the cable by somebody else than the master.
std::uint16_t register_of(TestBus& bus, std::uint16_t position, std::uint16_t address) {
    LoopbackTransport transport{bus.network};
    Exchange exchange{transport};
    AcyclicChannel channel{exchange};
    const auto id = channel.submit(Command::APRD, Address::position(position, address), 2);
    for (int i = 0; i < 5; ++i) {
        exchange.receive(bus.now);
        channel.collect(bus.now);
        channel.pack(bus.now, 1);
        bus.now += 100us;
        bus.network.advance(bus.now);
    }
    const auto answer = channel.poll(*id);
    return answer && answer->wkc == 1 ? load_le<std::uint16_t>(answer->data, 0) : std::uint16_t{0};
}

std::vector<std::string> notes(const TestBus& bus) {
    const auto all = bus.master->notes();
    return {all.begin(), all.end()};
}

ObjectEntry object(std::uint16_t index, std::uint8_t sub, DataType type, Access access, Mappable mappable, std::int64_t value = 0) {
    return {index, sub, "object", type, access, mappable, value, {}, {}, {}};
}

// --- start-up SDOs -----------------------------------------------------------------------------------------------------------

TEST(StartupSdos, OfSafeopAreWrittenAfterSafeopAndBeforeOp) {
    TestBus bus{"s"};
    StartupSdo sdo;
    sdo.at = Transition::SafeopToOp;
    sdo.index = 0x6085;
    sdo.value = 4321;
    bus.config.slaves[0].startup = {sdo};
    bool seen_in_safeop = false;
    bus.on_cycle = [&] {
        const bool written = bus.network.slave(0).dictionary().value(0x6085, 0) == 4321;
        if (written && bus.state(0) == sim::EsmState::safeop) seen_in_safeop = true;
        EXPECT_TRUE(!written || bus.state(0) == sim::EsmState::safeop || bus.state(0) == sim::EsmState::op);
    };
    ASSERT_TRUE(bus.bring_up()) << bus.why();
    EXPECT_TRUE(seen_in_safeop);
    EXPECT_EQ(bus.network.slave(0).dictionary().value(0x6085, 0), 4321);
}

TEST(StartupSdos, ThatAreToBeWrittenIfChangedAreNotWrittenWhereTheyHoldAlready) {
    // 6085h is 100 from the factory. Read-only, a write to it would fail the bring-up: so none was tried.
    TestBus bus{""};
    auto played = servo_description();
    for (auto& o : played->objects)
        if (o.index == 0x6085) o.access = Access::ro;
    add(bus, played, servo_description(), std::make_unique<EchoServo>());
    StartupSdo sdo;
    sdo.index = 0x6085;
    sdo.value = 100;
    sdo.if_changed = true;
    bus.config.slaves[0].startup = {sdo};
    EXPECT_TRUE(bus.bring_up()) << bus.why();
}

TEST(StartupSdos, ThatAreToBeWrittenIfChangedAreWrittenWhereTheyDiffer) {
    TestBus bus{"s"};
    StartupSdo sdo;
    sdo.index = 0x6085;
    sdo.value = 777;
    sdo.if_changed = true;
    bus.config.slaves[0].startup = {sdo};
    ASSERT_TRUE(bus.bring_up()) << bus.why();
    EXPECT_EQ(bus.network.slave(0).dictionary().value(0x6085, 0), 777);
}

// --- identity ----------------------------------------------------------------------------------------------------------------

// Found in real files: EEPROM product 03B11002h, object 1018h 32h. The slave runs, and the difference is a note.
TEST(Identity, ThatDiffersBetweenEepromAndDictionaryIsANoteOnly) {
    TestBus bus{"s"};
    bus.network.slave(0).dictionary().find(0x1018, 2)->set(0x32);
    bus.on_cycle = [&] { bus.network.slave(0).dictionary().find(0x1018, 2)->set(0x32); };
    ASSERT_TRUE(bus.bring_up()) << bus.why();
    EXPECT_THAT(notes(bus), Contains(HasSubstr("EEPROM says product 000C0108h, its object 1018h:02 says 00000032h")));
}

TEST(Identity, ThatAgreesIsNoNote) {
    TestBus bus{"s"};
    ASSERT_TRUE(bus.bring_up()) << bus.why();
    EXPECT_THAT(notes(bus), Not(Contains(HasSubstr("1018h"))));
}

TEST(Identity, OfAnOlderRevisionIsRefusedWhereALeastOneIsAskedFor) {
    TestBus bus{"s"};
    auto device = servo_description();
    device->identity.revision = 0x00010002;
    bus.config.slaves[0].device = device;
    bus.config.slaves[0].revision_rule = RevisionRule::at_least;
    EXPECT_FALSE(bus.bring_up());
    EXPECT_EQ(bus.master->failure().code, "bus.wrong_identity");
    EXPECT_THAT(bus.master->failure().what, HasSubstr("revision 00010002h or later, found"));
}

// --- process data ------------------------------------------------------------------------------------------------------------

/// 3 bits, a gap of 5, 12 bits that do not begin at a byte, out; 1 + 2 bits in.
std::shared_ptr<DeviceDescription> odd_bits() {
    auto d = std::make_shared<DeviceDescription>();
    d->name = "odd";
    d->identity = {0xABC, 0x0DD, 1, 0};
    d->sync_managers = {{SmUse::outputs, 0x1000, 3, 0x44}, {SmUse::inputs, 0x1100, 1, 0x20}};
    d->rx_pdos = {{0x1600, true, {{0x7000, 1, 3}, {0, 0, 2}, {0x7000, 2, 12}}}, {0x1601, true, {{0x7010, 1, 4}}}};
    d->tx_pdos = {{0x1A00, true, {{0x6000, 1, 1}, {0x6000, 2, 2}}}};
    d->rx_assigned = {0x1600, 0x1601};
    d->tx_assigned = {0x1A00};
    return d;
}

// Offsets by hand: 3 bits at 0, gap 3..4, 12 bits at 5, 4 bits at 17; 21 bits, 3 bytes.
TEST(ProcessData, OddBitsAndGapsStandWhereTheMappingPutsThem) {
    TestBus bus{""};
    add(bus, odd_bits(), odd_bits(), std::make_unique<QuietModel>());
    ASSERT_TRUE(bus.bring_up()) << bus.why();
    EXPECT_EQ(bus.master->output(0, 0x7000, 1).value().bit_offset, 0u);
    EXPECT_EQ(bus.master->output(0, 0x7000, 2).value().bit_offset, 5u);
    EXPECT_EQ(bus.master->output(0, 0x7000, 2).value().bits, 12u);
    EXPECT_EQ(bus.master->output(0, 0x7010, 1).value().bit_offset, 17u);

    write_signal(bus.master->outputs(), bus.master->output(0, 0x7000, 2).value(), 0xABC);
    bus.run_for(10ms);
    const auto& got = dynamic_cast<QuietModel&>(bus.network.slave(0).model()).got;
    ASSERT_EQ(got.size(), 3u);
    const auto word = static_cast<unsigned>(got[0]) | (static_cast<unsigned>(got[1]) << 8) | (static_cast<unsigned>(got[2]) << 16);
    EXPECT_EQ((word >> 5) & 0xFFFu, 0xABCu);
}

// The configuration knows the device and none of its process data: the EEPROM says it all.
TEST(ProcessData, OfATerminalIsItsEepromsWhereTheConfigurationHasNone) {
    TestBus bus{""};
    auto told = odd_bits();
    told->rx_pdos.clear(), told->tx_pdos.clear(), told->rx_assigned.clear(), told->tx_assigned.clear();
    told->sync_managers.clear();
    told->sync_manager_count = 8;
    add(bus, odd_bits(), told, std::make_unique<QuietModel>());
    ASSERT_TRUE(bus.bring_up()) << bus.why();
    EXPECT_EQ(bus.master->output(0, 0x7000, 2).value().bit_offset, 5u);
    EXPECT_EQ(bus.master->input(0, 0x6000, 2).value().bit_offset, 1u);
}

TEST(ProcessData, WhoseLayoutIsAnotherInTheEepromIsTheEepromsAndNoted) {
    TestBus bus{""};
    auto told = odd_bits();
    told->tx_pdos[0].entries = {{0x6000, 1, 8}};
    add(bus, odd_bits(), told, std::make_unique<QuietModel>());
    ASSERT_TRUE(bus.bring_up()) << bus.why();
    EXPECT_TRUE(bus.master->input(0, 0x6000, 2).ok());
    EXPECT_THAT(notes(bus), Contains(HasSubstr("inputs are mapped as its EEPROM says (3 bits)")));
}

/// A mailbox for FoE or EoE alone: it must be set up, and nothing can be asked through it.
TEST(ProcessData, OfASlaveWithAMailboxButWithoutCoeComesFromItsEeprom) {
    TestBus bus{""};
    auto d = odd_bits();
    d->mailbox = MailboxDescription{};
    d->mailbox->coe = false;
    d->sync_managers = {{SmUse::mailbox_out, 0x1000, 0x80, 0x26},
                        {SmUse::mailbox_in, 0x1400, 0x80, 0x22},
                        {SmUse::outputs, 0x1800, 3, 0x64},
                        {SmUse::inputs, 0x1C00, 1, 0x20}};
    add(bus, d, d, std::make_unique<QuietModel>());
    bus.start();
    bus.run_until([&] { return bus.state(0) == sim::EsmState::preop || bus.master->phase() == Master::Phase::failed; }, 5s);
    EXPECT_EQ(bus.state(0), sim::EsmState::preop) << bus.why();
}

// --- modules -----------------------------------------------------------------------------------------------------------------

/// Two slots as the TSVM-D6 manual numbers them (5.2.5): objects +800h, PDOs +40h.
std::shared_ptr<DeviceDescription> modular() {
    auto d = servo_description();
    d->dc = {};
    d->rx_pdos.clear(), d->tx_pdos.clear(), d->rx_assigned.clear(), d->tx_assigned.clear();
    d->rx_rules.max_assigned = d->tx_rules.max_assigned = 6;
    d->slots = {2,
                0x800,
                0x40,
                false,
                {{"csp", 0x11, {{0x1600, true, {{0x6040, 0, 16}, {0x607A, 0, 32}}, {}}}, {{0x1A00, true, {{0x6041, 0, 16}}, {}}}}}};
    return d;
}

/// The same slave as its firmware knows it: PDOs of both slots, of which it has none assigned, and the module lists.
std::shared_ptr<DeviceDescription> played_modular(std::int64_t module_in_slot_1) {
    auto d = modular();
    d->slots = {};
    d->rx_pdos = {{0x1600, true, {{0x6040, 0, 16}, {0x607A, 0, 32}}, {}}, {0x1640, true, {{0x6840, 0, 16}, {0x687A, 0, 32}}, {}}};
    d->tx_pdos = {{0x1A00, true, {{0x6041, 0, 16}}, {}}, {0x1A40, true, {{0x6841, 0, 16}}, {}}};
    for (const auto& [index, type, mappable] :
         {std::tuple{0x6840, DataType::U16, Mappable::rx}, std::tuple{0x687A, DataType::I32, Mappable::rx},
          std::tuple{0x6841, DataType::U16, Mappable::tx}})
        d->objects.push_back(object(static_cast<std::uint16_t>(index), 0, type, Access::rw, mappable));
    d->objects.push_back(object(0xF030, 0, DataType::U8, Access::rw, Mappable::no, 2));
    d->objects.push_back(object(0xF030, 1, DataType::U32, Access::rw, Mappable::no));
    d->objects.push_back(object(0xF030, 2, DataType::U32, Access::rw, Mappable::no));
    d->objects.push_back(object(0xF050, 0, DataType::U8, Access::ro, Mappable::no, 2));
    d->objects.push_back(object(0xF050, 1, DataType::U32, Access::ro, Mappable::no, 0x11));
    d->objects.push_back(object(0xF050, 2, DataType::U32, Access::ro, Mappable::no, module_in_slot_1));
    return d;
}

// Slot 0: 6040h 607Ah, slot 1: 6840h 687Ah: 48 bits each, so 687Ah stands at 48 + 16.
TEST(Modules, AreChosenComparedAndMappedSlotBySlot) {
    TestBus bus{""};
    add(bus, played_modular(0x11), modular(), std::make_unique<QuietModel>());
    bus.config.slaves[0].modules = {{0, "csp"}, {1, "csp"}};
    ASSERT_TRUE(bus.bring_up()) << bus.why();
    auto& dictionary = bus.network.slave(0).dictionary();
    EXPECT_EQ(dictionary.value(0xF030, 1), 0x11);
    EXPECT_EQ(dictionary.value(0xF030, 2), 0x11);
    EXPECT_EQ(dictionary.value(0x1C12, 0), 2);
    EXPECT_EQ(dictionary.value(0x1C12, 2), 0x1640);
    EXPECT_EQ(dictionary.value(0x1C13, 2), 0x1A40);
    EXPECT_EQ(bus.master->output(0, 0x687A, 0).value().bit_offset, 64u);
    EXPECT_EQ(bus.master->input(0, 0x6841, 0).value().bit_offset, 16u);
}

TEST(Modules, ThatAreNotThereAreNamedWithTheirSlot) {
    TestBus bus{""};
    add(bus, played_modular(0), modular(), std::make_unique<QuietModel>());
    bus.config.slaves[0].modules = {{0, "csp"}, {1, "csp"}};
    EXPECT_FALSE(bus.bring_up());
    EXPECT_EQ(bus.master->failure().code, "bus.module_mismatch");
    EXPECT_THAT(bus.master->failure().what, HasSubstr("slot 1 holds no module, configured is 'csp' (00000011h)"));
}

// TSVM-D6 5.2.5: each slot has to hold one valid module. The slave knows its slots here, and 0025h / 0024h (ETG.1000.6, invalid output /
// input mapping) is what the simulated one answers: what a real one says is not stated.
std::shared_ptr<DeviceDescription> knows_its_slots() {
    auto d = played_modular(0x11);
    d->rx_pdos.clear(), d->tx_pdos.clear();  // those of the modules, in every slot, come by themselves
    d->slots = modular()->slots;
    return d;
}

TEST(Modules, ASlotWithoutOneIsRefusedByTheSlave) {
    TestBus full{""};
    add(full, knows_its_slots(), modular(), std::make_unique<QuietModel>());
    full.config.slaves[0].modules = {{0, "csp"}, {1, "csp"}};
    ASSERT_TRUE(full.bring_up()) << full.why();

    auto told = modular(), played = knows_its_slots();
    told->slots.modules[0].ident = played->slots.modules[0].ident = 0;  // no comparison of idents: the PDO assignment alone
    TestBus half{""};
    add(half, played, told, std::make_unique<QuietModel>());
    half.config.slaves[0].modules = {{0, "csp"}};
    EXPECT_FALSE(half.bring_up());
    EXPECT_EQ(half.master->failure().code, "bus.refused_state");
    EXPECT_THAT(half.master->failure().what, HasSubstr("0025h"));
    EXPECT_EQ(half.state(0), sim::EsmState::preop);
}

// Outputs in every slot, but the inputs of slot 1 missing.
TEST(Modules, ASlotWithoutInputsIsRefusedToo) {
    auto told = modular(), played = knows_its_slots();
    told->slots.modules[0].ident = played->slots.modules[0].ident = 0;
    ModuleDescription blind = told->slots.modules[0];
    blind.name = "blind";
    blind.tx_pdos.clear();
    told->slots.modules.push_back(blind);
    TestBus bus{""};
    add(bus, played, told, std::make_unique<QuietModel>());
    bus.config.slaves[0].modules = {{0, "csp"}, {1, "blind"}};
    EXPECT_FALSE(bus.bring_up());
    EXPECT_THAT(bus.master->failure().what, HasSubstr("0024h"));
}

// --- watchdogs ---------------------------------------------------------------------------------------------------------------

// 1 ms cycle: 10 ms, 100 ticks; a PDI watchdog of 5 ms: 50 ticks; not configured: as after power-on (1000).
TEST(Watchdogs, AreWrittenFromTheConfiguration) {
    TestBus bus{"ss"};
    bus.config.slaves[1].pdi_watchdog = 5ms;
    ASSERT_TRUE(bus.bring_up()) << bus.why();
    for (std::size_t i = 0; i < 2; ++i) {
        const auto position = static_cast<std::uint16_t>(i);
        EXPECT_EQ(register_of(bus, position, reg::watchdog_divider), 2498u);
        EXPECT_EQ(register_of(bus, position, reg::sm_watchdog_time), 100u);
        EXPECT_EQ(register_of(bus, position, reg::pdi_watchdog_time), i == 0 ? 1000u : 50u);
    }
}

TEST(StateTimeouts, AreTheConfigurations) {
    TestBus bus{""};
    bus.config.slaves = {TestBus{"s"}.config.slaves[0]};
    bus.config.state_timeouts.preop = 50ms;
    sim::SlaveOptions slow;
    slow.transition_time = 400ms;  // longer than it may take
    bus.network.add(servo_description(), std::make_unique<EchoServo>(), slow);
    EXPECT_FALSE(bus.bring_up());
    EXPECT_EQ(bus.master->failure().code, "bus.state_timeout");
    EXPECT_THAT(bus.master->failure().what, HasSubstr("did not reach PREOP within 0.05"));
}

}  // namespace
}  // namespace taktwerk::ecat::test
