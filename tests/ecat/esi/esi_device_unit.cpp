// What a device says of itself: sync managers, process data, mailbox, clock, slots. ETG.2000.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/ecat/esi/esi_text.hpp"

namespace taktwerk::ecat::esi {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Optional;

std::vector<std::string> paths(const std::vector<Unread>& unread) {
    std::vector<std::string> out;
    for (const auto& one : unread) out.push_back(one.path);
    return out;
}

TEST(EsiSyncManagers, HaveUseAddressSizeAndControl) {
    const auto reading = reading_of(
        "<Sm MinSize=\"34\" MaxSize=\"128\" DefaultSize=\"128\" StartAddress=\"#x1000\" ControlByte=\"#x26\" Enable=\"1\">MBoxOut</Sm>"
        "<Sm DefaultSize=\"128\" StartAddress=\"4224\" ControlByte=\"34\" Enable=\"1\">MBoxIn</Sm>"
        "<Sm DefaultSize=\"0\" StartAddress=\"#x1100\" ControlByte=\"#x64\" Enable=\"0\" OpOnly=\"1\">Outputs</Sm>"
        "<Sm StartAddress=\"#x1180\" ControlByte=\"#x20\"/>");
    ASSERT_THAT(reading.problems, IsEmpty());
    const auto& sms = reading.device.sync_managers;
    ASSERT_EQ(sms.size(), 4u);
    EXPECT_THAT(sms[0].use, Optional(SmUse::mailbox_out));
    EXPECT_EQ(sms[0].start, 0x1000);
    EXPECT_EQ(sms[0].size, 128);
    EXPECT_EQ(sms[0].control, 0x26);
    EXPECT_THAT(sms[1].use, Optional(SmUse::mailbox_in));
    EXPECT_EQ(sms[1].start, 0x1080);
    EXPECT_FALSE(sms[2].enable);
    EXPECT_TRUE(sms[2].op_only);
    EXPECT_THAT(sms[3].use, Optional(SmUse::inputs)) << "its control byte says it";
}

TEST(EsiPdos, HaveEntriesGapsExclusionsAndASyncManager) {
    const auto reading = reading_of(
        "<TxPdo Fixed=\"1\" Mandatory=\"true\" Sm=\"3\"><Index>#x1A00</Index><Name>Channel 1</Name>"
        "<Exclude>#x1A01</Exclude><Exclude>6658</Exclude>"
        "<Entry><Index>#x6000</Index><SubIndex>1</SubIndex><BitLen>2</BitLen><Name>Status</Name><DataType>BIT2</DataType></Entry>"
        "<Entry><Index>0</Index><BitLen>6</BitLen></Entry>"
        "<Entry><Index>#x6000</Index><SubIndex>#x11</SubIndex><BitLen>16</BitLen><Name>Value</Name><DataType>INT</DataType></Entry></TxPdo>"
        "<TxPdo OSFac=\"10\"><Index DependOnSlot=\"1\">#x1A01</Index><Name>Fast</Name></TxPdo>"
        "<RxPdo Virtual=\"1\" Sm=\"2\"><Index>#x1600</Index><Name>Out</Name></RxPdo>");
    ASSERT_THAT(reading.problems, IsEmpty());
    EXPECT_THAT(reading.unread, IsEmpty());
    const auto& device = reading.device;
    ASSERT_EQ(device.tx.size(), 2u);
    const auto& pdo = device.tx[0];
    EXPECT_EQ(pdo.index, 0x1A00);
    EXPECT_EQ(pdo.name, "Channel 1");
    EXPECT_TRUE(pdo.fixed);
    EXPECT_TRUE(pdo.mandatory);
    EXPECT_THAT(pdo.sync_manager, Optional(3));
    EXPECT_THAT(pdo.excludes, ElementsAre(0x1A01, 0x1A02));
    ASSERT_EQ(pdo.entries.size(), 3u);
    EXPECT_EQ(pdo.entries[0].bits, 2u);
    EXPECT_EQ(pdo.entries[1].index, 0);
    EXPECT_EQ(pdo.entries[1].bits, 6u);
    EXPECT_EQ(pdo.entries[2].sub, 0x11);
    EXPECT_EQ(pdo.entries[2].type, "INT");
    EXPECT_FALSE(device.tx[1].sync_manager) << "offered, not assigned";
    EXPECT_THAT(device.tx[1].oversampling, Optional(10u));
    EXPECT_TRUE(device.tx[1].depends_on_slot);
    ASSERT_EQ(device.rx.size(), 1u);
    EXPECT_TRUE(device.rx[0].is_virtual);
}

TEST(EsiPdos, AnEntryWithoutALengthOrWithAWordForOneIsAProblemWithItsPlace) {
    const auto reading = reading_of(
        "<TxPdo><Index>#x1A00</Index>\n<Entry><Index>#x6000</Index></Entry>\n"
        "<Entry><Index>#x6001</Index><BitLen>many</BitLen></Entry></TxPdo>\n<RxPdo Sm=\"77\"/>");
    ASSERT_EQ(reading.problems.size(), 4u);
    EXPECT_EQ(reading.problems[0].text(),  // in the order of reading: RxPdos first
              "box.xml:12:2 (Device 'BX1'/RxPdo): it has no Index. add <Index>...</Index>, or ask the vendor for a complete file");
    EXPECT_EQ(reading.problems[1].what, "Sm is 77, beyond 0 to 15");
    EXPECT_EQ(
        reading.problems[2].text(),
        "box.xml:10:2 (Device 'BX1'/TxPdo/Entry[1]): it has no BitLen. add <BitLen>...</BitLen>, or ask the vendor for a complete file");
    EXPECT_EQ(
        reading.problems[3].text(),
        "box.xml:11:30 (Device 'BX1'/TxPdo/Entry[2]/BitLen): BitLen is 'many', which is no number. write a number such as 16 or #x10");
}

TEST(EsiMailbox, HasWhatCoeCanAndInitCommands) {
    const auto reading = reading_of(
        "<Info><Mailbox><Timeout><RequestTimeout>100</RequestTimeout><ResponseTimeout>2000</ResponseTimeout></Timeout></Mailbox></Info>"
        "<Mailbox DataLinkLayer=\"true\"><CoE SdoInfo=\"1\" PdoAssign=\"true\" PdoConfig=\"0\" CompleteAccess=\"1\">"
        "<InitCmd "
        "CompleteAccess=\"1\"><Transition>PS</Transition><Transition>IP</Transition><Index>#x8000</Index><SubIndex>0</SubIndex><Data>0100</"
        "Data>"
        "<Comment>filter</Comment></InitCmd></CoE><FoE/></Mailbox>");
    ASSERT_THAT(reading.problems, IsEmpty());
    ASSERT_TRUE(reading.device.mailbox);
    const auto& mailbox = *reading.device.mailbox;
    ASSERT_TRUE(mailbox.coe);
    EXPECT_TRUE(mailbox.coe->sdo_info);
    EXPECT_TRUE(mailbox.coe->pdo_assign);
    EXPECT_FALSE(mailbox.coe->pdo_config);
    EXPECT_TRUE(mailbox.coe->complete_access);
    EXPECT_THAT(mailbox.other_protocols, ElementsAre("FoE"));
    EXPECT_THAT(mailbox.request_timeout, Optional(Duration(100ms)));
    EXPECT_THAT(mailbox.response_timeout, Optional(Duration(2s)));
    ASSERT_EQ(mailbox.init_commands.size(), 1u);
    const auto& command = mailbox.init_commands[0];
    EXPECT_THAT(command.transitions, ElementsAre("PS", "IP"));
    EXPECT_EQ(command.index, 0x8000);
    EXPECT_THAT(command.data, ElementsAre(std::byte{1}, std::byte{0}));
    EXPECT_TRUE(command.complete_access);
    EXPECT_EQ(command.comment, "filter");
}

TEST(EsiMailbox, DataThatAreNoBytesAreAProblem) {
    const auto reading =
        reading_of("<Mailbox><CoE><InitCmd><Transition>PS</Transition><Index>#x8000</Index><Data>#x1</Data></InitCmd></CoE></Mailbox>");
    ASSERT_EQ(reading.problems.size(), 1u);
    EXPECT_EQ(reading.problems[0].code, "esi.bytes");
    EXPECT_EQ(reading.problems[0].what, "Data is '#x1', which are no bytes in hexadecimal");
}

TEST(EsiClock, ModesHaveCyclesShiftsAndFactors) {
    const auto reading = reading_of(
        "<Dc><OpMode><Name>Synchron</Name><Desc>SM</Desc><AssignActivate>#x0000</AssignActivate></OpMode>"
        "<OpMode><Name>DC</Name><AssignActivate>#x0730</AssignActivate><CycleTimeSync0 Factor=\"-10\">0</CycleTimeSync0>"
        "<ShiftTimeSync0>-500</ShiftTimeSync0><CycleTimeSync1 Factor=\"1\">0</CycleTimeSync1></OpMode></Dc>");
    ASSERT_THAT(reading.problems, IsEmpty());
    EXPECT_TRUE(reading.device.has_dc);
    const auto& modes = reading.device.op_modes;
    ASSERT_EQ(modes.size(), 2u);
    EXPECT_EQ(modes[0].assign_activate, 0);
    EXPECT_EQ(modes[0].description, "SM");
    EXPECT_EQ(modes[1].assign_activate, 0x0730);
    EXPECT_EQ(modes[1].sync0_factor, -10);
    EXPECT_EQ(modes[1].sync0_shift, -500ns);
    EXPECT_EQ(modes[1].sync1_factor, 1);
}

TEST(EsiSlots, TakeModulesByIdentAndByClass) {
    const auto reading = reading_of(
        "<Slots MaxSlotCount=\"8\" SlotPdoIncrement=\"1\" SlotIndexIncrement=\"#x10\" DownloadModuleIdentList=\"1\">"
        "<Slot MinInstances=\"0\" MaxInstances=\"8\"><Name>Terminal</Name><ModuleIdent Default=\"1\">#x11</ModuleIdent>"
        "<ModuleClass><Class>IO</Class></ModuleClass></Slot></Slots>",
        "<Modules><Module><Type ModuleIdent=\"#x11\">DI4</Type><Name>4 inputs</Name>"
        "<TxPdo Sm=\"3\"><Index DependOnSlot=\"1\">#x1A00</Index><Name>In</Name>"
        "<Entry><Index "
        "DependOnSlot=\"1\">#x6000</Index><SubIndex>1</SubIndex><BitLen>1</BitLen><Name>Input</Name><DataType>BOOL</DataType></Entry>"
        "</TxPdo></Module>"
        "<Module><Type ModuleIdent=\"#x12\" ModuleClass=\"IO\">DO4</Type></Module>"
        "<Module><Type ModuleIdent=\"#x13\">Other</Type></Module></Modules>");
    ASSERT_THAT(reading.problems, IsEmpty());
    EXPECT_THAT(reading.unread, IsEmpty());
    ASSERT_TRUE(reading.device.slots);
    EXPECT_EQ(reading.device.slots->maximum, 8u);
    EXPECT_EQ(reading.device.slots->pdo_increment, 1);
    EXPECT_EQ(reading.device.slots->index_increment, 0x10);
    EXPECT_TRUE(reading.device.slots->download_idents);
    ASSERT_EQ(reading.device.slots->slots.size(), 1u);
    EXPECT_THAT(reading.device.slots->slots[0].default_ident, Optional(0x11u));
    ASSERT_EQ(reading.device.modules.size(), 2u) << "13h fits nowhere";
    EXPECT_EQ(reading.device.modules[0].type, "DI4");
    EXPECT_TRUE(reading.device.modules[0].tx.at(0).entries.at(0).depends_on_slot);
    EXPECT_EQ(reading.device.modules[1].ident, 0x12u);
}

TEST(EsiDevice, HasCurrentTimeOutsControllerAndEeprom) {
    const auto reading = reading_of(
        "<Info><Electrical><EBusCurrent>-2000</EBusCurrent></Electrical><StateMachine><Timeout><PreopTimeout>2000</PreopTimeout>"
        "<SafeopOpTimeout>9000</SafeopOpTimeout></Timeout></StateMachine>"
        "<EtherCATController><DpramSize>8192</DpramSize><SmCount>4</SmCount><FmmuCount>3</FmmuCount></EtherCATController></Info>"
        "<Fmmu>Outputs</Fmmu><Fmmu>Inputs</Fmmu>"
        "<Eeprom><ByteSize>2048</ByteSize><ConfigData>050603446400</ConfigData><BootStrap>0010800080108000</BootStrap></Eeprom>");
    ASSERT_THAT(reading.problems, IsEmpty());
    const auto& device = reading.device;
    EXPECT_EQ(device.physics, "YY");
    EXPECT_THAT(device.ebus_current, Optional(-2000));
    EXPECT_THAT(device.timeouts.preop, Optional(Duration(2s)));
    EXPECT_THAT(device.timeouts.safeop_op, Optional(Duration(9s)));
    EXPECT_FALSE(device.timeouts.back_to_init);
    EXPECT_THAT(device.controller.sync_managers, Optional(4u));
    EXPECT_THAT(device.controller.fmmus, Optional(3u));
    EXPECT_THAT(device.fmmus, ElementsAre("Outputs", "Inputs"));
    ASSERT_TRUE(device.eeprom);
    EXPECT_EQ(device.eeprom->size, 2048u);
    EXPECT_EQ(device.eeprom->config.size(), 6u);
}

TEST(EsiDevice, WhatNobodyReadsIsCountedWithItsFirstLine) {
    const auto reading = reading_of(
        "<Image16x14/>\n<Su>one</Su>\n<Su>two</Su><TxPdo Ref=\"7\"><Index>#x1A00</Index></TxPdo>"
        "<VendorSpecific><Deep><Deeper/></Deep></VendorSpecific>");
    EXPECT_THAT(paths(reading.unread), ElementsAre("Device/Su", "Device/TxPdo@Ref", "Device/VendorSpecific")) << "and no word of pictures";
    EXPECT_EQ(reading.unread[0].count, 2u);
    EXPECT_EQ(reading.unread[0].line, 10u);
}

}  // namespace
}  // namespace taktwerk::ecat::esi
