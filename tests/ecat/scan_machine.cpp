// The scan against simulated slaves that answer only to frames: how long it takes, whose EEPROM it survives, how slaves are found.
// EEPROM model of the simulator: a command keeps the interface busy for eeprom_read_time and delivers 8 bytes; 100 us is an I2C
// memory at 1 MHz, 1 ms a slow one. A cycle of 1 ms moves at most 16 datagrams.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>

#include "ecat/bringup/sii_reader.hpp"
#include "ecat/exchange/acyclic_channel.hpp"
#include "tests/ecat/test_bus.hpp"
#include "tests/ecat/wire/captures.hpp"

namespace taktwerk::ecat::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

/// Servos with EEPROMs of a given speed.
void add_servos(TestBus& bus, std::size_t count, Duration eeprom_read_time) {
    for (std::size_t i = 0; i < count; ++i) {
        SlaveConfig slave;
        slave.name = "s" + std::to_string(i);
        slave.device = servo_description();
        slave.position = static_cast<std::uint16_t>(i);
        slave.dc = true;
        bus.config.slaves.push_back(slave);
        sim::SlaveOptions options;
        options.eeprom_read_time = eeprom_read_time;
        bus.network.add(slave.device, std::make_unique<EchoServo>(), options);
    }
}

struct Times {
    Duration scan{}, op{};
};

Times measure(std::size_t count, Duration eeprom_read_time) {
    TestBus bus{""};
    add_servos(bus, count, eeprom_read_time);
    bus.start();
    bus.run_until([&] { return bus.master->phase() != Master::Phase::scanning; }, 20s);
    Times times;
    times.scan = bus.now - Instant{};
    bus.run_until([&] { return bus.master->phase() == Master::Phase::operational || bus.master->phase() == Master::Phase::failed; }, 20s);
    EXPECT_EQ(bus.master->phase(), Master::Phase::operational) << bus.why();
    times.op = bus.now - Instant{};
    std::printf("%3zu slaves, EEPROM %4lld us a command: scan %5lld ms, OP %5lld ms of machine time\n", count,
                static_cast<long long>(eeprom_read_time / 1us), static_cast<long long>(times.scan / 1ms),
                static_cast<long long>(times.op / 1ms));
    return times;
}

// Required: 8 slaves scanned within 1 s, 64 in OP within 10 s.
TEST(ScanTime, OfEightSlavesStaysWithinASecondAlsoWithASlowEeprom) {
    EXPECT_LE(measure(8, 100us).scan, 1s);
    EXPECT_LE(measure(8, 1ms).scan, 1s);
}

TEST(ScanTime, SixtyFourSlavesReachOpWithinTenSeconds) {
    EXPECT_LE(measure(64, 100us).op, 10s);
    EXPECT_LE(measure(64, 1ms).op, 10s);
}

/// Reads the EEPROM of slave 0 with nothing but the reader.
Result<Sii> read_eeprom(TestBus& bus) {
    bus.config.acyclic_per_cycle = 16;
    Exchange exchange{bus.transport};
    AcyclicChannel channel{exchange};
    DatagramPort port{channel};
    std::optional<Result<Sii>> read;
    const auto script = [](DatagramPort& wire, std::optional<Result<Sii>>& out) -> Script<void> {
        co_await wire.apwr(0, reg::station_address, std::uint16_t{0x1001});
        out = co_await read_whole_sii(wire, 0x1001, std::string{"slave 0"});
    };
    Runner runner{script(port, read)};
    for (int i = 0; i < 20'000 && !runner.done(); ++i) {
        bus.now += 1ms;
        exchange.receive(bus.now);
        channel.collect(bus.now);
        runner.step(bus.now);
        channel.pack(bus.now, 16);
    }
    if (!read) return Error{"test.unfinished", "", "the reader did not come to an end", ""};
    return std::move(*read);
}

std::vector<std::byte>& eeprom_of(TestBus& bus) { return bus.network.slave(0).controller().eeprom().image(); }

// Whatever stands in the EEPROM, the reader brings what parse_sii() finds in the whole image.
TEST(SiiReader, BringsWhatAWholeReadWouldBring) {
    TestBus bus{"s"};
    const Sii whole = parse_sii(eeprom_of(bus));
    const auto read = read_eeprom(bus);
    ASSERT_TRUE(read) << read.error().text();
    EXPECT_TRUE(read->defects.empty());
    EXPECT_EQ(read->identity, whole.identity);
    EXPECT_EQ(read->strings, whole.strings);
    EXPECT_EQ(read->general, whole.general);
    EXPECT_EQ(read->sync_managers, whole.sync_managers);
    EXPECT_EQ(read->rx_pdos, whole.rx_pdos);
    EXPECT_EQ(read->tx_pdos, whole.tx_pdos);
}

