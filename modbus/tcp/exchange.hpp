#pragma once
// The way to one Modbus TCP device: one request, one answer, or what was wrong.

#include <cstdint>
#include <span>

#include "modbus/tcp/device_config.hpp"

namespace taktwerk::modbus::tcp {

/// Why a request came to nothing. Plain data.
struct Fault {
    enum class Kind : std::uint8_t {
        none,
        refused,      ///< nobody listens at that port
        unreachable,  ///< no way to that address
        timeout,      ///< no connection, or no whole answer, in time
        closed,       ///< the device ended the connection
        exception,    ///< it answered with an exception code
        bad_answer,   ///< it answered something else than was asked
    };
    Kind kind = Kind::none;
    std::uint8_t exception = 0;  ///< chapter 7: 1 illegal function, 2 illegal address, 3 illegal value, 4 device failure, ...
    constexpr explicit operator bool() const noexcept { return kind != Kind::none; }
    /// After any other fault nobody knows which answer comes next: the connection is ended.
    [[nodiscard]] constexpr bool ends_connection() const noexcept { return kind != Kind::none && kind != Kind::exception; }
    friend bool operator==(const Fault&, const Fault&) = default;
};

/// Used by one thread. Everything blocks for the device's `timeout` at most.
class Exchange {
public:
    virtual ~Exchange() = default;
    [[nodiscard]] virtual bool connected() const = 0;
    [[nodiscard]] virtual Fault connect() = 0;
    virtual void close() = 0;
    /// `values.size()` registers, or bits as 0 and 1. On a fault `values` are void.
    [[nodiscard]] virtual Fault read(Table table, std::uint16_t address, std::span<std::uint16_t> values) = 0;
    /// Coils or holding registers. One of them: functions 5 and 6; several: 15 and 16.
    [[nodiscard]] virtual Fault write(Table table, std::uint16_t address, std::span<const std::uint16_t> values) = 0;
};

}  // namespace taktwerk::modbus::tcp
