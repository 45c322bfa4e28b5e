// `taktwerk bus eeprom make`, and the way back: an image made of a description is understood as that description.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>

#include "apps/bus/eeprom.hpp"
#include "apps/terminal/exit_code.hpp"
#include "config/device_file/device_loader.hpp"
#include "config/drive_file/drive_library.hpp"
#include "core/bytes.hpp"
#include "ecat/diagnosis/derived_config.hpp"
#include "ecat/eeprom/sii_fields.hpp"
#include "ecat/sim/sii_image.hpp"
#include "ecat/wire/sii.hpp"
#include "tests/apps/in_process.hpp"
#include "tests/apps/machine_files.hpp"

namespace taktwerk::apps {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

/// As `bus` understands a slave of which it knows nothing but its EEPROM.
ecat::DeviceDescription understood(const std::vector<std::byte>& image) {
    ecat::SurveyedSlave slave;
    slave.found.sii = ecat::parse_sii(image);
    EXPECT_TRUE(slave.found.sii.defects.empty());
    slave.found.identity = slave.found.sii.identity;
    slave.found.mailbox = {slave.found.sii.mailbox_out.start, slave.found.sii.mailbox_out.size, slave.found.sii.mailbox_in.start,
                           slave.found.sii.mailbox_in.size};
    return ecat::describe(slave);
}

std::string pdos_of(const std::vector<ecat::PdoDescription>& pdos, const std::vector<std::uint16_t>& assigned) {
    std::string text;
    for (const auto& pdo : pdos) {
        const bool used = std::find(assigned.begin(), assigned.end(), pdo.index) != assigned.end();
        text += fmt::format("\n{:04X}{}{}:", pdo.index, pdo.fixed ? " fixed" : "", used ? " assigned" : "");
        for (const auto& entry : pdo.entries) text += fmt::format(" {:04X}.{}/{}", entry.index, entry.sub, entry.bits);
    }
    return text;
}

void goes_round(const ecat::DeviceDescription& device) {
    SCOPED_TRACE(device.name);
    const auto back = understood(ecat::sim::sii_image(device, 7));
    EXPECT_EQ(back.identity, device.identity);
    EXPECT_EQ(back.mailbox.has_value(), device.mailbox.has_value());
    if (back.mailbox && device.mailbox) {
        EXPECT_EQ(back.mailbox->coe, device.mailbox->coe);
        EXPECT_EQ(back.mailbox->sdo_info, device.mailbox->sdo_info);
        EXPECT_EQ(back.mailbox->complete_access, device.mailbox->complete_access);
    }
    ASSERT_EQ(back.sync_managers.size(), device.sync_managers.size());
    for (std::size_t n = 0; n < back.sync_managers.size(); ++n) {
        EXPECT_EQ(back.sync_managers[n].use, device.sync_managers[n].use) << n;
        EXPECT_EQ(back.sync_managers[n].start, device.sync_managers[n].start) << n;
        EXPECT_EQ(back.sync_managers[n].control, device.sync_managers[n].control) << n;
    }
    EXPECT_EQ(pdos_of(back.rx_pdos, back.rx_assigned), pdos_of(device.rx_pdos, device.rx_assigned));
    EXPECT_EQ(pdos_of(back.tx_pdos, back.tx_assigned), pdos_of(device.tx_pdos, device.tx_assigned));
}

TEST(EepromMade, OfEveryShippedDeviceIsUnderstoodAsThatDevice) {
    config::DeviceLibrary devices({std::string(TAKTWERK_SOURCE_DIR) + "/config/devices"});
    std::size_t count = 0;
    for (const auto& name : devices.names())
        if (const auto* device = devices.find(name)) goes_round(*device->device), ++count;
    EXPECT_TRUE(devices.errors().empty());
    EXPECT_GE(count, 100u);
}

TEST(EepromMade, OfEveryShippedDriveIsUnderstoodAsThatDrive) {
    config::DriveLibrary drives({std::string(TAKTWERK_SOURCE_DIR) + "/config/drives"});
    std::size_t count = 0;
    for (const auto& name : drives.names())
        if (const auto* drive = drives.find(name); drive != nullptr && drive->device) goes_round(*drive->device), ++count;
    EXPECT_EQ(count, drives.names().size() - 1) << "the XP200 alone is on no bus";
    EXPECT_GT(count, 25u);
}

class EepromMake : public ::testing::Test {
protected:
    EepromMake() { fs::create_directories(folder); }
    ~EepromMake() override { fs::remove_all(folder); }
    [[nodiscard]] std::string file(const char* name) const { return folder + "/" + name; }
    const std::string folder = (fs::temp_directory_path() / ("taktwerk-eeprom-make-" + std::to_string(::getpid()))).string();
    const std::string works = std::string(TAKTWERK_SOURCE_DIR) + "/tests/apps/esi/works.xml";
};

TEST_F(EepromMake, TakesAVendorsFile) {
    const auto made =
        in_process({"bus", "eeprom", "make", works, "--device", "DI2", "-o", file("di2.bin"), "--serial", "5", "--alias", "9"});
    ASSERT_EQ(made.code, exit_ok) << made.err;
    EXPECT_THAT(made.out,
                AllOf(HasSubstr("EEPROM of 1024 bytes"), HasSubstr("vendor 0000270Fh product 00000D14h revision 00020000h serial 5"),
                      HasSubstr("'DI2'"), HasSubstr("Tx 1A01h"), HasSubstr("takes 90 mA"), HasSubstr("checksum right")));
    const auto sii = ecat::parse_sii(read_eeprom_file(file("di2.bin")).value());
    EXPECT_EQ(sii.alias, 9);
    EXPECT_TRUE(sii.defects.empty());
    EXPECT_EQ(in_process({"bus", "eeprom", "make", works, "-o", file("which.bin")}).code, exit_usage) << "several devices";
    EXPECT_EQ(in_process({"bus", "eeprom", "make", works, "--device", "TORN", "-o", file("torn.bin")}).code, exit_bad_file);
    EXPECT_FALSE(fs::exists(file("torn.bin")));
}

TEST_F(EepromMake, TakesADeviceFileAndWhatOnlyTheSlaveKnows) {
    const auto made = in_process({"bus", "eeprom", "make", "el1008", "--machine", demo, "-o", file("a.bin")});
    ASSERT_EQ(made.code, exit_ok) << made.err;
    EXPECT_THAT(made.out, HasSubstr("words 0 to 3"));
    auto like = read_eeprom_file(file("a.bin")).value();
    store_le<std::uint16_t>(like, 0, 0x1234);
    store_le<std::uint32_t>(like, 2 * ecat::sii_word::serial, 99);
    ecat::set_sii_alias(like, 3);
    ASSERT_TRUE(write_eeprom_file(file("backup.bin"), like));
    ASSERT_EQ(in_process({"bus", "eeprom", "make", "el1008", "--machine", demo, "--like", file("backup.bin"), "-o", file("b.bin")}).code,
              exit_ok);
    EXPECT_EQ(read_eeprom_file(file("b.bin")).value(), like);
    EXPECT_THAT(in_process({"bus", "eeprom", "make", "el10008", "--machine", demo, "-o", file("c.bin")}).err,
                HasSubstr("did you mean el1008"));
}

}  // namespace
}  // namespace taktwerk::apps
