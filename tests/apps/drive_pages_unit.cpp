// Pages made from drive files: what they show, and that the committed ones are what the files say today.

#include "apps/docs/drive_pages.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "config/drive_file/drive_library.hpp"
#include "tests/apps/machine_files.hpp"

namespace taktwerk::apps {
namespace {

using testing::HasSubstr;
using testing::Not;

config::LoadedDrive a_drive() {
    auto device = std::make_shared<ecat::DeviceDescription>();
    device->identity = {0xAB6, 0x1000, 0x10001, 0};
    device->rx_pdos = {{0x1600, false, {{0x6040, 0, 16}, {0x6060, 0, 8}}}, {0x1601, true, {{0x607A, 0, 32}}}};
    device->rx_assigned = {0x1601};
    device->rx_rules = {2, 4, 64};
    device->dc.supported = true;
    device->dc.minimum_cycle = std::chrono::microseconds{500};
    auto profile = std::make_shared<axes::DriveProfile>();
    profile->name = "a-1";
    profile->title = "A-1 drive";
    profile->modes = {axes::DriveMode::cyclic_position, axes::DriveMode::homing};
    profile->homing_methods = {-1, 17};
    profile->quirks = {axes::Quirk::no_remote_bit};
    profile->enable_delay = std::chrono::milliseconds{250};
    profile->stops.fault = axes::DriveStop::coast;
    axes::DriveAlarmText fault;
    fault.code = 0x3210, fault.detail = 7, fault.panel = "Er.1", fault.english = "over-voltage", fault.chinese = "过压";
    fault.cause = "it | brakes", fault.remedy = "slower", fault.section = "5.1";
    axes::DriveAlarmText broken;
    broken.code = 0x7305, broken.panel = "Er.2", broken.english = "encoder", broken.chinese = "编码器";
    broken.cause = "cable", broken.remedy = "look", broken.resettable = false, broken.section = "5.2";
    axes::DriveAlarmText warning;
    warning.code = 0x5443, warning.panel = "Al.1", warning.english = "limit", warning.chinese = "限位";
    warning.cause = "switch", warning.remedy = "move back", warning.warning = true, warning.section = "5.3";
    profile->alarms = {fault, broken, warning};
    axes::DriveParameter gain;
    gain.address = {0x2005, 0x0B};
    gain.parameter = "P05.10";
    gain.name = "gain";
    gain.chinese = "增益";
    gain.minimum = 1, gain.maximum = 99, gain.value = 7;
    gain.unit = "%", gain.scale = 0.1;
    gain.factory = axes::FactoryValue::stated;
    gain.effect = axes::ParameterEffect::after_restart;
    gain.section = "7.2";
    profile->parameters = {gain};
    profile->hazards = {{axes::HazardCondition::always, {}, {}, {}, "it falls", "hold it", "4.3"}};
    profile->assumed = {"An assumption."};
    profile->questions = {"A question?"};
    return {device, profile, {{{0x1600, false, {{0x6040, 0, 16}}}}}, {}, {}};
}

TEST(DriveFeatures, SayWhatTheProfileSays) {
    const auto text = drive_features_markdown(a_drive());

    EXPECT_THAT(text, HasSubstr("| Identity | vendor 00000AB6h, product 00001000h, revision 00010001h |"));
    EXPECT_THAT(text, HasSubstr("| Modes of operation (6060h) | cyclic position (8), homing (6) |"));
    EXPECT_THAT(text, HasSubstr("| Homing methods (6098h) | -1, 17 |"));
    EXPECT_THAT(text, HasSubstr("| Least SYNC0 cycle | 500 us |"));
    EXPECT_THAT(text, HasSubstr("| RxPDOs | 2 PDOs, 1 of them fixed; at most 2 assigned, 4 objects in one, 64 bytes |"));
    EXPECT_THAT(text, HasSubstr("| Factory sends it | 1601h (607Ah): 4 bytes |"));
    EXPECT_THAT(text, HasSubstr("| Taktwerk sends it | 1600h (6040h): 2 bytes |"));
    EXPECT_THAT(text, HasSubstr("| Motion waits after enabling | 250 ms |"));
    EXPECT_THAT(text, HasSubstr("| At a fault | power off at once, the motor runs out |"));
    EXPECT_THAT(text,
                HasSubstr("| Alarms | 3, 1 of them warnings; 1 need a power cycle: [all of them](../reference/drives/a-1-alarms.md) |"));
    EXPECT_THAT(text, HasSubstr("| `no_remote_bit` | statusword bit 9 (remote) means nothing |"));
    EXPECT_THAT(text, HasSubstr("| it falls | hold it | 4.3 |"));
    EXPECT_THAT(text, HasSubstr("* An assumption.\n"));
    EXPECT_THAT(text, HasSubstr("* A question?\n"));
    EXPECT_THAT(text, Not(HasSubstr("Brake"))) << "nothing is said of what is not there";
}

TEST(DriveFeatures, OfADriveWithoutABusHaveNoProcessData) {
    auto drive = a_drive();
    drive.device.reset();

    const auto text = drive_features_markdown(drive);

    EXPECT_THAT(text, Not(HasSubstr("PDO")));
    EXPECT_THAT(text, HasSubstr("| Modes of operation | cyclic position, homing |"));
    EXPECT_THAT(text, Not(HasSubstr("60FDh")));
}

TEST(DriveAlarmPage, HasBothNamesCauseRemedyAndHowItGoes) {
    const auto page = drive_alarms_markdown(a_drive());

    EXPECT_THAT(page,
                HasSubstr("| 3210h, 7h | Er.1 | over-voltage<br>过压 | it \\| brakes | slower | MC_Reset, once the cause is gone | 5.1 |"));
    EXPECT_THAT(page, HasSubstr("| 7305h | Er.2 | encoder<br>编码器 | cable | look | power cycle | 5.2 |"));
    EXPECT_THAT(page, HasSubstr("| 5443h | Al.1 | limit<br>限位 | switch | move back | goes with its cause | 5.3 |"));
}

TEST(DriveParameterPage, HasNumberRangeFactoryValueAndUnitOfOneCount) {
    auto drive = a_drive();

    EXPECT_THAT(drive_parameters_markdown(drive),
                HasSubstr("| 2005h:0B | P05.10 | gain<br>增益 | U16 | 1 .. 99 | 7 | 0.1 % |  | any time | after a restart | 7.2 |"));
    drive.device.reset();  // a register of a drive on a serial line
    EXPECT_THAT(drive_parameters_markdown(drive), HasSubstr("| 8197 | P05.10 |"));
}

TEST(WithFeatures, ReplacesWhatStandsBetweenTheMarks) {
    const std::string begin{features_begin}, end{features_end};
    const auto page = with_features("# A\n" + begin + "old\n" + end + "rest\n", "new\n", "a.md");
    ASSERT_TRUE(page.ok());
    EXPECT_EQ(*page, "# A\n" + begin + "new\n" + end + "rest\n");

    for (const auto& wrong : {std::string("# A\n"), begin, end, end + begin}) {
        const auto refused = with_features(wrong, "new\n", "a.md");
        ASSERT_FALSE(refused.ok()) << wrong;
        EXPECT_EQ(refused.error().code, "docs.no_marks");
        EXPECT_EQ(refused.error().subject, "a.md");
    }
}

TEST(DrivePages, AreErrorsWhereThePageIsMissing) {
    const auto refused = drive_pages(a_drive(), source.string() + "/docs");
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().code, "docs.no_page");
}

std::string committed_page(const std::string& file) {
    std::ifstream stream(file);
    return {std::istreambuf_iterator<char>(stream), {}};
}

// TAKTWERK_REGENERATE=1 writes them; so does `taktwerk docs drives -o docs`.
TEST(DrivePages, EqualTheGeneratedText) {
    config::DriveLibrary library({source.string() + "/config/drives"});
    const auto names = library.names();
    ASSERT_FALSE(names.empty());
    for (const auto& name : names) {
        const auto* drive = library.find(name);
        ASSERT_NE(drive, nullptr) << name << ": " << library.errors().front().text();
        if (!std::filesystem::exists(source.string() + "/docs/drives/" + name + ".md")) continue;
        const auto pages = drive_pages(*drive, source.string() + "/docs");
        ASSERT_TRUE(pages.ok()) << pages.error().text();
        for (const auto& page : *pages) {
            const auto file = source.string() + "/docs/" + page.file;
            if (std::getenv("TAKTWERK_REGENERATE") != nullptr) std::ofstream(file) << page.text;
            EXPECT_TRUE(committed_page(file) == page.text)
                << page.file << " is not what the drive file gives: run `taktwerk docs drives " << name << " -o docs` and commit it";
        }
    }
}

}  // namespace
}  // namespace taktwerk::apps
