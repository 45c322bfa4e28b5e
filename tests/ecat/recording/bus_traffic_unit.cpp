// Who speaks on a cable: frames made here, and a recording of another make of master.

#include "ecat/recording/bus_traffic.hpp"

#include <gmock/gmock.h>

#include <array>
#include <vector>

#include "core/bytes.hpp"
#include "tests/ecat/wire/captures.hpp"

namespace taktwerk::ecat {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::Pair;
using testing::SizeIs;

constexpr MacAddress ours{0x00, 0x11, 0x22, 0x33, 0x44, 0x55}, theirs{0x08, 0, 0, 0, 0, 1}, local{0x02, 0, 0, 0, 0, 7};

using Bytes = std::vector<std::byte>;

/// BRD of 0130h and LRW of eight bytes.
Bytes frame(const MacAddress& source) {
    std::array<std::byte, max_frame_size> buffer{};
    FrameBuilder builder{buffer, source};
    (void)builder.add(Command::BRD, 1, Address::physical(0, 0x0130), 2);
    (void)builder.add(Command::LRW, 2, Address::logical(0x10000), 8);
    const auto bytes = builder.finish();
    return {bytes.begin(), bytes.end()};
}

/// As three slaves give it back, of which the process data concern `exchanged`.
Bytes answer(Bytes bytes, std::uint16_t exchanged) {
    bytes[6] |= std::byte{0x02};
    FrameEditor editor{bytes};
    const auto state = editor.next();
    store_le(state->header, 2, std::uint16_t{3});
    store_le(state->wkc, 0, std::uint16_t{3});
    store_le(editor.next()->wkc, 0, exchanged);
    return bytes;
}

TEST(BusTraffic, TellsWhatWasSentWhatCameBackAndWithWhichCounters) {
    BusTraffic traffic;
    for (int i = 0; i < 10; ++i) {
        const Instant at = Instant{} + i * 1ms + (i == 4 ? 200us : 0us);
        traffic.note(frame(ours), at, true);
        if (i != 7) traffic.note(answer(frame(ours), i == 5 ? 2 : 3), at + 30us, false);
    }
    EXPECT_EQ(traffic.frames(), 19u);
    ASSERT_THAT(traffic.masters(), SizeIs(1)) << "a mark of a slave makes no other master";
    const auto& master = traffic.masters()[0];
    EXPECT_EQ(master.address, ours);
    EXPECT_EQ(master.sent, 10u);
    EXPECT_EQ(master.back, 9u);
    EXPECT_EQ(master.sending.cycles, 9u);
    EXPECT_EQ(master.sending.shortest, 800us);
    EXPECT_EQ(master.sending.longest, 1200us);
    EXPECT_EQ(master.sending.last - master.sending.first, 9ms);
    ASSERT_THAT(master.datagrams, SizeIs(2)) << "the incremented address makes no other kind";
    EXPECT_EQ(master.datagrams[0].command, Command::BRD);
    EXPECT_THAT(master.datagrams[0].working_counters, ElementsAre(Pair(3, 9)));
    EXPECT_EQ(master.datagrams[1].command, Command::LRW);
    EXPECT_EQ(master.datagrams[1].address.raw, 0x10000u);
    EXPECT_EQ(master.datagrams[1].size, 8u);
    EXPECT_EQ(master.datagrams[1].sent, 10u);
    EXPECT_THAT(master.datagrams[1].working_counters, ElementsAre(Pair(2, 1), Pair(3, 8)));
}

TEST(BusTraffic, FramesOfOneCycleAreOneCycle) {
    BusTraffic traffic;
    for (int i = 0; i < 5; ++i)
        for (int k = 0; k < 3; ++k) traffic.note(frame(ours), Instant{} + i * 1ms + k * 20us, true);
    EXPECT_EQ(traffic.masters()[0].sent, 15u);
    EXPECT_EQ(traffic.masters()[0].cycle().cycles, 4u);
    EXPECT_EQ(traffic.masters()[0].cycle().shortest, 1ms);
    EXPECT_EQ(traffic.masters()[0].cycle().longest, 1ms);
}

// At a tap nothing leaves: a slave's mark tells the two directions apart. A second master is told from the first.
TEST(BusTraffic, AtATapAndWithTwoMasters) {
    BusTraffic traffic;
    for (int i = 0; i < 4; ++i) {
        traffic.note(frame(theirs), Instant{} + i * 2ms, false);
        traffic.note(answer(frame(theirs), 3), Instant{} + i * 2ms + 50us, false);
        traffic.note(frame(local), Instant{} + i * 2ms + 1ms, true);
        traffic.note(answer(frame(local), 3), Instant{} + i * 2ms + 1050us, false);
    }
    ASSERT_THAT(traffic.masters(), SizeIs(2));
    for (const auto& master : traffic.masters()) {
        EXPECT_EQ(master.sent, 4u);
        EXPECT_EQ(master.back, 4u);
        EXPECT_EQ(master.sending.shortest, 2ms);
    }
    EXPECT_EQ(traffic.masters()[0].address, theirs);
    EXPECT_EQ(traffic.masters()[1].address, local);
}

TEST(BusTraffic, OfAMasterThatIsNotHeardSendingTheCycleIsThatOfItsAnswers) {
    BusTraffic traffic;
    for (int i = 0; i < 5; ++i) traffic.note(answer(frame(ours), 3), Instant{} + i * 4ms, false);
    const auto& master = traffic.masters()[0];
    EXPECT_EQ(master.sent, 0u);
    EXPECT_EQ(master.back, 5u);
    EXPECT_EQ(master.cycle().cycles, 4u);
    EXPECT_EQ(master.cycle().longest, 4ms);
}

TEST(BusTraffic, AnyBytesAreSafeAndCounted) {
    BusTraffic traffic;
    const auto whole = frame(ours);
    for (std::size_t size = 0; size < whole.size(); ++size) traffic.note(std::span{whole}.first(size), Instant{}, true);
    EXPECT_EQ(traffic.others(), 14u) << "without a sender";
    EXPECT_EQ(traffic.masters()[0].damaged, 2u + 14u + 20u) << "cut in the head or in a datagram; without padding it is whole";
    for (int i = 0; i < 1000; ++i) {
        MacAddress any{};
        any[4] = static_cast<std::uint8_t>(i >> 8), any[5] = static_cast<std::uint8_t>(i);
        traffic.note(frame(any), Instant{}, true);
    }
    EXPECT_THAT(traffic.masters(), SizeIs(BusTraffic::most_masters));
    EXPECT_EQ(traffic.others(), 14u + 1000u - (BusTraffic::most_masters - 1));
}

TEST(BusTraffic, ARecordingOfAnotherMaster) {
    TAKTWERK_SKIP_WITHOUT_CAPTURES();
    BusTraffic traffic;
    Instant at{};
    for (const auto& packet : test::read_pcapng(test::captures_folder() / "replay-dc.pcapng")) traffic.note(packet, at += 100us, false);
    EXPECT_EQ(traffic.frames(), 3604u);
    ASSERT_GE(traffic.masters().size(), 1u);
    std::uint64_t counted = traffic.others();
    for (const auto& master : traffic.masters()) {
        counted += master.sent + master.back;
        EXPECT_EQ(master.damaged, 0u);
        EXPECT_FALSE(master.datagrams.empty());
    }
    EXPECT_EQ(counted, 3604u) << "each frame went one way";
}

}  // namespace
}  // namespace taktwerk::ecat
