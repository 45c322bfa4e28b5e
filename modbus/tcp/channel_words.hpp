#pragma once
// Between the registers of a request and the raw words of channels, as points take them (core/point_line.hpp): whole numbers, or the bit
// pattern of a real one.

#include <cstdint>
#include <span>

#include "core/process_image.hpp"
#include "modbus/tcp/device_config.hpp"

namespace taktwerk::modbus::tcp {

/// `values`: those of the channel alone, as many as addresses_of() says; bits as 0 and 1.
[[nodiscard]] std::int64_t word_of(const Channel& channel, std::span<const std::uint16_t> values) noexcept;
/// What the channel's bits do not hold is cut off. Of a boolean in a register: all other bits are 0.
void put_word(const Channel& channel, std::int64_t word, std::span<std::uint16_t> values) noexcept;

/// How wide a channel's number is, for who treats it as a signal of an image; its bit offset means nothing.
[[nodiscard]] Signal signal_of(NumberType type) noexcept;

}  // namespace taktwerk::modbus::tcp
