// Whatever a master sends, a simulated slave stays within its memory and its state machine. Meant for the sanitizers; the
// invariants hold in every build. The generator is seeded: a failure repeats.

#include <gtest/gtest.h>

#include <random>

#include "ecat/sim/digital_terminal.hpp"
#include "tests/ecat/sim/bus_probe.hpp"

namespace taktwerk::ecat::sim {
namespace {

TEST(HostileFrames, RandomDatagramsOnInterestingAddresses) {
    std::mt19937 random{20260721};
    const auto pick = [&](std::uint32_t below) { return static_cast<std::uint32_t>(random() % below); };
    constexpr std::uint16_t interesting[] = {0x0000, 0x0010, 0x0100, 0x0120, 0x0200, 0x0300, 0x0400, 0x0420, 0x0500, 0x0502, 0x0600,
                                             0x0610, 0x0800, 0x0808, 0x0810, 0x0818, 0x0838, 0x0900, 0x0910, 0x0920, 0x0980, 0x0990,
                                             0x09A0, 0x0FF0, 0x1000, 0x1070, 0x1400, 0x1800, 0x1C00, 0x1FF8, 0x2000, 0xFFFE};
    for (int round = 0; round < 40; ++round) {
        BusProbe bus;
        auto description = small_drive();
        description.dc.supported = true;
        bus.add_drive({.alias = 3}, description);
        bus.add(digital_input_output_terminal(7, 9), std::make_unique<DigitalTerminal>());
        if (round % 2 == 0) bus.to_safeop(0), bus.request(0, 8);
        for (int i = 0; i < 500; ++i) {
            const auto command = static_cast<Command>(pick(15));
            const std::size_t size = pick(8) == 0 ? pick(1487) : pick(40);
            const bool logical = command >= Command::LRD && command <= Command::LRW;
            const auto ado = static_cast<std::uint16_t>(interesting[pick(std::size(interesting))] + pick(4));
            const auto address = logical ? Address::logical(pick(4) == 0 ? static_cast<std::uint32_t>(random()) : pick(64))
                                         : Address::physical(static_cast<std::uint16_t>(0u - pick(3)), ado);
            Bytes data(size);
            for (auto& byte : data) byte = pick(3) == 0 ? std::byte{0} : static_cast<std::byte>(random());
            bus.send(command, address, data);
            bus.now += Duration{pick(300'000)};
            if (pick(4) == 0) bus.network.advance(bus.now);

            if (bus.read(0, 0, 1); !bus.flight) {  // the random master shut or opened a loop: only the switch helps
                for (std::size_t p = 0; p < 2; ++p) bus.network.set_power(p, false), bus.network.set_power(p, true);
            }
            const auto status = bus.value<std::uint16_t>(0, reg::al_status);
            const auto state = status & 0x0Fu;
            ASSERT_TRUE(state == 1 || state == 2 || state == 4 || state == 8) << status;
            ASSERT_EQ(state, static_cast<unsigned>(bus.network.slave(0).state()));
        }
    }
}

TEST(HostileFrames, RandomMailboxContent) {
    std::mt19937 random{42};
    BusProbe bus;
    bus.add_drive();
    bus.to_preop(0);
    for (int i = 0; i < 20'000; ++i) {
        Bytes message(0x80);
        for (auto& byte : message) byte = random() % 2 == 0 ? std::byte{0} : static_cast<std::byte>(random());
        if (random() % 4 != 0) {  // plausible header, so that the SDO server gets its share
            store_le<std::uint16_t>(message, 0, static_cast<std::uint16_t>(random() % 124));
            message[5] = static_cast<std::byte>(0x03 | ((i % 7 + 1) << 4));
            message[6] = std::byte{0}, message[7] = std::byte{0x20};
        }
        if (random() % 2 == 0)
            store_le<std::uint16_t>(message, 9, static_cast<std::uint16_t>(std::array{0x2001, 0x60F0, 0x1600, 0x1C12}[random() % 4]));
        bus.write(0, 0x1000, message);
        bus.wait(300us);
        bus.read(0, 0x1400, 0x80);
    }
    EXPECT_EQ(bus.value<std::uint16_t>(0, reg::al_status), 2);
    bus.wait(10ms);
    bus.read(0, 0x1400, 0x80);
    (void)bus.upload(0, 0x1000, 0);  // its counter may happen to be that of the last random message
    const auto answer = bus.upload(0, 0x1000, 0);
    EXPECT_EQ(answer.size(), 10u) << "it still serves";
}

}  // namespace
}  // namespace taktwerk::ecat::sim
