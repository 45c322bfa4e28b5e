// CoE while the bus is in OP: emergencies, parameters read and written under load, the cycle that must not notice.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "ecat/alarms.hpp"
#include "ecat/wire/frame.hpp"
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
    EXPECT_FALSE(fault(bus, id(BusAlarm::slave_emergency)));

    bus.servo(1).raise({0x7305, 0x21, {}});
    const Instant raised = bus.now;
    bus.run_for(150ms);

    ASSERT_THAT(bus.master->emergencies(), SizeIs(1));
    const auto& entry = bus.master->emergencies()[0];
    EXPECT_EQ(entry.slave, 1u);
    EXPECT_EQ(entry.emergency.code, 0x7305);
    EXPECT_GE(entry.at, raised);
    EXPECT_LE(entry.at, raised + 150ms);
    const auto warned = fault(bus, id(BusAlarm::slave_emergency));
    ASSERT_TRUE(warned);
    EXPECT_EQ(warned->index, 1);
    EXPECT_EQ(warned->a, 0x7305);
    EXPECT_EQ(warned->b, 0x21);
    EXPECT_EQ(find_alarm(bus_alarms, id(BusAlarm::slave_emergency))->reaction, Reaction::warn);
}

TEST(Emergency, TheWarningGoesWhenTheSlaveTakesItBack) {
    TestBus bus{"s"};
    ASSERT_TRUE(bus.bring_up());
    bus.servo(0).raise({0x7305, 0x21, {}});
    bus.run_for(150ms);
    ASSERT_TRUE(fault(bus, id(BusAlarm::slave_emergency)));

    bus.servo(0).raise({0x0000, 0x00, {}});
    bus.run_for(150ms);

    EXPECT_FALSE(fault(bus, id(BusAlarm::slave_emergency)));
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

/// Reads an object of each of the first `slaves` without a pause and counts.
class Readers {
public:
    Readers(TestBus& bus, std::size_t slaves) : bus_(bus), tickets_(slaves), answers_(slaves) {}
    void step() {
        for (std::size_t s = 0; s < tickets_.size(); ++s) {
            if (tickets_[s]) {
                const auto result = bus_.master->poll(*tickets_[s]);
                if (!result) continue;
                ASSERT_TRUE(*result) << result->error().text();
                ASSERT_EQ((*result)->data.size(), 4u);
                ++answers_[s];
            }
            tickets_[s] = bus_.master->upload(s, 0x6085, 0);
        }
    }
    [[nodiscard]] std::size_t least() const { return *std::min_element(answers_.begin(), answers_.end()); }
    [[nodiscard]] std::size_t all() const { return std::accumulate(answers_.begin(), answers_.end(), std::size_t{0}); }

private:
    TestBus& bus_;
    std::vector<std::optional<SdoTicket>> tickets_;
    std::vector<std::size_t> answers_;
};

// The service side runs once a cycle, after send(): what it submits leaves with the next cycle, the answer is back in the one
// after that. Request in cycle 1; the slave answers within 0.2 ms; cycle 2 sees its mailbox full; cycle 3 knows that and fetches
// the message, which is back in cycle 4. The next request is made in cycle 5.
TEST(SdoInOp, AnAnswerTakesFiveCyclesWhereTheStatusIsMapped) {
    TestBus bus{"s"};
    ASSERT_TRUE(bus.bring_up());
    bus.run_for(50ms);
    Readers readers{bus, 1};
    for (int i = 0; i < 500; ++i) {
        readers.step();
        bus.cycle_once();
    }
    EXPECT_GE(readers.all(), 95u) << "100 less what the watch over the slave takes";
}

// Two FMMUs are taken by process data: none is left for the mailbox. Its reading then follows the request in the next frame.
TEST(SdoInOp, ASlaveWithoutASpareFmmuIsReadWithoutAskingForItsStatus) {
    TestBus bus{"s"};
    auto description = servo_description();
    description->fmmus = 2;
    bus.network.add(description, std::make_unique<EchoServo>(), {});
    bus.config.slaves.push_back(bus.config.slaves[0]);
    bus.config.slaves[1].name = "b";
    bus.config.slaves[1].device = description;
    bus.config.slaves[1].position = std::uint16_t{1};
    ASSERT_TRUE(bus.bring_up()) << bus.why();
    bus.run_for(50ms);
    std::size_t answers = 0;
    std::optional<SdoTicket> ticket;
    for (int i = 0; i < 500; ++i) {
        if (!ticket) ticket = bus.master->upload(1, 0x6085, 0);
        bus.cycle_once();
        if (const auto result = bus.master->poll(*ticket)) {
            ASSERT_TRUE(*result) << result->error().text();
            ++answers;
            ticket.reset();
        }
    }
    EXPECT_GE(answers, 95u);

    bus.servo(1).raise({0x7305, 0x21, {}});
    bus.run_for(150ms);
    EXPECT_THAT(bus.master->emergencies(), SizeIs(1)) << "asked every 100 ms";
}

// Eight drives, each read without a pause: 20 s of machine time. Every cycle every slave exchanges its process data with the right
// working counter, and never more acyclic datagrams leave than a cycle grants.
TEST(SdoInOp, EightSlavesReadWithoutPauseDoNotTouchTheCycle) {
    TestBus bus{"ssssssss"};
    ASSERT_TRUE(bus.bring_up()) << bus.why();
    bus.run_for(50ms);
    struct Count {
        std::size_t now = 0, most = 0, all = 0;
    } acyclic;
    bus.master->set_tap(
        [](void* context, std::span<const std::byte> frame, Instant, bool outgoing) noexcept {
            if (!outgoing) return;
            auto& count = *static_cast<Count*>(context);
            FrameReader reader{frame};
            while (const auto datagram = reader.next()) {
                const bool addressed = datagram->command == Command::FPRD || datagram->command == Command::FPWR ||
                                       datagram->command == Command::APRD || datagram->command == Command::APWR;
                if (addressed) ++count.now;
            }
        },
        &acyclic);
    Readers readers{bus, 8};
    const auto errors_before = bus.master->statistics().working_counter_errors;

    for (int i = 0; i < 20'000; ++i) {
        readers.step();
        acyclic.now = 0;
        bus.cycle_once();
        acyclic.most = std::max(acyclic.most, acyclic.now);
        acyclic.all += acyclic.now;
        for (std::size_t s = 0; s < 8; ++s) ASSERT_TRUE(bus.master->health(s).fresh) << "slave " << s << " in cycle " << i;
        if (HasFatalFailure()) return;
    }

    EXPECT_EQ(bus.master->statistics().working_counter_errors, errors_before);
    EXPECT_EQ(bus.master->statistics().frames_lost, 0u);
    EXPECT_EQ(acyclic.most, bus.config.acyclic_per_cycle);
    EXPECT_GE(readers.all(), 31'000u) << "eight slaves, one answer in five cycles each: 32,000 less the watch over them";
    EXPECT_GE(readers.least(), readers.all() / 8 * 9 / 10) << "nobody starves";
}

}  // namespace
}  // namespace taktwerk::ecat::test
