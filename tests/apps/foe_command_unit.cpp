// `taktwerk bus file` and `taktwerk bus firmware` as a user meets them, on simulated slaves and on files.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/bus/foe.hpp"
#include "apps/bus/kept_file.hpp"
#include "apps/terminal/exit_code.hpp"
#include "tests/apps/gauge_files.hpp"
#include "tests/apps/in_process.hpp"
#include "tests/apps/machine_files.hpp"

namespace taktwerk::apps {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class FoeCommand : public ::testing::Test {
protected:
    Outcome gauge(std::vector<std::string> words) const {
        words.insert(words.begin(), "bus");
        words.insert(words.end(), {"--machine", files.machine, "--simulate"});
        return in_process(std::move(words));
    }
    Outcome firmware(std::vector<std::string> words) const {
        words.insert(words.begin(), {"firmware", "gauge"});
        words.emplace_back("--yes");
        return gauge(std::move(words));
    }
    const GaugeFiles files;
};

TEST_F(FoeCommand, FirmwareIsWrittenAndWhatDiffersIsSaid) {
    const auto written = firmware({files.firmware("firmware.bin", "2.1", 0x00020001)});
    ASSERT_EQ(written.code, exit_ok) << written.err;
    EXPECT_THAT(written.out, AllOf(HasSubstr("slave 1 'gauge'"), HasSubstr("12032 bytes written; it is back, in PREOP")));
    EXPECT_THAT(written.out, AllOf(HasSubstr("revision 00010000h -> 00020001h"), HasSubstr("software '1.0' -> '2.1'")));
    EXPECT_THAT(written.err, AllOf(HasSubstr("to BOOT"), HasSubstr("leave cable and power alone"), HasSubstr("50 %")));
}

TEST_F(FoeCommand, FirmwareAnswersScriptsInJson) {
    const auto written = firmware({files.firmware("firmware.bin", "2.1", 0x00020001), "--json"});
    ASSERT_EQ(written.code, exit_ok) << written.out;
    const auto json = written.json();
    EXPECT_EQ(json["ok"], true);
    EXPECT_EQ(json["firmware"], "complete");
    EXPECT_EQ(json["state"], "PREOP");
    EXPECT_EQ(json["before"]["software"], "1.0");
    EXPECT_EQ(json["after"]["revision"], 0x00020001);
    EXPECT_TRUE(written.err.empty()) << written.err;
}

TEST_F(FoeCommand, ARefusalSaysWhatTheSlaveIsLeftWithAndTheWayBack) {
    const auto other = firmware({files.firmware("firmware.bin", "2.1", 1, 0x9999)});
    EXPECT_EQ(other.code, exit_refused);
    EXPECT_THAT(other.err, AllOf(HasSubstr("800Dh"), HasSubstr("is in BOOT"), HasSubstr("give the same command again")));
    const auto named = firmware({files.firmware("x.bin", "2.1", 1)});
    EXPECT_EQ(named.code, exit_refused);
    EXPECT_THAT(named.err, AllOf(HasSubstr("8009h"), HasSubstr("is in INIT"), HasSubstr("its firmware is what it was")));
    const auto json = firmware({files.firmware("x.bin", "2.1", 1), "--json"}).json();
    EXPECT_EQ(json["ok"], false);
    EXPECT_EQ(json["firmware"], "untouched");
    EXPECT_EQ(json["error"]["code"], "foe.refused");
}

// /proc/self/mem can be opened and not read: EIO, as a disk that fails.
TEST_F(FoeCommand, AFileThatCannotBeReadIsAnEndBeforeTheBeginning) {
    for (const std::string& path : {files.folder + "/nothing", files.folder, std::string{"/proc/self/mem"}, files.keep("empty", "")}) {
        const auto outcome = firmware({path, "--json"});
        EXPECT_EQ(outcome.code, exit_bad_file) << path;
        EXPECT_EQ(outcome.json()["error"]["code"], "foe.file") << path;
    }
    const auto eeprom = gauge({"eeprom", "write", "gauge", "/proc/self/mem", "--json"});
    EXPECT_EQ(eeprom.code, exit_bad_file);
    EXPECT_EQ(eeprom.json()["error"]["code"], "eeprom.file");
}

TEST_F(FoeCommand, WhoHasNoFilesIsNotAsked) {
    const auto drive =
        in_process({"bus", "firmware", "x_drive", files.firmware("firmware.bin", "2.1", 1), "--machine", demo, "--simulate", "--yes"});
    EXPECT_EQ(drive.code, exit_refused);
    EXPECT_THAT(drive.err, HasSubstr("its EEPROM says that it has no FoE"));
    EXPECT_EQ(gauge({"file", "read", "io", "firmware"}).code, exit_refused);
    const auto forced = in_process({"bus", "file", "read", "x_drive", "firmware", "--machine", demo, "--simulate", "--force"});
    EXPECT_THAT(forced.err, HasSubstr("mailbox error 2"));
}

TEST_F(FoeCommand, FilesAreReadIntoFilesAndNothingIsWrittenOver) {
    const auto path = files.folder + "/image.bin";
    const auto read = gauge({"file", "read", "gauge", "firmware", "-o", path});
    ASSERT_EQ(read.code, exit_ok) << read.err;
    const auto image = read_whole_file(path, 1 << 20, "test");
    ASSERT_TRUE(image);
    const auto info = ecat::sim::read_firmware(*image);
    ASSERT_TRUE(info && info->sound);
    EXPECT_EQ(info->version, "1.0");
    EXPECT_EQ(gauge({"file", "read", "gauge", "firmware", "-o", path}).code, exit_bad_file);
    EXPECT_THAT(gauge({"file", "read", "gauge", "firmware"}).err, HasSubstr("-o FILE")) << "no text";
    EXPECT_THAT(gauge({"file", "read", "gauge", "nothing"}).err, HasSubstr("8001h file not found"));
}

// Nobody is there to say yes (standard input of a test is no terminal): the rehearsal on simulated slaves wants what the real thing wants.
TEST_F(FoeCommand, WithoutAYesNoFirmwareIsWrittenInASimulationNeither) {
    const auto image = files.firmware("firmware.bin", "2.1", 0x00020001);
    const auto asked = gauge({"firmware", "gauge", image});
    EXPECT_EQ(asked.code, exit_usage);
    EXPECT_THAT(asked.err, AllOf(HasSubstr("nothing was written"), HasSubstr("say --yes"), Not(HasSubstr("to BOOT"))));
    EXPECT_EQ(firmware({image}).code, exit_ok);
}

TEST_F(FoeCommand, ANameThatIsNoneDoesNotReachTheSlave) {
    const auto image = files.firmware("firmware.bin", "2.1", 0x00020001);
    for (const std::string bad : {"", "firm\nware", "firmware\x7f", "\x1b[2Jfirmware"}) {
        for (const auto& outcome :
             {firmware({image, "--name", bad}), gauge({"file", "read", "gauge", bad}), gauge({"file", "write", "gauge", bad, image})}) {
            EXPECT_EQ(outcome.code, exit_usage) << bad;
            EXPECT_THAT(outcome.err, bad.empty() ? HasSubstr("is empty") : HasSubstr("control character")) << bad;
            EXPECT_THAT(outcome.err, AllOf(Not(HasSubstr("refused")), Not(HasSubstr("to BOOT")))) << bad;
        }
    }
    EXPECT_THAT(firmware({files.firmware("firm\tware.bin", "2.1", 1)}).err, HasSubstr("control character 09h at place 5"))
        << "the name that the file lends it";
}

TEST_F(FoeCommand, WhereItGoesIsLookedAtBeforeTheSlaveIsRead) {
    const auto folder = gauge({"file", "read", "gauge", "nothing", "-o", files.folder});
    EXPECT_EQ(folder.code, exit_bad_file);
    EXPECT_THAT(folder.err, AllOf(HasSubstr("is a folder"), Not(HasSubstr("8001h"))));
    const auto taken = gauge({"file", "read", "gauge", "nothing", "-o", files.keep("taken", "text")});
    EXPECT_THAT(taken.err, AllOf(HasSubstr("there is such a file already"), Not(HasSubstr("8001h"))));
}

TEST_F(FoeCommand, FilesAreWritten) {
    const auto path = files.keep("note.txt", "hello");
    const auto written = gauge({"file", "write", "gauge", "note.txt", path});
    ASSERT_EQ(written.code, exit_ok) << written.err;
    EXPECT_THAT(written.out, HasSubstr("file 'note.txt' is written, 5 bytes"));
    const auto firmware = gauge({"file", "write", "gauge", "firmware", path});
    EXPECT_EQ(firmware.code, exit_refused);
    EXPECT_THAT(firmware.err, AllOf(HasSubstr("8008h only in BOOT"), HasSubstr("taktwerk bus firmware")));
}

TEST(FoePassword, IsANumberOf32Bits) {
    EXPECT_EQ(password_of("").value(), 0u);
    EXPECT_EQ(password_of("4711").value(), 4711u);
    EXPECT_EQ(password_of("0x12345678").value(), 0x12345678u);
    for (const char* bad : {"0x", "x", "1 ", "-1", "4294967296", "0x123456789"}) EXPECT_FALSE(password_of(bad)) << bad;
}

TEST(FoeProgressText, SaysHowFarAndWhatTheSlaveSays) {
    ecat::FoeProgress progress;
    progress.bytes = 4096;
    EXPECT_EQ(progress_text(progress), "4.0 KiB");
    progress.of = 12288;
    EXPECT_EQ(progress_text(progress), "4.0 of 12.0 KiB, 33 %");
    progress.busy = true;
    progress.done = 40;
    EXPECT_EQ(progress_text(progress), "4.0 of 12.0 KiB, 33 %; the slave is busy: 40 %");
    progress.entire = 80;
    progress.words = "erasing";
    EXPECT_EQ(progress_text(progress), "4.0 of 12.0 KiB, 33 %; the slave is busy: 40 of 80 'erasing'");
}

}  // namespace
}  // namespace taktwerk::apps
