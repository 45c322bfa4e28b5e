// A file as a whole: what is refused and where, which devices it holds, which one a word means.

#include "ecat/esi/esi_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>

#include "ecat/esi/choose_device.hpp"
#include "ecat/esi/esi_folder.hpp"
#include "tests/ecat/esi/esi_text.hpp"

namespace taktwerk::ecat::esi {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Error refusal(const std::string& text) {
    const auto file = parsed(text);
    return file ? Error{"none", "", "it was read", ""} : file.error();
}

TEST(EsiFile, WhatIsNoXmlIsRefusedWithItsPlace) {
    EXPECT_EQ(refusal("").text(),
              "box.xml: it is no XML file: there is no element in it. get the file anew from the vendor: it may have been cut or damaged "
              "on its way");
    const auto cut = refusal("<EtherCATInfo>\n<Vendor>\n  <Id>2</Idd>");
    EXPECT_EQ(cut.code, "esi.xml");
    EXPECT_EQ(cut.subject, "box.xml:3:10");
    EXPECT_THAT(cut.what, HasSubstr("Start-end tags mismatch"));
    EXPECT_EQ(refusal(std::string("\x7F") + "ELF\x02\x01\x01").code, "esi.xml");
}

TEST(EsiFile, FilesOfOtherKindsAreNamed) {
    const auto html = refusal("<html><body/></html>");
    EXPECT_EQ(html.code, "esi.not_esi");
    EXPECT_EQ(html.subject, "box.xml:1:2");
    EXPECT_EQ(html.what, "its first element is 'html', not EtherCATInfo");
    EXPECT_THAT(refusal("<EtherCATModule/>").remedy, HasSubstr("modules alone"));
    EXPECT_THAT(refusal("<EtherCATDict/>").remedy, HasSubstr("DictionaryFile"));
    EXPECT_THAT(refusal("<EtherCATConfig/>").remedy, HasSubstr("ENI"));
}

TEST(EsiFile, AVendorIsNeeded) {
    const auto none = refusal("<EtherCATInfo>\n</EtherCATInfo>");
    EXPECT_EQ(none.subject, "box.xml:1:2 (EtherCATInfo)");
    EXPECT_EQ(none.what, "it has no Vendor");
    const auto word = refusal("<EtherCATInfo><Vendor>\n<Id>two</Id></Vendor></EtherCATInfo>");
    EXPECT_EQ(word.subject, "box.xml:2:2 (EtherCATInfo/Vendor/Id)");
    EXPECT_EQ(word.what, "Id is 'two', which is no number");
    EXPECT_EQ(word.remedy, "write a number such as 16 or #x10");
    EXPECT_EQ(refusal("<EtherCATInfo><Vendor><Id>#x100000000</Id></Vendor></EtherCATInfo>").what,
              "Id is #x100000000, beyond 0 to 4294967295");
}

TEST(EsiFile, HeadingsHaveIdentityNamesAndGroup) {
    const auto file = parsed(
        file_with("<Device><Type ProductCode=\"#x1001\" RevisionNo=\"131073\" CheckRevisionNo=\"EQ_OR_G\">BX1</Type>"
                  "<Name LcId=\"1031\">Kasten</Name><Name LcId=\"2052\">\xE7\x9B\x92</Name><Name LcId=\"1033\"><![CDATA[Box <1>]]></Name>"
                  "<GroupType>Boxes</GroupType></Device>\n"));
    ASSERT_TRUE(file) << file.error().text();
    EXPECT_EQ(file->vendor(), 9999u);
    EXPECT_EQ(file->vendor_name(), "Works");
    ASSERT_EQ(file->devices().size(), 1u);
    const auto& box = file->devices()[0];
    EXPECT_EQ(box.identity, (Identity{9999, 0x1001, 0x20001, 0}));
    EXPECT_EQ(box.name, "Box <1>");
    EXPECT_EQ(box.chinese, "\xE7\x9B\x92");
    EXPECT_EQ(box.group, "Field boxes");
    EXPECT_EQ(box.check_revision, "EQ_OR_G");
    EXPECT_EQ(box.line, 6u);
}

TEST(EsiFile, WithoutEnglishTheNameIsWhatThereIs) {
    const auto name = [](const std::string& names) {
        const auto file = parsed(file_with("<Device><Type ProductCode=\"1\">A</Type>" + names + "</Device>"));
        return file ? file->devices().at(0).name : file.error().text();
    };
    EXPECT_EQ(name("<Name LcId=\"1031\">Kasten</Name><Name LcId=\"2057\">British box</Name>"), "British box");
    EXPECT_EQ(name("<Name LcId=\"2052\">\xE7\x9B\x92</Name>"), "\xE7\x9B\x92");
    EXPECT_EQ(name("<Name LcId=\"2052\">\xE7\x9B\x92</Name><Name>Box</Name>"), "Box");
    EXPECT_EQ(name("<Name LcId=\"1031\">Kasten</Name>"), "Kasten");
}

TEST(EsiFile, ADeviceHidesTheRevisionsThatItReplaces) {
    const auto file =
        parsed(file_with("<Device><Type ProductCode=\"1\" RevisionNo=\"#x10000\">A</Type></Device>"
                         "<Device><Type ProductCode=\"1\" RevisionNo=\"#x20000\">A</Type><HideType RevisionNo=\"#x10000\"/></Device>"
                         "<Device><Type ProductCode=\"2\" RevisionNo=\"#x10000\">B</Type></Device>"
                         "<Device Invisible=\"true\"><Type ProductCode=\"3\">C</Type></Device>"));
    ASSERT_TRUE(file);
    std::vector<bool> hidden;
    for (const auto& device : file->devices()) hidden.push_back(device.hidden);
    EXPECT_THAT(hidden, ElementsAre(true, false, false, true));
}

TEST(EsiFile, APartWithoutAControllerIsListedAndCannotBeUsed) {
    const auto file = parsed(file_with("<Device><Type>End cap</Type></Device>"));
    ASSERT_TRUE(file);
    EXPECT_THAT(file->remarks(), IsEmpty());
    const auto reading = file->read(0);
    ASSERT_EQ(reading.problems.size(), 1u);
    EXPECT_EQ(reading.problems[0].code, "esi.no_product");
    EXPECT_EQ(reading.problems[0].subject, "box.xml:6:10 (Device 'End cap'/Type)");
}

TEST(EsiFile, OtherFilesThatItRefersToAreNamed) {
    const auto file = parsed("<EtherCATInfo><InfoReference>modules.xml</InfoReference><Vendor><Id>1</Id></Vendor></EtherCATInfo>");
    ASSERT_TRUE(file);
    ASSERT_EQ(file->remarks().size(), 1u);
    EXPECT_EQ(file->remarks()[0].code, "esi.other_file");
    EXPECT_EQ(file->remarks()[0].what, "it refers to 'modules.xml', which was not read");
}

TEST(EsiFile, AFileThatIsNotThereIsSaid) {
    const auto file = EsiFile::open("/nowhere/box.xml");
    ASSERT_FALSE(file);
    EXPECT_EQ(file.error().text(), "/nowhere/box.xml: the file cannot be read. check its name, and that you may read it");
}

TEST(EsiFile, AFolderAPipeAndADeviceAreNoFiles) {
    const auto folder = testing::TempDir() + "esi-kinds-" + std::to_string(::getpid());
    std::filesystem::create_directories(folder + "/a.xml");
    ASSERT_EQ(::mkfifo((folder + "/b.xml").c_str(), 0600), 0);
    for (const auto& path : {folder, folder + "/a.xml", folder + "/b.xml", std::string("/dev/zero")}) {
        const auto file = EsiFile::open(path);
        ASSERT_FALSE(file);
        EXPECT_EQ(file.error().code, "esi.file") << path;
        EXPECT_EQ(file.error().what, "this is not a regular file") << path;
    }
    const auto all = EsiFolder::open(folder);
    EXPECT_FALSE(all) << "a folder and a pipe among its files hold nothing up";
    std::filesystem::remove_all(folder);
}

// What a person reads, in tables, comments and on terminals, stays on its line, whatever references hide in it.
TEST(EsiFile, NamesAreOnOneLine) {
    const auto file =
        parsed(file_with("<Device Physics=\"Y&#27;Y\"><Type ProductCode=\"1\">B&#13;X&#10;\n1&#27;[31m</Type>"
                         "<Name>one&#x2028;two&#xD800;&#x85;three&#127;</Name></Device>"));
    ASSERT_TRUE(file);
    EXPECT_EQ(file->devices()[0].type, "B X  1 [31m");
    EXPECT_EQ(file->devices()[0].name, "one two three");
    EXPECT_EQ(file->read(0).device.physics, "Y Y");
}

class EsiChoice : public testing::Test {
protected:
    Result<EsiFile> file =
        parsed(file_with("<Device><Type ProductCode=\"1\" RevisionNo=\"#x30000\">EL1</Type></Device>"
                         "<Device><Type ProductCode=\"1\" RevisionNo=\"#x10000\">EL1</Type></Device>"
                         "<Device><Type ProductCode=\"1\" RevisionNo=\"#x20000\">EL1</Type><HideType RevisionNo=\"#x30000\"/></Device>"
                         "<Device><Type ProductCode=\"2\">EL2-0001</Type></Device>"));
    Result<std::size_t> choose(const std::string& word, std::optional<std::uint32_t> revision = {}) const {
        return choose_device(*file, word, revision);
    }
};

TEST_F(EsiChoice, ATypeMeansItsNewestRevisionThatIsNotReplaced) {
    EXPECT_EQ(choose("EL1").value(), 2u);
    EXPECT_EQ(choose("el1").value(), 2u);
    EXPECT_EQ(choose("el2-0001").value(), 3u);
    EXPECT_EQ(choose("EL1", 0x10000).value(), 1u);
    EXPECT_EQ(choose("EL1", 0x30000).value(), 0u) << "a replaced one, when it is asked for";
    EXPECT_EQ(choose("1").value(), 0u) << "the number in the list";
}

TEST_F(EsiChoice, WhatIsNotThereIsRefusedWithWhatIs) {
    EXPECT_EQ(choose("EL2-0002").error().text(), "box.xml: there is no device 'EL2-0002' in it. did you mean EL2-0001?");
    EXPECT_EQ(choose("9").error().text(), "box.xml: there is no device 9 in it: it has 4. choose one of EL1, EL2-0001");
    EXPECT_EQ(choose("").error().text(), "box.xml: it holds 2 types of device. choose one with --device: EL1, EL2-0001");
    EXPECT_EQ(choose("EL1", 5).error().text(),
              "box.xml: EL1 has no revision 00000005h in it. choose one of 00030000h, 00010000h, 00020000h");
}

TEST(EsiChoiceOfOne, NeedsNoWord) {
    const auto file = parsed(file_with(device_with("")));
    ASSERT_TRUE(file);
    EXPECT_EQ(choose_device(*file, "", {}).value(), 0u);
    const auto none = parsed(file_with(""));
    ASSERT_TRUE(none);
    EXPECT_EQ(choose_device(*none, "", {}).error().what, "there is no device in this file");
}

}  // namespace
}  // namespace taktwerk::ecat::esi
