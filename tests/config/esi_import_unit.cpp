// A vendor's device as a device file: it is read back by the loader of all device files as the same device, and what it cannot hold is told.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "config/device_file/device_file_text.hpp"
#include "config/device_file/device_loader.hpp"
#include "config/esi_import/esi_import.hpp"
#include "ecat/esi/choose_device.hpp"
#include "tests/ecat/esi/esi_text.hpp"

namespace taktwerk::config {
namespace {

using ecat::esi::EsiFile;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// A vendor and devices that do not exist (tests/apps/esi/README.md).
const std::string works_xml = std::string(TAKTWERK_SOURCE_DIR) + "/tests/apps/esi/works.xml";

Result<EsiImport> import_of(const EsiFile& file, const std::string& type, const std::string& name = {}) {
    const auto chosen = ecat::esi::choose_device(file, type, {});
    if (!chosen) return chosen.error();
    return import_device(file.read(*chosen), file.vendor_name(), "works.xml", name);
}

EsiImport works(const std::string& type) {
    const auto file = EsiFile::open(works_xml);
    if (!file) {
        ADD_FAILURE() << file.error().text();
        return {};
    }
    auto import = import_of(*file, type);
    if (!import) ADD_FAILURE() << import.error().text();
    return import ? std::move(*import) : EsiImport{};
}

/// Through the text of the file and its loader.
LoadedDevice loaded(const EsiImport& import) {
    auto back = load_device_text(import.file.name + ".yaml", device_file_text(import.file, "heading"));
    if (const auto* errors = std::get_if<std::vector<Error>>(&back)) {
        for (const auto& error : *errors) ADD_FAILURE() << error.text();
        return {};
    }
    return std::move(std::get<LoadedDevice>(back));
}

/// What is wrong with it as the only slave of a bus.
std::string on_a_bus(const LoadedDevice& device) {
    ecat::BusConfig bus;
    ecat::SlaveConfig slave;
    slave.name = "it", slave.position = 0, slave.device = device.device, slave.dc = device.device->dc.supported;
    bus.slaves.push_back(slave);
    std::string all;
    for (const auto& error : ecat::check(bus)) all += error.text() + "\n";
    return all;
}

auto left(const std::string& what, const std::string& meaning) {
    return Contains(AllOf(Field(&Leftover::what, HasSubstr(what)), Field(&Leftover::meaning, HasSubstr(meaning))));
}

std::vector<std::string> names_of(const LoadedDevice& device) {
    std::vector<std::string> out;
    for (const auto& channel : device.channels) out.push_back(channel.name);
    return out;
}

TEST(EsiImport, ATerminalWithoutAMailboxIsTheSameDeviceWhenItsFileIsRead) {
    const auto import = works("DI2");
    const auto device = loaded(import);
    ASSERT_NE(device.device, nullptr);
    const auto& d = *device.device;
    EXPECT_EQ(d.name, "di2");
    EXPECT_EQ(device.vendor, "Works");
    EXPECT_EQ(device.title, "2 digital inputs");
    EXPECT_EQ(device.source, "works.xml (ESI), DI2 revision 00020000h");
    EXPECT_EQ(device.checked, "vendor_file");
    EXPECT_EQ(d.identity, (ecat::Identity{9999, 0xD14, 0x20000, 0}));
    EXPECT_EQ(d.revision_rule, ecat::RevisionRule::at_least) << "CheckRevisionNo EQ_OR_G";
    EXPECT_EQ(d.ebus_current, 90);
    EXPECT_FALSE(d.mailbox);
    ASSERT_EQ(d.sync_managers.size(), 1u);
    EXPECT_EQ(d.sync_managers[0].use, ecat::SmUse::inputs);
    EXPECT_EQ(d.sync_managers[0].start, 0x1000);
    EXPECT_EQ(d.sync_managers[0].size, 1);
    ASSERT_EQ(d.tx_pdos.size(), 2u);
    EXPECT_EQ(d.tx_pdos[1].index, 0x1A01);
    EXPECT_TRUE(d.tx_pdos[1].fixed);
    EXPECT_EQ(d.tx_pdos[1].sync_manager, 0);
    EXPECT_THAT(d.tx_pdos[1].entries, ElementsAre(ecat::PdoEntry{0x6010, 1, 1}));
    EXPECT_THAT(d.tx_assigned, ElementsAre(0x1A00, 0x1A01));
    EXPECT_THAT(names_of(device), ElementsAre("channel_1_input", "channel_2_input"));
    EXPECT_EQ(on_a_bus(device), "");
}

TEST(EsiImport, AnAnalogTerminalHasMailboxDictionaryStartUpAndAlternatives) {
    const auto import = works("AI1");
    const auto device = loaded(import);
    ASSERT_NE(device.device, nullptr);
    const auto& d = *device.device;
    EXPECT_EQ(device.title, "1 analog input, \"current\": 4 to 20 mA");
    ASSERT_TRUE(d.mailbox);
    EXPECT_TRUE(d.mailbox->coe);
    EXPECT_TRUE(d.mailbox->complete_access);
    EXPECT_TRUE(d.mailbox->sdo_info);
    ASSERT_EQ(d.sync_managers.size(), 4u);
    EXPECT_EQ(d.sync_managers[0].size, 128);
    EXPECT_EQ(d.sync_managers[3].start, 0x1180);
    EXPECT_EQ(d.sync_managers[3].control, 0x20);
    EXPECT_EQ(d.sync_managers[3].size, 0) << "with CoE the PDOs give it";
    EXPECT_THAT(d.tx_assigned, ElementsAre(0x1A00)) << "1A01h is offered";
    EXPECT_THAT(d.tx_pdos.at(0).entries,
                ElementsAre(ecat::PdoEntry{0x6000, 1, 1}, ecat::PdoEntry{0x6000, 2, 1}, ecat::PdoEntry{0x6000, 3, 2},
                            ecat::PdoEntry{0, 0, 12}, ecat::PdoEntry{0x6000, 0x11, 16}));
    const auto* filter = find_object(d, 0x8000, 1);
    ASSERT_NE(filter, nullptr);
    EXPECT_EQ(filter->name, "Settings: Filter");
    EXPECT_EQ(filter->type, ecat::DataType::U16);
    EXPECT_EQ(filter->value, 1);
    EXPECT_EQ(filter->access, ecat::Access::rw);
    const auto* value = find_object(d, 0x6000, 0x11);
    ASSERT_NE(value, nullptr) << "of a PDO, and not in the dictionary";
    EXPECT_EQ(value->type, ecat::DataType::I16);
    ASSERT_EQ(device.startup.size(), 1u);
    EXPECT_EQ(device.startup[0].index, 0x8000);
    EXPECT_EQ(device.startup[0].value, 1);
    EXPECT_EQ(device.startup[0].at, ecat::Transition::PreopToSafeop);
    EXPECT_THAT(names_of(device), ElementsAre("underrange", "overrange", "limit", "value"));
    EXPECT_FALSE(d.dc.supported) << "the vendor's first mode has no clock";
    EXPECT_EQ(on_a_bus(device), "");
}

TEST(EsiImport, NothingIsDroppedWithoutAWord) {
    const auto import = works("AI1");
    EXPECT_THAT(import.leftovers, left("1A00h excludes 1A01h", "choose one of them"));
    EXPECT_THAT(import.leftovers, left("init command PS 8010h:00 = 010203", "in one piece"));
    EXPECT_THAT(import.leftovers, left("FoE", "nobody here speaks that"));
    EXPECT_THAT(import.leftovers, left("mode 'DC' of the clock (0300h, sampled at SYNC0)", "dc: { supported: true }"));
    EXPECT_THAT(import.leftovers, left("mode 'DC'", "sync0_shift: 10 us"));
    EXPECT_THAT(import.leftovers, left("1 values of types that are not known here: 8000h:02 (UINT24)", "bus sdo"));
    EXPECT_THAT(import.leftovers, left("SM2 is not enabled", "when it carries process data"));
    EXPECT_THAT(import.leftovers, left("mailbox: an answer may take 2000 ms", "times of its own"));
    EXPECT_THAT(import.leftovers, left("Device/Su (1, first in line 53)", "not read"));
    EXPECT_THAT(works("DI2").leftovers, left("contents of its EEPROM", "brings its own"));
}

TEST(EsiImport, ABoxKeepsItsSlotsAndModules) {
    const auto device = loaded(works("BOX"));
    ASSERT_NE(device.device, nullptr);
    const auto& slots = device.device->slots;
    EXPECT_EQ(slots.count, 4);
    EXPECT_EQ(slots.pdo_increment, 1);
    EXPECT_EQ(slots.index_increment, 0x10);
    EXPECT_TRUE(slots.may_be_empty) << "MinInstances 0";
    ASSERT_EQ(slots.modules.size(), 2u);
    EXPECT_EQ(slots.modules[0].name, "DI4");
    EXPECT_EQ(slots.modules[0].ident, 0x11u);
    EXPECT_THAT(slots.modules[0].tx_pdos.at(0).entries,
                ElementsAre(ecat::PdoEntry{0x6000, 1, 1}, ecat::PdoEntry{0x6000, 2, 1}, ecat::PdoEntry{0, 0, 6}));
    EXPECT_EQ(slots.modules[1].rx_pdos.at(0).sync_manager, 2);
    const auto* in_slot_2 = find_object(*device.device, 0x7020, 1);
    ASSERT_NE(in_slot_2, nullptr) << "what modules carry is there in every slot";
    EXPECT_EQ(in_slot_2->type, ecat::DataType::I16);
    EXPECT_EQ(in_slot_2->mappable, ecat::Mappable::rx);
    EXPECT_EQ(on_a_bus(device), "");
}

TEST(EsiImport, ADriveIsADeviceWithARemarkOfWhatThatMeans) {
    const auto import = works("SERVO");
    const auto device = loaded(import);
    ASSERT_NE(device.device, nullptr);
    EXPECT_THAT(import.leftovers, left("it is a drive (profile 402)", "no axis can be on it"));
    EXPECT_TRUE(device.device->dc.supported);
    EXPECT_TRUE(device.device->dc.required) << "it has no mode without SYNC0";
    EXPECT_FALSE(device.device->rx_pdos.at(0).fixed) << "PdoConfig";
    EXPECT_EQ(find_object(*device.device, 0x6064, 0)->type, ecat::DataType::I32);
    EXPECT_EQ(on_a_bus(device), "");
}

TEST(EsiImport, ADescriptionWithAHoleIsRefusedWithThePlace) {
    const auto file = EsiFile::open(works_xml);
    ASSERT_TRUE(file);
    const auto torn = import_of(*file, "TORN");
    ASSERT_FALSE(torn);
    EXPECT_EQ(torn.error().subject, works_xml + ":104:12 (Device 'TORN'/TxPdo/Entry)");
    EXPECT_EQ(torn.error().what, "it has no BitLen");
}

Result<EsiImport> import_text(const std::string& content, const std::string& name = {}) {
    const auto file = ecat::esi::parsed(ecat::esi::file_with(ecat::esi::device_with(content)));
    if (!file) return file.error();
    return import_of(*file, "", name);
}

TEST(EsiImport, WhatNoDeviceFileCanHoldIsRefused) {
    const auto refused = [](const std::string& content) {
        const auto import = import_text(content);
        return import ? std::string("imported") : import.error().text();
    };
    EXPECT_EQ(refused("<Sm StartAddress=\"#x1000\" Enable=\"1\"/>"),
              "BX1: nothing says what sync manager 0 is for. ask the vendor for a newer file");
    EXPECT_EQ(refused("<Sm StartAddress=\"#x0800\">Inputs</Sm>"),
              "BX1: sync manager 0 begins at 0800h, inside the controller's registers. ask the vendor for a newer file");
    EXPECT_EQ(refused("<Sm StartAddress=\"#x1000\">MBoxOut</Sm>"),
              "BX1: the mailbox in sync manager 0 has no size. ask the vendor for a newer file");
    EXPECT_EQ(refused("<TxPdo Sm=\"0\"><Index>16</Index><Name>AT</Name></TxPdo><Mailbox><SoE/></Mailbox>"),
              "BX1: 'AT' has the number 0010h; PDOs have 1600h to 1BFFh. this device does not speak CoE: it cannot be used here");
    EXPECT_EQ(refused("<TxPdo Sm=\"3\"><Index>#x1A00</Index></TxPdo>"),
              "BX1: 1A00h goes through sync manager 3, and it has 0. correct the file, or ask the vendor for a newer one");
}

TEST(EsiImport, WhatIsNotAssignedNeedsNoNumberAndWhatCarriesNothingNoAddress) {
    const auto import = import_text(
        "<Sm StartAddress=\"#x1000\" ControlByte=\"#x20\" DefaultSize=\"1\">Inputs</Sm><Sm>Inputs</Sm>"
        "<TxPdo><Index>#x15FE</Index><Name>Raw</Name></TxPdo>");
    ASSERT_TRUE(import) << import.error().text();
    EXPECT_EQ(import->file.device.sync_managers.size(), 1u);
    EXPECT_THAT(import->leftovers, left("the last 1 of 2 sync managers", "without an address"));
    EXPECT_THAT(import->leftovers, left("'Raw' with the number 15FEh", "left out"));
    EXPECT_THAT(import->file.tx, IsEmpty());
}

TEST(EsiImport, AValueOfMoreThan255BitsKeepsItsPlace) {
    const auto import = import_text(
        "<Sm StartAddress=\"#x1000\" ControlByte=\"#x20\">Inputs</Sm><TxPdo Sm=\"0\"><Index>#x1A00</Index>"
        "<Entry><Index>#x6000</Index><BitLen>400</BitLen><Name>Text</Name></Entry></TxPdo>");
    ASSERT_TRUE(import) << import.error().text();
    EXPECT_THAT(import->file.tx.at(0).pdo.entries, ElementsAre(ecat::PdoEntry{0, 0, 255}, ecat::PdoEntry{0, 0, 145}));
    EXPECT_EQ(import->file.device.sync_managers.at(0).size, 50) << "400 bits, no size of its own";
    EXPECT_THAT(import->leftovers, left("'Text' (6000h:00) of 400 bits", "its place is kept"));
    EXPECT_NE(loaded(*import).device, nullptr);
}

TEST(EsiImport, NumbersThatVendorsWriteWithoutTheirSignGetIt) {
    const auto import = import_text(
        "<Profile><Dictionary><Objects><Object><Index>#x2000</Index><Name>N</Name><Type>DINT</Type>"
        "<Info><DefaultValue>#xFFFFFFFF</DefaultValue><MinValue>#x80000000</MinValue><MaxValue>#x7FFFFFFF</MaxValue></Info></Object>"
        "<Object><Index>#x2001</Index><Type>USINT</Type><Info><DefaultValue>300</DefaultValue></Info></Object></Objects></Dictionary></"
        "Profile>");
    ASSERT_TRUE(import);
    const auto& object = import->file.objects.at(0).object;
    EXPECT_EQ(object.value, -1);
    EXPECT_EQ(object.minimum, -2147483648LL);
    EXPECT_EQ(object.maximum, 2147483647LL);
    EXPECT_FALSE(import->file.objects.at(1).has_value) << "300 is no USINT";
    EXPECT_THAT(import->leftovers, left("defaults or limits of 1 objects", "left out"));
    EXPECT_NE(loaded(*import).device, nullptr) << "an object without a name gets one";
}

TEST(EsiImport, InitCommandsOfPdosAndModulesAreTheMastersOwn) {
    const auto command = [](const char* transition, const char* index, const char* data) {
        return std::string("<InitCmd><Transition>") + transition + "</Transition><Index>" + index + "</Index><Data>" + data +
               "</Data></InitCmd>";
    };
    const auto import = import_text(
        "<Sm StartAddress=\"#x1000\" DefaultSize=\"128\">MBoxOut</Sm><Sm StartAddress=\"#x1080\" DefaultSize=\"128\">MBoxIn</Sm>"
        "<Mailbox><CoE>" +
        command("PS", "#x1C12", "00") + command("PS", "#xF030", "0100") + command("SO", "#x2001", "FEFF") + command("OP", "#x2002", "00") +
        command("PS", "#x2003", "010203") + command("IP", "#x2004", "01") + command("IP", "#x2004", "02") + "</CoE></Mailbox>");
    ASSERT_TRUE(import) << import.error().text();
    EXPECT_THAT(import->leftovers, left("PS 1C12h:00", "from `pdo:`"));
    EXPECT_THAT(import->leftovers, left("PS F030h:00", "from `modules:`"));
    EXPECT_THAT(import->leftovers, left("OP 2002h:00", "before SAFEOP or before OP"));
    EXPECT_THAT(import->leftovers, left("PS 2003h:00", "3 bytes"));
    EXPECT_THAT(import->leftovers, left("IP 2004h:00 = 02", "the later one is kept"));
    const auto device = loaded(*import);
    ASSERT_EQ(device.startup.size(), 2u);
    EXPECT_EQ(device.startup[0].at, ecat::Transition::SafeopToOp);
    EXPECT_EQ(device.startup[0].value, 0xFFFE);
    EXPECT_EQ(device.startup[1].value, 2);
}

TEST(EsiImport, NamesBecomeThoseOfFiles) {
    EXPECT_EQ(device_file_name("EL3104-0020"), "el3104-0020");
    EXPECT_EQ(device_file_name("2CS3E-D503"), "device-2cs3e-d503");
    EXPECT_EQ(device_file_name("Box, 8 in (M12)"), "box-8-in-m12");
    EXPECT_EQ(device_file_name(""), "device");
    EXPECT_EQ(device_file_name(std::string(60, 'a')), std::string(40, 'a'));
    const auto refused = import_text("", "8 inputs");
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, "esi.name");
    EXPECT_THAT(refused.error().remedy, HasSubstr("call the file bx1.yaml"));
}

TEST(DeviceFileText, QuotesWhatYamlWouldReadOtherwise) {
    EXPECT_EQ(quoted_yaml("a \"b\" \\ c: #d"), "\"a \\\"b\\\" \\\\ c: #d\"");
    EXPECT_EQ(quoted_yaml("two\nlines\x01"), "\"two lines\"");
}

}  // namespace
}  // namespace taktwerk::config
