// A folder of vendors' files, and which of their devices a slave is.

#include "ecat/esi/esi_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "tests/ecat/esi/esi_text.hpp"

namespace taktwerk::ecat::esi {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

class EsiFolderTest : public testing::Test {
protected:
    void SetUp() override {
        std::string pattern = testing::TempDir() + "esi-folder-XXXXXX";
        ASSERT_NE(::mkdtemp(pattern.data()), nullptr);
        folder = pattern;
    }
    void TearDown() override { std::filesystem::remove_all(folder); }
    void write(const std::string& name, const std::string& text) const { std::ofstream(folder / name) << text; }
    static std::string device(const char* type, const char* revision) {
        return std::string("<Device><Type ProductCode=\"#x1001\" RevisionNo=\"") + revision + "\">" + type + "</Type></Device>";
    }
    std::filesystem::path folder;
};

TEST_F(EsiFolderTest, FindsTheRevisionItselfElseTheNearestOfTheVariant) {
    write("a.xml", file_with(device("BX1", "#x00010000") + device("BX1", "#x00030000") + device("BX1-0020", "#x00050014")));
    write("b.XML", file_with(device("BX1-0030", "#x0001001E")));
    write("notes.txt", "no XML");
    write("dictionary.xml", "<EtherCATDict/>");
    const auto found = EsiFolder::open(folder.string());
    ASSERT_TRUE(found) << found.error().text();
    EXPECT_THAT(found->damaged(), IsEmpty());
    const auto who = [&](std::uint32_t revision) {
        const auto* known = found->find({9999, 0x1001, revision, 0});
        return known == nullptr ? std::string("nobody") : known->heading.type + " " + known->file;
    };
    EXPECT_EQ(who(0x00010000), "BX1 a.xml");
    EXPECT_EQ(who(0x0001001E), "BX1-0030 b.XML");
    EXPECT_EQ(who(0x0009001E), "BX1-0030 b.XML") << "newer than the file, same variant";
    EXPECT_EQ(found->find({9999, 0x1001, 0x00020000, 0})->heading.identity.revision, 0x00010000u) << "not a later one than the slave";
    EXPECT_EQ(found->find({9999, 0x1001, 0x00040000, 0})->heading.identity.revision, 0x00030000u);
    EXPECT_EQ(who(0x00010099), "BX1-0020 a.xml") << "a variant that nobody describes: the newest";
    EXPECT_EQ(found->find({9999, 0x1002, 0x00010000, 0}), nullptr);
    EXPECT_EQ(found->find({9998, 0x1001, 0x00010000, 0}), nullptr);
}

TEST_F(EsiFolderTest, SaysWhichFileIsDamaged) {
    write("a.xml", file_with(device("BX1", "1")));
    write("b.xml", "<EtherCATInfo><Vendor>");
    const auto found = EsiFolder::open(folder.string());
    ASSERT_TRUE(found);
    ASSERT_EQ(found->damaged().size(), 1u);
    EXPECT_THAT(found->damaged()[0].subject, HasSubstr("b.xml:1:"));
}

TEST_F(EsiFolderTest, WithoutOneItIsRefused) {
    const auto empty = EsiFolder::open(folder.string());
    ASSERT_FALSE(empty);
    EXPECT_EQ(empty.error().what, "no ESI file in it describes a device");
    const auto nowhere = EsiFolder::open((folder / "nowhere").string());
    ASSERT_FALSE(nowhere);
    EXPECT_EQ(nowhere.error().code, "esi.folder");
    EXPECT_THAT(nowhere.error().what, HasSubstr("cannot be read"));
}

}  // namespace
}  // namespace taktwerk::ecat::esi
