// A whole bus over a real cable, by every door of the kernel: the master's frames go out at one end of a veth pair, simulated slaves answer at the
// other. Time is virtual; only the frames' way is real. Needs a network of its own.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "core/guard/allocation_guard.hpp"
#include "ecat/alarms.hpp"
#include "tests/ecat/test_bus.hpp"
#include "tests/ecat/transport/doors.hpp"

namespace taktwerk::ecat::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// What the master sends crosses the cable, runs through the slaves and crosses it again before send() returns; what it receives is what came
/// back. A veth pair delivers in a context of the kernel's own, so both ends wait for what is under way.
class AcrossTheCable final : public Transport {
public:
    AcrossTheCable(Transport& master, RawSocketTransport& far, sim::SimNetwork& slaves) : master_(master), far_(far), slaves_(slaves) {}

    bool send(std::span<const std::byte> frame, Instant now) noexcept override {
        if (!master_.send(frame, now)) return false;
        slaves_.advance(now);
        std::array<std::byte, max_frame_size> there{};
        const auto arrived = awaited(far_, there, now);
        if (!arrived) return true;  // the cable was out at the far end
        const auto bytes = std::span{there}.first(arrived->size);
        if (slaves_.process(bytes, now) && far_.send(bytes, now)) ++under_way_;
        return true;
    }
    std::optional<ReceivedFrame> receive(std::span<std::byte> buffer, Instant now) noexcept override {
        slaves_.advance(now);
        if (under_way_ == 0) return master_.receive(buffer, now);
        --under_way_;
        return awaited(master_, buffer, now);
    }
    [[nodiscard]] MacAddress mac() const noexcept override { return master_.mac(); }
    [[nodiscard]] bool link_up() const noexcept override { return master_.link_up(); }

private:
    static std::optional<ReceivedFrame> awaited(Transport& by, std::span<std::byte> buffer, Instant now) noexcept {
        const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds{1};
        do {
            if (auto received = by.receive(buffer, now)) return received;
            std::this_thread::yield();
        } while (std::chrono::steady_clock::now() < patience && by.link_up());
        return std::nullopt;
    }
    Transport& master_;
    RawSocketTransport& far_;
    sim::SimNetwork& slaves_;
    std::uint32_t under_way_ = 0;
};

struct BusByDoor : ::testing::TestWithParam<Door> {
    void SetUp() override {
        if (!veth_network().empty()) GTEST_SKIP() << veth_network();
        ASSERT_TRUE(lay_veth_pair());
        door = open_door(GetParam());
        if (not_to_be_had(door)) GTEST_SKIP() << door.why;
        ASSERT_EQ(door.why, "");
        auto other = RawSocketTransport::open("ecat1");
        ASSERT_TRUE(other.ok()) << other.error().text();
        far = std::move(*other);
        ASSERT_TRUE(link_becomes(true));
        cable.emplace(door.transport(), *far, bus.network);
        bus.master = std::make_unique<Master>(*cable, bus.config);
        ASSERT_TRUE(bus.bring_up()) << bus.why();
        bus.run_for(200ms);
        ASSERT_THAT(bus.faults(), IsEmpty());
    }
    bool link_becomes(bool up) {
        for (int i = 0; i < 1000; ++i) {
            door.refresh();
            far->refresh();
            if (door.transport().link_up() == up && far->link_up() == up) return true;
            std::this_thread::sleep_for(1ms);
        }
        return false;
    }
    /// All of them exchanged in the cycle that was last, and nothing to complain about.
    bool well() {
        for (std::size_t i = 0; i < bus.config.slaves.size(); ++i)
            if (bus.state(i) != sim::EsmState::op || !bus.master->health(i).fresh) return false;
        return bus.faults().empty();
    }

    TestBus bus{"sts"};
    OpenDoor door;
    std::unique_ptr<RawSocketTransport> far;
    std::optional<AcrossTheCable> cable;
};
INSTANTIATE_TEST_SUITE_P(Doors, BusByDoor, every_door(), door_name);

