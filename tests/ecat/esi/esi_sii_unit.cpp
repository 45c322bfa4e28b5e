// The EEPROM that an ESI file describes. Words and categories: ETG.2010; elements: ETG.2000; numbers of types: ETG.1020.
#include "ecat/esi/esi_sii.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/bytes.hpp"
#include "tests/ecat/esi/esi_text.hpp"

namespace taktwerk::ecat::esi {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string box =
    "<GroupType>Boxes</GroupType><Info><Electrical><EBusCurrent>-2000</EBusCurrent></Electrical>"
    "<IdentificationReg134>1</IdentificationReg134><IdentificationAdo>#x0F18</IdentificationAdo></Info>"
    "<Fmmu>Outputs</Fmmu><Fmmu>Inputs</Fmmu><Fmmu>MBoxState</Fmmu>"
    "<Sm DefaultSize=\"128\" StartAddress=\"#x1000\" ControlByte=\"#x26\" Enable=\"1\">MBoxOut</Sm>"
    "<Sm DefaultSize=\"256\" StartAddress=\"#x1080\" ControlByte=\"#x22\" Enable=\"1\">MBoxIn</Sm>"
    "<Sm DefaultSize=\"4\" StartAddress=\"#x1100\" ControlByte=\"#x64\" Enable=\"1\" OpOnly=\"1\">Outputs</Sm>"
    "<RxPdo Fixed=\"1\" Mandatory=\"1\" Sm=\"2\"><Index>#x1600</Index><Name>Outputs</Name>"
    "<Entry><Index>#x7000</Index><SubIndex>1</SubIndex><BitLen>16</BitLen><Name>Value</Name><DataType>INT</DataType></Entry>"
    "<Entry><Index>#x7000</Index><SubIndex>2</SubIndex><BitLen>2</BitLen><Name>Mode</Name><DataType>BIT2</DataType></Entry>"
    "<Entry><Index>0</Index><BitLen>300</BitLen></Entry></RxPdo>"
    "<TxPdo><Index>#x1A00</Index><Name>Offered</Name></TxPdo>"
    "<Mailbox DataLinkLayer=\"1\"><CoE SdoInfo=\"1\" PdoAssign=\"1\" CompleteAccess=\"1\"/><FoE/></Mailbox>"
    "<Dc><OpMode><Name>Sync</Name><Desc>with SYNC0</Desc><AssignActivate>#x300</AssignActivate>"
    "<CycleTimeSync0 Factor=\"1\">0</CycleTimeSync0><ShiftTimeSync0>5000</ShiftTimeSync0></OpMode></Dc>";

Sii built(const std::string& eeprom, std::vector<std::string>* leftovers = nullptr) {
    const auto reading = reading_of(box + eeprom);
    EXPECT_THAT(reading.problems, IsEmpty());
    const auto made = esi_image(reading.device);
    if (leftovers != nullptr) *leftovers = made.leftovers;
    auto read = parse_sii(made.bytes);
    EXPECT_THAT(read.defects, IsEmpty());
    std::vector<std::string> ignored;
    EXPECT_EQ(read, sii_of(reading.device, ignored)) << "an image reads back as what it was made of";
    return read;
}

TEST(EsiImage, SaysWhoTheDeviceIs) {
    const auto sii = built({});
    EXPECT_EQ(sii.identity, (Identity{9999, 0x1001, 0x00020001, 0}));
    ASSERT_TRUE(sii.general);
    EXPECT_EQ(sii.string(sii.general->order), "BX1");
    EXPECT_EQ(sii.string(sii.general->name), "Box one");
    EXPECT_EQ(sii.string(sii.general->group), "Field boxes");
    EXPECT_EQ(sii.general->ebus_current, -2000);
    EXPECT_EQ(sii.general->physical_ports, 0x0011) << "two cables";
    EXPECT_EQ(sii.general->flags, 0x1C) << "data link layer, id in AL status, id in memory";
    EXPECT_EQ(sii.general->id_address, 0x0F18);
}

TEST(EsiImage, HasMailboxesProtocolsAndSyncManagers) {
    const auto sii = built({});
    EXPECT_EQ(sii.mailbox_out, (SiiMailbox{0x1000, 128}));
    EXPECT_EQ(sii.mailbox_in, (SiiMailbox{0x1080, 256}));
    EXPECT_EQ(sii.mailbox_protocols, 0x000C) << "CoE bit 2, FoE bit 3";
    EXPECT_EQ(sii.general->coe_details, 0x27) << "SDO, information, assignment, complete access";
    EXPECT_EQ(sii.general->foe_details, 1);
    EXPECT_THAT(sii.sync_managers, ElementsAre(SiiSyncManager{0x1000, 128, 0x26, 0, 1, SiiSyncManagerUse::mailbox_out},
                                               SiiSyncManager{0x1080, 256, 0x22, 0, 1, SiiSyncManagerUse::mailbox_in},
                                               SiiSyncManager{0x1100, 4, 0x64, 0, 9, SiiSyncManagerUse::outputs}));
    EXPECT_THAT(sii.fmmus, ElementsAre(SiiFmmuUse::outputs, SiiFmmuUse::inputs, SiiFmmuUse::mailbox_status));
}

TEST(EsiImage, HasProcessDataWithTypesAndLongGapsInParts) {
    const auto sii = built({});
    ASSERT_EQ(sii.rx_pdos.size(), 1u);
    const auto& pdo = sii.rx_pdos[0];
    EXPECT_EQ(pdo.index, 0x1600);
    EXPECT_EQ(pdo.sync_manager, 2);
    EXPECT_EQ(pdo.flags, 0x0011) << "mandatory, fixed";
    ASSERT_EQ(pdo.entries.size(), 4u);
    EXPECT_EQ(pdo.entries[0].data_type, 0x03) << "INTEGER16";
    EXPECT_EQ(sii.string(pdo.entries[0].name), "Value");
    EXPECT_EQ(pdo.entries[1].data_type, 0x31) << "BIT2";
    EXPECT_EQ(pdo.entries[2].bits, 255);
    EXPECT_EQ(pdo.entries[3].bits, 45);
    EXPECT_EQ(pdo.bits(), 318u);
    ASSERT_EQ(sii.tx_pdos.size(), 1u);
    EXPECT_EQ(sii.tx_pdos[0].sync_manager, SiiPdo::not_assigned);
}

TEST(EsiImage, HasItsClock) {
    const auto sii = built({});
    ASSERT_EQ(sii.dc_modes.size(), 1u);
    EXPECT_EQ(sii.dc_modes[0].assign_activate, 0x0300);
    EXPECT_EQ(sii.dc_modes[0].sync0_factor, 1);
    EXPECT_EQ(sii.dc_modes[0].sync0_shift, 5000);
    EXPECT_EQ(sii.string(sii.dc_modes[0].name), "Sync");
    EXPECT_EQ(sii.string(sii.dc_modes[0].description), "with SYNC0");
}

TEST(EsiImage, TakesConfigDataBootStrapAndCategoriesByteByByte) {
    std::vector<std::string> leftovers;
    const auto sii = built(
        "<Eeprom><ByteSize>4096</ByteSize><ConfigData>0506034464000000000012345678</ConfigData><BootStrap>0010800080108000</BootStrap>"
        "<Category><CatNo>2048</CatNo><Data>01020304</Data></Category>"
        "<Category><CatNo>#x0801</CatNo><DataUINT>#x1234</DataUINT><DataUINT>5</DataUINT></Category>"
        "<Category><CatNo>2050</CatNo><DataString>ABC</DataString></Category>"
        "<Category><CatNo>2051</CatNo><DataUDINT>#x01020304</DataUDINT></Category></Eeprom>",
        &leftovers);
    EXPECT_THAT(leftovers, IsEmpty());
    EXPECT_EQ(sii.size_code, 31) << "32 kbit";
    EXPECT_EQ(sii.pdi_control, 0x0605);
    EXPECT_EQ(sii.pdi_configuration, 0x4403);
    EXPECT_EQ(sii.sync_pulse_length, 0x0064);
    EXPECT_THAT(sii.pdi_configuration_more, ElementsAre(0x3412, 0x7856));
    EXPECT_EQ(sii.boot_mailbox_out, (SiiMailbox{0x1000, 0x0080}));
    EXPECT_EQ(sii.boot_mailbox_in, (SiiMailbox{0x1080, 0x0080}));
    const auto bytes = [](std::initializer_list<unsigned> values) {
        std::vector<std::byte> out;
        for (const unsigned value : values) out.push_back(static_cast<std::byte>(value));
        return out;
    };
    EXPECT_THAT(sii.others, ElementsAre(SiiOtherCategory{2048, bytes({1, 2, 3, 4})}, SiiOtherCategory{2049, bytes({0x34, 0x12, 5, 0})},
                                        SiiOtherCategory{2050, bytes({'A', 'B', 'C', 0})}, SiiOtherCategory{2051, bytes({4, 3, 2, 1})}));
}

TEST(EsiImage, SaysWhatAnEepromCannotHoldAndWhatIsMissing) {
    const auto reading = reading_of(
        "<RxPdo><Index>#x1600</Index><Name>Long</Name><Entry><Index>#x7000</Index><SubIndex>1</SubIndex>"
        "<BitLen>2048</BitLen><Name>Block</Name><DataType>ARRAY [0..255] OF BYTE</DataType></Entry></RxPdo>"
        "<Eeprom><ByteSize>128</ByteSize></Eeprom>");
    const auto made = esi_image(reading.device);
    EXPECT_THAT(made.leftovers,
                ElementsAre(HasSubstr("no ConfigData"), HasSubstr("7000h in PDO 1600h has 2048 bits"), HasSubstr("EEPROM 128")));
    EXPECT_EQ(parse_sii(made.bytes).rx_pdos.at(0).entries.at(0).bits, 255);
}

TEST(EsiImage, IsTheVendorsOwnWhereTheFileHoldsIt) {
    Sii sii;
    sii.identity = {9999, 0x1001, 0x00020001, 0};
    sii.size_code = 0;
    auto image = build_sii(sii);
    std::string text;
    for (const auto byte : image) text += fmt::format("{:02X}", std::to_integer<unsigned>(byte));
    EXPECT_EQ(esi_image(reading_of("<Eeprom><Data>" + text + "</Data></Eeprom>").device).bytes, image);
}

}  // namespace
}  // namespace taktwerk::ecat::esi
