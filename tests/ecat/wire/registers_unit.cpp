// Register layouts written by hand from ETG.1000.4; AL codes from ETG.1000.6 (reference/ethercat-masters.md section 5).
#include "ecat/wire/registers.hpp"

#include <gtest/gtest.h>

#include "ecat/wire/al_status.hpp"
#include "tests/ecat/wire/bytes_of.hpp"

namespace taktwerk::ecat {
namespace {

using test::bytes_of;
using test::copy_of;

TEST(Fmmu, EncodesToItsSixteenRegisterBytes) {
    const Fmmu outputs{.logical_start = 0x00012345,
                       .length = 19,
                       .logical_start_bit = 3,
                       .logical_stop_bit = 5,
                       .physical_start = 0x1800,
                       .physical_start_bit = 1,
                       .read = false,
                       .write = true,
                       .active = true};
    std::array<std::byte, Fmmu::size> registers;
    registers.fill(std::byte{0xEE});

    encode(outputs, registers);

    EXPECT_EQ(copy_of(registers), bytes_of({0x45, 0x23, 0x01, 0x00, 19, 0, 3, 5, 0x00, 0x18, 1, 2, 1, 0, 0, 0}));
    EXPECT_EQ(decode_fmmu(registers), outputs);
}

TEST(Fmmu, OfZeroesIsOff) {
    const std::array<std::byte, Fmmu::size> registers{};
    const auto fmmu = decode_fmmu(registers);
    EXPECT_FALSE(fmmu.active);
    EXPECT_FALSE(fmmu.read);
    EXPECT_FALSE(fmmu.write);
    EXPECT_EQ(fmmu.logical_stop_bit, 0);
}

TEST(SyncManager, EncodesToItsEightRegisterBytes) {
    const SyncManager mailbox_out{
        .start = 0x1000, .length = 0x0080, .control = SyncManager::usual_mailbox_out, .status = 0, .activate = 1, .pdi_control = 0};
    std::array<std::byte, SyncManager::size> registers{};

    encode(mailbox_out, registers);

    EXPECT_EQ(copy_of(registers), bytes_of({0x00, 0x10, 0x80, 0x00, 0x26, 0x00, 0x01, 0x00}));
    EXPECT_EQ(decode_sync_manager(registers), mailbox_out);
}

TEST(SyncManager, UsualControlBytesSayModeAndDirection) {
    const auto with = [](std::uint8_t control) {
        return SyncManager{.start = 0, .length = 0, .control = control, .status = 0, .activate = 0, .pdi_control = 0};
    };
    EXPECT_TRUE(with(0x26).is_mailbox());
    EXPECT_TRUE(with(0x26).is_written_by_master());
    EXPECT_TRUE(with(0x22).is_mailbox());
    EXPECT_FALSE(with(0x22).is_written_by_master());
    EXPECT_FALSE(with(0x64).is_mailbox());
    EXPECT_TRUE(with(0x64).is_written_by_master());
    EXPECT_TRUE((with(0x64).control & SyncManager::watchdog_trigger) != 0);
    EXPECT_FALSE(with(0x20).is_mailbox());
    EXPECT_FALSE(with(0x20).is_written_by_master());
}

TEST(Registers, TablesAreSixteenAndEightBytesApart) {
    EXPECT_EQ(reg::fmmu_at(0), 0x0600);
    EXPECT_EQ(reg::fmmu_at(7), 0x0670);
    EXPECT_EQ(reg::sync_manager_at(2), 0x0810);
    EXPECT_EQ(reg::sync_manager_at(15), 0x0878);
}

// A port leads to a neighbour only with a signal and an open loop; a physical link alone is not enough.
TEST(DlStatus, PortIsOpenOnlyWithSignalAndWithoutLoop) {
    const std::uint16_t two_ports = 0x5A33;  // b4,5 links; port 0, 1: signal (b9, b11), loop open; port 2, 3: closed (b12, b14)
    EXPECT_TRUE(dl_port_open(two_ports, 0));
    EXPECT_TRUE(dl_port_open(two_ports, 1));
    EXPECT_FALSE(dl_port_open(two_ports, 2));
    EXPECT_FALSE(dl_port_open(two_ports, 3));
    EXPECT_FALSE(dl_port_open(0x0010, 0)) << "link without signal";
    EXPECT_FALSE(dl_port_open(0x0310, 0)) << "signal with the loop closed";
}

TEST(DcDifference, IsSignAndMagnitude) {
    EXPECT_EQ(dc_difference_ns(0x00000010), 16);
    EXPECT_EQ(dc_difference_ns(0x80000010), -16);
    EXPECT_EQ(dc_difference_ns(0x7FFFFFFF), 2147483647);
    EXPECT_EQ(dc_difference_ns(0xFFFFFFFF), -2147483647);
}

TEST(AlState, IgnoresTheOtherBitsOfAlStatus) {
    EXPECT_EQ(al_state(0x0014), AlState::safeop);
    EXPECT_EQ(al_state(0x0028), AlState::op);
    EXPECT_EQ(al_state(0x0005), AlState::unknown);
    EXPECT_EQ(name(AlState::safeop), "SAFEOP");
    EXPECT_EQ(name(static_cast<AlState>(5)), "unknown");
}

TEST(AlStatusCodes, CoverTheStandardsTable) {
    for (const int code :
         {0x0001, 0x0002, 0x0003, 0x0004, 0x0006, 0x0011, 0x0012, 0x0013, 0x0014, 0x0015, 0x0016, 0x0017, 0x0018, 0x0019, 0x001A,
          0x001B, 0x001C, 0x001D, 0x001E, 0x001F, 0x0020, 0x0021, 0x0022, 0x0023, 0x0024, 0x0025, 0x0026, 0x0027, 0x0028, 0x0029,
          0x002A, 0x002B, 0x002C, 0x002D, 0x002E, 0x0030, 0x0031, 0x0032, 0x0033, 0x0034, 0x0035, 0x0036, 0x0037, 0x0041, 0x0042,
          0x0043, 0x0044, 0x0045, 0x004F, 0x0050, 0x0051, 0x0052, 0x0060, 0x0061, 0x0070, 0x0080, 0x0081, 0x0082, 0x0083, 0x00F0})
        EXPECT_EQ(al_status_info(static_cast<std::uint16_t>(code)).code, code) << std::hex << code;
    EXPECT_EQ(al_status_info(0x001B).text, "sync manager watchdog");
    EXPECT_EQ(al_status_info(0x8123).code, 0xFFFF);
    EXPECT_FALSE(al_status_info(0x8123).remedy.empty());
}

}  // namespace
}  // namespace taktwerk::ecat
