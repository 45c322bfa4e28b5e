#pragma once
// A simulated slave with files, in PREOP or BOOT, and scripts that speak to its mailbox, in virtual time.

#include <utility>

#include "ecat/foe/file_transfer.hpp"
#include "tests/ecat/coe/coe_bench.hpp"

namespace taktwerk::ecat::test {

inline constexpr std::uint16_t boot_mailbox_size = 0x100;  ///< twice that in PREOP: a packet has 244 bytes

inline DeviceDescription drive_with_files() {
    auto d = sim::small_drive();
    d.mailbox->foe = true;
    d.mailbox->bootstrap = BootstrapDescription{0x1000, boot_mailbox_size, 0x1100, boot_mailbox_size};
    return d;
}

inline Bytes pattern(std::size_t size, unsigned seed = 1) {
    Bytes out(size);
    for (std::size_t i = 0; i < size; ++i) out[i] = static_cast<std::byte>((i * 7 + i / 256 + seed) & 0xFFu);
    return out;
}

class FoeBench : public CoeBench {
public:
    explicit FoeBench(sim::SlaveOptions options = {}) : CoeBench(drive_with_files(), std::move(options)) {}

    void to_boot() {
        probe.now = now;
        probe.request(0, 1);
        for (const unsigned n : {0u, 1u}) probe.set_sync_manager(0, n, 0, 0, 0, 0);  // while one is on its place is frozen
        probe.set_sync_manager(0, 0, 0x1000, boot_mailbox_size, 0x26);
        probe.set_sync_manager(0, 1, 0x1100, boot_mailbox_size, 0x22);
        ASSERT_EQ(probe.request(0, 3), 3);
        now = probe.now;
        mailbox.reset();
        mailbox.out_size = mailbox.in_size = boot_mailbox_size;
        mailbox.in_start = 0x1100;
    }
    /// BOOT left: what is in the flash decides. The station address is gone with the restart.
    std::uint16_t to_init() {
        probe.now = now + 1ms;
        (void)probe.request(0, 1);
        probe.wait(100ms);
        now = probe.now;
        return probe.value<std::uint16_t>(0, reg::al_status);
    }
    Result<Bytes> read(const std::string& name, FoeSettings settings = {}, std::uint32_t password = 0) {
        return run(read_file(*port, mailbox, {name, password}, std::move(settings)), 1'000'000);
    }
    Result<FoeWritten> write(const std::string& name, Bytes content, FoeSettings settings = {}, std::uint32_t password = 0) {
        return run(write_file(*port, mailbox, {name, password}, std::move(content), std::move(settings)), 1'000'000);
    }
    [[nodiscard]] std::uint32_t refusal_of_write(const std::string& name, Bytes content, std::uint32_t password = 0) {
        const auto written = write(name, std::move(content), {}, password);
        if (!written || !written->failure) return 0;
        return foe_code(*written->failure);
    }
    [[nodiscard]] const Bytes* stored(const std::string& name) const {
        const auto* file = slave->files()->find(name);
        return file == nullptr ? nullptr : &file->bytes;
    }
    [[nodiscard]] Bytes firmware(std::string_view version, std::uint32_t revision, std::size_t body = 3000) const {
        const auto& id = slave->description().identity;
        return sim::firmware_image({id.vendor, id.product, revision, 0}, version, body);
    }
};

}  // namespace taktwerk::ecat::test
