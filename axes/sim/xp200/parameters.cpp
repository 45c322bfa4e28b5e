#include "axes/sim/xp200/parameters.hpp"

namespace taktwerk::axes::sim::xp200 {

namespace pr = axes::xp200::pr;

namespace {

constexpr std::uint16_t unlocked = 316, unlocked_too = 385;  // Pr000 (5.4.1, 3.7)

bool needs_password(std::uint16_t number) noexcept { return number == pr::motor_code || number == pr::motor_series; }

}  // namespace

Parameters::Parameters(const std::vector<DriveParameter>& rows) {
    for (const auto& parameter : rows) {
        const auto number = parameter.address.index;
        if (number >= rows_.size()) continue;
        auto& row = rows_[number];
        row.documented = true;
        row.read_only = parameter.change == ParameterChange::never;
        row.is_signed = parameter.is_signed;
        row.after_restart = parameter.waits_for_restart();
        if (parameter.minimum) row.low = *parameter.minimum;
        if (parameter.maximum) row.high = *parameter.maximum;
        stored_[number] = static_cast<std::uint16_t>(parameter.value);
    }
    restart();
}

std::int64_t Parameters::value(std::uint16_t number, std::uint16_t word) const noexcept {
    return rows_[number].is_signed ? static_cast<std::int16_t>(word) : static_cast<std::int64_t>(word);
}

modbus::ExceptionCode Parameters::read(std::uint16_t address, std::uint16_t& word) const noexcept {
    if (address >= memory_.size()) return modbus::ExceptionCode::illegal_address;
    word = memory_[address];
    return modbus::ExceptionCode::none;
}

modbus::ExceptionCode Parameters::write(std::uint16_t address, std::uint16_t word) noexcept {
    if (address >= memory_.size() || !rows_[address].documented) return modbus::ExceptionCode::illegal_address;
    const auto& row = rows_[address];
    if (row.read_only) return modbus::ExceptionCode::device_failure;
    const auto wanted = value(address, word);
    if (wanted < row.low || wanted > row.high) return modbus::ExceptionCode::illegal_value;
    const auto password = memory_[pr::password];
    if (needs_password(address) && password != unlocked && password != unlocked_too) return modbus::ExceptionCode::none;
    memory_[address] = word;
    if (!row.after_restart) in_force_[address] = word;
    return modbus::ExceptionCode::none;
}

std::int64_t Parameters::operator[](std::uint16_t number) const noexcept { return value(number, in_force_[number]); }

void Parameters::restart() noexcept { memory_ = in_force_ = stored_; }

void Parameters::commission(std::uint16_t number, std::int64_t value) noexcept {
    if (number < stored_.size()) stored_[number] = static_cast<std::uint16_t>(value);
}

}  // namespace taktwerk::axes::sim::xp200
