// New firmware into a simulated slave, from the first look to the last.
#include "ecat/firmware/firmware_update.hpp"

#include <gmock/gmock.h>

#include "core/bytes.hpp"
#include "ecat/wire/foe_error.hpp"
#include "tests/ecat/firmware/firmware_bench.hpp"

namespace taktwerk::ecat::test {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class UpdatedFirmware : public ::testing::TestWithParam<unsigned> {};

TEST_P(UpdatedFirmware, RunsAfterwardsAndTheSlaveSaysSo) {
    FirmwareBench bench{GetParam()};
    std::vector<FirmwareStage> stages;
    auto settings = FirmwareBench::settings();
    settings.stage = [&](FirmwareStage stage) { stages.push_back(stage); };
    const auto file = FirmwareBench::image("2.1", 0x00020001);

    const auto outcome = bench.update(file, {}, 0, settings);

    ASSERT_TRUE(outcome) << outcome.error().text();
    ASSERT_FALSE(outcome->failure) << outcome->failure->text();
    EXPECT_EQ(outcome->acknowledged, file.size());
    EXPECT_EQ(bench.running(), "2.1");
    EXPECT_EQ(outcome->before->software, "1.0");
    EXPECT_EQ(outcome->after->software, "2.1");
    EXPECT_THAT(changes(*outcome->before, *outcome->after),
                ElementsAre("revision 00010000h -> 00020001h", "object 1018h:03 00010000h -> 00020001h", "software '1.0' -> '2.1'"));
    EXPECT_EQ(outcome->left.state, AlState::preop);
    EXPECT_EQ(outcome->firmware(), FirmwareLeft::complete);
    EXPECT_THAT(stages, ElementsAre(FirmwareStage::looking, FirmwareStage::entering_boot, FirmwareStage::writing,
                                    FirmwareStage::leaving_boot, FirmwareStage::comparing, FirmwareStage::done));
    bench.power_cycle();
    EXPECT_EQ(bench.running(), "2.1") << "and after the next power-on";
}
INSTANTIATE_TEST_SUITE_P(Banks, UpdatedFirmware, ::testing::Values(1u, 2u));

TEST(FirmwareUpdate, TheSameFirmwareOnceMoreChangesNothing) {
    FirmwareBench bench;
    const auto outcome = bench.update(FirmwareBench::image("1.0", 0x00010000));
    ASSERT_TRUE(outcome && !outcome->failure);
    EXPECT_TRUE(changes(*outcome->before, *outcome->after).empty());
    EXPECT_EQ(*outcome->before, *outcome->after);
}

// Its controller was reset with it: no station address. The neighbours keep theirs.
TEST(FirmwareUpdate, ASlaveThatRestartsGetsItsStationAddressAgain) {
    FirmwareBench bench;
    const auto first = bench.network.slave(0).controller().station_address();
    const auto outcome = bench.update(FirmwareBench::image("2.1", 0x00020001));
    ASSERT_TRUE(outcome && !outcome->failure);
    EXPECT_NE(bench.gauge().controller().station_address(), 0);
    EXPECT_NE(bench.network.slave(2).controller().station_address(), bench.gauge().controller().station_address());
    EXPECT_EQ(first, 0) << "nobody had given it one";
}

TEST(FirmwareUpdate, AnEepromThatNamesNoBootstrapMailboxIsAnEndBeforeTheBeginning) {
    auto description = gauge_description();
    description->mailbox->bootstrap.reset();
    FirmwareBench bench{2, 0, description};
    const auto outcome = bench.update(FirmwareBench::image("2.1", 0x00020001));
    ASSERT_TRUE(outcome && outcome->failure);
    EXPECT_EQ(outcome->failure->code, "foe.no_boot");
    EXPECT_EQ(outcome->firmware(), FirmwareLeft::untouched);
    EXPECT_EQ(outcome->left.state, AlState::init);
}

// Whatever mailbox counter the killed command used last: one in seven is the first of the next one.
class KilledAt : public ::testing::TestWithParam<std::size_t> {};
INSTANTIATE_TEST_SUITE_P(EachCounter, KilledAt, ::testing::Range(std::size_t{0}, std::size_t{8}));

TEST_P(KilledAt, ASlaveLeftInBootIsWrittenFromThere) {
    FirmwareBench bench{1};
    const auto bytes = 3000 + GetParam() * 244;
    const auto killed =
        bench.update(FirmwareBench::image("2.1", 0x00020001), [&] { return bench.gauge().files()->flash().written() < bytes; });
    ASSERT_FALSE(killed);
    ASSERT_EQ(bench.gauge().state(), sim::EsmState::boot);

    const auto outcome = bench.update(FirmwareBench::image("2.1", 0x00020001));
    ASSERT_TRUE(outcome && !outcome->failure) << outcome->failure->text();
    EXPECT_EQ(bench.running(), "2.1");
    EXPECT_TRUE(outcome->before->software.empty()) << "in BOOT it has no objects";
}

// The boot loader alone: INIT and BOOT are all it knows.
TEST(FirmwareUpdate, ABootLoaderWithoutFirmwareTakesIt) {
    FirmwareBench bench{1};
    bench.gauge().files()->flash().begin(bench.now);
    bench.power_cycle();
    ASSERT_EQ(bench.running(), "");
    const auto outcome = bench.update(FirmwareBench::image("2.1", 0x00020001));
    ASSERT_TRUE(outcome) << outcome.error().text();
    ASSERT_FALSE(outcome->failure) << outcome->failure->text();
    ASSERT_TRUE(outcome->before->silence);
    EXPECT_THAT(outcome->before->silence->what, HasSubstr("0014h"));
    EXPECT_EQ(bench.running(), "2.1");
}

}  // namespace
}  // namespace taktwerk::ecat::test