TEST_P(BusByDoor, ReachesOpAndLosesNothing) {
    const auto& seen = bus.master->statistics();
    const auto sent = seen.frames_sent;
    bus.run_for(1s);
    EXPECT_GE(seen.frames_sent - sent, 1000u);
    EXPECT_EQ(seen.frames_lost, 0u);
    EXPECT_EQ(seen.send_errors, 0u);
    EXPECT_EQ(seen.working_counter_errors, 0u);
    EXPECT_EQ(seen.frames_foreign, 0u);
    EXPECT_TRUE(well());

    write_signal(bus.master->outputs(), bus.master->output(1, 0x7000, 3).value(), 1);  // the terminal answers with the opposite
    bus.run_for(3ms);
    EXPECT_EQ(read_signal(bus.master->inputs(), bus.master->input(1, 0x6000, 3).value()), 0);
    EXPECT_EQ(read_signal(bus.master->inputs(), bus.master->input(1, 0x6000, 4).value()), 1);
    door.refresh();
    if (door.xdp) {
        EXPECT_EQ(door.xdp->passed_by(), 0u);
    }
}

TEST_P(BusByDoor, LostFramesAreAnAlarmFromTheLimitOnAndComeBack) {
    bus.network.lose_frames(2);
    bus.run_for(20ms);
    EXPECT_THAT(bus.faults(), IsEmpty()) << "the limit is three in a row";
    EXPECT_EQ(bus.master->statistics().frames_lost, 2u);
    bus.network.lose_frames(30);
    EXPECT_TRUE(bus.run_until([&] { return !bus.faults().empty(); }, 20ms));
    EXPECT_THAT(bus.faults(), ElementsAre(id(BusAlarm::frames_lost)));
    EXPECT_TRUE(bus.run_until([&] { return well(); }, 10s)) << bus.why();
}

TEST_P(BusByDoor, AnUnpluggedCableIsNoLinkAndPluggedInAgainTheBusIsBack) {
    for (const char* end : {"ecat1", "ecat0"}) {
        ASSERT_TRUE(shell(std::string{"ip link set "} + end + " down"));
        ASSERT_TRUE(link_becomes(false)) << end;
        bus.run_for(20ms);
        EXPECT_THAT(bus.faults(), ElementsAre(id(BusAlarm::link_down))) << end;
        EXPECT_GT(bus.master->statistics().send_errors, 0u);
        ASSERT_TRUE(shell(std::string{"ip link set "} + end + " up"));
        ASSERT_TRUE(link_becomes(true)) << end;
        EXPECT_TRUE(bus.run_until([&] { return well(); }, 10s)) << end << ": " << bus.why();
    }
}

TEST_P(BusByDoor, APortThatIsRenamedOrGoneInOperationIsNoLink) {
    ASSERT_TRUE(shell("ip link set ecat0 down && ip link set ecat0 name enp3s0"));
    ASSERT_TRUE(link_becomes(false));
    bus.run_for(20ms);
    EXPECT_THAT(bus.faults(), ElementsAre(id(BusAlarm::link_down)));
    ASSERT_TRUE(shell("ip link del enp3s0"));
    door.refresh();
    bus.run_for(1s);
    EXPECT_THAT(bus.faults(), ElementsAre(id(BusAlarm::link_down)));
}

TEST_P(BusByDoor, ACycleTouchesNoHeap) {
    std::uint64_t used = 0;
    for (int i = 0; i < 100; ++i) {
        bus.now += bus.config.cycle + bus.master->period_correction();
        {
            const NoAllocationScope heap;
            bus.master->receive(bus.now);
            bus.master->send(bus.now);
            used += heap.used().total();
        }
        bus.master->step(bus.now);
    }
    EXPECT_EQ(used, 0u);
    EXPECT_TRUE(well());
}

}  // namespace
}  // namespace taktwerk::ecat::test
