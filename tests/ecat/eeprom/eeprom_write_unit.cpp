// An EEPROM that is written through the controller of a simulated slave, and everything that can go wrong meanwhile: one test a line of the
// table in eeprom_write.hpp.
#include "ecat/eeprom/eeprom_write.hpp"

#include <gmock/gmock.h>

#include "core/bytes.hpp"
#include "ecat/bringup/scan.hpp"
#include "ecat/bringup/sii_reader.hpp"
#include "ecat/eeprom/sii_fields.hpp"
#include "tests/ecat/diagnosis/probed_bus.hpp"

namespace taktwerk::ecat {
namespace {

using namespace std::chrono_literals;
using test::ProbedBus;
using ::testing::HasSubstr;

using Image = std::vector<std::byte>;

constexpr std::uint16_t new_alias = 4711;

class EepromOfASlave : public ::testing::Test {
protected:
    EepromOfASlave() {
        (void)bus.look();  // gives the station addresses
        before = eeprom().image();
        after = before;
        set_sii_alias(after, new_alias);
        store_le<std::uint32_t>(after, 2 * sii_word::serial, 0xCAFE0007);
    }
    sim::SlaveController& controller(std::size_t position = 0) { return bus.network.slave(position).controller(); }
    sim::EepromInterface& eeprom() { return controller().eeprom(); }
    /// `each`: at every look at the wire.
    Result<EepromWriting> write(const Image& from, const Image& to, const std::function<void()>& each = {}) {
        BusProbe probe{bus.transport, {}, [&](Duration period) {
                           bus.now += period;
                           if (each) each();
                           return std::optional{bus.now};
                       }};
        return probe.run(write_eeprom(probe.port(), station_at(0), from, to, "slave 0"));
    }
    Result<EepromWriting> write() { return write(before, after); }
    std::uint16_t alias_now() { return load_le<std::uint16_t>(std::array{controller().peek(0x0012), controller().peek(0x0013)}); }
    void power_cycle() {
        bus.network.set_power(0, false);
        bus.now += 10ms;
        bus.network.advance(bus.now);
        bus.network.set_power(0, true);
    }
    /// 0500h and 0501h: the master has offered the EEPROM, and the application has taken it.
    void let_the_application_take_it() {
        auto probe = bus.probe();
        ASSERT_TRUE(probe.run(give_eeprom_back(probe.port(), station_at(0), "slave 0")));
        ASSERT_TRUE(controller().take_eeprom(true));
    }

