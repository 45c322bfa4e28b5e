// Receive times that real slaves latched for other masters: our delays are those that SOEM and ethercrab wrote to 0928h.

#include <gtest/gtest.h>

#include <cstdlib>
#include <map>

#include "core/bytes.hpp"
#include "ecat/dc/propagation.hpp"
#include "ecat/wire/frame.hpp"
#include "ecat/wire/registers.hpp"
#include "tests/ecat/wire/captures.hpp"

namespace taktwerk::ecat {
namespace {

struct RecordedClock {
    std::uint16_t dl_status = 0;
    LatchedTimes latched;
    std::optional<std::uint32_t> delay;  ///< as the other master computed it
};

std::map<std::uint16_t, RecordedClock> recorded_clocks(const std::filesystem::path& file) {
    std::map<std::uint16_t, RecordedClock> clocks;  // by station, which is the order of the cable
    for (const auto& packet : test::read_pcapng(file)) {
        FrameReader reader{packet};
        while (const auto datagram = reader.next()) {
            if (datagram->working_counter() != 1) continue;
            auto& clock = clocks[datagram->address.adp()];
            const auto ado = datagram->address.ado();
            const auto& data = datagram->data;
            if (datagram->command == Command::FPRD && ado == reg::dl_status && data.size() >= 2)
                clock.dl_status = load_le<std::uint16_t>(data);
            if (datagram->command == Command::FPRD && ado >= reg::dc_receive_times && ado < reg::dc_system_time)
                for (std::size_t at = 0; at + 4 <= data.size(); at += 4)
                    clock.latched.port.at((ado - reg::dc_receive_times + at) / 4) = load_le<std::uint32_t>(data, at);
            if (datagram->command == Command::FPRD && ado == reg::dc_receive_time_unit && data.size() >= 8) {
                clock.latched.unit = load_le<std::uint64_t>(data);
                clock.latched.dc = true;
            }
            if (datagram->command == Command::FPWR && ado == reg::dc_system_delay && data.size() >= 4)
                clock.delay = load_le<std::uint32_t>(data);
        }
    }
    std::erase_if(clocks, [](const auto& entry) { return entry.second.dl_status == 0; });
    return clocks;
}

class RecordedDelays : public ::testing::TestWithParam<const char*> {};

TEST_P(RecordedDelays, AreWhatTheOtherMasterComputed) {
    TAKTWERK_SKIP_WITHOUT_CAPTURES();
    const auto clocks = recorded_clocks(test::captures_folder() / GetParam());
    std::vector<std::uint16_t> dl_status;
    std::vector<LatchedTimes> latched;
    for (const auto& [station, clock] : clocks) {
        dl_status.push_back(clock.dl_status);
        latched.push_back(clock.latched);
    }
    const auto tree = build_topology(dl_status);
    ASSERT_TRUE(tree) << tree.error().text();

    const PropagationDelays delays = propagation_delays(*tree, latched);

    std::size_t position = 0, compared = 0;
    for (const auto& [station, clock] : clocks) {
        if (clock.delay && *clock.delay != 0) {
            // They leave the processing unit's share out, which we count: that is the difference allowed.
            EXPECT_LE(std::llabs(static_cast<long long>(delays.ns[position]) - static_cast<long long>(*clock.delay)),
                      processing_difference.count())
                << "station " << std::hex << station;
            ++compared;
        }
        ++position;
    }
    EXPECT_GT(compared, 0u);
}

INSTANTIATE_TEST_SUITE_P(Files, RecordedDelays,
                         ::testing::Values("soem-dual-lan9252.pcapng", "replay-dc.pcapng", "replay-ek1100-el2828-el2889.pcapng"));

}  // namespace
}  // namespace taktwerk::ecat