TEST(SiiReader, OfRealDevicesBringsWhatAWholeReadWouldBring) {
    TAKTWERK_SKIP_WITHOUT_CAPTURES();
    for (const auto& entry : std::filesystem::directory_iterator{captures_folder() / "eeprom"}) {
        SCOPED_TRACE(entry.path().filename());
        TestBus bus{"s"};
        eeprom_of(bus) = read_file(entry.path());
        const Sii whole = parse_sii(eeprom_of(bus));
        const auto read = read_eeprom(bus);
        ASSERT_TRUE(read) << read.error().text();
        EXPECT_EQ(read->identity, whole.identity);
        EXPECT_EQ(read->strings, whole.strings);
        EXPECT_EQ(read->sync_managers, whole.sync_managers);
        EXPECT_EQ(read->rx_pdos, whole.rx_pdos);
        EXPECT_EQ(read->tx_pdos, whole.tx_pdos);
        EXPECT_EQ(read->dc_modes, whole.dc_modes);
    }
}

// The memory ends early: the controller refuses what lies behind its end.
TEST(SiiReader, SurvivesATruncatedEepromAtEveryEighthWord) {
    TestBus good{"s"};
    const auto image = eeprom_of(good);
    // A memory of exactly the header reads FFFFh behind it: that is an end marker, and a good image.
    for (std::size_t words = sii_word::categories + 8; words < 0x140; words += 8) {
        SCOPED_TRACE(words);
        TestBus bus{"s"};
        eeprom_of(bus).resize(2 * words);
        const auto read = read_eeprom(bus);
        ASSERT_TRUE(read) << read.error().text();
        EXPECT_EQ(read->identity, servo_description()->identity);
        EXPECT_TRUE(!read->defects.empty() || read->tx_pdos == parse_sii(image).tx_pdos);
    }
}

TEST(SiiReader, SaysThatAnEepromIsEmptyAfterFewWords) {
    for (const auto filling : {std::byte{0}, std::byte{0xFF}}) {
        TestBus bus{"s"};
        std::fill(eeprom_of(bus).begin(), eeprom_of(bus).end(), filling);
        const auto read = read_eeprom(bus);
        ASSERT_TRUE(read);
        EXPECT_THAT(read->defects, Contains(SiiDefect::empty));
        EXPECT_LE(bus.now, Instant{} + 50ms);  // nine commands of two or three cycles
    }
}

TEST(SiiReader, NamesSlaveAndWordWhenTheEepromStaysBusy) {
    TestBus bus{""};
    add_servos(bus, 1, 5s);
    const auto read = read_eeprom(bus);
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error().code, "bus.sii");
    EXPECT_EQ(read.error().subject, "slave 0");
    EXPECT_THAT(read.error().what, HasSubstr("EEPROM word 0000h"));
    EXPECT_THAT(read.error().what, HasSubstr("stays busy"));
}

TEST(Scan, OfASlaveWithAnEmptyEepromSaysSo) {
    TestBus bus{"s"};
    std::fill(eeprom_of(bus).begin(), eeprom_of(bus).end(), std::byte{0xFF});
    EXPECT_FALSE(bus.bring_up());
    EXPECT_EQ(bus.master->failure().code, "bus.wrong_identity");
    EXPECT_THAT(bus.master->failure().what, HasSubstr("EEPROM is empty"));
}

TEST(Scan, HintsAtTwoSlavesThatAreSwapped) {
    TestBus bus{"ts"};
    std::swap(bus.config.slaves[0].position, bus.config.slaves[1].position);
    EXPECT_FALSE(bus.bring_up());
    EXPECT_EQ(bus.master->failure().code, "bus.wrong_identity");
    EXPECT_THAT(bus.master->failure().remedy, HasSubstr("'a' and 'b' look swapped"));
}

// Only the second of three is configured; the others stay in INIT and nobody minds.
TEST(Scan, LeavesExtraSlavesAloneWhereTheConfigurationSaysSo) {
    TestBus bus{"tst"};
    bus.config.slaves = {bus.config.slaves[1]};
    bus.config.extra_slaves = ExtraSlaves::ignore;
    ASSERT_TRUE(bus.bring_up()) << bus.why();
    EXPECT_EQ(bus.state(0), sim::EsmState::init);
    EXPECT_EQ(bus.state(1), sim::EsmState::op);
    EXPECT_EQ(bus.state(2), sim::EsmState::init);
}

TEST(Scan, RefusesAnAliasThatTwoSlavesHave) {
    TestBus bus{""};
    for (int i = 0; i < 2; ++i) {
        sim::SlaveOptions options;
        options.alias = 77;
        bus.network.add(servo_description(), std::make_unique<EchoServo>(), options);
    }
    SlaveConfig y;
    y.name = "y";
    y.device = servo_description();
    y.alias = 77;
    y.dc = true;
    bus.config.slaves = {y};
    bus.config.extra_slaves = ExtraSlaves::ignore;
    EXPECT_FALSE(bus.bring_up());
    EXPECT_EQ(bus.master->failure().code, "bus.duplicate_alias");
    EXPECT_THAT(bus.master->failure().what, HasSubstr("at positions 0 and 1"));
}

}  // namespace
}  // namespace taktwerk::ecat::test
