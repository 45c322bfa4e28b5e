#include "ecat/sim/firmware_flash.hpp"

#include <algorithm>

#include "ecat/wire/foe_error.hpp"

namespace taktwerk::ecat::sim {

namespace {

constexpr std::byte erased{0xFF};

}  // namespace

FirmwareFlash::FirmwareFlash(const Identity& device, const FirmwareOptions& options) : device_(device), options_(options) {
    banks_.assign(std::max(1u, options.banks), std::vector<std::byte>(options.capacity, erased));
    const auto image = firmware_image(device, "1.0", std::min(options.factory_size, options.capacity - firmware_header_size));
    std::copy(image.begin(), image.end(), banks_[0].begin());
    boot();
}

std::optional<FirmwareInfo> FirmwareFlash::sound_in(unsigned bank) const {
    auto info = read_firmware(banks_[bank]);
    if (!info || !info->sound || info->identity.vendor != device_.vendor || info->identity.product != device_.product) return std::nullopt;
    return info;
}

void FirmwareFlash::boot() noexcept {
    busy_until_ = Instant{};
    running_.reset();
    for (unsigned n = 0; n < banks_.size() && !running_; ++n) {
        running_bank_ = (chosen_ + n) % static_cast<unsigned>(banks_.size());
        running_ = sound_in(running_bank_);
    }
}

std::span<const std::byte> FirmwareFlash::image() const noexcept {
    if (!running_) return {};
    return std::span{banks_[running_bank_]}.first(running_->size);
}

void FirmwareFlash::begin(Instant now) noexcept {
    target_ = banks_.size() == 1 ? 0 : (running_bank_ + 1) % static_cast<unsigned>(banks_.size());
    std::fill(banks_[target_].begin(), banks_[target_].end(), erased);
    written_ = 0;
    work(options_.erase_time, now);
}

unsigned FirmwareFlash::percent(Instant now) const noexcept {
    if (!busy(now) || busy_until_ <= busy_from_) return 100;
    return static_cast<unsigned>(100 * (now - busy_from_) / (busy_until_ - busy_from_));
}

std::uint32_t FirmwareFlash::program(std::span<const std::byte> bytes, Instant now) noexcept {
    auto& bank = banks_[target_];
    if (bytes.size() > bank.size() - written_) return foe_error::disk_full;
    std::copy(bytes.begin(), bytes.end(), bank.begin() + static_cast<std::ptrdiff_t>(written_));
    written_ += bytes.size();
    work(options_.write_time_per_kib * static_cast<std::int64_t>(bytes.size()) / 1024, now);
    return 0;
}

std::uint32_t FirmwareFlash::finish() noexcept {
    const auto info = read_firmware(std::span{banks_[target_]}.first(written_));
    if (!info) return foe_error::no_file_header;
    if (!info->sound || info->size != written_) return foe_error::wrong_checksum;
    if (!sound_in(target_)) return foe_error::wrong_firmware;
    chosen_ = target_;
    return 0;
}

void FirmwareFlash::work(Duration length, Instant now) noexcept {
    busy_from_ = now;
    busy_until_ = now + length;
}

}  // namespace taktwerk::ecat::sim
