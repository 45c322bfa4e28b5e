// Where the files of a machine lie in its bundle, so that every word of the machine file still means them.

#include "apps/bundle/packed_machine.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/runtime/bundle/small_bundle.hpp"

namespace taktwerk::apps {
namespace {

using config::UsedFile;
using Kind = config::UsedFile::Kind;
using runtime::TemporaryFolder;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

struct PackedMachineTest : ::testing::Test {
    TemporaryFolder folder;
    std::string machine = folder.write("cell.yaml", "name: cell\n");
    std::string a = folder.write("a", "A"), b = folder.write("b", "B");
    static std::vector<std::string> places(const PackedMachine& packed) {
        std::vector<std::string> out;
        for (const auto& file : packed.files) out.push_back(file.kind + " " + file.path);
        return out;
    }
};

TEST_F(PackedMachineTest, RelativeWordsStayWhatTheyAre) {
    const auto packed = pack(machine, {{Kind::program, "build/feeder.so", a},
                                       {Kind::image, "./plan.svg", b},
                                       {Kind::drive, "xp200.yaml", a},
                                       {Kind::device, "el1008.yaml", b}});
    ASSERT_TRUE(packed) << packed.error().text();
    EXPECT_THAT(places(*packed), ElementsAre("machine machine/cell.yaml", "device devices/el1008.yaml", "drive drives/xp200.yaml",
                                             "program machine/build/feeder.so", "image machine/plan.svg"));
    EXPECT_EQ(packed->files[3].bytes, "A");
    EXPECT_EQ(packed->place_of("build/feeder.so"), "machine/build/feeder.so");
}

TEST_F(PackedMachineTest, WordsThatGoUpPutTheMachineDeeper) {
    const auto packed =
        pack(machine, {{Kind::program, "../../build/feeder.so", a}, {Kind::cam, "../tables/cut.csv", b}, {Kind::drive, "own.yaml", b}});
    ASSERT_TRUE(packed) << packed.error().text();
    EXPECT_THAT(places(*packed), ElementsAre("machine above/machine/cell.yaml", "drive above/drives/own.yaml", "cam above/tables/cut.csv",
                                             "program build/feeder.so"))
        << "drives are looked up in ../drives of the machine's folder";
}

TEST_F(PackedMachineTest, AFileThatIsNamedTwiceIsThereOnce) {
    const auto packed = pack(machine, {{Kind::image, "a.png", a}, {Kind::image, "x/../a.png", a}});
    ASSERT_TRUE(packed);
    EXPECT_EQ(packed->files.size(), 2u);
}

TEST_F(PackedMachineTest, TwoFilesForOnePlaceAreRefused) {
    const auto packed = pack(machine, {{Kind::drive, "own.yaml", a}, {Kind::drive, "own.yaml", b}});
    ASSERT_FALSE(packed);
    EXPECT_EQ(packed.error().code, "bundle.collision");
}

TEST_F(PackedMachineTest, APathOfThisComputerIsRefused) {
    const auto packed = pack(machine, {{Kind::program, a, a}});
    ASSERT_FALSE(packed);
    EXPECT_EQ(packed.error().code, "bundle.absolute");
    EXPECT_THAT(packed.error().text(), HasSubstr("write it relative to the machine file"));
}

TEST_F(PackedMachineTest, AFileThatIsGoneIsSaid) {
    const auto packed = pack(machine, {{Kind::cam, "c.csv", (folder.path() / "c.csv").string()}});
    ASSERT_FALSE(packed);
    EXPECT_EQ(packed.error().code, "bundle.unreadable");
}

}  // namespace
}  // namespace taktwerk::apps
