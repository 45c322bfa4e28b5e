// SV-DA200 guide 2.2.4, CT-1 of its sheet: process data are mapped anew in Pre-Op, in six steps, with at most ten objects a PDO [2.1 note 11].

#include <algorithm>

#include "ecat/sim/process_data.hpp"
#include "tests/drives/drive_desk.hpp"

namespace taktwerk::test::sv_da200_mapping {
namespace {

constexpr std::uint32_t device_state = 0x08000022, sub0_not_zero = 0x06010003, too_high = 0x06090031;  // CiA 301 table 22

class SvDa200Mapping : public ::testing::Test, protected DriveDesk {
protected:
    SvDa200Mapping() : DriveDesk("sv-da200") {}

    /// Step 1: 1C12h, 1C13h off. Step 2: 1600h to 1603h, 1A00h to 1A03h off.
    void steps_1_and_2() {
        for (const unsigned assignment : {0x1C12u, 0x1C13u}) ASSERT_EQ(write(assignment, 0, 0), 0u);
        for (unsigned n = 0; n < 4; ++n)
            for (const unsigned first : {0x1600u, 0x1A00u}) ASSERT_EQ(write(first + n, 0, 0), 0u);
    }
    /// Steps 3 and 4: the entries, then how many they are.
    void map(unsigned pdo, const std::vector<std::uint32_t>& entries) {
        std::uint8_t sub = 0;
        for (const auto entry : entries) ASSERT_EQ(write(pdo, ++sub, entry), 0u) << std::hex << entry;
        ASSERT_EQ(write(pdo, 0, sub), 0u);
    }
    /// Steps 5 and 6.
    void assign(unsigned rx, unsigned tx) {
        ASSERT_EQ(write(0x1C12, 1, rx), 0u);
        ASSERT_EQ(write(0x1C13, 1, tx), 0u);
        ASSERT_EQ(write(0x1C12, 0, 1), 0u);
        ASSERT_EQ(write(0x1C13, 0, 1), 0u);
    }
    std::uint32_t write(unsigned index, std::uint8_t sub, std::int64_t value) { return sdo(static_cast<std::uint16_t>(index), sub, value); }
};

const std::vector<std::uint32_t> outputs{0x60400010, 0x607A0020, 0x60600008}, inputs{0x60410010, 0x60640020, 0x60610008};

TEST_F(SvDa200Mapping, SixStepsGiveAMappingThatCarriesTheDrive) {
    steps_1_and_2();
    map(0x1600, outputs);
    map(0x1A00, inputs);
    assign(0x1600, 0x1A00);

    // What Safe-Op makes of it: 2 + 4 + 1 bytes each way, packed.
    ecat::sim::ProcessData image(*drive.device, dictionary);
    ASSERT_EQ(image.resolve(), 0);
    EXPECT_EQ(image.bytes(2), 7);
    EXPECT_EQ(image.bytes(3), 7);
    go_operational();
    std::array<std::byte, 7> out{std::byte{0x06}, {}, {}, {}, {}, {}, std::byte{0x08}}, in{};
    image.load_outputs(2, out);
    run(2);
    image.store_inputs(3, in);
    EXPECT_EQ(static_cast<unsigned>(in[0]) & 0x6F, 0x21u) << "Ready to Switch On";
    EXPECT_EQ(in[6], std::byte{8});
}

TEST_F(SvDa200Mapping, TheFactoryMappingIsThatOf224) {
    const std::uint32_t rx[] = {0x60400010, 0x607A0020, 0x60FF0020, 0x60600008, 0x60710010, 0x60B80010, 0x60E00010, 0x60E10010, 0x607F0020};
    const std::uint32_t tx[] = {0x60410010, 0x60640020, 0x606C0020, 0x60770010, 0x60610008, 0x60780010, 0x60B90010, 0x60BA0020, 0x60FD0020};
    EXPECT_EQ(read(0x1600), 9);
    EXPECT_EQ(read(0x1A00), 9);
    for (std::uint8_t n = 0; n < 9; ++n) {
        EXPECT_EQ(read(0x1600, static_cast<std::uint8_t>(n + 1)), rx[n]) << int{n};
        EXPECT_EQ(read(0x1A00, static_cast<std::uint8_t>(n + 1)), tx[n]) << int{n};
    }
    ecat::sim::ProcessData image(*drive.device, dictionary);
    ASSERT_EQ(image.resolve(), 0);
    EXPECT_EQ(image.bytes(2), 23);
    EXPECT_EQ(image.bytes(3), 25);
}

// 2.1 note 11: with more than ten the slave does not come to Op. Which step refuses is not stated; here the count does.
TEST_F(SvDa200Mapping, TenObjectsAreTheMost) {
    steps_1_and_2();
    const std::vector<std::uint32_t> ten{0x60400010, 0x607A0020, 0x60FF0020, 0x60600008, 0x60710010,
                                         0x60B80010, 0x60E00010, 0x60E10010, 0x607F0020, 0x60B20010};
    map(0x1600, ten);
    ASSERT_EQ(write(0x1600, 0, 0), 0u);
    EXPECT_NE(write(0x1600, 11, 0x60720010), 0u);
    EXPECT_EQ(write(0x1600, 0, 11), too_high);
    // Nothing is mapped and nothing assigned now: no outputs to run by.
    ecat::sim::ProcessData image(*drive.device, dictionary);
    ASSERT_EQ(image.resolve(), 0);
    EXPECT_EQ(image.bytes(2), 0);
}

// 2.2.4, note: "takes effect when written in Pre-Op". What an attempt elsewhere answers is not stated; CiA 301 has a code for it.
TEST_F(SvDa200Mapping, OutsidePreOpItStaysAsItIs) {
    go_operational();
    for (const unsigned object : {0x1600u, 0x1601u, 0x1602u, 0x1603u, 0x1A00u, 0x1A01u, 0x1A02u, 0x1A03u, 0x1C12u, 0x1C13u})
        EXPECT_EQ(write(object, 0, 0), device_state) << std::hex << object;
    EXPECT_EQ(read(0x1600), 9);
    EXPECT_EQ(read(0x1C12), 1);
    enter(EsmState::safeop);
    EXPECT_EQ(write(0x1C12, 0, 0), device_state);
    enter(EsmState::preop);
    EXPECT_EQ(write(0x1C12, 0, 0), 0u);
}

// The steps are there for a reason: entries of a mapping in force cannot be written [2.2.4 steps 1 and 2].
TEST_F(SvDa200Mapping, WithoutTheFirstStepsNoEntryIsTaken) {
    EXPECT_EQ(write(0x1600, 1, 0x60410010), sub0_not_zero);
    EXPECT_EQ(write(0x1C12, 1, 0x1601), sub0_not_zero);
    EXPECT_EQ(read(0x1600, 1), 0x60400010);
}

// 4.3, 4.4, column "PDO": what has an N there fits into no PDO.
TEST_F(SvDa200Mapping, OnlyMappableObjectsAreTaken) {
    steps_1_and_2();
    for (const std::uint32_t entry : {0x605D0010u, 0x60980008u, 0x60990120u, 0x609A0020u, 0x20030010u})
        EXPECT_NE(write(0x1600, 1, entry), 0u) << std::hex << entry;
    for (const std::uint32_t entry :
         {0x60720010u, 0x60810020u, 0x60830020u, 0x60840020u, 0x60B00020u, 0x60B10020u, 0x60FE0120u, 0x41000020u})
        EXPECT_EQ(write(0x1600, 1, entry), 0u) << std::hex << entry;
    for (const std::uint32_t entry : {0x603F0010u, 0x60BB0020u, 0x60F40020u, 0x40000010u, 0x300D0020u})
        EXPECT_EQ(write(0x1A00, 1, entry), 0u) << std::hex << entry;
}

}  // namespace
}  // namespace taktwerk::test::sv_da200_mapping