    ProbedBus bus{"st"};
    Image before, after;
};

TEST_F(EepromOfASlave, IsReadByteByByteWithEightAndWithFourBytesACommand) {
    sim::SlaveOptions narrow;
    narrow.eeprom_reads_8_bytes = false;
    bus.network.add(test::servo_description(), std::make_unique<test::EchoServo>(), narrow);
    (void)bus.look();
    auto probe = bus.probe();
    for (const std::uint16_t position : {std::uint16_t{0}, std::uint16_t{2}}) {
        const auto image = probe.run(read_eeprom(probe.port(), station_at(position), "slave"));
        ASSERT_TRUE(image) << image.error().text();
        EXPECT_EQ(*image, controller(position).eeprom().image()) << position;
    }
    const auto part = probe.run(read_eeprom(probe.port(), station_at(0), "slave", 70));
    ASSERT_TRUE(part);
    EXPECT_EQ(*part, Image(before.begin(), before.begin() + 140));
}

TEST_F(EepromOfASlave, HoldsWhatWasWrittenAndTheAliasCountsAfterThePowerCycle) {
    const Instant began = bus.now;
    const auto written = write();
    ASSERT_TRUE(written) << written.error().text();
    EXPECT_FALSE(written->failure);
    EXPECT_EQ(written->words, 4u) << "alias, checksum, two of the serial number";
    EXPECT_GE(bus.now - began, 4 * 2ms) << "2 ms a word (SlaveOptions)";
    EXPECT_EQ(eeprom().image(), after);
    EXPECT_EQ(alias_now(), 0) << "the controller works with what it loaded";
    power_cycle();
    EXPECT_EQ(alias_now(), new_alias);
    EXPECT_EQ(eeprom().image(), after);
}

TEST_F(EepromOfASlave, WithAWrongChecksumIsMendedByWriting) {
    auto broken = before;
    broken[2 * sii_word::alias] = std::byte{9};
    eeprom().image() = broken;
    power_cycle();
    (void)bus.look();
    ASSERT_NE(controller().peek(reg::eeprom_control + 1) & std::byte{0x08}, std::byte{0}) << "0502h bit 11: checksum";
    const auto written = write(broken, before);
    ASSERT_TRUE(written) << written.error().text();
    EXPECT_FALSE(written->failure);
    EXPECT_EQ(eeprom().image(), before);
}

TEST_F(EepromOfASlave, IsTakenFromTheProcessorThatHoldsIt) {
    let_the_application_take_it();
    const auto written = write();
    ASSERT_TRUE(written) << written.error().text();
    EXPECT_FALSE(written->failure);
    EXPECT_EQ(eeprom().image(), after);
    EXPECT_EQ(controller().peek(reg::eeprom_pdi_access), std::byte{0});
}

TEST_F(EepromOfASlave, ThatItsProcessorDoesNotLetGoIsNotWritten) {
    eeprom().faults().held_by_application = true;
    let_the_application_take_it();
    const auto written = write();
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().code, "bus.sii_taken");
    EXPECT_THAT(written.error().what, HasSubstr("0500h = 00h, 0501h = 01h"));
    EXPECT_EQ(eeprom().image(), before);
}

TEST_F(EepromOfASlave, ThatDoesNotAcknowledgeForAWhileIsWrittenAllTheSame) {
    eeprom().faults().refused = 5;
    const auto written = write();
    ASSERT_TRUE(written);
    EXPECT_FALSE(written->failure) << written->failure->text();
    EXPECT_EQ(eeprom().image(), after);
}

TEST_F(EepromOfASlave, ThatDoesNotAcknowledgeAnyMoreIsAnErrorAfterTwentyAttempts) {
    eeprom().faults().refused = 0xFFFFFFFF;
    const Instant began = bus.now;
    const auto written = write();
    ASSERT_TRUE(written);
    ASSERT_TRUE(written->failure);
    EXPECT_EQ(written->failure->code, "bus.eeprom_write");
    EXPECT_THAT(written->failure->what, HasSubstr("the memory does not acknowledge"));
    EXPECT_THAT(written->failure->what, HasSubstr("000Fh")) << "the last word goes first";
    EXPECT_FALSE(written->restored) << "who does not answer cannot say what it holds";
    EXPECT_EQ(eeprom().image(), before);
    EXPECT_EQ(eeprom().faults().refused, 0xFFFFFFFF - eeprom_attempts - (sii_retries + 1)) << "writing, then one read";
    EXPECT_LT(bus.now - began, 1s);
}

TEST_F(EepromOfASlave, ThatIsWriteProtectedStaysAsItIs) {
    eeprom().faults().write_protected = true;
    const auto written = write();
    ASSERT_TRUE(written);
    ASSERT_TRUE(written->failure);
    EXPECT_EQ(written->failure->code, "bus.eeprom_write");
    EXPECT_THAT(written->failure->what, HasSubstr("writing is not enabled"));
    EXPECT_EQ(written->words, 0u);
    EXPECT_TRUE(written->restored);
    EXPECT_EQ(eeprom().image(), before);
}

TEST_F(EepromOfASlave, ThatStaysBusyForEverIsAnErrorAfterASecond) {
    eeprom().faults().stays_busy = true;
    const Instant began = bus.now;
    const auto written = write();
    ASSERT_TRUE(written);
    ASSERT_TRUE(written->failure);
    EXPECT_EQ(written->failure->code, "bus.eeprom_write");
    EXPECT_THAT(written->failure->what, HasSubstr("stays busy"));
    EXPECT_FALSE(written->restored);
    EXPECT_GE(bus.now - began, eeprom_busy_limit);
    EXPECT_LT(bus.now - began, 3 * eeprom_busy_limit) << "a second to see it, one more to see that nothing can be put back";
}

TEST_F(EepromOfASlave, WithAWornWordIsPutBack) {
    eeprom().faults().worn_word = sii_word::serial;
    const auto written = write();
    ASSERT_TRUE(written);
    ASSERT_TRUE(written->failure);
    EXPECT_EQ(written->failure->code, "bus.eeprom_verify");
    EXPECT_THAT(written->failure->what, HasSubstr("word 000Eh (serial number) was written as 0007h and reads 0000h"));
    EXPECT_EQ(written->words, 4u);
    EXPECT_TRUE(written->restored);
    EXPECT_EQ(eeprom().image(), before);
}

// The cable goes while words are written: nothing can be put back, and the backup mends it when the cable is in again.
TEST_F(EepromOfASlave, LeftInTheMiddleIsMendedFromTheBackup) {
    const auto written = write(before, after, [&] {
        if (eeprom().image() != before) bus.network.set_cable(0, false);
    });
    ASSERT_TRUE(written);
    ASSERT_TRUE(written->failure);
    EXPECT_EQ(written->failure->code, "bus.no_frame");
    EXPECT_FALSE(written->restored);
    const auto torn = eeprom().image();
    ASSERT_NE(torn, before);
    ASSERT_NE(torn, after);
    bus.network.set_cable(0, true);
    const auto again = write(torn, before);
    ASSERT_TRUE(again) << again.error().text();
    EXPECT_FALSE(again->failure);
    EXPECT_EQ(eeprom().image(), before);
}

TEST_F(EepromOfASlave, ThatVanishesIsSaidToBeGone) {
    ProbedBus line{"ss"};
    (void)line.look();
    auto& memory = line.network.slave(1).controller().eeprom();
    const Image was = memory.image();
    auto wanted = was;
    set_sii_alias(wanted, new_alias);
    BusProbe probe{line.transport, {}, [&](Duration period) {
                       line.now += period;
                       if (memory.image() != was) line.network.set_power(1, false);
                       return std::optional{line.now};
                   }};
    const auto written = probe.run(write_eeprom(probe.port(), station_at(1), was, wanted, "slave 1"));
    ASSERT_TRUE(written);
    ASSERT_TRUE(written->failure);
    EXPECT_EQ(written->failure->code, "bus.no_slave");
    EXPECT_FALSE(written->restored);
}

// SOEM leaves the EEPROM with the processor: whoever looked gives it back.
TEST_F(EepromOfASlave, IsRememberedToHaveBeenWithItsProcessor) {
    EXPECT_FALSE(bus.look().slaves[0].eeprom_with_pdi);
    let_the_application_take_it();
    const auto found = bus.look();
    EXPECT_TRUE(found.slaves[0].eeprom_with_pdi);
    EXPECT_FALSE(found.slaves[1].eeprom_with_pdi);
    EXPECT_FALSE(found.slaves[0].found.error) << "the survey took it";
}

}  // namespace
}  // namespace taktwerk::ecat
