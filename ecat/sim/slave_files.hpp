#pragma once
// What a simulated slave has by name: plain files, which are there in PREOP and above, and its firmware, which is written in BOOT alone and
// can always be read. One file is open at a time. A plain file becomes another one when all of it is there; what becomes of firmware
// says firmware_flash.hpp.
//
//   the name                                      read                          write
//   "firmware", or what begins with "ECATFW__"    what runs; none: not found    in BOOT; else 8008h
//   a plain file                                  its bytes                     new content; of a read-only one 8002h
//   another                                       8001h                         a new file, up to the capacity of all (8003h)

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/time.hpp"
#include "ecat/sim/device_model.hpp"
#include "ecat/sim/firmware_flash.hpp"

namespace taktwerk::ecat::sim {

struct SlaveFile {
    std::string name;
    std::vector<std::byte> bytes{};
    std::uint32_t password = 0;  ///< asked for in both directions; 0: none
    bool read_only = false;
};

class SlaveFiles {
public:
    explicit SlaveFiles(const Identity& device, const FirmwareOptions& options);

    static constexpr std::size_t capacity = std::size_t{256} * 1024;  ///< of all plain files together
    static constexpr std::size_t longest_name = 64;

    // All give a foe_error; 0: done.
    [[nodiscard]] std::uint32_t open_to_read(std::string_view name, std::uint32_t password, EsmState state);
    [[nodiscard]] std::uint32_t open_to_write(std::string_view name, std::uint32_t password, EsmState state, Instant now);
    [[nodiscard]] std::uint32_t write(std::span<const std::byte> bytes, Instant now);
    /// All of it was written.
    [[nodiscard]] std::uint32_t close();
    /// The transfer broke off.
    void abandon() noexcept;

    /// Of the file that is open to read.
    [[nodiscard]] std::span<const std::byte> content() const noexcept { return content_; }
    /// It takes no more just now.
    [[nodiscard]] bool busy(Instant now) const noexcept { return firmware_open_ && flash_.busy(now); }
    [[nodiscard]] unsigned percent(Instant now) const noexcept { return flash_.percent(now); }

    [[nodiscard]] FirmwareFlash& flash() noexcept { return flash_; }
    [[nodiscard]] const FirmwareFlash& flash() const noexcept { return flash_; }
    [[nodiscard]] std::vector<SlaveFile>& plain() noexcept { return files_; }
    [[nodiscard]] SlaveFile* find(std::string_view name) noexcept;

private:
    [[nodiscard]] std::size_t used() const noexcept;

    FirmwareFlash flash_;
    std::uint32_t firmware_password_;
    std::vector<SlaveFile> files_;
    std::span<const std::byte> content_;
    SlaveFile incoming_;
    bool firmware_open_ = false;
};

}  // namespace taktwerk::ecat::sim
