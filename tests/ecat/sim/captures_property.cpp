// What real masters were recorded to send, thrown at simulated slaves: nothing breaks, and where the answer does not depend on the
// device, it is the recorded one. The recorded slaves are other devices than ours, so most answers differ; working counters of
// broadcasts and of station addressing do not.

#include <gtest/gtest.h>

#include "ecat/sim/digital_terminal.hpp"
#include "tests/ecat/sim/bus_probe.hpp"
#include "tests/ecat/wire/captures.hpp"

namespace taktwerk::ecat::sim {
namespace {

bool is_ethercat(std::span<const std::byte> packet) {
    return packet.size() >= ethernet_header_size + ecat_header_size && packet[12] == std::byte{0x88} && packet[13] == std::byte{0xA4};
}

/// A request has the source address that its master gave it; in the answer bit 1 of the first byte is set.
bool is_request(std::span<const std::byte> packet) { return (packet[6] & std::byte{0x02}) == std::byte{0}; }

struct Recording {
    const char* file;
    std::size_t slaves;  ///< on the recorded bus: its BRD count
};

class RecordedMaster : public testing::TestWithParam<Recording> {};

TEST_P(RecordedMaster, TalksToSimulatedSlaves) {
    TAKTWERK_SKIP_WITHOUT_CAPTURES();
    const auto packets = test::read_pcapng(test::captures_folder() / GetParam().file);
    BusProbe bus;
    auto description = small_drive();
    description.dc.supported = true;
    for (std::size_t i = 0; i < GetParam().slaves; ++i)
        // The recorded frames follow each other every 0.56 ms; a second AL control in the next frame was not taken yet.
        bus.add_drive({.transition_time = 1ms}, description);

    std::size_t requests = 0, broadcasts = 0;
    std::array<std::byte, max_frame_size> buffer{};
    for (std::size_t i = 0; i + 1 < packets.size(); ++i) {
        const std::span<const std::byte> packet{packets[i]}, answer{packets[i + 1]};
        if (!is_ethercat(packet) || !is_request(packet) || packet.size() > buffer.size()) continue;
        ++requests;
        std::copy(packet.begin(), packet.end(), buffer.begin());
        const std::span<std::byte> frame{buffer.data(), packet.size()};
        const auto flight = bus.network.process(frame, bus.now);
        bus.now += 560us;
        bus.network.advance(bus.now);
        ASSERT_TRUE(flight) << "frame " << i;
        ASSERT_EQ(frame[6] & std::byte{0x02}, std::byte{0x02});

        // A broadcast write that has the recorded answer right behind it is counted by every slave, whatever it is.
        if (!is_ethercat(answer) || is_request(answer)) continue;
        FrameReader ours{frame}, theirs{answer};
        for (auto a = ours.next(), b = theirs.next(); a && b; a = ours.next(), b = theirs.next()) {
            if (a->command != b->command || a->index != b->index || a->command != Command::BWR) continue;
            // Not every recorded slave has a clock, and each has another number of FMMUs and sync managers.
            const auto ado = b->address.ado();
            if (ado >= reg::dc_system_time || (ado >= reg::fmmu_at(1) && ado < reg::dc_receive_times)) continue;
            EXPECT_EQ(a->working_counter(), b->working_counter()) << "frame " << i << ", BWR " << std::hex << b->address.ado();
            EXPECT_EQ(a->address.adp(), b->address.adp());
            ++broadcasts;
        }
    }
    EXPECT_GT(requests, 100u);
    EXPECT_GT(broadcasts, 0u);
    for (std::size_t i = 0; i < bus.network.size(); ++i) {
        const auto state = static_cast<unsigned>(bus.network.slave(i).state());
        EXPECT_TRUE(state == 1 || state == 2 || state == 4 || state == 8);
    }
}

INSTANTIATE_TEST_SUITE_P(Captures, RecordedMaster,
                         testing::Values(Recording{"replay-dc.pcapng", 3}, Recording{"replay-ek1100-el2828-el2889.pcapng", 3},
                                         Recording{"replay-ek1914-segmented-upload.pcapng", 2}, Recording{"soem-dual-lan9252.pcapng", 2},
                                         Recording{"soem-sdinfo-akd.pcapng", 1}));

}  // namespace
}  // namespace taktwerk::ecat::sim
