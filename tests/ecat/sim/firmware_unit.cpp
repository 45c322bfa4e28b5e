// The firmware of a simulated slave: what its flash holds after whatever was done to it, and what the boot loader makes of it.
#include "ecat/sim/firmware_flash.hpp"

#include <gtest/gtest.h>

#include "ecat/wire/foe_error.hpp"

namespace taktwerk::ecat::sim {
namespace {

using namespace std::chrono_literals;

constexpr Identity flash_device{0xABC, 0x4711, 1, 0};

class Flash : public ::testing::TestWithParam<unsigned> {
protected:
    Flash() {
        options.banks = GetParam();
        flash.emplace(flash_device, options);
    }
    void write(std::span<const std::byte> bytes) { ASSERT_EQ(flash->program(bytes, now), 0u); }
    [[nodiscard]] std::string after_boot() {
        flash->boot();
        return flash->running() ? flash->running()->version : "";
    }
    [[nodiscard]] std::string kept() const { return GetParam() == 1 ? "" : "1.0"; }

    FirmwareOptions options;
    std::optional<FirmwareFlash> flash;
    Instant now = Instant{} + 1s;
    const std::vector<std::byte> fresh = firmware_image({0xABC, 0x4711, 2, 0}, "2.0", 5000);
};

TEST_P(Flash, ComesWithVersionOne) {
    EXPECT_EQ(after_boot(), "1.0");
    EXPECT_TRUE(read_firmware(flash->image())->sound);
}

TEST_P(Flash, RunsWhatIsCompleteFromTheNextBootOn) {
    flash->begin(now);
    write(fresh);
    EXPECT_EQ(flash->finish(), 0u);
    EXPECT_EQ(after_boot(), "2.0");
    flash->begin(now);
    write(firmware_image({0xABC, 0x4711, 3, 0}, "3.0", 100));
    EXPECT_EQ(flash->finish(), 0u);
    EXPECT_EQ(after_boot(), "3.0") << "and back into the first bank";
}

TEST_P(Flash, HalfAnImageIsNone) {
    flash->begin(now);
    write(std::span{fresh}.first(2500));
    EXPECT_EQ(after_boot(), kept());
}

TEST_P(Flash, ErasingAloneCostsWhatWasInTheBank) {
    flash->begin(now);
    EXPECT_EQ(after_boot(), kept());
}

TEST_P(Flash, ErasingAndWritingTakeTheirTime) {
    flash->begin(now);
    EXPECT_TRUE(flash->busy(now));
    EXPECT_TRUE(flash->busy(now + options.erase_time - 1ns));
    EXPECT_FALSE(flash->busy(now + options.erase_time));
    EXPECT_EQ(flash->percent(now + options.erase_time / 2), 50u);
    now += options.erase_time;
    write(std::span{fresh}.first(2048));
    EXPECT_FALSE(flash->busy(now + 2 * options.write_time_per_kib));
    EXPECT_TRUE(flash->busy(now + 2 * options.write_time_per_kib - 1ns));
}

TEST_P(Flash, SaysWhatIsWrongWithAnImage) {
    const auto verdict = [&](std::vector<std::byte> bytes) {
        flash->begin(now);
        write(bytes);
        return flash->finish();
    };
    EXPECT_EQ(verdict(std::vector<std::byte>(100, std::byte{1})), foe_error::no_file_header);
    EXPECT_EQ(verdict({}), foe_error::no_file_header);
    auto damaged = fresh;
    damaged.back() ^= std::byte{1};
    EXPECT_EQ(verdict(damaged), foe_error::wrong_checksum);
    EXPECT_EQ(verdict({fresh.begin(), fresh.end() - 1}), foe_error::wrong_checksum);
    EXPECT_EQ(verdict(firmware_image({0xABC, 0x4712, 2, 0}, "2.0", 100)), foe_error::wrong_firmware);
    EXPECT_EQ(after_boot(), kept());
}

TEST_P(Flash, HoldsNoMoreThanABank) {
    flash->begin(now);
    write(std::vector<std::byte>(options.capacity));
    const std::byte one{};
    EXPECT_EQ(flash->program({&one, 1}, now), foe_error::disk_full);
}

INSTANTIATE_TEST_SUITE_P(Banks, Flash, ::testing::Values(1u, 2u));

// CRC-32 of IEEE 802.3 over what the header says: by hand over "123456789" it is CBF43926h; here that any change is seen.
TEST(FirmwareImage, ASingleBitAnywhereIsSeen) {
    const auto image = firmware_image(flash_device, "1.0", 40);
    ASSERT_TRUE(read_firmware(image)->sound);
    for (std::size_t bit = 32; bit < image.size() * 8; ++bit) {  // behind the magic
        auto changed = image;
        changed[bit / 8] ^= static_cast<std::byte>(1u << bit % 8);
        const auto read = read_firmware(changed);
        EXPECT_FALSE(read && read->sound) << bit;
    }
}

}  // namespace
}  // namespace taktwerk::ecat::sim
