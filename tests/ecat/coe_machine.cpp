// CoE while the bus is in OP: emergencies, parameters read and written under load, the cycle that must not notice.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ecat/alarms.hpp"
#include "tests/ecat/test_bus.hpp"

namespace taktwerk::ecat::test {
namespace {

using ::testing::SizeIs;

std::optional<AlarmFact> fault(const TestBus& bus, AlarmId id) {
    std::array<AlarmFact, 32> facts;
    const std::size_t count = bus.master->active_faults(facts);
    const auto it = std::find_if(facts.begin(), facts.begin() + count, [&](const AlarmFact& fact) { return fact.id == id; });
    return it == facts.begin() + count ? std::nullopt : std::optional{*it};
}

// Nobody asks the drive anything; it sends 7305h (encoder), register 21h. Within 150 ms it is known, with its slave and its time.
TEST(Emergency, IsReadThoughNobodyAskedAndWarns) {
    TestBus bus{"ss"};
    ASSERT_TRUE(bus.bring_up()) << bus.why();
    bus.run_for(100ms);
    EXPECT_FALSE(fault(bus, alarm::slave_emergency));

    bus.servo(1).raise({0x7305, 0x21, {}});
    const Instant raised = bus.now;
    bus.run_for(150ms);

    ASSERT_THAT(bus.master->emergencies(), SizeIs(1));
    const auto& entry = bus.master->emergencies()[0];
    EXPECT_EQ(entry.slave, 1u);
    EXPECT_EQ(entry.emergency.code, 0x7305);
    EXPECT_GE(entry.at, raised);
    EXPECT_LE(entry.at, raised + 150ms);
    const auto warned = fault(bus, alarm::slave_emergency);
    ASSERT_TRUE(warned);
    EXPECT_EQ(warned->index, 1);
    EXPECT_EQ(warned->a, 0x7305);
    EXPECT_EQ(warned->b, 0x21);
    EXPECT_EQ(find_alarm(bus_alarms, alarm::slave_emergency)->reaction, Reaction::warn);
}

TEST(Emergency, TheWarningGoesWhenTheSlaveTakesItBack) {
    TestBus bus{"s"};
    ASSERT_TRUE(bus.bring_up());
    bus.servo(0).raise({0x7305, 0x21, {}});
    bus.run_for(150ms);
    ASSERT_TRUE(fault(bus, alarm::slave_emergency));

    bus.servo(0).raise({0x0000, 0x00, {}});
    bus.run_for(150ms);

    EXPECT_FALSE(fault(bus, alarm::slave_emergency));
    EXPECT_THAT(bus.master->emergencies(), SizeIs(2)) << "both stay in the list";
}

// A drive that sends more than its mailbox holds: one after the other, none lost, while a program reads it.
TEST(Emergency, ComeBetweenRequestsAndAnswersOfAProgram) {
    TestBus bus{"s"};
    ASSERT_TRUE(bus.bring_up());
    std::size_t read = 0;
    std::optional<SdoTicket> ticket;
    for (std::uint16_t n = 1; n <= 20; ++n) {
        bus.servo(0).raise({static_cast<std::uint16_t>(0x1000 + n), 1, {}});
        for (int i = 0; i < 20; ++i) {
            if (!ticket) ticket = bus.master->upload(0, 0x6085, 0);
            bus.cycle_once();
            if (const auto result = bus.master->poll(*ticket)) {
                ASSERT_TRUE(*result) << result->error().text();
                ++read;
                ticket.reset();
            }
        }
    }
    bus.run_for(100ms);

    ASSERT_THAT(bus.master->emergencies(), SizeIs(20));
    for (std::uint16_t n = 1; n <= 20; ++n) EXPECT_EQ(bus.master->emergencies()[n - 1u].emergency.code, 0x1000 + n);
    EXPECT_GT(read, 20u);
}

// How long one answer takes in OP, counted in cycles from upload() to poll(). The service side runs once a cycle, after send().
TEST(SdoInOp, OneAnswerTakesFewCycles) {
    TestBus bus{"s"};
    ASSERT_TRUE(bus.bring_up());
    bus.run_for(50ms);
    int cycles = 0;
    for (int n = 0; n < 20; ++n) {
        const auto ticket = bus.master->upload(0, 0x6085, 0);
        for (;;) {
            bus.cycle_once();
            ++cycles;
            if (const auto result = bus.master->poll(ticket)) {
                ASSERT_TRUE(*result);
                break;
            }
        }
    }
    EXPECT_LE(cycles, 20 * 7);
    RecordProperty("cycles_for_20", cycles);
    std::printf("%d cycles for 20 answers\n", cycles);
}

}  // namespace
}  // namespace taktwerk::ecat::test
