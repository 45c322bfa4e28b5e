// `taktwerk bus eeprom` as a user meets it, on the simulated slaves of the demo machine and on files.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "apps/bus/eeprom.hpp"
#include "apps/terminal/exit_code.hpp"
#include "core/bytes.hpp"
#include "ecat/eeprom/sii_fields.hpp"
#include "ecat/wire/sii.hpp"
#include "tests/apps/in_process.hpp"
#include "tests/apps/machine_files.hpp"

namespace taktwerk::apps {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class EepromCommand : public ::testing::Test {
protected:
    EepromCommand() { fs::create_directories(folder); }
    ~EepromCommand() override { fs::remove_all(folder); }

    /// On the demo, whose backups go into `folder`.
    Outcome eeprom(std::vector<std::string> words) {
        const bool writes = words.front() != "read";
        words.insert(words.begin(), {"bus", "eeprom"});
        words.insert(words.end(), {"--machine", demo, "--simulate"});
        if (writes) words.insert(words.end(), {"-d", folder});
        return in_process(std::move(words));
    }
    /// The image of a slave of the demo, with `change` made to it, as a file.
    std::string changed(const std::string& slave, const std::function<void(EepromImage&)>& change) {
        auto path = folder + "/image.bin";
        fs::remove(path);
        EXPECT_EQ(eeprom({"read", slave, "-o", path}).code, exit_ok);
        auto image = read_eeprom_file(path).value();
        change(image);
        fs::remove(path);
        EXPECT_TRUE(write_eeprom_file(path, image));
        return path;
    }
    [[nodiscard]] std::size_t files() const {
        return static_cast<std::size_t>(std::distance(fs::directory_iterator{folder}, fs::directory_iterator{}));
    }

