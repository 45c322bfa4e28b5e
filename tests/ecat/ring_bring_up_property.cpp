// A cable of a ring breaks while the bus comes up: at every cable and all along the bring-up, mended soon, later or not at all. The bus is up then,
// or it says which cable it is; and with the ring whole again it comes up.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "ecat/alarms.hpp"
#include "tests/ecat/test_bus.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::ecat::test {
namespace {

struct RingStart {
    static constexpr std::size_t slaves = 4;
    TestBus bus{"stss"};
    RingStart() { bus.make_ring(); }
    [[nodiscard]] bool up() const { return bus.master->phase() == Master::Phase::operational; }
    [[nodiscard]] bool done() const { return up() || bus.master->phase() == Master::Phase::failed; }
    [[nodiscard]] std::string faults() const {
        std::string out;
        for (const auto& fact : bus.facts()) out += fmt::format("{:x}@{} {}; ", fact.id, fact.index, bus.master->detail(fact));
        return out;
    }
};

/// As the bring-up names it.
std::string place_of(std::size_t cable) {
    if (cable == 0) return "in front of the first slave";
    if (cable == RingStart::slaves) return "behind slave 3";
    return fmt::format("between slave {} and slave {}", cable - 1, cable);
}

TEST(RingBringUps, BearABreakOrNameIt) {
    Duration whole{};
    {
        RingStart plain;
        ASSERT_TRUE(plain.bus.bring_up());
        whole = plain.bus.now.time_since_epoch();
    }
    std::size_t up = 0, named = 0;
    const auto steps = static_cast<int>(property_cases(12));
    for (std::size_t cable = 0; cable <= RingStart::slaves; ++cable)
        for (const Duration mended : {Duration{3ms}, Duration{60ms}, Duration{60s}})
            for (int step = 0; step < steps; ++step) {
                const Duration at = whole * step / steps;
                SCOPED_TRACE(fmt::format("cable {} after {} ms, mended after {} ms", cable, at / 1ms, mended / 1ms));
                RingStart start;
                auto& bus = start.bus;
                bus.start();
                bus.run_for(at);
                bus.set_ring_cable(cable, false);
                if (mended < 1s) {
                    bus.run_for(mended);
                    bus.set_ring_cable(cable, true);
                }
                ASSERT_TRUE(bus.run_until([&] { return start.done(); }, 60s)) << bus.why();
                if (mended > 1s && !start.up()) {
                    ++named;
                    EXPECT_EQ(bus.master->failure().code, "bus.ring_broken");
                    EXPECT_NE(bus.why().find(place_of(cable)), std::string::npos) << bus.why();
                } else if (mended > 1s) {
                    ++up;
                    bus.run_for(500ms);
                    const auto facts = bus.facts();
                    ASSERT_EQ(facts.size(), 1u) << start.faults();
                    EXPECT_EQ(facts.front().id, id(BusAlarm::ring_broken));
                }
                bus.set_ring_cable(cable, true);
                if (!start.up()) {
                    EXPECT_TRUE(bus.bring_up()) << "again: " << bus.why();
                }
                bus.run_for(500ms);
                EXPECT_EQ(start.faults(), "");
                if (testing::Test::HasFailure()) return;
            }
    EXPECT_GT(up, 10u);
    EXPECT_GT(named, 10u);
}

// The ports of all slaves are read one after the other: whatever they say while it breaks, it is the break that is told, and no slave.
TEST(RingBringUps, ABreakWhileTheRingIsMeasuredIsTheBreak) {
    std::size_t named = 0;
    for (std::size_t cable = 0; cable <= RingStart::slaves; ++cable)
        for (Duration at = 50ms; at < 80ms; at += 250us) {
            SCOPED_TRACE(fmt::format("cable {} after {} us", cable, at / 1us));
            RingStart start;
            auto& bus = start.bus;
            bus.start();
            bus.run_for(at);
            bus.set_ring_cable(cable, false);
            ASSERT_TRUE(bus.run_until([&] { return start.done(); }, 60s)) << bus.why();
            if (start.up()) {  // the last cable, when all slaves were a line already: nobody is missing
                bus.run_for(500ms);
                ASSERT_EQ(bus.facts().size(), 1u) << start.faults();
                EXPECT_EQ(bus.facts().front().id, id(BusAlarm::ring_broken));
                continue;
            }
            ++named;
            EXPECT_EQ(bus.master->failure().code, "bus.ring_broken") << bus.why();
            EXPECT_NE(bus.why().find(place_of(cable)), std::string::npos) << bus.why();
            if (testing::Test::HasFailure()) return;
        }
    EXPECT_GT(named, 120 * RingStart::slaves);
}

// Links are up, and one interface takes frames and sends none: nobody's slave is to blame.
TEST(RingBringUps, BlameNoSlaveForAnInterfaceThatSendsNothing) {
    RingStart start;
    auto& bus = start.bus;
    bus.transport.faults.drop_requests = 1'000'000;
    EXPECT_FALSE(bus.bring_up());
    EXPECT_EQ(bus.master->failure().code, "bus.no_frame") << bus.why();
    bus.transport.faults.drop_requests = 0;
    ASSERT_TRUE(bus.bring_up()) << bus.why();
    bus.transport.faults.drop_requests = 1'000'000;
    bus.run_for(500ms);
    ASSERT_EQ(bus.facts().size(), 1u) << start.faults();
    EXPECT_EQ(bus.facts().front().id, id(BusAlarm::frames_lost));
}

}  // namespace
}  // namespace taktwerk::ecat::test
