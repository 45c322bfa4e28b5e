#include "ecat/sim/eeprom_interface.hpp"

#include <utility>

#include "core/bytes.hpp"
#include "ecat/wire/registers.hpp"

namespace taktwerk::ecat::sim {

EepromInterface::EepromInterface(std::vector<std::byte> image, Duration read_time, Duration write_time, bool reads_8_bytes)
    : image_(std::move(image)), read_time_(read_time), write_time_(write_time), reads_8_bytes_(reads_8_bytes) {}

void EepromInterface::power_on() noexcept {
    busy_ = false;
    running_ = Running::none;
    address_ = 0;
    write_data_ = 0;
    for (auto& byte : data_) byte = std::byte{0};
    errors_ = checksum_ok() ? std::uint16_t{0} : static_cast<std::uint16_t>(eeprom::checksum_error | eeprom::not_loaded);
}

std::uint16_t EepromInterface::status() const noexcept {
    std::uint16_t value = static_cast<std::uint16_t>((reads_8_bytes_ ? eeprom::reads_8_bytes : 0u) | eeprom::two_byte_address | errors_);
    if (busy_) value = static_cast<std::uint16_t>(value | eeprom::busy);
    switch (running_) {
        case Running::none: break;
        case Running::read: value = static_cast<std::uint16_t>(value | eeprom::read); break;
        case Running::write: value = static_cast<std::uint16_t>(value | eeprom::write); break;
        case Running::reload: value = static_cast<std::uint16_t>(value | eeprom::reload); break;
    }
    return value;
}

void EepromInterface::control_written(std::uint16_t control, Instant now) noexcept {
    if (busy_) return;
    const auto command = static_cast<std::uint16_t>(control & eeprom::command_mask);
    errors_ = static_cast<std::uint16_t>(errors_ & (eeprom::checksum_error | eeprom::not_loaded));
    const auto begin = [&](Running what, Duration time) {
        running_ = what;
        busy_ = true;
        due_ = faults_.stays_busy ? Instant::max() : now + time;
    };
    switch (command) {
        case 0: break;  // clears the error bits
        case eeprom::read: begin(Running::read, read_time_); break;
        case eeprom::write:
            // The enable bit counts only in the same access as the command.
            if ((control & eeprom::write_enable) == 0 || faults_.write_protected)
                errors_ = static_cast<std::uint16_t>(errors_ | eeprom::write_enable_error);
            else begin(Running::write, write_time_);
            break;
        case eeprom::reload: begin(Running::reload, read_time_ * 4); break;
        default: errors_ = static_cast<std::uint16_t>(errors_ | eeprom::command_error); break;
    }
}

bool EepromInterface::complete() noexcept {
    const Running what = std::exchange(running_, Running::none);
    busy_ = false;
    const std::size_t at = std::size_t{address_} * 2;
    if (what != Running::reload && faults_.refused > 0) {
        --faults_.refused;
        errors_ = static_cast<std::uint16_t>(errors_ | eeprom::command_error);
    } else if (what == Running::read) {
        if (at >= image_.size()) errors_ = static_cast<std::uint16_t>(errors_ | eeprom::command_error);
        for (std::size_t i = 0; i < (reads_8_bytes_ ? 8u : 4u); ++i) data_[i] = at + i < image_.size() ? image_[at + i] : std::byte{0xFF};
    } else if (what == Running::write) {
        if (at + 2 > image_.size()) errors_ = static_cast<std::uint16_t>(errors_ | eeprom::command_error);
        else if (faults_.worn_word != address_) store_le<std::uint16_t>(image_, at, write_data_);
    } else if (what == Running::reload) {
        errors_ = checksum_ok() ? std::uint16_t{0} : eeprom::checksum_error;
        return checksum_ok();
    }
    return false;
}

std::uint16_t EepromInterface::word(std::uint32_t address) const noexcept {
    const std::size_t at = std::size_t{address} * 2;
    return at + 2 <= image_.size() ? load_le<std::uint16_t>(image_, at) : std::uint16_t{0xFFFF};
}

bool EepromInterface::checksum_ok() const noexcept {
    if (image_.size() < 16) return false;
    unsigned crc = 0xFF;
    for (std::size_t i = 0; i < 14; ++i) {
        crc ^= static_cast<unsigned>(image_[i]);
        for (int bit = 0; bit < 8; ++bit) crc = (crc & 0x80u) != 0 ? ((crc << 1) ^ 0x07u) & 0xFFu : (crc << 1) & 0xFFu;
    }
    return crc == (static_cast<unsigned>(image_[14]));
}

}  // namespace taktwerk::ecat::sim
