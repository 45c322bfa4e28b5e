// What goes wrong when groups come and go is named by cause and place, and nobody else is accused.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/bytes.hpp"
#include "ecat/alarms.hpp"
#include "ecat/wire/mapping_units.hpp"
#include "ecat/wire/registers.hpp"
#include "tests/ecat/hot_connect_bus.hpp"

namespace taktwerk::ecat::test {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class HotConnectTroubles : public ::testing::Test {
protected:
    /// Operational, with the tool away.
    void start() {
        bus_.plug(false);
        ASSERT_TRUE(bus_.bring_up()) << bus_.why();
        bus_.run_for(200ms);
        ASSERT_THAT(bus_.faults(), IsEmpty());
    }
    /// The one thing that is said within two seconds: the text behind it.
    [[nodiscard]] std::string told(BusAlarm alarm) {
        std::string text;
        bus_.run_until(
            [&] {
                for (const auto& fact : bus_.facts())
                    if (fact.id == id(alarm)) text = bus_.master->detail(fact);
                return !text.empty();
            },
            2s);
        bus_.run_for(300ms);
        EXPECT_THAT(bus_.faults(), AllOf(::testing::SizeIs(1), Each(id(alarm)))) << ::testing::PrintToString(bus_.master->notes());
        return text;
    }
    void expect_all_well() {
        for (std::size_t slave = 0; slave < 3; ++slave) EXPECT_TRUE(bus_.master->health(slave).fresh) << slave;
    }

    /// By another controller, at the slave in this place of the cable.
    std::vector<std::byte> by_another(Command command, std::uint16_t place, std::uint16_t address, std::vector<std::uint8_t> bytes) {
        std::array<std::byte, min_frame_size> buffer{};
        FrameBuilder builder{buffer, MacAddress{0x00, 0x11, 0x22, 0x33, 0x44, 0x55}};
        const auto data = builder.add(command, 0x40, Address::position(place, address), bytes.size());
        for (std::size_t i = 0; i < bytes.size(); ++i) data[i] = std::byte{bytes[i]};
        const auto at = static_cast<std::size_t>(data.data() - buffer.data());
        (void)builder.finish();
        (void)bus_.network.process(buffer, bus_.now);
        return {buffer.begin() + static_cast<std::ptrdiff_t>(at), buffer.begin() + static_cast<std::ptrdiff_t>(at + bytes.size())};
    }
    void write(std::uint16_t place, std::uint16_t address, std::vector<std::uint8_t> bytes) {
        (void)by_another(Command::APWR, place, address, std::move(bytes));
    }
    /// The FMMU that maps the inputs of 'b'.
    Fmmu read_fmmu_of_b() {
        for (unsigned n = 0; n < 8; ++n) {
            const auto bytes = by_another(Command::APRD, 1, reg::fmmu_at(n), std::vector<std::uint8_t>(Fmmu::size));
            const auto fmmu = decode_fmmu(std::span<const std::byte, Fmmu::size>{bytes});
            if (fmmu.active && fmmu.read) return fmmu;
        }
        return {};
    }

