// A bus of any length comes up, whatever its slaves: short and long EEPROMs, with and without mailbox and clock. A line of slaves is
// longer than the master can speak to at once, so who waits for his turn must not be taken for one who does not answer.
//
// `./dev soak` goes through every count from 1 to 300. The table of docs/performance.md is what DISABLED_PrintsTheTable prints.
#include <gtest/gtest.h>

#include <cstdio>

#include "ecat/sim/digital_terminal.hpp"
#include "tests/ecat/test_bus.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::ecat::test {
namespace {

enum class Kind { short_eeprom, long_eeprom, mailbox, mailbox_long_eeprom };
constexpr std::array all_kinds{Kind::short_eeprom, Kind::long_eeprom, Kind::mailbox, Kind::mailbox_long_eeprom};

std::string name(Kind kind) {
    switch (kind) {
        case Kind::short_eeprom: return "terminal, short EEPROM";
        case Kind::long_eeprom: return "terminal, long EEPROM";
        case Kind::mailbox: return "servo, short EEPROM";
        case Kind::mailbox_long_eeprom: return "servo, long EEPROM";
    }
    return {};
}

/// A servo whose EEPROM lists as many PDOs as those of large drives do.
std::shared_ptr<DeviceDescription> servo_with_long_eeprom() {
    auto servo = servo_description();
    for (std::uint16_t n = 1; n <= 12; ++n) {
        PdoDescription rx{static_cast<std::uint16_t>(0x1600 + n), true, {}}, tx{static_cast<std::uint16_t>(0x1A00 + n), true, {}};
        for (int i = 0; i < 8; ++i) {
            rx.entries.push_back({0x607A, 0, 32});
            tx.entries.push_back({0x6064, 0, 32});
        }
        servo->rx_pdos.push_back(rx);
        servo->tx_pdos.push_back(tx);
    }
    return servo;
}

struct Row {
    bool up = false;
    Duration to_op{};
    std::string why;
};

Row bring_up(Kind kind, std::size_t count, Duration cycle) {
    TestBus bus{"", cycle};
    const bool servo = kind == Kind::mailbox || kind == Kind::mailbox_long_eeprom;
    const auto device = kind == Kind::short_eeprom  ? terminal_description()
                        : kind == Kind::long_eeprom ? std::make_shared<DeviceDescription>(sim::digital_input_output_terminal(128, 128))
                        : kind == Kind::mailbox     ? servo_description()
                                                    : servo_with_long_eeprom();
    for (std::size_t i = 0; i < count; ++i) {
        SlaveConfig slave;
        slave.name = "s" + std::to_string(i);
        slave.device = device;
        slave.position = static_cast<std::uint16_t>(i);
        slave.dc = servo;
        bus.config.slaves.push_back(slave);
        sim::SlaveOptions options;
        options.clock_start = Duration{static_cast<std::int64_t>(i + 1) * 987'654'321};
        std::unique_ptr<sim::DeviceModel> model;
        if (servo) model = std::make_unique<EchoServo>();
        else if (kind == Kind::long_eeprom) model = std::make_unique<sim::DigitalTerminal>();
        else model = std::make_unique<InvertingTerminal>();
        bus.network.add(device, std::move(model), options);
    }
    Row row;
    row.up = bus.bring_up(120s);
    row.to_op = bus.now - Instant{};
    row.why = bus.why();
    if (!row.up) return row;
    bus.run_for(4 * cycle);
    for (std::size_t i = 0; i < count; ++i) {
        EXPECT_EQ(bus.state(i), sim::EsmState::op) << "slave " << i;
        EXPECT_TRUE(bus.master->health(i).fresh) << "slave " << i;
    }
    EXPECT_TRUE(bus.master->notes().empty()) << bus.master->notes().front() << ": nobody did anything wrong";
    return row;
}

/// Around what is limited somewhere: entries and datagrams of a frame, a byte, the bits of a frame; and the longest bus.
std::vector<std::size_t> counts() {
    std::vector<std::size_t> some{1, 2, 33, 41, 97, 130, 300};
    if (property_cases(1) == 1) return some;
    std::vector<std::size_t> every;
    for (std::size_t n = 1; n <= 300; ++n) every.push_back(n);
    return every;
}

class AnyCount : public ::testing::TestWithParam<Kind> {};

TEST_P(AnyCount, OfSlavesComesUp) {
    for (const std::size_t count : counts()) {
        const Row row = bring_up(GetParam(), count, 4ms);
        EXPECT_TRUE(row.up) << count << " times " << name(GetParam()) << ": " << row.why;
        if (HasFailure()) return;
    }
}

INSTANTIATE_TEST_SUITE_P(Of, AnyCount, ::testing::ValuesIn(all_kinds));

// Not a test: what docs/performance.md shows.
TEST(AnyCountTable, DISABLED_PrintsTheTable) {
    std::printf("| slaves | cycle |");
    for (const Kind kind : all_kinds) std::printf(" %s |", name(kind).c_str());
    std::printf("\n");
    for (const Duration cycle : {Duration{1ms}, Duration{4ms}})
        for (const std::size_t count : {std::size_t{1}, std::size_t{4}, std::size_t{30}, std::size_t{33}, std::size_t{64}, std::size_t{100},
                                        std::size_t{200}, std::size_t{300}}) {
            std::printf("| %zu | %lld ms |", count, static_cast<long long>(cycle / 1ms));
            for (const Kind kind : all_kinds) {
                const Row row = bring_up(kind, count, cycle);
                if (row.up) std::printf(" %.1f s |", to_seconds(row.to_op));
                else std::printf(" %s |", row.why.c_str());
                std::fflush(stdout);
            }
            std::printf("\n");
        }
}

}  // namespace
}  // namespace taktwerk::ecat::test