    const std::string folder = (fs::temp_directory_path() / ("taktwerk-eeprom-" + std::to_string(::getpid()))).string();
};

TEST_F(EepromCommand, ReadShowsWhatTheSlaveSaysOfItself) {
    const auto read = eeprom({"read", "x_drive"});
    ASSERT_EQ(read.code, exit_ok) << read.err;
    EXPECT_THAT(read.out, HasSubstr("slave 0 'x_drive': EEPROM of 2048 bytes"));
    EXPECT_THAT(read.out, HasSubstr("checksum right"));
    EXPECT_THAT(read.out, HasSubstr("vendor 000007FBh product 000C0108h"));  // SV33-E manual
    EXPECT_THAT(read.out, HasSubstr("'SV33-ECAT'"));
    EXPECT_THAT(read.out, AllOf(HasSubstr("Categories"), HasSubstr("Sync managers"), HasSubstr("Rx 1600h"), HasSubstr("Strings")));
}

TEST_F(EepromCommand, ReadKeepsTheBytesAndShowSaysTheSameOfThem) {
    const auto path = folder + "/x.bin";
    const auto read = eeprom({"read", "x_drive", "-o", path, "--json"});
    ASSERT_EQ(read.code, exit_ok) << read.err;
    ASSERT_EQ(fs::file_size(path), 2048u);
    auto shown = in_process({"bus", "eeprom", "show", path, "--json"}).json();
    for (const auto& [key, value] : shown.items()) EXPECT_EQ(value, read.json()[key]) << key;
    EXPECT_EQ(shown["vendor"], 0x7FB);
    EXPECT_EQ(shown["checksum_right"], true);
    EXPECT_EQ(shown["sync_managers"][0]["use"], "mailbox out");
    EXPECT_TRUE(shown["defects"].empty());
    EXPECT_THAT(in_process({"bus", "eeprom", "show", path}).out, HasSubstr("SV33-ECAT"));

    EXPECT_EQ(eeprom({"read", "x_drive", "-o", path}).code, exit_ok) << "the same content: nothing to refuse";
    const auto other = eeprom({"read", "z_drive", "-o", path});
    EXPECT_EQ(other.code, exit_bad_file);
    EXPECT_THAT(other.err, HasSubstr("nothing is written over"));
}

TEST_F(EepromCommand, ShowTakesAnyBytes) {
    const auto path = folder + "/odd.bin";
    std::ofstream(path) << "abc";
    EXPECT_EQ(in_process({"bus", "eeprom", "show", path}).code, exit_bad_file);
    EXPECT_EQ(in_process({"bus", "eeprom", "show", folder}).code, exit_bad_file);
    EXPECT_EQ(in_process({"bus", "eeprom", "show", folder + "/nothing"}).code, exit_bad_file);
    std::ofstream(folder + "/empty.bin") << std::string(512, '\xFF');
    EXPECT_THAT(in_process({"bus", "eeprom", "show", folder + "/empty.bin"}).out, HasSubstr("it is empty"));
    std::ofstream(folder + "/short.bin") << "abcd";
    EXPECT_THAT(in_process({"bus", "eeprom", "show", folder + "/short.bin"}).out, HasSubstr("shorter than its 64-word header"));
}

TEST_F(EepromCommand, AnImageInIntelHexIsTheSameImage) {
    const auto binary = folder + "/x.bin", hex = folder + "/x.hex";
    ASSERT_EQ(eeprom({"read", "x_drive", "-o", binary}).code, exit_ok);
    const auto image = read_eeprom_file(binary).value();
    std::ofstream text(hex);
    for (std::size_t at = 0; at < image.size(); at += 16) {
        auto sum = static_cast<unsigned>(16 + at / 256 + at % 256);
        text << fmt::format(":10{:04X}00", at);
        for (std::size_t n = 0; n < 16; ++n) {
            const auto byte = std::to_integer<unsigned>(image[at + n]);
            text << fmt::format("{:02X}", byte);
            sum += byte;
        }
        text << fmt::format("{:02X}\r\n", (0x100 - sum % 0x100) % 0x100);
    }
    text << ":00000001FF\r\n" << std::flush;
    const auto shown = in_process({"bus", "eeprom", "show", hex, "--json"});
    ASSERT_EQ(shown.code, exit_ok) << shown.err;
    EXPECT_EQ(shown.json()["strings"], in_process({"bus", "eeprom", "show", binary, "--json"}).json()["strings"]);
    EXPECT_EQ(read_eeprom_file(hex).value(), image);
    EXPECT_EQ(eeprom({"write", "x_drive", hex}).out, "slave 0 'x_drive': its EEPROM holds just that; nothing was written\n");

    std::ofstream(folder + "/cut.hex") << ":020000001122CB\n";
    const auto cut = in_process({"bus", "eeprom", "show", folder + "/cut.hex"});
    EXPECT_EQ(cut.code, exit_bad_file);
    EXPECT_THAT(cut.err, HasSubstr("cut.hex:1: the end record"));
}

// As found in a public image: a name with NULs in it.
TEST_F(EepromCommand, NoNameOfASlaveReachesTheTerminalAsAControlCharacter) {
    const auto path = changed("x_drive", [](EepromImage& image) {
        const std::string name = "SV33-ECAT";
        const auto at = std::search(image.begin(), image.end(), name.begin(), name.end(),
                                    [](std::byte a, char b) { return a == static_cast<std::byte>(b); });
        ASSERT_NE(at, image.end());
        at[1] = std::byte{0x1B};
        at[2] = std::byte{0x00};
    });
    const auto shown = in_process({"bus", "eeprom", "show", path});
    EXPECT_THAT(shown.out, HasSubstr("S  3-ECAT"));
    EXPECT_EQ(shown.out.find('\0'), std::string::npos);
    EXPECT_EQ(shown.out.find('\x1B'), std::string::npos);
}

TEST_F(EepromCommand, BackupKeepsEverySlaveInAFileOfItsOwnAndWritesNothingOver) {
    const auto all = eeprom({"backup"});
    ASSERT_EQ(all.code, exit_ok) << all.err;
    EXPECT_EQ(files(), 4u);
    const auto name = folder + "/slave0-000007FB-000C0108-00010001-serial0.bin";
    ASSERT_TRUE(fs::exists(name));
    EXPECT_EQ(eeprom({"backup", "x_drive", "all"}).code, exit_ok);
    EXPECT_EQ(files(), 4u) << "the same content once more";
    auto other = read_eeprom_file(name).value();
    ecat::set_sii_alias(other, 5);
    fs::remove(name);
    ASSERT_TRUE(write_eeprom_file(name, other));
    const auto again = eeprom({"backup", "0", "--json"});
    ASSERT_EQ(again.code, exit_ok) << again.err;
    EXPECT_THAT(again.json()["backups"][0]["file"].get<std::string>(), HasSubstr("serial0-2.bin"));
    EXPECT_EQ(read_eeprom_file(name).value(), other);
}

TEST_F(EepromCommand, AliasIsWrittenReadBackAndSaysWhenItCounts) {
    const auto alias = eeprom({"alias", "y_drive", "17"});
    ASSERT_EQ(alias.code, exit_ok) << alias.err;
    EXPECT_THAT(alias.out,
                AllOf(HasSubstr("2 words differ"), HasSubstr("0004h"), HasSubstr("0011"), HasSubstr("checksum of words 0 to 6")));
    EXPECT_THAT(alias.out,
                AllOf(HasSubstr("backup of what is there: " + folder), HasSubstr("2 words written"), HasSubstr("next power-on")));
    EXPECT_THAT(alias.out, HasSubstr("`alias: 17`"));
    EXPECT_LT(alias.out.find("backup of"), alias.out.find("words written"));
    EXPECT_EQ(files(), 1u);
    EXPECT_EQ(eeprom({"alias", "y_drive", "0"}).out, "slave 1 'y_drive': its EEPROM holds just that; nothing was written\n");
    EXPECT_EQ(eeprom({"alias", "y_drive", "65536"}).code, exit_usage);
    EXPECT_EQ(eeprom({"alias", "y_drive"}).code, exit_usage);
}

TEST_F(EepromCommand, WriteSaysWordByWordWhatItChanges) {
    const auto path =
        changed("x_drive", [](EepromImage& image) { store_le<std::uint32_t>(image, 2 * ecat::sii_word::serial, 0x00010203); });
    const auto written = eeprom({"write", "x_drive", path, "--json"});
    ASSERT_EQ(written.code, exit_ok) << written.err;
    const auto json = written.json();
    EXPECT_EQ(json["words"], 2);
    EXPECT_EQ(json["changes"][0]["field"], "serial number");
    EXPECT_EQ(json["changes"][0]["to"], 0x0203);
    EXPECT_TRUE(fs::exists(json["backup"].get<std::string>()));
    EXPECT_THAT(written.err, HasSubstr(json["backup"].get<std::string>())) << "told before it is written";
    EXPECT_THAT(eeprom({"write", "x_drive", path}).out, HasSubstr("000Eh  0000 0000  0203 0001  serial number"));
}

TEST_F(EepromCommand, WriteRefusesWhatWouldMakeTheSlaveUseless) {
    const auto refused = [&](const std::string& path, const char* code) {
        const auto before = files();
        const auto outcome = eeprom({"write", "x_drive", path, "--json"});
        EXPECT_EQ(outcome.code, exit_refused);
        EXPECT_EQ(outcome.json()["error"]["code"], code);
        EXPECT_EQ(files(), before) << "no backup where nothing is written";
    };
    refused(changed("x_drive", [](EepromImage& image) { image[2 * ecat::sii_word::alias] = std::byte{1}; }), "eeprom.image");
    refused(changed("x_drive", [](EepromImage& image) { image.resize(200); }), "eeprom.image");
    refused(changed("z_drive", [](EepromImage&) {}), "eeprom.other_device");
    refused(changed("x_drive", [](EepromImage& image) { image[2 * ecat::sii_word::revision] = std::byte{9}; }), "eeprom.other_device");
    refused(changed("x_drive", [](EepromImage& image) { image[2 * ecat::sii_word::size] = std::byte{3}; }), "eeprom.other_size");
    refused(changed("x_drive",
                    [](EepromImage& image) {
                        image[0] = std::byte{0x04};
                        ecat::set_sii_alias(image, 0);
                    }),
            "eeprom.other_interface");
    refused(changed("x_drive", [](EepromImage& image) { image.resize(4096, std::byte{0xFF}); }), "eeprom.too_large");
    const auto forced = eeprom({"write", "x_drive", changed("z_drive", [](EepromImage&) {}), "--force"});
    EXPECT_EQ(forced.code, exit_ok) << forced.err;
    EXPECT_EQ(eeprom({"write", "x_drive", changed("x_drive", [](EepromImage& image) { image.resize(4096); }), "--force"}).code,
              exit_refused);
}

TEST(EepromAfter, AShortImageLeavesWhatIsBehindIt) {
    ecat::Sii sii;
    sii.identity = {1, 2, 3, 0};
    sii.size_code = 15;
    auto before = ecat::build_sii(sii);
    before.back() = std::byte{0x55};
    auto file = ecat::build_sii(sii);
    file.resize(200);
    ecat::set_sii_alias(file, 7);
    const auto after = eeprom_after("slave 0", before, file, false);
    ASSERT_TRUE(after) << after.error().text();
    EXPECT_EQ(after->size(), before.size());
    EXPECT_EQ(after->back(), std::byte{0x55});
    EXPECT_EQ(ecat::parse_sii(*after).alias, 7);
}

// A checksum that is wrong keeps the controller from loading words 0 to 6; a right one would make it load them, whatever they are.
TEST(EepromAlias, OfAnImageThatIsNotInOrderIsRefused) {
    ecat::Sii sii;
    sii.identity = {1, 2, 3, 0};
    auto image = ecat::build_sii(sii);
    image[0] = std::byte{1};
    EXPECT_EQ(eeprom_with_alias("slave 0", image, 7, false).error().code, "eeprom.image");
    EXPECT_TRUE(eeprom_with_alias("slave 0", image, 7, true));
    EXPECT_FALSE(eeprom_with_alias("slave 0", EepromImage(16, std::byte{0}), 7, true)) << "no header at all";
}

}  // namespace
}  // namespace taktwerk::apps