    HotConnectBus bus_;
};

TEST_F(HotConnectTroubles, AStrangerIsNamedAndLeftAlone) {
    auto& stranger = bus_.network.add_behind(bus_.network.slave(2), 1, terminal_description(), std::make_unique<InvertingTerminal>());
    bus_.network.set_cable(stranger, false);
    start();
    bus_.plug(stranger, true);
    EXPECT_THAT(told(BusAlarm::stranger_plugged_in),
                AllOf(HasSubstr("at place 3 of the cable"), HasSubstr("vendor 00000ABCh product 00000808h")));
    expect_all_well();
    bus_.plug(true);  // the tool joins beside it
    ASSERT_TRUE(bus_.joins()) << ::testing::PrintToString(bus_.master->notes());
    bus_.plug(stranger, false);
    bus_.run_for(300ms);
    EXPECT_THAT(bus_.faults(), IsEmpty());
    EXPECT_EQ(bus_.presence(), GroupPresence::present);
}

TEST_F(HotConnectTroubles, ASecondToolWithTheSameNumberLeavesTheFirstInOperation) {
    auto& second = bus_.add_tool(bus_.network.slave(2), 1, tool_alias);
    bus_.network.set_cable(second, false);
    start();
    bus_.plug(true);
    ASSERT_TRUE(bus_.joins());
    bus_.plug(second, true);
    EXPECT_THAT(told(BusAlarm::group_does_not_join),
                AllOf(HasSubstr("slave 'd' (dio8) of group 'tool'"), HasSubstr("it is in operation, and another slave with alias 100"),
                      HasSubstr("unplug one of them")));
    EXPECT_EQ(bus_.presence(), GroupPresence::present);
    expect_all_well();
    bus_.plug(second, false);
    bus_.run_for(300ms);
    EXPECT_THAT(bus_.faults(), IsEmpty());
    EXPECT_EQ(bus_.presence(), GroupPresence::present);
}

TEST_F(HotConnectTroubles, TwoToolsWithOneNumberAtOnce) {
    auto& second = bus_.add_tool(bus_.network.slave(2), 1, tool_alias);
    bus_.network.set_cable(second, false);
    start();
    bus_.plug(true);
    bus_.plug(second, true);
    EXPECT_THAT(told(BusAlarm::group_does_not_join), HasSubstr("alias 100 is set in two slaves, at places 3 and 5 of the cable"));
    EXPECT_EQ(bus_.presence(), GroupPresence::absent);
    bus_.plug(second, false);
    EXPECT_TRUE(bus_.joins()) << ::testing::PrintToString(bus_.master->notes());
    bus_.run_for(10ms);
    EXPECT_THAT(bus_.faults(), IsEmpty());
}

TEST_F(HotConnectTroubles, TheRightNumberOnAnotherDevice) {
    sim::SlaveOptions options;
    options.alias = tool_alias;
    auto& wrong = bus_.network.add_behind(bus_.network.slave(2), 1, servo_description(), std::make_unique<EchoServo>(), options);
    bus_.network.set_cable(wrong, false);
    start();
    bus_.plug(wrong, true);
    EXPECT_THAT(told(BusAlarm::group_does_not_join), AllOf(HasSubstr("slave 'd' (dio8) of group 'tool'"),
                                                           HasSubstr("expected vendor 00000ABCh"), HasSubstr("found vendor 000007FBh")));
    EXPECT_EQ(bus_.presence(), GroupPresence::absent);
    expect_all_well();
}

TEST_F(HotConnectTroubles, AGroupThatIsNotCompleteSaysWhoIsMissingAndJoinsWhenItIs) {
    start();
    bus_.network.set_cable(bus_.tool_servo_slave(), false);
    bus_.plug(true);
    EXPECT_THAT(told(BusAlarm::group_does_not_join),
                AllOf(HasSubstr("1 of its 2 slaves are there"), HasSubstr("behind 'd' stands nobody, where 'e' (sv33-e) is configured")));
    bus_.network.set_cable(bus_.tool_servo_slave(), true);
    EXPECT_TRUE(bus_.joins()) << ::testing::PrintToString(bus_.master->notes());
    bus_.run_for(10ms);
    EXPECT_THAT(bus_.faults(), IsEmpty());
}

TEST_F(HotConnectTroubles, AGroupThatRefusesAStateSaysWhyAndIsTriedAgain) {
    bus_.tool_servo_slave().refuse_state(sim::EsmState::safeop, 0x001E);
    start();
    bus_.plug(true);
    EXPECT_THAT(told(BusAlarm::group_does_not_join), AllOf(HasSubstr("slave 'e' (sv33-e) of group 'tool'"), HasSubstr("001Eh")));
    expect_all_well();
    bus_.tool_servo_slave().refuse_state(sim::EsmState::safeop, 0);
    EXPECT_TRUE(bus_.joins(10s)) << ::testing::PrintToString(bus_.master->notes());
    bus_.run_for(10ms);
    EXPECT_THAT(bus_.faults(), IsEmpty());
}

TEST_F(HotConnectTroubles, APlugThatBouncesHarmsNobody) {
    start();
    std::vector<AlarmId> said;
    int missed = 0;
    bus_.on_cycle = [&] {
        for (const auto alarm : bus_.faults()) said.push_back(alarm);
        for (std::size_t slave = 0; slave < 3; ++slave)
            missed += bus_.master->statistics().lost_in_a_row == 0 && !bus_.master->health(slave).fresh ? 1 : 0;
    };
    for (int i = 0; i < 60; ++i) {
        bus_.plug(i % 2 == 0);
        bus_.run_for(std::chrono::milliseconds{3 + 7 * (i % 23)});
    }
    EXPECT_EQ(bus_.presence(), GroupPresence::absent);
    bus_.plug(true);
    EXPECT_TRUE(bus_.joins()) << ::testing::PrintToString(bus_.master->notes());
    EXPECT_THAT(said, IsEmpty()) << ::testing::PrintToString(bus_.master->notes());
    EXPECT_EQ(missed, 0);
}

// A tool that was in operation elsewhere, and kept its power: its FMMU maps its inputs to where those of 'b' are.
TEST_F(HotConnectTroubles, WhoStillTakesPartInSomebodysProcessDataIsToldAndNotWhoSuffersByIt) {
    start();
    auto mine = read_fmmu_of_b();
    ASSERT_TRUE(mine.active);
    mine.physical_start = 0x1F00;  // memory of no sync manager: readable in every state
    bus_.network.set_cable(bus_.tool(), true);
    std::vector<std::byte> fmmu(Fmmu::size);
    encode(mine, std::span<std::byte, Fmmu::size>{fmmu});
    std::vector<std::uint8_t> bytes;
    for (const auto byte : fmmu) bytes.push_back(std::to_integer<std::uint8_t>(byte));
    write(3, reg::fmmu_at(0), bytes);
    bus_.network.set_cable(bus_.tool(), false);
    bus_.run_for(50ms);
    ASSERT_THAT(bus_.faults(), IsEmpty());

    std::vector<AlarmId> said;
    bus_.on_cycle = [&] {
        for (const auto alarm : bus_.faults()) said.push_back(alarm);
    };
    bus_.plug(true);
    EXPECT_TRUE(bus_.joins()) << ::testing::PrintToString(bus_.master->notes());
    EXPECT_THAT(said, AllOf(::testing::Not(IsEmpty()), Each(id(BusAlarm::newcomer_takes_part))));
    bus_.run_for(100ms);
    EXPECT_THAT(bus_.faults(), IsEmpty());
    expect_all_well();
}

}  // namespace
}  // namespace taktwerk::ecat::test
