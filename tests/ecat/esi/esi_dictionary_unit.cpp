// Dictionaries: objects whose types stand elsewhere in the file. ETG.2000, Dictionary; ETG.1020, data types.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/ecat/esi/esi_text.hpp"

namespace taktwerk::ecat::esi {
namespace {

using testing::IsEmpty;
using testing::Optional;

EsiReading dictionary(const std::string& types, const std::string& objects) {
    return reading_of("<Profile><ProfileNo>5001</ProfileNo><Dictionary><DataTypes>" + types + "</DataTypes><Objects>" + objects +
                      "</Objects></Dictionary></Profile>");
}

const EsiObject* at(const EsiReading& reading, std::uint16_t index, std::uint8_t sub) {
    const auto& all = reading.device.objects;
    const auto found = std::find_if(all.begin(), all.end(), [&](const EsiObject& one) { return one.index == index && one.sub == sub; });
    return found == all.end() ? nullptr : &*found;
}

TEST(EsiDictionary, AVariableHasTypeAccessMappingAndLimits) {
    const auto reading = dictionary("",
                                    "<Object><Index>#x6060</Index><Name>Modes of operation</Name><Type>SINT</Type><BitSize>8</BitSize>"
                                    "<Info><DefaultData>FF</DefaultData><MinValue>-3</MinValue><MaxValue>#x0A</MaxValue></Info>"
                                    "<Flags><Access>rw</Access><Category>m</Category><PdoMapping>R</PdoMapping></Flags></Object>");
    ASSERT_THAT(reading.problems, IsEmpty());
    EXPECT_THAT(reading.device.profiles, testing::ElementsAre(5001u));
    const auto* object = at(reading, 0x6060, 0);
    ASSERT_NE(object, nullptr);
    EXPECT_EQ(object->name, "Modes of operation");
    EXPECT_THAT(object->basic, Optional(DataType::I8));
    EXPECT_EQ(object->access, Access::rw);
    EXPECT_EQ(object->mappable, Mappable::rx);
    EXPECT_THAT(object->value, Optional(-1)) << "bytes are as on the wire, and the type has a sign";
    EXPECT_THAT(object->minimum, Optional(-3));
    EXPECT_THAT(object->maximum, Optional(10));
}

TEST(EsiDictionary, ARecordIsTakenApart) {
    const auto reading = dictionary(
        "<DataType><Name>DT8000</Name><BitSize>56</BitSize>"
        "<SubItem><SubIdx>0</SubIdx><Name>SubIndex "
        "000</Name><Type>USINT</Type><BitSize>8</BitSize><BitOffs>0</BitOffs><Flags><Access>ro</Access></Flags></SubItem>"
        "<SubItem><SubIdx>1</SubIdx><Name>Filter</Name><Type>DT0800</Type><BitSize>16</BitSize><BitOffs>16</BitOffs><Flags><Access>rw</"
        "Access></Flags></SubItem>"
        "<SubItem><SubIdx>17</SubIdx><Name>Gain</Name><Type>DINT</Type><BitSize>32</BitSize><BitOffs>32</BitOffs><Flags><Access>rw</"
        "Access><PdoMapping>TR</PdoMapping></Flags></SubItem>"
        "</DataType><DataType><Name>DT0800</Name><BaseType>UINT</BaseType><BitSize>16</BitSize>"
        "<EnumInfo><Text>off</Text><Enum>0</Enum></EnumInfo><EnumInfo><Text>50 Hz</Text><Enum>1</Enum></EnumInfo></DataType>",
        "<Object><Index>#x8000</Index><Name>Settings</Name><Type>DT8000</Type><BitSize>56</BitSize><Info>"
        "<SubItem><Name>SubIndex 000</Name><Info><DefaultData>11</DefaultData></Info></SubItem>"
        "<SubItem><Name>Filter</Name><Info><DefaultData>0100</DefaultData></Info></SubItem>"
        "<SubItem><Name>Gain</Name><Info><DefaultData>00000100</DefaultData></Info></SubItem>"
        "</Info></Object>");
    ASSERT_THAT(reading.problems, IsEmpty());
    EXPECT_THAT(reading.remarks, IsEmpty());
    ASSERT_EQ(reading.device.objects.size(), 3u);
    const auto* filter = at(reading, 0x8000, 1);
    ASSERT_NE(filter, nullptr);
    EXPECT_EQ(filter->name, "Settings: Filter");
    EXPECT_THAT(filter->basic, Optional(DataType::U16)) << "through the type that only names it";
    EXPECT_EQ(filter->meaning, "0 off · 1 50 Hz");
    EXPECT_THAT(filter->value, Optional(1));
    const auto* gain = at(reading, 0x8000, 17);
    ASSERT_NE(gain, nullptr);
    EXPECT_THAT(gain->value, Optional(65536));
    EXPECT_EQ(gain->mappable, Mappable::both);
}

TEST(EsiDictionary, DefaultsThatLeaveSomeOutGoByName) {
    const auto reading = dictionary(
        "<DataType><Name>DT</Name><SubItem><SubIdx>0</SubIdx><Name>SubIndex 000</Name><Type>USINT</Type></SubItem>"
        "<SubItem><SubIdx>1</SubIdx><Name>A</Name><Type>UINT</Type></SubItem><SubItem><SubIdx>2</SubIdx><Name>B</Name><Type>UINT</Type></"
        "SubItem></DataType>",
        "<Object><Index>#x2000</Index><Name>O</Name><Type>DT</Type><Info><SubItem><Name>B</Name><Info><DefaultValue>7</DefaultValue></"
        "Info></SubItem>"
        "<SubItem><Name>C</Name><Info><DefaultValue>8</DefaultValue></Info></SubItem></Info></Object>");
    EXPECT_FALSE(at(reading, 0x2000, 1)->value);
    EXPECT_THAT(at(reading, 0x2000, 2)->value, Optional(7));
    ASSERT_EQ(reading.remarks.size(), 1u);
    EXPECT_EQ(reading.remarks[0].what, "its type has no sub-index 'C' behind those before it");
    EXPECT_THAT(reading.problems, IsEmpty()) << "the device can do without";
}

TEST(EsiDictionary, AnArrayHasItsElements) {
    const auto reading = dictionary(
        "<DataType><Name>DT1C13ARR</Name><BaseType>UINT</BaseType><BitSize>48</BitSize><ArrayInfo><LBound>1</LBound><Elements>3</"
        "Elements></ArrayInfo></DataType>"
        "<DataType><Name>DT1C13</Name><BitSize>64</BitSize><SubItem><SubIdx>0</SubIdx><Name>SubIndex 000</Name><Type>USINT</Type></SubItem>"
        "<SubItem><Name>Elements</Name><Type>DT1C13ARR</Type><BitSize>48</BitSize><BitOffs>16</BitOffs><Flags><Access>rw</Access></Flags></"
        "SubItem></DataType>",
        "<Object><Index>#x1C13</Index><Name>TxPDO assign</Name><Type>DT1C13</Type></Object>");
    ASSERT_EQ(reading.device.objects.size(), 4u);
    const auto* third = at(reading, 0x1C13, 3);
    ASSERT_NE(third, nullptr);
    EXPECT_THAT(third->basic, Optional(DataType::U16));
    EXPECT_EQ(third->access, Access::rw);
    EXPECT_EQ(third->name, "TxPDO assign: 3");
}

TEST(EsiDictionary, StringsAndBytesThatNoTypeOfOursHolds) {
    const auto reading = dictionary(
        "<DataType><Name>RAW</Name><BaseType>BYTE</BaseType><ArrayInfo><LBound>0</LBound><Elements>4</Elements></ArrayInfo></DataType>",
        "<Object><Index>#x1008</Index><Name>Device name</Name><Type>STRING(3)</Type><Info><DefaultData>425831</DefaultData></Info></Object>"
        "<Object><Index>#x100A</Index><Name>Software</Name><Type>STRING(2)</Type><Info><DefaultString>01</DefaultString></Info></Object>"
        "<Object><Index>#x2100</Index><Name>Key</Name><Type>RAW</Type></Object>");
    EXPECT_EQ(at(reading, 0x1008, 0)->text, "BX1");
    EXPECT_EQ(at(reading, 0x100A, 0)->text, "01");
    EXPECT_FALSE(at(reading, 0x2100, 0)->basic);
}

TEST(EsiDictionary, TypesThatNameEachOtherEndSomewhere) {
    const auto reading =
        dictionary("<DataType><Name>A</Name><BaseType>B</BaseType></DataType><DataType><Name>B</Name><BaseType>A</BaseType></DataType>",
                   "<Object><Index>#x2000</Index><Type>A</Type></Object>");
    ASSERT_NE(at(reading, 0x2000, 0), nullptr);
    EXPECT_FALSE(at(reading, 0x2000, 0)->basic);
}

TEST(EsiDictionary, AWrongNumberInItIsARemark) {
    const auto reading =
        dictionary("", "<Object><Index>#x2000</Index><Type>UINT</Type><Info><DefaultValue>none</DefaultValue></Info></Object>");
    EXPECT_THAT(reading.problems, IsEmpty());
    ASSERT_EQ(reading.remarks.size(), 1u);
    EXPECT_EQ(reading.remarks[0].what, "DefaultValue is 'none', which is no number");
}

}  // namespace
}  // namespace taktwerk::ecat::esi
