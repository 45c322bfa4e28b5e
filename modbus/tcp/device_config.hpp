#pragma once
// A Modbus TCP device as the machine file describes it. Plain data. What is wrong with one: runtime/check/modbus_check.cpp.
// Source: MODBUS Application Protocol Specification V1.1b3.

#include <cstdint>
#include <string>
#include <vector>

#include "core/time.hpp"

namespace taktwerk::modbus::tcp {

/// The four tables of the protocol (chapter 4.3).
enum class Table : std::uint8_t { coil, discrete_input, holding, input };
[[nodiscard]] constexpr bool is_bits(Table table) noexcept { return table == Table::coil || table == Table::discrete_input; }
[[nodiscard]] constexpr bool is_writable(Table table) noexcept { return table == Table::coil || table == Table::holding; }

enum class NumberType : std::uint8_t { boolean, uint16, int16, uint32, int32, float32 };
/// Addresses that a number takes: registers, or one bit.
[[nodiscard]] constexpr std::uint16_t addresses_of(NumberType type) noexcept {
    return type == NumberType::uint32 || type == NumberType::int32 || type == NumberType::float32 ? 2 : 1;
}

/// Which register of a number of 32 bits comes first. Inside a register the high byte does, always (chapter 4.2).
enum class WordOrder : std::uint8_t { high_first, low_first };

struct Channel {
    enum class Use : std::uint8_t { none, read, written };
    std::string name;
    Table table = Table::holding;
    std::uint16_t address = 0;  ///< as on the wire: from 0. What manuals call 40001 is address 0 of the holding registers
    NumberType type = NumberType::uint16;
    WordOrder order = WordOrder::high_first;
    std::uint8_t bit = 0;  ///< of a boolean in a register: 0 = lowest
    Use use = Use::none;   ///< by a point of the machine; without one it is not asked for
};

struct DeviceConfig {
    std::string name;
    std::string host;                               ///< IPv4 or IPv6 address, no name: looking one up may take any time. Empty: simulated
    std::uint16_t port = 502;                       ///< assigned by IANA
    std::uint8_t unit = 1;                          ///< 1..247 behind a gateway; 255 where there is none
    Duration poll = std::chrono::milliseconds{20};  ///< from one reading of all channels to the next
    static constexpr Duration longest_timeout = std::chrono::seconds{2};  ///< or the end of a run would wait for too long
    Duration timeout = std::chrono::milliseconds{200};                    ///< for a connection, and for each answer as a whole
    Duration max_age = std::chrono::milliseconds{100};  ///< of an input; older ones are not good any more, and an alarm says why
    Duration refresh = std::chrono::milliseconds{500};  ///< outputs are written so often although nothing changed
    std::uint16_t gap = 8;                              ///< addresses that nobody named and one read may span
    std::vector<Channel> channels;
};

}  // namespace taktwerk::modbus::tcp
