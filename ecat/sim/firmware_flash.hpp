#pragma once
// The flash in which a simulated slave keeps its firmware, and the boot loader that chooses what runs. What is in it survives a power
// cut as far as it was written, and nobody remembers more: at power-on the boot loader looks at the bytes alone.
//
//   two banks    the new image goes into the one that does not run; the word that says which runs is written when the image was found sound
//   one bank     the new image goes over the old one: from the first erase on only the boot loader is left, until all of it is there
//
// Erasing and writing take machine time. Banks are allocated once.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/time.hpp"
#include "ecat/sim/firmware_image.hpp"
#include "ecat/wire/identity.hpp"

namespace taktwerk::ecat::sim {

struct FirmwareOptions {
    unsigned banks = 2;
    std::size_t capacity = std::size_t{256} * 1024;        ///< of a bank
    Duration erase_time = std::chrono::milliseconds{120};  ///< of a bank
    Duration write_time_per_kib = std::chrono::milliseconds{1};
    Duration restart_time = std::chrono::milliseconds{40};  ///< from BOOT left until the application answers again
    std::uint32_t password = 0;                             ///< that a writer has to know
    std::size_t factory_size = std::size_t{8} * 1024;       ///< of the body it comes with
};

class FirmwareFlash {
public:
    /// As it comes from the factory: version 1.0 of this device in the first bank.
    FirmwareFlash(const Identity& device, const FirmwareOptions& options);

    /// Power is on, or the application ends: the boot loader looks what can run.
    void boot() noexcept;
    /// Nothing: no bank holds a sound image of this device. The boot loader alone runs.
    [[nodiscard]] const std::optional<FirmwareInfo>& running() const noexcept { return running_; }
    /// The bytes of what runs.
    [[nodiscard]] std::span<const std::byte> image() const noexcept;

    /// Erases the bank that the new image goes into.
    void begin(Instant now) noexcept;
    /// It takes nothing until then.
    [[nodiscard]] bool busy(Instant now) const noexcept { return now < busy_until_; }
    [[nodiscard]] unsigned percent(Instant now) const noexcept;
    /// Behind what was written since begin(). A foe_error, 0: taken.
    [[nodiscard]] std::uint32_t program(std::span<const std::byte> bytes, Instant now) noexcept;
    /// Is it a sound image of this device? A foe_error, 0: it runs from the next boot() on.
    [[nodiscard]] std::uint32_t finish() noexcept;
    /// Bytes since begin().
    [[nodiscard]] std::size_t written() const noexcept { return written_; }

private:
    void work(Duration length, Instant now) noexcept;
    [[nodiscard]] std::optional<FirmwareInfo> sound_in(unsigned bank) const;

    Identity device_;
    FirmwareOptions options_;
    std::vector<std::vector<std::byte>> banks_;
    unsigned chosen_ = 0;  ///< the word in the flash; which bank runs when both could
    unsigned target_ = 0;
    std::size_t written_ = 0;
    unsigned running_bank_ = 0;
    std::optional<FirmwareInfo> running_;
    Instant busy_from_{}, busy_until_{};
};

}  // namespace taktwerk::ecat::sim
